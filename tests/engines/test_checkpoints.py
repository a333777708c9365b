"""A run that goes on from a checkpoint is the run that was never stopped, bit for bit; what is no checkpoint is refused."""

from __future__ import annotations

import json
import math
import os
import zipfile
from contextlib import suppress
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

import eventsim as es
import eventsim.engines.auto
from eventsim.engines import checkpoint as checkpoints
from eventsim.engines.base import Snapshot, Stop
from eventsim.engines.checkpoint import Every, interval, load_checkpoint
from eventsim.engines.fitting import demand_fit
from eventsim.engines.packing import packed, unpacked
from eventsim.formulas.rest import SUPPORTED
from eventsim.record.files import SUFFIXES
from eventsim.scene.stage import stage_of
from tests.engines.scenes import lattice_gas, session_of
from tests.engines.test_purity import SCENES

WITH_NUMBA = pytest.mark.skipif(not eventsim.engines.auto.has_compiler(), reason="needs numba")
FAST = ("box", "torus of ties", "plane")
"""Scenes for which kernels are compiled."""

ALL = [
    *(pytest.param(name, "reference", id=name) for name in SCENES),
    *(pytest.param(name, "fast", id=f"{name}, fast", marks=WITH_NUMBA) for name in FAST),
]
TOTAL = 400


class BrokenOff(Exception):  # noqa: N818
    """What a run is broken off with, as a kill would."""


def break_off(scene, path, after, engine="reference", every=1, **wishes):
    """Run with checkpoints until about so many events, then break off without a word of goodbye."""

    def count(rows):
        if rows["event"][-1] >= after:
            raise BrokenOff

    with pytest.raises(BrokenOff):
        es.simulate(scene, events=TOTAL, engine=engine, checkpoint=path, every=every, on_event=count, **wishes)


@pytest.mark.parametrize(("name", "engine"), ALL)
def test_a_run_goes_on_from_any_event(tmp_path, name, engine):
    scene = SCENES[name]()
    whole = es.simulate(scene, events=TOTAL, engine=engine, log=tmp_path / "whole.npz")
    rng = np.random.default_rng(len(name))
    path, log = tmp_path / "run.checkpoint", tmp_path / "run.npz"
    for after in (0, *rng.integers(1, TOTAL, 3).tolist()):
        es.simulate(scene, events=after, engine=engine, log=log, checkpoint=path)
        run = es.resume(path, events=TOTAL)
        assert run.digest == whole.digest
        assert es.load_log(log).rows.tobytes() == es.load_log(tmp_path / "whole.npz").rows.tobytes()
        assert (run.stopped, run.counters.events) == (whole.stopped, whole.counters.events)
        if run.stopped == "events":  # the clock of a quiet run stands where its engine noticed
            assert log.read_bytes() == (tmp_path / "whole.npz").read_bytes()
            assert run.residuals == whole.residuals
            assert np.array_equal(run.state.position, whole.state.position)


@pytest.mark.parametrize("compact", [False, True])
@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_broken_run_leaves_a_readable_part_and_joins_to_the_same_log(tmp_path, suffix, compact):
    scene = SCENES["channel"]()
    whole, log, path = tmp_path / f"whole{suffix}", tmp_path / f"run{suffix}", tmp_path / "run.checkpoint"
    run = es.simulate(scene, events=TOTAL, engine="reference", log=whole, compact=compact)
    for after, every in ((3, 1), (250, 64), (399, 1000)):
        break_off(scene, path, after, every=every, log=log, compact=compact)
        assert not log.exists()
        part = es.load_log(tmp_path / f"run{suffix}.part")
        assert len(part) > after
        assert part.rows["remainder"].tobytes() == es.load_log(whole).rows["remainder"][: len(part)].tobytes()
        part.expand()
        assert es.resume(path, every=100).digest == run.digest
        assert log.read_bytes() == whole.read_bytes()
        assert {file.name for file in tmp_path.iterdir()} == {"run" + suffix, "run.checkpoint", "whole" + suffix}
        log.unlink()


def test_engines_take_over_each_other_s_checkpoints(tmp_path):
    pytest.importorskip("numba")
    scene = SCENES["box"]()
    whole = es.simulate(scene, events=3 * TOTAL, engine="reference", digest=True)
    path = tmp_path / "run.checkpoint"
    es.simulate(scene, events=TOTAL, engine="reference", log=tmp_path / "run.csv", checkpoint=path)
    es.resume(path, events=2 * TOTAL, engine="fast")
    assert es.resume(path, events=3 * TOTAL, engine="reference").digest == whole.digest


def test_a_run_goes_on_behind_its_stop_time(tmp_path):
    scene = SCENES["torus"]()
    path = tmp_path / "run.checkpoint"
    whole = es.simulate(scene, until=3.0, log=tmp_path / "whole.csv")
    es.simulate(scene, until=1.25, log=tmp_path / "run.csv", checkpoint=path)
    run = es.resume(path, until=3.0)
    assert (run.digest, run.stopped, run.time) == (whole.digest, "until", 3.0)
    assert es.resume(path).stopped == "until"


def test_a_collapse_is_told_alike_after_a_resume(tmp_path):
    scene = lattice_gas(40, 0.3, es.Box, restitution=0.1)
    whole = es.simulate(scene, events=10**6, engine="reference", log=tmp_path / "whole.csv")
    assert whole.stopped in ("collapse", "digits")
    path = tmp_path / "run.checkpoint"
    run = es.simulate(scene, events=10**6, engine="reference", log=tmp_path / "run.csv", checkpoint=path, every=100)
    again = es.resume(path)
    assert (run.stopped, run.reason) == (whole.stopped, whole.reason) == (again.stopped, again.reason)
    assert (tmp_path / "run.csv").read_bytes() == (tmp_path / "whole.csv").read_bytes()


def test_checkpoint_and_log_can_be_moved_together(tmp_path):
    there, here = tmp_path / "there", tmp_path / "here"
    (there / "logs").mkdir(parents=True)
    scene = SCENES["box"]()
    whole = es.simulate(scene, events=TOTAL, digest=True)
    es.simulate(scene, events=100, log=there / "logs" / "run.csv", checkpoint=there / "run.checkpoint")
    there.rename(here)
    assert es.resume(here / "run.checkpoint", events=200).log_path == here / "logs" / "run.csv"
    (here / "logs" / "run.csv").rename(here / "elsewhere.csv")
    with pytest.raises(es.LogError, match=r"neither this log nor run\.csv\.part"):
        es.resume(here / "run.checkpoint", events=TOTAL)
    assert es.resume(here / "run.checkpoint", events=TOTAL, log=here / "elsewhere.csv").digest == whole.digest


@pytest.mark.parametrize(("name", "engine"), [*ALL, ("joint", "reference")])
def test_every_field_of_a_snapshot_comes_back(name, engine):
    """A field of a new kind fails here until `packing` knows it."""
    scene = lattice_gas(36, 0.3, quantum=1.0) if name == "joint" else SCENES[name]()
    session = es.ENGINES[engine].open(stage_of(scene))
    for events in (0, 50, 300):
        session.advance(Stop(events=events), 10**6)
        snapshot, arrays = session.snapshot(), {}
        forms = {item.name: packed(item.name, getattr(snapshot, item.name), arrays) for item in fields(Snapshot)}
        forms = json.loads(json.dumps(forms))
        again = Snapshot(**{key: unpacked(form, arrays) for key, form in forms.items()})
        assert again == snapshot
        assert repr(again) == repr(snapshot)  # types and signs of zeros too
        demand_fit(again, stage_of(scene))


@pytest.mark.parametrize(
    "value", [np.float64(1.0), [1.0], {1: 2}, (1, 2.0), (1.0, (2.0,)), (True, False), ((), 1), b""]
)
def test_what_would_not_come_back_as_it_was_is_not_packed(value):
    with pytest.raises(TypeError, match="name: "):
        packed("name", value, {})


@pytest.mark.parametrize(
    "value", [None, 7, -0.0, math.inf, "text", True, (), (1,), (0.5, -math.inf), ((), ((1, 2), ()), ())]
)
def test_nested_tuples_come_back(value):
    arrays = {}
    form = json.loads(json.dumps(packed("name", value, arrays)))
    assert repr(unpacked(form, arrays)) == repr(value)


@pytest.fixture
def saved(tmp_path):
    """A checkpoint of a small run, in the middle."""
    path = tmp_path / "run.checkpoint"
    es.simulate(SCENES["walls"](), events=100, checkpoint=path)
    return path


def rewritten(path, change_data=None, change_arrays=None):
    """Write the checkpoint anew with changed metadata or arrays."""
    with np.load(path) as archive:
        arrays = {name: archive[name] for name in archive.files}
    data = json.loads(bytes(arrays["eventsim"]))
    if change_data is not None:
        change_data(data)
    if change_arrays is not None:
        change_arrays(arrays)
    arrays["eventsim"] = np.frombuffer(json.dumps(data).encode(), np.uint8)
    with path.open("wb") as file:
        np.savez(file, **arrays)


def put(name, index, value):
    def change(arrays):
        arrays[name][index] = value

    return change


@pytest.mark.parametrize(
    ("change_data", "change_arrays", "words"),
    [
        (lambda data: data.update(checkpoint=2), None, "format 1"),
        (lambda data: data["provenance"].update(version="0.0.9"), None, "written by eventsim 0.0.9; this is eventsim"),
        (lambda data: data["provenance"]["scene"]["disk"].pop(), None, "entries for"),
        (lambda data: data["snapshot"].pop("wraps_x"), None, "other fields: wraps_x"),
        (lambda data: data["counters"].update(events=-1), None, "counter events"),
        (lambda data: data["counters"].update(events=1.5), None, "counter events"),
        (lambda data: data["every"].update(events=0), None, "no interval"),
        (lambda data: data["snapshot"].update(window={"value": 5000}), None, "clock"),
        (lambda data: data["snapshot"].update(now={"value": math.nan}), None, "after the present"),
        (lambda data: data["snapshot"].update(x={"value": 1}), None, "cut short or damaged"),
        (None, put("x", 0, math.nan), "x has entries"),
        (None, put("x", 0, 1e9), "outside the domain"),
        (None, put("vx", 0, 1e12), "outside the domain"),
        (None, put("t", 3, -1.0), "flights begin before"),
        (None, put("met.items.items", 0, 10**6), "cannot have met"),
        (None, put("met.items.items", 0, -(10**6)), "cannot have met"),
        (None, put("met", 0, -3), "lengths of tuples"),
        (None, lambda arrays: arrays.update(x=arrays["x"][:-1]), "x has 35 entries for 36 disks"),
        (None, lambda arrays: arrays.update(at_once=arrays["x"]), "at_once has entries that are not whole"),
        (None, lambda arrays: arrays.update(last_rows=np.zeros(3)), "last rows"),
        (None, lambda arrays: arrays.pop("last_rows"), "not a checkpoint"),
    ],
)
def test_a_checkpoint_that_cannot_be_one_is_refused_before_an_engine_sees_it(saved, change_data, change_arrays, words):
    rewritten(saved)
    load_checkpoint(saved)
    rewritten(saved, change_data, change_arrays)
    with pytest.raises(es.CheckpointError, match=words) as caught:
        es.resume(saved, events=200)
    assert str(caught.value).startswith(str(saved))


def test_a_run_does_not_go_back_to_a_stop_that_it_has_passed(tmp_path):
    path = tmp_path / "run.checkpoint"
    run = es.simulate(es.gallery("break"), until=3.0, checkpoint=path)
    for stop, words in (({"until": 2.0}, "has come to t = 3.0, past until = 2.0"), ({"events": 3}, "events, past events = 3")):
        with pytest.raises(es.CheckpointError, match=words):
            es.resume(path, **stop)
    for again in (es.resume(path), es.resume(path, until=3.0)):
        assert (again.time, again.counters.events, again.stopped) == (3.0, run.counters.events, "until")


def at_rest():
    """One disk that lies still on the floor from early on, and one that slides down a slope."""
    disks = es.Disks([[2.0, 0.25], [1.0, 1.3]], radius=0.1)
    slope = es.Segment((0.5, 1.2), (4.0, 0.8))
    return es.Scene(disks, es.Box((4.0, 2.0)), [slope], gravity=(0.0, -9.81), restitution=0.25)


@pytest.mark.parametrize("engine", ["reference", pytest.param("fast", marks=WITH_NUMBA)])
def test_a_run_goes_on_with_disks_at_rest(tmp_path, engine):
    path = tmp_path / "run.checkpoint"
    whole = es.simulate(at_rest(), until=6.0, engine=engine, log=tmp_path / "whole.csv")
    es.simulate(at_rest(), until=1.0, engine=engine, log=tmp_path / "run.csv", checkpoint=path)
    resting = [met[0][2] for met in load_checkpoint(path).snapshot.met]
    assert resting == [SUPPORTED, SUPPORTED]
    for until in (5.0, 6.0):  # one fall in that time is further than the domain is high
        run = es.resume(path, until=until)
    assert run.digest == whole.digest
    assert run.state.position.tolist() == whole.state.position.tolist()


def test_a_snapshot_rests_on_what_supports_disks(tmp_path):
    scene = es.Scene(es.Disks([[1.0, 1.0]], radius=0.5), es.Box((4.0, 2.0)), [es.Segment((2.0, 1.0), (3.0, 1.0))],
                     gravity=(0.0, -1.0), restitution=0.5)  # fmt: skip
    stage = stage_of(scene)
    es.simulate(scene, until=0.5, engine="reference", checkpoint=tmp_path / "a")
    saved = load_checkpoint(tmp_path / "a").snapshot
    demand_fit(replace(saved, met=(((-5, 1, SUPPORTED),),)), stage)
    with pytest.raises(ValueError, match="cannot rest on -6"):  # the segment's end
        demand_fit(replace(saved, met=(((-6, 1, SUPPORTED),),)), stage)


def test_a_damaged_file_is_refused(saved):
    whole = saved.read_bytes()
    for share in (0.0, 0.01, 0.5, 0.999):
        saved.write_bytes(whole[: int(share * len(whole))])
        with pytest.raises(es.CheckpointError, match=r"run\.checkpoint"):
            load_checkpoint(saved)
    for place in np.random.default_rng(1).integers(0, len(whole), 60).tolist():
        saved.write_bytes(whole[:place] + bytes([whole[place] ^ 0x55]) + whole[place + 1 :])
        with suppress(es.CheckpointError):  # a bit that the file does not need may be any
            load_checkpoint(saved)


def test_an_encrypted_file_is_refused(saved):
    whole = bytearray(saved.read_bytes())
    entry = whole.index(b"PK\x01\x02")
    whole[entry + 8] |= 1  # the flag in the directory, and in the entry itself
    whole[6] |= 1
    saved.write_bytes(whole)
    with pytest.raises(es.CheckpointError, match="encrypted"):
        load_checkpoint(saved)


def test_a_checkpoint_holds_no_code(saved):
    with zipfile.ZipFile(saved) as archive:
        assert all(name.endswith(".npy") for name in archive.namelist())
        for name in archive.namelist():
            assert b"'O'" not in archive.read(name)[:200]
    with np.load(saved, allow_pickle=True) as archive:
        arrays = {name: archive[name] for name in archive.files}
    arrays["x"] = np.array([print], dtype=object)
    with saved.open("wb") as file:
        np.savez(file, allow_pickle=True, **arrays)
    with pytest.raises(es.CheckpointError, match="pickle"):
        load_checkpoint(saved)


def test_a_file_that_is_no_checkpoint_is_not_overwritten(tmp_path):
    mine = tmp_path / "thesis.tex"
    mine.write_text("dear to me")
    with pytest.raises(es.CheckpointError, match="no checkpoint takes its place"):
        es.simulate(SCENES["box"](), events=10, checkpoint=mine)
    assert mine.read_text() == "dear to me"


def test_wishes_that_a_checkpoint_cannot_keep_are_refused(tmp_path, saved):
    scene, path = SCENES["box"](), tmp_path / "new.checkpoint"
    for wish, words in (
        ({"log": True}, "in memory"),
        ({"digest": True}, "give it a log"),
        ({"measure": True}, "measures are not"),
        ({"engine": "frames"}, "has no checkpoints"),
        ({"every": "5x"}, "90s, 5min or 2h"),
    ):
        with pytest.raises(es.EventsimError, match=words):
            es.simulate(scene, events=10, checkpoint=path, **wish)
        assert not path.exists()
    with pytest.raises(es.CheckpointError, match="kept no log"):
        es.resume(saved, log=tmp_path / "a.csv")
    with pytest.raises(es.CheckpointError, match="another scene: it has 36 disks, not 40"):
        es.resume(saved, scene=scene)
    other = replace_gravity(SCENES["walls"]())
    with pytest.raises(es.CheckpointError, match=r"another scene: its gravity is None, not \(0\.0, -1\.0\)"):
        es.resume(saved, scene=other)


def replace_gravity(scene):
    return es.Scene(scene.disks, scene.domain, scene.walls, gravity=(0.0, -1.0))


@pytest.mark.parametrize(
    ("text", "expected"),
    [(5, Every(events=5)), ("5", Every(events=5)), ("5s", Every(seconds=5.0)), (" 1.5 min", Every(seconds=90.0)),
     ("2h", Every(seconds=7200.0)), ("0s", Every(seconds=0.0))],
)  # fmt: skip
def test_an_interval_is_a_number_of_events_or_a_time(text, expected):
    assert interval(text) == expected


@pytest.mark.parametrize("text", [0, -1, "", "s", "5 parsecs", "-5s", "nans", "infs", "1e3", 1.5, None, "1e400h"])
def test_what_is_no_interval_is_refused(text):
    with pytest.raises(es.CheckpointError, match="every = "):
        interval(text)


def test_checkpoints_come_as_often_as_asked(tmp_path, monkeypatch):
    seen = []
    save = checkpoints.save_checkpoint

    def noted(path, checkpoint, provenance):
        seen.append(checkpoint.counters.events)
        save(path, checkpoint, provenance)

    monkeypatch.setattr("eventsim.engines.keeper.save_checkpoint", noted)
    es.simulate(SCENES["box"](), events=350, engine="reference", checkpoint=tmp_path / "a", every=100)
    assert seen == [0, 100, 200, 300, 350]
    seen.clear()
    es.simulate(SCENES["box"](), events=350, engine="reference", checkpoint=tmp_path / "a")
    assert seen == [0, 350]


def test_a_checkpoint_that_cannot_be_written_later_does_not_end_the_run(tmp_path, monkeypatch, capsys):
    replaced = os.replace
    turns = iter(range(100))

    def full(source, target):
        if next(turns) in (1, 2):
            raise OSError(28, "No space left on device")
        replaced(source, target)

    monkeypatch.setattr("eventsim.engines.checkpoint.os.replace", full)
    run = es.simulate(SCENES["box"](), events=350, engine="reference", checkpoint=tmp_path / "a", every=100)
    assert run.stopped == "events"
    assert capsys.readouterr().err.count("the run goes on with the checkpoint before") == 2
    assert load_checkpoint(tmp_path / "a").counters.events == 350
    assert [file.name for file in tmp_path.iterdir()] == ["a"]
    turns = iter([1] * 100)
    with pytest.raises(es.CheckpointError, match="No space left"):
        es.simulate(SCENES["box"](), events=350, engine="reference", checkpoint=tmp_path / "b")


def test_a_snapshot_with_no_number_for_a_disk_does_not_fit(tmp_path):
    session = session_of(SCENES["box"]())
    snapshot = session.snapshot()
    with pytest.raises(ValueError, match="vx has 39 entries for 40 disks"):
        demand_fit(replace(snapshot, vx=snapshot.vx[1:]), session.stage)


def test_a_checkpoint_is_the_old_or_the_new_one(tmp_path, monkeypatch):
    """Killed while it is written, the one before stays whole."""
    path = tmp_path / "a"
    es.simulate(SCENES["box"](), events=100, checkpoint=path)
    before = Path(path).read_bytes()

    def killed(*_):
        raise BrokenOff

    monkeypatch.setattr("eventsim.engines.checkpoint.os.fsync", killed)
    with pytest.raises(BrokenOff):
        es.resume(path, events=200)
    assert path.read_bytes() == before

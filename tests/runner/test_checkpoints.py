"""A run that goes on from a checkpoint is the run that was never stopped, bit for bit; what is no checkpoint is refused."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

import eventsim as es
import eventsim.engines.auto
from eventsim.formulas.rest import SUPPORTED
from eventsim.runner import checkpoint as checkpoints
from eventsim.runner.checkpoint import Every, interval, load_checkpoint
from eventsim.suffixes import LOGS
from tests.engines.scenes import lattice_gas
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
@pytest.mark.parametrize("suffix", LOGS)
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


@pytest.fixture
def saved(tmp_path):
    """A checkpoint of a small run, in the middle."""
    path = tmp_path / "run.checkpoint"
    es.simulate(SCENES["walls"](), events=100, checkpoint=path)
    return path


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

    monkeypatch.setattr("eventsim.runner.checkpoint_writer.save_checkpoint", noted)
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

    monkeypatch.setattr("eventsim.runner.checkpoint.os.replace", full)
    run = es.simulate(SCENES["box"](), events=350, engine="reference", checkpoint=tmp_path / "a", every=100)
    assert run.stopped == "events"
    assert capsys.readouterr().err.count("the run goes on with the checkpoint before") == 2
    assert load_checkpoint(tmp_path / "a").counters.events == 350
    assert [file.name for file in tmp_path.iterdir()] == ["a"]
    turns = iter([1] * 100)
    with pytest.raises(es.CheckpointError, match="No space left"):
        es.simulate(SCENES["box"](), events=350, engine="reference", checkpoint=tmp_path / "b")


def test_a_checkpoint_is_the_old_or_the_new_one(tmp_path, monkeypatch):
    """Killed while it is written, the one before stays whole."""
    path = tmp_path / "a"
    es.simulate(SCENES["box"](), events=100, checkpoint=path)
    before = Path(path).read_bytes()

    def killed(*_):
        raise BrokenOff

    monkeypatch.setattr("eventsim.runner.checkpoint.os.fsync", killed)
    with pytest.raises(BrokenOff):
        es.resume(path, events=200)
    assert path.read_bytes() == before


@pytest.mark.parametrize("suffix", LOGS)
@pytest.mark.parametrize("where", ["", ".part"])
def test_a_checkpoint_without_rows_replaces_no_other_log(tmp_path, suffix, where):
    """It was begun anew over whatever had come to stand there."""
    path, log = tmp_path / "run.checkpoint", tmp_path / f"run{suffix}"
    es.simulate(lattice_gas(4, 0.3), events=0, engine="reference", log=log, checkpoint=path)
    other = es.gallery("two-disks")
    if where:
        log.unlink()

        def end(rows):
            raise BrokenOff

        with pytest.raises(BrokenOff):
            es.simulate(other, events=5, engine="reference", log=log, on_event=end)
    else:
        es.simulate(other, events=5, engine="reference", log=log)
    before = es.load_log(f"{log}{where}").scene
    with pytest.raises(es.EventsimError, match="is not the log of the run that goes on"):
        es.resume(path, events=20)
    assert es.load_log(f"{log}{where}").scene == before == other

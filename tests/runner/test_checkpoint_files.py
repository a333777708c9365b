"""The file of a checkpoint: all of a snapshot comes back from it, and one that is damaged or does not fit is refused."""

from __future__ import annotations

import json
import math
import zipfile
from contextlib import suppress
from dataclasses import fields, replace

import numpy as np
import pytest

import eventsim as es
import eventsim.engines.auto
from eventsim.engines import ENGINES
from eventsim.engines.base import Snapshot, Stop
from eventsim.formulas.rest import SUPPORTED
from eventsim.record.events import blank_rows
from eventsim.runner.checkpoint import load_checkpoint
from eventsim.runner.snapshots import demand_fit, packed, unpacked
from eventsim.scene.stage import stage_of
from tests.engines.scenes import lattice_gas, session_of
from tests.engines.test_purity import SCENES
from tests.runner.test_checkpoints import ALL


@pytest.fixture
def saved(tmp_path):
    """A checkpoint of a small run, in the middle."""
    path = tmp_path / "run.checkpoint"
    es.simulate(SCENES["walls"](), events=100, checkpoint=path)
    return path


@pytest.mark.parametrize(("name", "engine"), [*ALL, ("joint", "reference")])
def test_every_field_of_a_snapshot_comes_back(name, engine):
    """A field of a new kind fails here until `packing` knows it."""
    scene = lattice_gas(36, 0.3, quantum=1.0) if name == "joint" else SCENES[name]()
    session = ENGINES[engine].open(stage_of(scene))
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


def odd_row(name, value):
    """A row that no scene has."""
    rows = blank_rows(1)
    rows[name] = value
    return rows


@pytest.mark.parametrize(
    ("change_data", "change_arrays", "words"),
    [
        (lambda data: data.update(checkpoint=1), None, "format 2"),
        (lambda data: data["provenance"].update(version="0.0.9"), None, r"eventsim 0.0.9 \(bits 2\); this is eventsim"),
        (lambda data: data["provenance"]["scene"]["disk"].pop(), None, "its scene is not the one of its run"),
        (lambda data: data["snapshot"].pop("wraps_x"), None, "other fields: wraps_x"),
        (lambda data: data["counters"].update(events=-1), None, "counter events"),
        (lambda data: data["counters"].update(events=1.5), None, "counter events"),
        (lambda data: data["counters"].update(support_force=["0", "0"]), None, "counter support_force"),
        (lambda data: data["counters"].update(support_force=[math.nan, 0.0]), None, "counter support_force"),
        (lambda data: data["counters"].update(support_force=[0.0]), None, "counter support_force"),
        (lambda data: data["counters"].update(outer_momentum=[0.0, math.inf]), None, "counter outer_momentum"),
        (lambda data: data["counters"].update(outer_momentum={"x": 0.0}), None, "counter outer_momentum"),
        (lambda data: data["counters"].update(deepest_overlap=math.nan), None, "counter deepest_overlap"),
        (lambda data: data.update(elapsed_s=-1.0), None, "-1.0 seconds"),
        (lambda data: data.update(write_s=math.nan), None, "nan seconds"),
        (lambda data: data["stop"].update(until=math.nan), None, "until = nan"),
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
        (None, lambda arrays: arrays.update(last_rows=odd_row("a", 10**6)), "last rows have a = "),
        (None, lambda arrays: arrays.update(last_rows=odd_row("wall", -2)), "last rows have wall = "),
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


def test_a_snapshot_with_no_number_for_a_disk_does_not_fit(tmp_path):
    session = session_of(SCENES["box"]())
    snapshot = session.snapshot()
    with pytest.raises(ValueError, match="vx has 39 entries for 40 disks"):
        demand_fit(replace(snapshot, vx=snapshot.vx[1:]), session.stage)

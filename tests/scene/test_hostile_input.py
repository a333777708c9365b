"""Whatever a file or a command line says: it is read, or refused with a sentence, at once."""

from __future__ import annotations

import copy
import json
import math
import random
from contextlib import suppress

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import eventsim as es
from eventsim.errors import LogWarning
from eventsim.runner.checkpoint import interval, load_checkpoint
from eventsim.scene.files import apply_overrides, load_scene, scene_from_dict
from eventsim.suffixes import LOGS

SCENE = {
    "until": 1.0,
    "events": 200,
    "gravity": [0.0, -1.0],
    "restitution": {"pair": 0.9, "wall": 1.0},
    "contact_duration": 1e-6,
    "domain": {"kind": "box", "size": [1.0, 1.0], "origin": [0.0, 0.0]},
    "disk": [
        {"position": [0.3, 0.3], "velocity": [1.0, 0.5], "radius": 0.1, "mass": 1.0},
        {"position": [0.7, 0.7], "radius": 0.1},
    ],
    "wall": [{"kind": "segment", "start": [0.1, 0.9], "end": [0.2, 0.95], "name": "ramp"}],
}
ABSURD = (
    1e308,
    -1e308,
    1e-308,
    5e-324,
    -0.0,
    1e200,
    1e150,
    1e-200,
    float("inf"),
    float("nan"),
    10**9,
    10**400,
    -1,
    True,
    "x",
)
LONG = "1" * 5000
USUAL = settings(deadline=None, max_examples=40, suppress_health_check=list(HealthCheck))


def places_in(data, path=()):
    """Every path to a value inside tables and lists."""
    entries = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in entries:
        yield (*path, key)
        yield from places_in(value, (*path, key))


PLACES = list(places_in(SCENE))
anything = st.recursive(
    st.one_of(st.sampled_from(ABSURD), st.none(), st.floats(), st.integers(), st.text(max_size=5)),
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(st.text(max_size=5), inner, max_size=3)),
    max_leaves=5,
)


def changed(place, value):
    data = copy.deepcopy(SCENE)
    inside = data
    for step in place[:-1]:
        inside = inside[step]
    inside[place[-1]] = value
    return data


def read_and_run(data):
    with suppress(es.EventsimError):
        scene = scene_from_dict(data)
        run = es.simulate(scene, until=scene.start_time + 1.0, events=50, engine="reference", log=True)
        assert run.counters.events == len(run.log)


@pytest.mark.parametrize("value", ABSURD, ids=repr)
def test_an_absurd_number_anywhere_in_a_scene_is_answered(value):
    for place in PLACES:
        read_and_run(changed(place, value))


@USUAL
@given(st.sampled_from(PLACES), anything)
def test_anything_anywhere_in_a_scene_is_answered(place, value):
    read_and_run(changed(place, value))


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("count", 10**9, "must be at most 50000000"),
        ("count", 10**400, "count"),
        ("radius", 1e-308, "radius"),
        ("speed", 1e291, "velocity"),
        ("mass", 5e-324, "mass"),
    ],
)
def test_a_gas_beyond_all_measure_is_refused_at_once(key, value, words):
    gas = {"count": 20, "radius": 0.01, "arrangement": "square", "seed": 1}
    with pytest.raises(es.SceneError, match=words):
        scene_from_dict({"domain": {"kind": "periodic", "size": [1.0, 1.0]}, "gas": [gas | {key: value}]})


@pytest.mark.parametrize("kind", ["periodic", "channel"])
@pytest.mark.parametrize("radius", [1e3, 1e9, 1e15])
def test_a_disk_far_wider_than_the_period_is_refused_at_once(kind, radius):
    """All images within its reach were made: of a disk of radius 1000 a million, and then the memory was full."""
    wall = {"kind": "segment", "start": [0.5, 0.5], "end": [0.6, 0.6]}
    disk = {"position": [0.2, 0.5], "radius": radius}
    with pytest.raises(es.SceneError, match="the diameter must be at most the period"):
        scene_from_dict({"domain": {"kind": kind, "size": [1.0, 1.0]}, "wall": [wall], "disk": [disk]})


def test_a_wall_over_many_periods_both_ways_is_refused_at_once():
    wall = {"kind": "segment", "start": [0.5, 0.5], "end": [900.5, 900.6]}
    disk = {"position": [0.2, 0.5], "radius": 0.01}
    with pytest.raises(es.SceneError, match=r"more than 1000 periods, counted in x times in y, and does over 810090"):
        scene_from_dict({"domain": {"kind": "periodic", "size": [1.0, 1.0]}, "wall": [wall], "disk": [disk]})


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"velocity": [1e76, 0.0]}, "the larger 1e-75 to 1e.75, or both 0: else choose other units of length or time"),
        ({"velocity": [0.0, -1e-76]}, "the larger 1e-75 to 1e.75, or both 0"),
        ({"velocity": [math.nan, 0.0]}, "must be two finite numbers"),
        ({"velocity": [1e70, 0.0], "mass": 1e200}, "mass: 1e.200, and the energy of such a disk"),
        ({"velocity": [1e70, 0.0], "mass": 1e120, "radius": 1e-140}, "momentum of such a disk over the shortest length"),
        (
            {"velocity": [1e70, 0.0], "position": [1e90, 0.0], "gravity": 1.0},
            "times the largest length, 1e.90, .* gravity",
        ),
        ({"velocity": [1e70, 0.0], "mass": 1e200, "gravity": 1.0}, "energy of such a disk"),
        ({"mass": 1e305}, "mass: 1e"),
        ({"mass": 5e-324}, "mass = 5e-324"),
    ],
)
def test_products_that_are_no_numbers_are_refused_by_name(changes, words):
    disk = {"position": [0.0, 0.0], "radius": 1.0} | changes
    pull = {"gravity": [0.0, -disk.pop("gravity")]} if "gravity" in disk else {}
    with pytest.raises(es.SceneError, match=words):
        scene_from_dict({"domain": {"kind": "open"}, "disk": [disk]} | pull)


def test_a_light_disk_that_heavy_ones_could_drive_beyond_all_numbers_is_refused():
    disk = {"radius": 1.0, "velocity": [1e75, 0.0]}
    disks = [disk | {"position": [0.0, 0.0], "mass": 1e-300}, disk | {"position": [9.0, 0.0], "mass": 1e165}]
    with pytest.raises(es.SceneError, match=r"velocity: 4.47214e\+307, the most that a disk can come to"):
        scene_from_dict({"domain": {"kind": "open"}, "disk": disks})


@pytest.mark.parametrize("suffix", [".toml", ".json"])
@pytest.mark.parametrize(
    "text", ["a = " + "1" * 5000, "[" * 5000, '{"a": ' + "1" * 5000 + "}", "\x00", "\ufeff{}", "[[disk]]" * 3]
)
def test_a_text_that_breaks_parsers_is_refused(tmp_path, suffix, text):
    path = tmp_path / f"scene{suffix}"
    path.write_text(text)
    with pytest.raises(es.SceneError, match="scene"):
        load_scene(path)


@USUAL
@given(st.text(max_size=60))
def test_any_setting_is_applied_or_refused(text):
    for typed in (text, f"{text}={text}", f"disk.0.{text}", f"radius={text}"):
        with suppress(es.SceneError):
            apply_overrides(SCENE, [typed])
        with suppress(es.CheckpointError):
            interval(typed)


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """Name -> bytes of good logs and a checkpoint."""
    place = tmp_path_factory.mktemp("good")
    scene = scene_from_dict(SCENE)
    for suffix in LOGS:
        es.simulate(scene, events=10, until=9.0, log=place / f"log{suffix}")
    es.simulate(scene, events=10, until=9.0, checkpoint=place / "run.checkpoint")
    return {path.name: path.read_bytes() for path in place.iterdir()}


@pytest.mark.parametrize("name", [*(f"log{suffix}" for suffix in LOGS), "run.checkpoint"])
@pytest.mark.filterwarnings("ignore::eventsim.errors.LogWarning")
def test_damage_anywhere_in_a_file_is_answered(tmp_path, written, name):
    """Bytes changed, left out, doubled: what is read is used, what is not is refused."""
    chance = random.Random(name)
    whole = written[name]
    refused = []
    for _ in range(80):
        data = bytearray(whole)
        for _ in range(chance.randint(1, 4)):
            place = chance.randrange(len(data))
            match chance.randrange(4):
                case 0:
                    data[place] = chance.randrange(256)
                case 1:
                    del data[place : place + chance.randint(1, 40)]
                case 2:
                    data[place:place] = data[place : place + chance.randint(1, 40)]
                case _:
                    data[place:place] = chance.choice([b"1e308", b"9" * 30, b"-1", b"null", b"NaN", b"\x00"])
        path = tmp_path / name
        path.write_bytes(data)
        try:
            if name == "run.checkpoint":
                load_checkpoint(path)
            else:
                es.load_log(path).expand()
        except es.EventsimError as error:
            refused.append(str(error))
    assert len(refused) > 20
    assert all(name in words or "does not fit its scene" in words for words in refused)


def test_a_scene_in_json_with_doubled_and_missing_keys_is_answered(tmp_path):
    path = tmp_path / "scene.json"
    text = json.dumps(SCENE)
    for key in SCENE:
        path.write_text(text.replace(f'"{key}"', '"unheard_of"', 1))
        with pytest.raises(es.SceneError, match="unheard_of"):
            load_scene(path)


def test_a_row_at_the_end_of_time_is_refused_at_once(tmp_path):
    """In a periodic domain windows stay short, so the clock would turn over for ever."""
    scene = es.Scene(es.Disks([(1.0, 1.0), (3.0, 1.0)], [(1.0, 0.0), (0.0, 0.0)], 0.5), es.Periodic((8.0, 8.0)))
    log = es.simulate(scene, events=1, log=True).log
    log.save(tmp_path / "log.jsonl", compact=True)
    head, _, rows = (tmp_path / "log.jsonl").read_text().partition("\n")
    assert '"epoch": 0' in rows
    (tmp_path / "log.jsonl").write_text(head + "\n" + rows.replace('"epoch": 0', f'"epoch": {2**62}'))
    with pytest.warns(LogWarning, match="another digest"):
        log = es.load_log(tmp_path / "log.jsonl")
    with pytest.raises(es.LogError, match="turns of the clock"):
        log.expand()


@pytest.mark.parametrize(
    ("speed", "unit"), [(1e-75, 1e-101), (1e-75, 1e100), (1e75, 1e-101), (1e75, 1e100)]
)
def test_contacts_at_the_ends_of_speeds_and_lengths_are_right(speed, unit):
    disks = [
        {"position": [-5.0 * unit, 0.0], "velocity": [speed, 0.0], "radius": unit},
        {"position": [2.5 * unit, 0.5 * unit], "velocity": [0.0, 0.0], "radius": unit},
    ]
    log = es.simulate(scene_from_dict({"domain": {"kind": "open"}, "disk": disks}), events=1, engine="reference", log=True).log
    assert log.vxb[0] == pytest.approx(0.9375 * speed, rel=1e-12)


@pytest.mark.parametrize(("domain", "axis"), [("box", 0), ("box", 1), ("channel", 1)])
def test_a_disk_without_room_between_walls_may_not_move_there(domain, axis):
    velocity = [0.25, 0.25]
    tables = {
        "domain": {"kind": domain, "size": [4.0, 1.0] if axis else [1.0, 4.0]},
        "disk": [{"position": [0.5, 0.5], "velocity": velocity, "radius": 0.5}],
    }
    with pytest.raises(es.SceneError, match=rf"disk\[0\] is as wide as the domain, 1.0, and has a velocity along {'xy'[axis]}"):
        scene_from_dict(tables)
    velocity[axis] = 0.0
    assert scene_from_dict(tables).disks.radius.tolist() == [0.5]

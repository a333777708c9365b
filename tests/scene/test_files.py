"""Scene files: what is written is read back in every bit, and settings change keys."""

import json
import math
import tomllib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eventsim.errors import SceneError
from eventsim.record.events import State
from eventsim.replay.states import write_states
from eventsim.scene import Arc, Box, Channel, Circle, Disks, Open, Periodic, Polygon, Polyline, Scene, Segment
from eventsim.scene.disks_file import read_disks_file, write_disks_file
from eventsim.scene.files import (
    apply_overrides,
    listed_scene,
    load_scene,
    origins,
    scene_from_dict,
    scene_to_dict,
    scene_to_json,
    scene_to_toml,
)
from eventsim.scene.numbers import is_velocity

finite = st.floats(-1e6, 1e6)
points = st.tuples(finite, finite)
velocities = points.map(lambda v: v if is_velocity(*v) else (0.0, 0.0))
domains = st.one_of(
    st.just(Open()),
    *(
        st.builds(kind, st.tuples(*[st.floats(3e6, 1e7)] * 2), st.just((-1.5e6, -1.25e6)))
        for kind in (Box, Periodic, Channel)
    ),
)
walls = st.lists(
    st.sampled_from(
        [
            Segment((0.1, 0.2), (0.3, -0.0)),
            Polygon([(1 / 3, 0), (1, 0), (0, 1)]),
            Polyline([(5, 5), (6, 6)]),
            Arc((0, 0), (1, 1), (2, 0)),
            Circle((0, 0), 1e7 / 3),
        ]
    ),
    max_size=3,
)


@st.composite
def scenes(draw):
    count = draw(st.integers(1, 5))
    domain = draw(domains)
    some = draw(walls)
    if domain.size is not None and any(domain.periodic):
        some = [wall for wall in some if not isinstance(wall, Circle)]
    # Points (radius 0) of any mass lie anywhere without overlap.
    disks = Disks(
        draw(st.lists(points, min_size=count, max_size=count)),
        draw(st.lists(velocities, min_size=count, max_size=count)),
        0.0,
        draw(st.lists(st.sampled_from([0.0, math.inf]) | st.floats(1e-320, 1e250), min_size=count, max_size=count)),
    )
    return Scene(
        disks,
        domain,
        some,
        gravity=draw(st.none() | points.filter(lambda g: all(x == 0.0 or abs(x) >= 1e-150 for x in g))),
        restitution=draw(st.none() | st.floats(0, 1) | st.fixed_dictionaries({"wall": st.floats(0, 1)})),
        contact_duration=draw(st.none() | st.floats(0, 1e3)),
        until=draw(st.none() | st.floats(2, 1e6)),
        events=draw(st.none() | st.integers(0, 10**12)),
        start_time=draw(st.floats(-1e6, 1)),
        name=draw(st.none() | st.text(st.characters(exclude_categories=["Cc", "Cs", "Zl", "Zp"]))),
    )


def bits(scene):
    """Everything a scene holds, with -0.0 told from 0.0."""
    disks = scene.disks
    arrays = [array.tobytes() for array in (disks.position, disks.velocity, disks.radius, disks.mass)]
    rest = (scene.domain, scene.walls, scene.gravity, scene.restitution, scene.contact_duration)
    return arrays, repr((*rest, scene.until, scene.events, scene.start_time, scene.name))


@given(scenes())
@settings(max_examples=100, deadline=None)
def test_a_scene_comes_back_in_every_bit(scene):
    tables = scene_to_dict(scene)
    assert bits(scene_from_dict(tables)) == bits(scene)
    assert bits(scene_from_dict(json.loads(json.dumps(tables, allow_nan=False)))) == bits(scene)
    assert bits(scene_from_dict(tomllib.loads(scene_to_toml(scene)))) == bits(scene)
    assert scene_to_dict(scene_from_dict(tables)) == tables
    assert scene_to_json(scene) == json.dumps(tables)


def test_a_file_with_every_key_gives_the_scene_it_describes(tmp_path):
    (tmp_path / "start.csv").write_text("mass,x,y,vx,vy,radius,colour\n2,6,3,0,1,0.25,red\n")
    (tmp_path / "all.toml").write_text(
        """
        name = "all"
        until = 4
        events = 100
        start_time = 1.0
        gravity = [0, -9.81]
        restitution = {pair = 0.9}
        contact_duration = 1e-6
        domain = {kind = "box", size = [10, 5], origin = [-1, 0]}
        disk = [{position = [0, 1], velocity = [3, 0], radius = 0.5, mass = inf}]
        disks_file = [{path = "start.csv"}]
        wall = [{kind = "segment", start = [2, 0], end = [2, 5], name = "middle"}]
        gas = [{count = 5, radius = 0.1, mass = 3, speed = 2, arrangement = "square", region = [3, 0, 5, 5], seed = 1}]
        """
    )
    scene = load_scene(tmp_path / "all.toml")
    assert (scene.name, scene.until, scene.events, scene.start_time) == ("all", 4.0, 100, 1.0)
    assert (scene.gravity, scene.restitution.pair, scene.restitution.wall) == ((0.0, -9.81), 0.9, 1.0)
    assert scene.domain == Box((10, 5), (-1, 0))
    assert scene.walls == (Segment((2, 0), (2, 5), "middle"),)
    # The order: disk tables, files of disks, gases.
    assert scene.disks.mass.tolist() == [math.inf, 2, 3, 3, 3, 3, 3]
    assert scene.disks.position[1].tolist() == [6, 3]
    assert np.hypot(*scene.disks.velocity[2:].T) == pytest.approx(2, rel=4e-16)


def test_json_has_the_same_keys_and_a_word_for_inf(tmp_path):
    tables = {"domain": {"kind": "open"}, "disk": [{"position": [0, 0], "radius": 1, "mass": "inf"}]}
    (tmp_path / "post.json").write_text(json.dumps(tables))
    assert load_scene(tmp_path / "post.json").disks.mass.tolist() == [math.inf]


GASES = {
    "domain": {"kind": "box", "size": [10, 10]},
    "gas": [{"count": 5, "radius": 0.1, "seed": 7, "speed": 1.0, "region": [5 * i, 0, 5 * i + 5, 10]} for i in (0, 1)],
}


def test_tables_with_one_seed_are_alike_and_a_seed_for_all_makes_them_differ():
    velocity = scene_from_dict(GASES).disks.velocity
    assert np.array_equal(velocity[:5], velocity[5:])
    velocity = scene_from_dict(GASES, seed=7).disks.velocity
    assert not np.array_equal(velocity[:5], velocity[5:])
    assert scene_from_dict(GASES, seed=7) == scene_from_dict(GASES, seed=7)
    angle = 2 * math.pi * np.random.default_rng((7, 1)).random(5)
    assert np.array_equal(velocity[5:], np.stack([np.cos(angle), np.sin(angle)], axis=1))


def test_a_seed_for_all_stands_in_for_a_missing_one():
    tables = {"domain": {"kind": "box", "size": [1, 1]}, "gas": [{"count": 3, "radius": 0.1}]}
    assert len(scene_from_dict(tables, seed=0).disks) == 3


def test_settings_change_keys_without_touching_the_original():
    tables = {"gas": [{"count": 5}], "restitution": 1.0}
    changed = apply_overrides(
        tables,
        [
            "gas.0.count=500",
            "restitution=0.9",
            "gas[1].speed = 2",
            "name=my scene",
            "gravity=[0, -1]",
            "domain.kind=box",
        ],
    )
    assert changed == {
        "gas": [{"count": 500}, {"speed": 2}],
        "restitution": 0.9,
        "name": "my scene",
        "gravity": [0, -1],
        "domain": {"kind": "box"},
    }
    assert tables == {"gas": [{"count": 5}], "restitution": 1.0}


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("gas.0.count", "must be key=value"),
        ("=3", "must be key=value"),
        ("gas.3.count=1", "there is no gas.3: there is gas.0 alone \\(gas.1 would add one"),
        ("gas.x=1", "there is no gas.x: there is gas.0 alone"),
        ("gas.0.region.9=1", r"there is no gas.0.region.9: there are gas.0.region.0 and gas.0.region.1 \(gas.0.region.2 would"),
        ("until.x=1", "until is 3, which has no key 'x'"),
    ],
)
def test_a_setting_that_leads_nowhere_is_refused(setting, words):
    with pytest.raises(SceneError, match=words):
        apply_overrides({"gas": [{"count": 5, "region": [0, 1]}], "until": 3}, [setting])


def test_an_entry_of_a_list_may_be_set():
    assert apply_overrides({"gravity": [0.0, -1.0]}, "gravity.1=-2") == {"gravity": [0.0, -2]}


@pytest.mark.parametrize("wrong", [3, {"until": 1}, [3]])
def test_what_holds_no_settings_is_refused(wrong):
    with pytest.raises(SceneError, match='must be settings "key=value", like '):
        apply_overrides({"until": 3}, wrong)


TABLES = {"domain": {"kind": "box", "size": [4, 3]}, "disk": [{"position": [1, 1], "radius": 0.5}]}


def test_a_dict_of_tables_is_loaded_like_a_file():
    assert load_scene(TABLES, "until=2").until == 2.0
    assert load_scene(TABLES, seed=7).seed is None
    with pytest.raises(SceneError, match=r"seed = 2\.5: must be a whole number"):
        load_scene(TABLES, seed=2.5)
    with pytest.raises(SceneError, match="seed = -1: must be at least 0"):
        load_scene(TABLES, seed=-1)


def test_what_is_no_file_is_refused():
    with pytest.raises(SceneError, match="from the path of a file, or a dict, not from the type int"):
        load_scene(3)
    with pytest.raises(SceneError, match=r"newton-cradle: no such file; the built-in scene is gallery\('newton-cradle'\)"):
        load_scene("newton-cradle")


def test_a_scene_has_the_name_of_its_file_where_that_can_be_one(tmp_path):
    for stem, name in (("ramp", "ramp"), ("ra\tmp", None)):
        path = tmp_path / f"{stem}.json"
        path.write_text(json.dumps(TABLES))
        assert load_scene(path).name == name


def test_tables_that_are_nested_beyond_all_measure_are_refused(tmp_path):
    deep = {"domain": 3}
    for _ in range(40):
        deep = {"a": deep}
    with pytest.raises(SceneError, match="mine: is nested too deeply for a scene"):
        scene_from_dict(deep, source="mine")
    with pytest.raises(SceneError, match="the tables are nested too deeply for a scene"):
        load_scene(deep)
    (tmp_path / "deep.json").write_text(json.dumps(deep))
    with pytest.raises(SceneError, match=r"deep.json: is nested too deeply for a scene file"):
        load_scene(tmp_path / "deep.json")


@pytest.mark.parametrize(
    ("tables", "words"),
    [
        (3, "it is no table with the keys of a scene"),
        ({**TABLES, "gas": []}, "gas: a log lists its disks; it makes none and reads no other file"),
        ({**TABLES, "contact_law": "laws.py:soft"}, "contact_law: a log holds the text of a law; it runs no other file"),
    ],
)
def test_a_scene_inside_a_log_reads_nothing_else(tables, words):
    with pytest.raises(SceneError, match=words):
        listed_scene(tables)


def test_disks_of_a_scene_come_from_its_tables(tmp_path):
    """Two gases with one seed are twins, unless all are seeded anew."""
    gas = {"count": 2, "radius": 0.1, "seed": 3}
    (tmp_path / "start.csv").write_text("x,y,radius\n0.2,0.2,0.1\n")
    tables = {**TABLES, "disks_file": [{"path": "start.csv"}], "gas": [gas, {**gas, "seed": 4}, gas]}
    (tmp_path / "scene.json").write_text(json.dumps(tables))
    found = origins(tmp_path / "scene.json", None, None, 8)
    assert found.shares == (("[[disk]]", 1), ("[[disks_file]]", 1), ("gas[0]", 2), ("gas[1]", 2), ("gas[2]", 2))
    assert found.twins == ((0, 2),)
    assert origins(tmp_path / "scene.json", None, 5, 8).twins == ()


def test_all_that_disks_have_comes_back_from_toml_and_from_npz(tmp_path):
    disks = Disks(
        position=[[1, 1], [2, 1], [3, 1]],
        velocity=[[0, 0], [1, 0], [0, 0]],
        radius=[0.25, 0.5, 0.25],
        mass=[1, math.inf, 2],
        species=["", "b", "c"],
        spin=[0, 1, 0],
        moment=[0.5, 0.5, 1],
    )
    scene = Scene(disks, Box((4, 3)), tangential_restitution=0.5)
    (tmp_path / "scene.toml").write_text(scene_to_toml(scene))
    assert load_scene(tmp_path / "scene.toml") == scene
    assert scene_from_dict(json.loads(scene_to_json(scene))) == scene
    write_disks_file(tmp_path / "start.npz", disks)
    assert read_disks_file(tmp_path / "start.npz").disks == disks


def test_a_scene_is_saved_under_its_own_suffixes(tmp_path):
    with pytest.raises(SceneError, match=r"scene.txt: a scene file ends in .toml or .json"):
        load_scene(TABLES).save(tmp_path / "scene.txt")


HEADER = "time,disk,x,y,vx,vy,radius,mass\n"


def load_with_disks(folder: Path, name: str) -> Scene:
    return scene_from_dict({"domain": {"kind": "open"}, "disks_file": [{"path": name}]}, folder)


def test_disks_come_from_csv_and_npz_alike_in_every_bit(tmp_path):
    rng = np.random.default_rng(1)
    table = {key: rng.random(50) * 10.0 ** rng.integers(-9, 9, 50) for key in ("x", "y", "vx", "vy", "mass")}
    table["radius"] = np.zeros(50)
    rows = [",".join(map(repr, row)) for row in zip(*(column.tolist() for column in table.values()), strict=True)]
    (tmp_path / "start.csv").write_text("# a comment\n" + ",".join(table) + "\n" + "\n".join(rows) + "\n")
    np.savez(tmp_path / "start.npz", **table)
    scene = load_with_disks(tmp_path, "start.csv")
    assert np.array_equal(scene.disks.position, np.stack([table["x"], table["y"]], axis=1))
    assert scene == load_with_disks(tmp_path, "start.npz")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (HEADER + "0,0,1,1,0,0,0.5,1\n1,0,2,1,0,0,0.5,1\n", ["2 times (0.0, 1.0)"]),
        ("x,y\n1,2\n", ["lacks radius: the columns must be named x, y, vx, vy, radius, mass"]),
        (
            HEADER + "0,0,1,1,0,0,0.5,1\n\n0,1,9,1,zero,0,0.5\n",
            ["line 4: vx = 'zero'", "line 4: mass is missing"],
        ),
        ("x,y,vx,radius\n1,2,0,1\n", ["lacks vy: the columns must be named"]),
        ("x,y,radius,x\n1,2,1,1\n", ["has more than one column x"]),
        ("x,y,radius\n" + "a,b,c\n" * 3, ["line 2: x = 'a'", "line 3: radius = 'c'", "lines after line 3 were not looked at"]),
        (HEADER, ["no disks"]),
        ("", ["lacks x"]),
        (
            HEADER + "0,0,1,1,0,0,0.5,1\n0,1,1,1,0,0,0.5,1\n",
            ["start.csv line 2 and start.csv line 3 overlap"],
        ),
        (
            HEADER + "0,0,1,1,0,0,-0.5,1\n",
            [
                "start.csv line 2: radius = -0.5",
            ],
        ),
    ],
)
def test_a_bad_file_of_disks_is_told_with_its_line(tmp_path, text, words):
    (tmp_path / "start.csv").write_text(text)
    with pytest.raises(SceneError) as caught:
        load_with_disks(tmp_path, "start.csv")
    for word in words:
        assert word in str(caught.value)


def test_a_bad_npz_is_told_in_a_sentence(tmp_path):
    (tmp_path / "start.npz").write_bytes(b"no zip")
    with pytest.raises(SceneError, match="a table of text is named"):
        load_with_disks(tmp_path, "start.npz")
    np.savez(
        tmp_path / "start.npz",
        **dict.fromkeys(("x", "y", "vx", "vy", "radius"), np.zeros(2)),
        mass=np.zeros(3),
    )
    with pytest.raises(SceneError, match="equally long"):
        load_with_disks(tmp_path, "start.npz")


def test_more_disks_than_a_scene_may_have_are_told(tmp_path, monkeypatch):
    monkeypatch.setattr("eventsim.scene.disks_file.MOST_DISKS", 2)
    np.savez(tmp_path / "start.npz", **dict.fromkeys(("x", "y", "radius"), np.zeros(3)))
    with pytest.raises(SceneError, match=r"start.npz: holds 3 disks: must be at most 2"):
        load_with_disks(tmp_path, "start.npz")


FRAMES = "".join(f"2\nTime={t}\nA {t} 0 0\nA 3 0.5 0\n" for t in (1, 5))


def test_a_frame_of_another_program_is_put_into_the_period(tmp_path):
    (tmp_path / "start.xyz").write_text(FRAMES)
    for domain, places in ((None, [[5, 0], [3, 0.5]]), (Box((6, 2)), [[5, 0], [3, 0.5]]), (Periodic((4, 2)), [[1, 0], [3, 0.5]])):
        found = read_disks_file(tmp_path / "start.xyz", domain, frame=-1, radius=0.125, mass=2.0)
        assert found.disks == Disks(places, radius=0.125, mass=2.0)
        assert (found.row, found.number.tolist()) == ("atom", [0, 1])
    with pytest.raises(SceneError, match=r"start.xyz: tells no radius: say radius = 0.5 beside the path"):
        read_disks_file(tmp_path / "start.xyz", frame=0)
    (tmp_path / "start.csv").write_text("x,y,radius\n0.2,0.2,0.1\n")
    with pytest.raises(SceneError, match=r"start.csv: frame = 1: a table has no frames"):
        read_disks_file(tmp_path / "start.csv", frame=1)


def test_a_frame_with_another_box_than_the_domain_is_refused(tmp_path):
    pytest.importorskip("gsd")
    scene = Scene(Disks([[1, 2]], radius=0.5), Periodic((4, 3)))
    write_states(tmp_path / "start.gsd", scene, [State(0.0, scene.disks.position, scene.disks.velocity)])
    assert read_disks_file(tmp_path / "start.gsd", scene.domain).disks.position.tolist() == [[1, 2]]
    with pytest.raises(SceneError, match=r"has the box \[4.0, 3.0\], and the domain the size \[4.0, 2.0\]: must be alike"):
        read_disks_file(tmp_path / "start.gsd", Periodic((4, 2)))


def test_the_equilibration_comes_back_and_must_be_a_time():
    data = {"domain": {"kind": "open"}, "disk": [{"position": [0.0, 0.0], "radius": 1.0}], "equilibration": 2.5}
    scene = scene_from_dict(data)
    assert scene.equilibration == 2.5
    assert scene_from_dict(scene_to_dict(scene)) == scene
    with pytest.raises(SceneError, match=r"equilibration = -1\.0: must be a finite time"):
        scene_from_dict({**data, "equilibration": -1.0})


def test_a_key_that_json_gives_twice_is_told(tmp_path):
    path = tmp_path / "twice.json"
    path.write_text('{"domain": {"kind": "open"}, "disk": [{"radius": 1, "position": [0, 0], "radius": 2}]}')
    with pytest.raises(SceneError, match=r"twice.json: gives the key 'radius' twice in one table"):
        load_scene(path)

"""What a page may say: read as it was meant, or refused in a sentence."""

import json

import pytest

from eventsim.errors import EventsimError, SceneError
from eventsim.formulas.laws import Treatment
from eventsim.live.menu import Menu
from eventsim.live.messages import AddDisk, AddWall, MessageError, Open, Shown, Throw, read_message
from eventsim.live.source import BuiltIn, Text
from eventsim.scene.contact_law import law_of_scene
from tests.live.running import menu


def test_messages_are_read_as_meant():
    assert read_message('{"type": "throw", "time": 1, "disk": 2, "velocity": [3, -4.5]}') == Throw(1.0, 2, (3.0, -4.5))
    assert read_message('{"type": "shown", "edition": 1, "time": 0.5, "events": 7, "speed": 2}') == Shown(
        1, 0.5, 7, 2.0
    )
    message = read_message(
        json.dumps({"type": "open", "scene": "gallery", "name": "gas", "parameters": {"n": 5}, "rate": 60})
    )
    assert message == Open(BuiltIn("gas", {"n": 5}), 60.0)
    opened = read_message(json.dumps(menu(count=7)))
    assert isinstance(opened, Open)
    assert isinstance(opened.source, Menu)
    assert opened.source.count == 7
    assert opened.rate is None


@pytest.mark.parametrize(
    ("text", "rule"),
    [
        ("", "must be JSON"),
        ("{", "must be JSON"),
        ("[" * 100_000, "must be JSON"),
        ("[1]", "must be a JSON object"),
        ("{}", "there is no message of type None"),
        ('{"type": ["open"]}', "there is no message of type"),
        ('{"type": "throw", "time": 1, "disk": 0}', "'velocity' is missing"),
        ('{"type": "throw", "time": -1, "disk": 0, "velocity": [0, 0]}', "time = -1: must be a number from 0"),
        ('{"type": "throw", "time": NaN, "disk": 0, "velocity": [0, 0]}', "must be JSON"),
        ('{"type": "throw", "time": 1e999, "disk": 0, "velocity": [0, 0]}', "a number beyond all bounds"),
        ('{"type": "throw", "time": true, "disk": 0, "velocity": [0, 0]}', "time = True"),
        ('{"type": "throw", "time": 1, "disk": 0.5, "velocity": [0, 0]}', "disk = 0.5: must be a whole number"),
        ('{"type": "throw", "time": 1, "disk": 0, "velocity": [0, "0"]}', "velocity = '0'"),
        ('{"type": "throw", "time": 1, "disk": 0, "velocity": [0, 0], "x": 1}', "there is no field 'x'"),
        ('{"type": "control", "time": 1, "speed": 1, "direction": 2, "playing": true}', "must be one of 1, -1"),
        ('{"type": "open", "scene": "cellar", "rate": null}', "scene = 'cellar': must be one of"),
        ('{"type": "open", "scene": "given", "rate": 0}', "rate = 0: must be a number from 1"),
        ('{"type": "open", "scene": "gallery", "name": "gas", "parameters": {"n": [1]}}', "must be a number or a word"),
        (json.dumps(menu(count=10**9)), "must be a whole number from 1 to 5000"),
        (json.dumps({"type": "join", "world": "x" * 1000}), "must be a text of at most 100"),
    ],
)  # fmt: skip
def test_a_bad_message_is_refused_in_a_short_sentence(text, rule):
    with pytest.raises(MessageError) as error:
        read_message(text)
    assert rule in str(error.value)
    assert len(str(error.value)) < 300


@pytest.mark.parametrize("masses", ["equal", "different"])
@pytest.mark.parametrize("radii", ["equal", "different"])
@pytest.mark.parametrize("count", [1, 3, 50])
def test_the_menu_makes_the_scene_that_it_describes(masses, radii, count):
    menu = Menu(width=900.0, height=600.0, count=count, masses=masses, radii=radii, packing=0.3, speed=100.0)
    disks = menu.scene().disks
    assert len(disks) == count
    assert 3.14159265 * (disks.radius**2).sum() == pytest.approx(0.3 * 900 * 600, rel=1e-6)
    speeds = (disks.velocity**2).sum(axis=1) ** 0.5
    assert speeds == pytest.approx(100.0)
    if count == 50:
        assert len(set(disks.mass)) == (5 if masses == "different" else 1)
        assert len(set(disks.radius)) == (5 if radii == "different" else 1)
    assert (menu.scene().disks.position == disks.position).all()


def test_the_menu_has_walls_that_heat_a_floor_that_shakes_and_disks_that_grip():
    law = law_of_scene(Menu(width=900.0, height=600.0).scene())
    assert (law.rough, law.drives, law.keeps_energy()) == (None, False, True)
    warm = Menu(width=900.0, height=600.0, temperature=5000.0, shaking=20.0, roughness=0.5, seed=9).scene()
    assert warm.seed == 9
    assert warm.disks.spins().tolist() == [0.0] * 50
    law = law_of_scene(warm)
    assert law.rough == (0.5, 0.5)
    assert [law.treatment(k) for k in range(4)] == [
        *[Treatment(5000.0)] * 2, Treatment(shaking=20.0), Treatment(5000.0),
    ]  # fmt: skip
    with pytest.raises(MessageError, match="roughness = -2: must be a number from -1 to 1"):
        read_message(json.dumps(menu(roughness=-2)))


def test_a_dense_menu_uses_a_lattice_and_what_does_not_fit_is_refused():
    assert len(Menu(width=900.0, height=600.0, count=200, packing=0.7).scene().disks) == 200
    with pytest.raises(SceneError):
        Menu(width=900.0, height=600.0, count=200, packing=0.85, radii="different").scene()


@pytest.mark.parametrize(
    ("text", "rule"),
    [
        ("disk = [", "not valid TOML"),
        ('[[disks_file]]\npath = "/etc/passwd"', "reads no other files"),
        ("[[gas]]\ncount = 1000000", "at most 5000 disks"),
        ("gas = 3", "gas"),
    ],
)
def test_a_scene_file_that_does_not_fit_a_live_view_is_refused(text, rule):
    with pytest.raises(EventsimError, match=rule):
        Text(text).scene()


def test_drawn_disks_and_walls_are_read_as_meant():
    assert read_message('{"type": "disk", "time": 1, "position": [3, 4], "radius": 0.5}') == AddDisk(1.0, (3.0, 4.0), 0.5)
    assert read_message('{"type": "wall", "time": 0, "start": [1, 2], "end": [3, 4]}') == AddWall(0.0, (1.0, 2.0), (3.0, 4.0))
    with pytest.raises(MessageError, match="radius = -1: must be a number from 0"):
        read_message('{"type": "disk", "time": 1, "position": [3, 4], "radius": -1}')

"""Mistakes that beginners make in a scene file: each is answered with its line, a caret, and the line that would be right."""

import json
import re
import tomllib
from itertools import pairwise

import pytest

from eventsim.errors import SceneError
from eventsim.scene.files import load_scene
from eventsim.scene.remedies import EXAMPLES, written
from eventsim.scene.schema import DISK, DISKS_FILE, DOMAIN, GAS, RESTITUTION, WALL
from eventsim.scene.schema import SCENE as SCENE_KEYS
from eventsim.scene.slips import problem_of
from eventsim.scene.walls import WALLS

SCENE = """\
until = 2.0
gravity = [0.0, -9.81]
restitution = 0.9
[domain]
kind = "box"
size = [2.0, 1.0]
[[wall]]
kind = "segment"
start = [0.0, 0.5]
end = [0.4, 0.5]
[[disk]]
position = [0.3, 0.8]
velocity = [1.0, 0.0]
radius = 0.05
mass = 2.0
[[gas]]
count = 20
radius = 0.02
temperature = 1.0
arrangement = "random"
region = [1.0, 0.0, 2.0, 1.0]
seed = 7
"""

MISTAKES = [
    # a line of SCENE, what somebody wrote instead, what the caret points to, what is proposed
    ("radius = 0.05", "radius = 0,05", ",05", "radius = 0.05"),
    ("radius = 0.05", "radius = .05", ".05", "radius = 0.05"),
    ("velocity = [1.0, 0.0]", "velocity = [1., 0.]", ", 0.]", "velocity = [1.0, 0.0]"),
    ("position = [0.3, 0.8]", "position = [0,3, 0,8]", "[0,3", "position = [0.3, 0.8]"),
    ("position = [0.3, 0.8]", "position = [0,3; 0,8]", ",3; 0,8]", "position = [0.3, 0.8]"),
    ("position = [0.3, 0.8]", "position = (0.3, 0.8)", "(0.3", "position = [0.3, 0.8]"),
    ("position = [0.3, 0.8]", "position = {0.3, 0.8}", "{0.3", "position = [0.3, 0.8]"),
    ("position = [0.3, 0.8]", "position = 0.3, 0.8", "0.3, 0.8", "position = [0.3, 0.8]"),
    ("position = [0.3, 0.8]", "position = [0.3 0.8]", " 0.8]", "position = [0.3, 0.8]"),
    ("position = [0.3, 0.8]", "position = [0.3, 0.8", "", "position = [0.3, 0.8]"),
    ("position = [0.3, 0.8]", 'position = "0.3, 0.8"', '"0.3', "position = [0.3, 0.8]"),
    ("position = [0.3, 0.8]", "x = 0.3\ny = 0.8", "x = 0.3", "position = [0.3, 0.8]"),
    ("position = [0.3, 0.8]", "pos = [0.3, 0.8]", "pos", "position = [0.3, 0.8]"),
    ('kind = "box"', "kind = box", "box", 'kind = "box"'),
    ('kind = "box"', "kind = “box”", "“box”", 'kind = "box"'),
    ('kind = "box"', 'kind = "box', "", 'kind = "box"'),
    ('kind = "box"', 'kind = "Box"', '"Box"', 'kind = "box"'),
    ('kind = "box"', 'kind = "rectangle"', '"rectangle"', 'kind = "box"'),
    ('kind = "box"', 'type = "box"', "type", 'kind = "box"'),
    ('kind = "segment"', 'kind = "line"', '"line"', 'kind = "segment"'),
    ("size = [2.0, 1.0]", "width = 2.0\nheight = 1.0", "width", "size = [2.0, 1.0]"),
    ("size = [2.0, 1.0]", "size = 2 x 1", "2 x 1", "size = [2, 1]"),
    ("[[disk]]", "[disk]", "[disk]", "[[disk]]"),
    ("[[disk]]", "[[disk]", "", "[[disk]]"),
    ("[[disk]]", "[[ball]]", "[[ball]]", "[[disk]]"),
    ("[[disk]]", "[[Disk]]", "[[Disk]]", "[[disk]]"),
    ("[domain]", "[[domain]]", "[[domain]]", "[domain]"),
    ("mass = 2.0", "mass = 2.0\n[domain]", "[domain]", None),
    ("mass = 2.0", "mass = 2.0\nposition = [0.5, 0.5]\nradius = 0.05", "position", "[[disk]]\nposition = [0.5, 0.5]"),
    ("mass = 2.0", "mass: 2.0", ": 2.0", "mass = 2.0"),
    ("mass = 2.0", "mass 2.0", "2.0", "mass = 2.0"),
    ("mass = 2.0", "mass = 2.0 kg", " kg", "mass = 2.0"),
    ("position = [0.3, 0.8]", "position = [0.3 m, 0.8 m]", " m, 0.8 m]", "position = [0.3, 0.8]"),
    ("position = [0.3, 0.8]", "position = [0.3, 0.8] m", " m", "position = [0.3, 0.8]"),
    ("velocity = [1.0, 0.0]", "velocity = {speed = 2.0, angle = 90}", "{speed", "velocity = [0.0, 2.0]"),
    ("velocity = [1.0, 0.0]", "velocity = [1, 30°]", "1, 30°", "velocity = [0.866025, 0.5]"),
    ("velocity = [1.0, 0.0]", "velocity = [2, 90 deg]", "2, 90 deg", "velocity = [0.0, 2.0]"),
    ("velocity = [1.0, 0.0]", "velocity = 3\nangle = 30", "3", "velocity = [2.598076, 1.5]"),
    ("velocity = [1.0, 0.0]", 'velocity = [1.0, 0.0]\nname = "A"', "name", 'species = "A"'),
    ('kind = "segment"', 'kind = "segmnt"', '"segmnt"', 'kind = "segment"'),
    ("mass = 2.0", "mass = 4/2", "4/2", "mass = 2.0"),
    ("mass = 2.0", "mass = 2.0;", ";", "mass = 2.0"),
    ("mass = 2.0", "mass = 2.0  // heavy", "  // heavy", "mass = 2.0"),
    ("mass = 2.0", "mass = infinity", "inity", "mass = inf"),
    ("mass = 2.0", 'mass = "2.0"', '"2.0"', "mass = 2.0"),
    ("mass = 2.0", "mass = 02.0", "02.0", "mass = 2.0"),
    ("mass = 2.0", "mass = heavy", "heavy", "mass = 2.0"),
    ("mass = 2.0", "mass =", "", "mass = 2.0"),
    ("radius = 0.05", "diameter = 0.1", "diameter", "radius = 0.05"),
    ("radius = 0.05", "r = 0.05", "r = 0.05", "radius = 0.05"),
    ("radius = 0.05", "", "[[disk]]", "radius = 0.05"),
    ("velocity = [1.0, 0.0]", "speed = 2.0\nangle = 90", "speed", "velocity = [0.0, 2.0]"),
    ("velocity = [1.0, 0.0]", "vx = 1.0\nvy = 0.0", "vx", "velocity = [1.0, 0.0]"),
    ("gravity = [0.0, -9.81]", "gravity = -9.81", "-9.81", "gravity = [0.0, -9.81]"),
    ("gravity = [0.0, -9.81]", "g = 9.81", "g = 9.81", "gravity = [0.0, -9.81]"),
    ("[[wall]]", "gravity = -9.81\n[[wall]]", "gravity", "gravity = [0.0, -9.81]\n[domain]"),
    ("mass = 2.0", "mass = 2.0\nduration = 3", "duration", "until = 3\n[domain]"),
    ("restitution = 0.9", "restitution = 90 %", "90 %", "restitution = 0.9"),
    ("restitution = 0.9", "restitution = 90", "90", "restitution = 0.9"),
    ("restitution = 0.9", "elasticity = 0.9", "elasticity", "restitution = 0.9"),
    ("until = 2.0", "until = 2 s", " s", "until = 2"),
    ("until = 2.0", "until = 2.0\ndt = 0.01", "dt", None),
    ("count = 20", "n = 20", "n = 20", "count = 20"),
    ("count = 20", "count = 1,000", ",000", "count = 1000"),
    ("seed = 7", "", "[[gas]]", "seed = 7"),
    ('arrangement = "random"', 'arrangement = "hex"', '"hex"', 'arrangement = "hexagonal"'),
    ("end = [0.4, 0.5]", "to = [0.4, 0.5]", "to", "end = [0.4, 0.5]"),
    ("radius = 0.02", "packing fraction = 0.02", " fraction", "packing_fraction = 0.02"),
]


def told(file, *settings):
    with pytest.raises(SceneError) as caught:
        load_scene(file, settings)
    return caught.value.problems


@pytest.mark.parametrize(("line", "wrong", "at", "right"), MISTAKES, ids=[repr(wrong) for _, wrong, _, _ in MISTAKES])
def test_a_mistake_is_told_with_its_line_a_caret_and_the_right_line(tmp_path, line, wrong, at, right):
    assert SCENE.count(line) == 1
    text = SCENE.replace(line, wrong)
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    problems = told(tmp_path / "scene.toml")
    found = []
    for problem in problems:
        _, *rows = problem.split("\n    ")
        if not rows:
            continue
        label, _, shown = rows[0].partition(": ")
        number = int(label.removeprefix("line "))
        assert shown.strip() == text.splitlines()[number - 1].strip()
        pointed = rows[0][rows[1].index("^") :]
        write = [row for row in rows[2:] if not row.startswith("line ")]  # another line that is mended with it
        found.append((pointed, [re.sub("^(write|as in):", "", row).strip() for row in write]))
    wanted = [] if right is None else right.split("\n")
    assert any(pointed.startswith(at) and (at or not pointed) and write == wanted for pointed, write in found), problems


@pytest.mark.parametrize(
    ("line", "right"),
    [
        (line, right)
        for line, _, _, right in MISTAKES
        if right and "[domain]" not in right and "[[disk]]\n" not in right
    ],
)
def test_what_is_proposed_makes_a_scene(tmp_path, line, right):
    (tmp_path / "scene.toml").write_text(SCENE.replace(line, right))
    load_scene(tmp_path / "scene.toml", ["gas.0.count=20"])


def told_of(tmp_path, tables):
    """What is told of a scene with further tables, without the path of its file."""
    path = tmp_path / "scene.toml"
    path.write_text(SCENE + tables)
    return "\n".join(told(path)).replace(f"{path}: ", "")


OPEN = '[domain]\nkind = "open"\n'
ONE = "[[disk]]\nposition = [0.3, 0.8]\nradius = 0.05\n"
SINGLE = "[gas]\ncount = 3\nradius = 0.1\nseed = 1\n"


def test_what_only_shows_the_form_is_called_an_example(tmp_path):
    text = told_of(tmp_path, '[[disk]]\nposition = [0.5, 0.2]\nradius = 0.01\nmass = "heavy"\n')
    assert "    as in:   mass = 2.0" in text
    assert "write:" not in text


@pytest.mark.parametrize(
    ("kind", "why"), [("pocket", "there are no pockets"), ("holes", "no pockets"), ("post", "a [[disk]] with mass = inf")]
)
def test_a_kind_of_wall_that_there_is_not_is_answered_without_another_ones_name(tmp_path, kind, why):
    text = told_of(tmp_path, f'[[wall]]\nkind = "{kind}"\n')
    assert why in text
    assert "write:" not in text
    assert "as in:" not in text


@pytest.mark.parametrize("kind", WALLS)
def test_a_slip_in_any_kind_of_wall_is_mended(tmp_path, kind):
    assert f'write:   kind = "{kind}"' in told_of(tmp_path, f'[[wall]]\nkind = "{kind[:-2]}{kind[-1]}{kind[-2]}"\n')


def test_a_kind_of_wall_nobody_knows_is_answered_with_one_of_a_wall(tmp_path):
    assert 'as in:   kind = "segment"' in told_of(tmp_path, '[[wall]]\nkind = "xyzzy"\n')


def test_a_round_obstacle_is_a_disk_that_nothing_deflects(tmp_path):
    table = "[[obstacle]]\nposition = [0.6, 0.2]\nradius = 0.05\n"
    text = told_of(tmp_path, table)
    assert "a round post is a [[disk]] with mass = inf\n    write:   [[disk]]\n             mass = inf" in text
    (tmp_path / "scene.toml").write_text(SCENE + table.replace("[[obstacle]]", "[[disk]]\nmass = inf"))
    assert load_scene(tmp_path / "scene.toml").disks.mass.tolist()[:2] == [2.0, float("inf")]
    assert "write:   [[wall]]" in told_of(tmp_path, "[[obstacle]]\nstart = [0.6, 0.2]\nend = [0.6, 0.3]\n")


def test_a_disk_outside_of_a_circle_is_told_what_a_round_post_is(tmp_path):
    circle = '[[wall]]\nkind = "circle"\ncenter = [0.6, 0.2]\nradius = 0.05\n'
    assert "must be inside its container (a round post is a disk of mass inf)" in told_of(tmp_path, circle)


def test_an_arc_of_angles_is_told_its_three_points(tmp_path):
    arc = '[[wall]]\nkind = "arc"\ncenter = [0.7, 0.2]\nradius = 0.1\nstart = 0\nend = 180\n'
    text = told_of(tmp_path, arc)
    proposed = [row.split("write:")[1].strip() for row in text.splitlines() if "write:" in row]
    assert set(proposed) == {"start = [0.8, 0.2]", "through = [0.7, 0.3]", "end = [0.6, 0.2]"}
    assert "the angles read as degrees" in text
    assert "as in:" not in text
    (tmp_path / "scene.toml").write_text(SCENE + '[[wall]]\nkind = "arc"\n' + "\n".join(dict.fromkeys(proposed)))
    assert load_scene(tmp_path / "scene.toml").walls[-1].through == (0.7, 0.3)


def test_a_setting_is_quoted_as_it_was_typed(tmp_path):
    (tmp_path / "scene.toml").write_text(SCENE)
    for setting, caret, right in (
        ("restitution=.17", 12, "restitution=0.17"),
        ("gravity=-9.81", 8, "gravity=[0.0, -9.81]"),
        ("gas.0.radius=0,01", 13, "gas.0.radius=0.01"),
    ):
        (problem,) = told(tmp_path / "scene.toml", setting)
        _, typed, pointed, write = problem.split("\n    ")
        assert typed == f"typed: {setting}"
        assert pointed.index("^") == caret + len("typed: ")
        assert write == f"write: {right}"


def test_two_disks_in_single_brackets_are_told_like_one(tmp_path):
    single = "[disk]\nposition = [0.3, 0.8]\nradius = 0.05\n"
    (tmp_path / "scene.toml").write_text(f'[domain]\nkind = "open"\n{single}{single.replace("0.3", "1.3")}')
    (problem,) = told(tmp_path / "scene.toml")
    assert "line 6: [disk]" in problem
    assert "write:  [[disk]]" in problem


@pytest.mark.parametrize(
    ("text", "line", "right"),
    [
        ("gravity = 9,81\n" + OPEN + ONE, 1, "gravity = [0.0, -9.81]"),
        (OPEN + ONE.replace("0.8]", "0.8]]"), 4, "position = [0.3, 0.8]"),
        (OPEN + ONE.replace("[[disk]]", "{disk}"), 3, "[[disk]]"),
        (OPEN.replace("open", "box") + "size = [2.0, 1.0\n" + ONE, 3, "size = [2.0, 1.0]"),
        (OPEN + SINGLE + SINGLE, "3, 7", "[[gas]]"),
    ],
)
def test_what_is_proposed_is_right(tmp_path, text, line, right):
    (tmp_path / "scene.toml").write_text(text)
    (problem,) = told(tmp_path / "scene.toml")
    assert f"(at line {line})" in problem
    assert problem.endswith(f"write:  {right}")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (OPEN + 'kind = "open"\n' + ONE, "this key is there already"),
        (OPEN + ONE.replace("0.05", "pi"), "this is no value: a number,"),
        (OPEN + ONE.replace("radius", "mass = 1.0 radius"), "a line holds one key and one value"),
    ],
)
def test_what_is_no_toml_is_told_in_words(tmp_path, text, words):
    (tmp_path / "scene.toml").write_text(text)
    (problem,) = told(tmp_path / "scene.toml")
    assert words in problem


def test_a_value_of_the_right_form_is_not_proposed_again(tmp_path):
    text = told_of(tmp_path, "[[disk]]\nposition = [0.5, inf]\nradius = 0.01\n")
    assert "position = [0.5, inf]" in text
    assert "write:" not in text
    text = told_of(tmp_path, "[[disk]]\nposition = [0.5, 1e200]\nradius = 0.01\n")
    assert "disk[1].position = [0.5, 1e+200]" in text
    assert "write:" not in text


def test_a_value_is_written_as_it_is_read():
    value = {"a": [True, 0.5, float("inf"), 3], "b": 'say "x"\n', "c": {"d": "C:\\x"}, "e": "ü"}
    assert tomllib.loads(f"value = {written(value)}")["value"] == value


def test_a_restitution_above_1_and_a_table_with_a_capital_are_told(tmp_path):
    (tmp_path / "scene.toml").write_text("restitution = 1.5\n" + OPEN + ONE)
    (problem,) = told(tmp_path / "scene.toml")
    assert "more than 1 would make energy" in problem
    assert problem.endswith("write:  restitution = 1.0")
    (tmp_path / "scene.toml").write_text(OPEN.replace("[domain]", "[Domain]") + ONE)
    first, second = told(tmp_path / "scene.toml")
    assert "names are written small\n    write:  [domain]" in first
    assert "domain is missing" in second


def test_very_long_files_are_told_their_mistake_without_a_proposal(tmp_path, monkeypatch):
    """Nothing is read again then with a line mended."""
    for module in ("slips", "json_slips", "quoting"):
        monkeypatch.setattr(f"eventsim.scene.{module}.LONGEST", 10)
    (tmp_path / "scene.toml").write_text(OPEN + ONE.replace("0.05", "0,05"))
    assert "a line holds one key and one value, and nothing more (at line 5" in told(tmp_path / "scene.toml")[0]
    (tmp_path / "scene.json").write_text(JSON.replace("0.1}", "0.1,}", 1))
    (problem,) = told(tmp_path / "scene.json")
    assert "(at line 4, column" in problem
    assert "write:" not in problem
    (tmp_path / "scene.toml").write_text(OPEN + ONE.replace("0.05", "-1"))
    assert told(tmp_path / "scene.toml")[0].endswith("(0 is a point, no other below 1e-150)")


def test_what_a_reader_of_toml_says_without_a_place_is_repeated():
    assert problem_of("until = 3", tomllib.TOMLDecodeError("is odd")) == "is odd"


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_a_mark_of_byte_order_is_no_part_of_a_scene(tmp_path, encoding):
    for name, text in (
        ("scene.toml", SCENE),
        ("scene.json", '{"domain": {"kind": "open"}, "disk": [{"position": [0, 0], "radius": 1}]}'),
    ):
        (tmp_path / name).write_text(text, encoding=encoding)
        assert len(load_scene(tmp_path / name).disks) > 0


def test_sides_are_names_of_walls_where_the_domain_has_none(tmp_path):
    wall = '[[wall]]\nkind = "segment"\nstart = [7, 1]\nend = [7, 2]\nname = "left"\n'
    disk = "[[disk]]\nposition = [2, 2]\nradius = 0.5\n"
    for domain in ('kind = "open"', 'kind = "periodic"\nsize = [10, 5]', 'kind = "channel"\nsize = [10, 5]'):
        (tmp_path / "scene.toml").write_text(f"[domain]\n{domain}\n{disk}{wall}")
        assert load_scene(tmp_path / "scene.toml").walls[0].name == "left"
    (tmp_path / "scene.toml").write_text(
        f'[domain]\nkind = "channel"\nsize = [10, 5]\n{disk}{wall.replace("left", "top")}'
    )
    (problem,) = told(tmp_path / "scene.toml")
    assert "bottom and top are the sides of the domain" in problem


def test_every_key_of_a_scene_has_an_example():
    keys = {
        str(key)
        for schema in (SCENE_KEYS, RESTITUTION, DISK, GAS, DISKS_FILE, *DOMAIN.values(), *WALL.values())
        for key in schema.schema
    }
    assert keys <= EXAMPLES.keys()


def test_a_proposal_stands_alone_without_a_guess_that_says_otherwise(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE.replace("restitution = 0.9\n", "").replace("radius = 0.05", "radius = 0.05\nrestitution = 0.5"))
    with pytest.raises(SceneError) as error:
        load_scene(path)
    assert "move it above the first table" in str(error.value)
    assert "did you mean" not in str(error.value)
    assert "known here" not in str(error.value)


def test_two_numbers_behind_another_name_of_a_key_are_put_in_brackets(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE.replace("position = [0.3, 0.8]", "pos = 0.3, 0.8"))
    with pytest.raises(SceneError) as error:
        load_scene(path)
    assert "write:   pos = [0.3, 0.8]" in str(error.value)


CROWD = """\
[domain]
kind = "box"
size = [2.0, 1.0]
[[wall]]
kind = "segment"
start = [1.0, 0.0]
end = [1.0, 1.0]
[[disk]]
position = [0.5, 0.5]
radius = 0.1
[[disk]]
position = [1.5, 0.5]
radius = 0.1
[[wall]]
kind = "polygon"
points = [[1.2, 0.1], [1.4, 0.1], [1.3, 0.2]]
name = "block"
"""


@pytest.mark.parametrize(
    ("line", "wrong", "places"),
    [
        ("position = [1.5, 0.5]", "position = [0.55, 0.5]", ["9 disk[0]", "12 disk[1]"]),
        ("position = [1.5, 0.5]", "position = [1.95, 0.5]", ["12 disk[1]"]),
        ("position = [1.5, 0.5]", "position = [1.05, 0.5]", ["12 disk[1]", "4 wall[0]"]),
        ("position = [1.5, 0.5]", "position = [1.3, 0.25]", ["12 disk[1]", "17 wall[1]"]),
        ('name = "block"', 'name = "wall0"', ["17 wall[1]", "4 wall[0]"]),
        ("[domain]", "seed = 1\n[domain]\nwalls = {top = {temperature = 1.0}}", ["13 disk[0]"]),
    ],
)
def test_disks_and_walls_that_a_sentence_speaks_of_are_quoted(tmp_path, line, wrong, places):
    text = CROWD.replace(line, wrong)
    (tmp_path / "scene.toml").write_text(text.replace("radius = 0.1\n", "radius = 0.1\nmass = inf\n", "seed" in wrong))
    (problem, *_) = told(tmp_path / "scene.toml")
    assert re.findall(r"line (\d+): [^\n]*\n +\^ (.*)", problem) == [tuple(place.split(" ")) for place in places]


def test_the_name_of_no_wall_is_answered_with_those_that_there_are(tmp_path):
    gas = '[[gas]]\ncount = 3\nradius = 0.01\nseed = 1\ninside = "blok"\n'
    (tmp_path / "scene.toml").write_text(CROWD + gas)
    (problem,) = told(tmp_path / "scene.toml")
    assert "must be the name of a wall (wall0, block)" in problem
    assert 'line 22: inside = "blok"' in problem
    assert "as in:" not in problem


def test_a_place_that_was_typed_is_quoted_as_typed(tmp_path):
    (tmp_path / "scene.toml").write_text(CROWD)
    (problem,) = told(tmp_path / "scene.toml", "disk.1.position=[0.55,0.5]")
    assert "typed: disk.1.position=[0.55,0.5]" in problem
    assert "line 9: position = [0.5, 0.5]" in problem


JSON = """\
{"until": 2.0,
 "domain": {"kind": "box",
            "size": [2.0, 1.0]},
 "disk": [{"position": [0.5, 0.5], "radius": 0.1},
          {"velocity": [1.0, 0.0], "radius": 0.1, "position":
            [1.5, 0.5]}]
}
"""


@pytest.mark.parametrize(
    ("right", "wrong", "line", "at", "write"),
    [
        ('"until"', '"gravity": -9.81, "until"', 1, "-9.81", '"gravity": [0.0, -9.81]'),
        ("2.0,\n", '"2,0",\n', 1, '"2,0"', '"until": 2.0'),
        ('"size"', '"dimensions"', 3, '"dimensions"', '"size": [2.0, 1.0]'),
        ('"size": [2.0, 1.0]', '"size": [2.0, -1.0]', 3, "[2.0, -1.0]", None),
        ('{"position": [0.5, 0.5], "radius": 0.1}', '{"position": [0.5, 0.5]}', 4, '{"position"', '"radius": 0.05'),
        ('0.1, "position"', '0.1, "mass": "2 kg", "position"', 5, '"2 kg"', '"mass": 2.0'),
        ("[1.5, 0.5]", "[1.5]", 5, '"position":', '"position": [0.3, 0.8]'),
        ('{"velocity"', '[{"velocity"', 7, "}", None),
        ("2.0,\n", "2.0\n", 1, "", '{"until": 2.0,'),
        ("[1.5, 0.5]", "[0.6, 0.5]", 5, '"position":', None),
    ],
)
def test_a_mistake_in_json_is_told_like_one_in_toml(tmp_path, right, wrong, line, at, write):
    assert JSON.count(right) == 1
    (tmp_path / "scene.json").write_text(JSON.replace(right, wrong))
    problems = told(tmp_path / "scene.json")
    found = []
    for problem in problems:
        _, *rows = problem.split("\n    ")
        for shown, caret in pairwise(rows):
            if shown.startswith(f"line {line}:"):
                found.append((shown[caret.index("^") :].startswith(at), re.sub("^(write|as in): +", "", rows[-1])))
    assert (True, write or rows[-1]) in found, problems


@pytest.mark.parametrize(
    ("wrong", "point", "none"),
    [
        ("until = 1,000", "until = 1.000", "until = 1000"),
        ("time = 12,500", "time = 12.500", "time = 12500"),
        ('until = "1,000"', "until = 1.000", "until = 1000"),
        ("gravity = [1,500, -2]", "gravity = [1.500, -2]", "gravity = [1500, -2]"),
        ("gravity = [1,500, 2,250]", "gravity = [1.500, 2.250]", "gravity = [1500, 2250]"),
        ("gravity = 1,500", "gravity = [0.0, -1.500]", "gravity = [0.0, -1500]"),
    ],
)
def test_a_comma_that_may_part_thousands_is_answered_with_both_numbers(tmp_path, wrong, point, none):
    (tmp_path / "scene.toml").write_text(f"{wrong}\n{OPEN}{ONE}")
    (problem,) = told(tmp_path / "scene.toml")
    assert "if the comma separates thousands" in problem
    rows = [row.split(":", 1) for row in problem.split("\n    ")[1:]]
    assert [row[1].strip() for row in rows if row[0] == "write"] == [point]
    assert [row[1].strip() for row in rows if row[0] == "or"] == [none]


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("until = 1,000,000", "until = 1000000"),
        ("until = 0,125", "until = 0.125"),
        ("until = 1,0000", "until = 1.0000"),
        ("events = 1,000", "events = 1000"),
        ('events = "1,000"', "events = 1000"),
        ("gravity = [1,5, 2]", "gravity = [1.5, 2]"),
        ("gravity = [0,05, 2]", "gravity = [0.05, 2]"),
        ("gravity = [1, 2,5]", "gravity = [1, 2.5]"),
        ("gravity = 1,5, 2", "gravity = [1.5, 2]"),
    ],
)
def test_a_comma_that_means_one_thing_is_answered_with_one_line(tmp_path, wrong, right):
    (tmp_path / "scene.toml").write_text(f"{wrong}\n{OPEN}{ONE}")
    (problem,) = told(tmp_path / "scene.toml")
    assert problem.endswith(f"write:  {right}")


def test_three_numbers_without_a_blank_are_not_taken_for_two(tmp_path):
    (tmp_path / "scene.toml").write_text(f"gravity = [1,2,3]\n{OPEN}{ONE}")
    assert "as in:  gravity = [0.0, -9.81]" in told(tmp_path / "scene.toml")[0]


def test_lists_with_decimal_commas_are_answered_in_json_and_in_settings(tmp_path):
    (tmp_path / "scene.json").write_text(JSON.replace("[0.5, 0.5]", "[0,5, 1]"))
    assert '"position": [0.5, 1]' in told(tmp_path / "scene.json")[0].split("write:")[1]
    (tmp_path / "scene.toml").write_text(OPEN + ONE)
    assert "write: disk.0.position=[1.5, 2]" in told(tmp_path / "scene.toml", "disk.0.position=[1,5, 2]")[0]


def test_points_with_decimal_commas_are_answered(tmp_path):
    (tmp_path / "scene.toml").write_text(OPEN + ONE + '[[wall]]\nkind = "polygon"\npoints = [[0,5, 1], [2, 1], [1, 2]]\n')
    assert "write:  points = [[0.5, 1], [2, 1], [1, 2]]" in told(tmp_path / "scene.toml")[0]


@pytest.mark.parametrize("name", ["disk", "gas", "wall"])
def test_a_table_in_single_brackets_before_others_in_double_ones_is_the_one_that_is_told(tmp_path, name):
    (tmp_path / "scene.toml").write_text(f"{OPEN}[{name}]\nradius = 1\n\n[[{name}]]\nradius = 1\n")
    (problem,) = told(tmp_path / "scene.toml")
    assert "(at line 3)" in problem
    assert problem.endswith(f"write:  [[{name}]]")


SOME = "[[gas]]\ncount = 5\nseed = 1\nregion = [5, 5, 9, 9]\n"
SEGMENT = '[[wall]]\nkind = "segment"\n'

FURTHER = [
    # what is added to a scene, what is said, what is proposed
    (ONE.replace("0.05", "0.05\nfixed = true"), "nothing deflects a disk of mass inf", "mass = inf"),
    (ONE + "mass = infinite\n", "infinity is written inf", "mass = inf"),
    (ONE + 'mass = "infinite"\n', "must be a number", "mass = inf"),
    (ONE + "mass = \u221e\n", "signs of the keyboard", "mass = inf"),
    (ONE + "speed = [2, 0]\n", "the key is velocity", "velocity = [2, 0]"),
    (ONE.replace("0.3", "\u22120.3"), "as its minus -", "position = [-0.3, 0.8]"),
    (ONE.replace("radius =", "radius\u00a0="), "the blank of the keyboard", "radius = 0.05"),
    (ONE.replace("radius", "\u200bradius"), "nothing unseen", "radius = 0.05"),
    (ONE.replace("0.05", "\uff10.05"), "signs of the keyboard", "radius = 0.05"),
    (ONE + "velocity = [2*cos(30), 0]\n", "a file does not compute: write the number itself", None),
    (ONE + "mass = sqrt(2)\n", "a file does not compute", None),
    (ONE + "mass = 3 + 4\n", "a file does not compute", None),
    (ONE + "import math\n", "a scene is no program: leave this line out", None),
    (ONE.replace("[[disk]]", "disk]]"), "the name of a table stands in brackets", "[[disk]]"),
    (ONE.replace("[[disk]]", "[[domain.disk]]"), "[[disk]] is a table of the scene", "[[disk]]"),
    (ONE.replace("position = [0.3, 0.8]", "x = 1, y = 2"), "a line holds one key and one value", "position = [1, 2]"),
    (ONE.replace("[0.3, 0.8]\n", "[0.3, 0.8], "), "one key and one value", "position = [0.3, 0.8] radius = 0.05"),
    (ONE + SOME + "radius = [0.1, 0.2]\n", "radii are drawn by a law", "radius = {uniform = [0.1, 0.2]}"),
    (ONE + SOME + "radius = 0.1\nvelocity = [3.0, 4.0]\n", "one speed, in all directions", "speed = 5"),
    (ONE + SEGMENT + "points = [[4, 4], [5, 5]]\n", "has a start and an end", "start = [4, 4] end = [5, 5]"),
    (ONE + SEGMENT + "points = [[4, 4], [5, 5], [6, 5]]\n", "goes a polyline", 'kind = "polyline"'),
    ("[gravity]\nx = 0\ny = -9.81\n" + ONE, "write it above the first table", "gravity = [0, -9.81] [domain]"),
    (ONE.replace("0.05", "[0.05]"), "must be a number", "radius = 0.05"),
    (ONE.replace("0.05", '"1/20"'), "must be a number", "radius = 0.05"),
    (ONE.replace("0.05", '"5 * 0.01"'), "must be a number", "radius = 0.05"),
    (ONE.replace("[0.3, 0.8]", "0.3, 0.8]"), "what is opened is closed", "position = [0.3, 0.8]"),
    (ONE.replace("[0.3, 0.8]", "(0,3; 0,8)"), "lists stand in square brackets; a number has", "position = [0.3, 0.8]"),
    (ONE + SOME + "radius = {uniform = [0.1, 0.2]\n", "what is opened is closed", "radius = {uniform = [0.1, 0.2]}"),
    (ONE + SOME.replace("5", '"5.0"', 1) + "radius = 0.1\n", "must be a whole number", "count = 5"),
    (ONE + SOME.replace("5", "5,5", 1) + "radius = 0.1\n", "a line holds one key and one value", "count = 20"),
    (ONE.replace("[0.3, 0.8]", "0,3 0,8"), "a line holds one key and one value", "position = [0.3, 0.8]"),
    ("disk = [3]\n" + ONE, "domain.disk: unknown key (known here: kind)", None),
    (ONE + "[[disks_file]]\nfile = 'C:\\data\\x.csv'\n", "the key is path", r'path = "C:\\data\\x.csv"'),
    (ONE + '[[wall]]\nkind = "polygon"\nvertices = [[0, 0], [true, 1]]\n', "key is points", "points = [[0, 0], [true, 1]]"),
    ("", "a scene needs at least one disk", "[[disk]] position = [0.3, 0.8] radius = 0.05"),
]


@pytest.mark.parametrize(("added", "said", "right"), FURTHER)
def test_a_slip_is_one_problem_with_what_is_right(tmp_path, added, said, right):
    (tmp_path / "scene.toml").write_text(OPEN + added, encoding="utf-8")
    problem = told(tmp_path / "scene.toml")[0]
    assert said in problem
    assert "{'" not in problem
    write = [row for row in re.split("write:|as in:", problem)[1:] if row]
    if right is None:
        assert "write:" not in problem
    else:
        assert " ".join(write[0].split()) == right
    assert len(told(tmp_path / "scene.toml")) == 1 or "domain.disk" in problem


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (JSON.replace('"', "'"), "double quotation marks"),
        (JSON.replace('"', "'").replace("2.0,\n", "2.0, // seconds\n"), "quotation marks; JSON has no comments"),
        (JSON.replace("}]\n", "},]\n"), "nothing follows a last comma"),
        (JSON.replace("0.1},", "0.1,},"), "nothing follows a last comma"),
        (JSON.replace("2.0,\n", "2.0, // seconds\n"), "JSON has no comments"),
        (JSON.replace('"until"', "until"), "a key stands in double quotation marks"),
        (JSON.replace("0.1}", ".1}", 1), "a digit before its point"),
        (JSON.replace("0.5, 0.5", "\u22120.5,\u00a00.5"), "other blanks and signs"),
        (JSON.replace('"until": 2.0', '"until": 2.0, "mass": inf'), 'infinity is written "inf"'),
    ],
)
def test_slips_in_json_are_mended_and_what_is_proposed_is_json(tmp_path, wrong, said):
    (tmp_path / "scene.json").write_text(wrong, encoding="utf-8")
    (problem,) = told(tmp_path / "scene.json")
    assert said in problem
    number, right = re.search(r"\(at line (\d+)\)", problem)[1], problem.split("write:")[1].strip()
    lines = wrong.splitlines()
    assert lines[int(number) - 1].strip() != right
    if "quotation" not in said:  # there all lines are wrong
        lines[int(number) - 1] = right
        json.loads("\n".join(lines))


def test_a_comma_that_may_part_thousands_is_answered_with_both_numbers_in_json(tmp_path):
    (tmp_path / "scene.json").write_text(JSON.replace("2.0,\n", "2,500,\n"))
    (problem,) = told(tmp_path / "scene.json")
    assert "2.500, or 2500 if the comma separates thousands (at line 1)" in problem
    assert '{"until": 2.500,' in problem.split("write:")[1]
    assert '{"until": 2500,' in problem.split("or:")[1]
    (tmp_path / "scene.json").write_text(JSON.replace("2.0,\n", "2,5,\n"))
    assert told(tmp_path / "scene.json")[0].endswith('write:  {"until": 2.5,')


def test_a_text_in_json_may_hold_what_elsewhere_is_a_slip(tmp_path):
    text = JSON.replace('"until"', '"name": "it\'s // no # comment, }",\n"until"').replace("0.1}", "0.1,}", 1)
    (tmp_path / "scene.json").write_text(text)
    (problem,) = told(tmp_path / "scene.json")
    assert "nothing follows a last comma" in problem
    assert "comments" not in problem


def test_a_file_of_the_other_format_is_told_its_name(tmp_path):
    (tmp_path / "scene.toml").write_text(JSON)
    assert "this is JSON: let the file's name end in .json" in told(tmp_path / "scene.toml")[0]
    (tmp_path / "scene.json").write_text("# mine\n" + SCENE)
    assert "this is TOML: let the file's name end in .toml" in told(tmp_path / "scene.json")[0]


def test_json_that_no_rule_mends_is_told_without_a_proposal(tmp_path):
    (tmp_path / "scene.json").write_text(JSON.replace('"until"', "until until"))
    (problem,) = told(tmp_path / "scene.json")
    assert "a key in double quotation marks is wanted here (at line 1, column 2)" in problem
    assert "write:" not in problem


def test_line_ends_of_old_macs_are_read(tmp_path):
    (tmp_path / "scene.toml").write_bytes((OPEN + ONE).replace("\n", "\r").encode())
    assert len(load_scene(tmp_path / "scene.toml").disks) == 1


@pytest.mark.parametrize(
    ("text", "count"),
    [
        (OPEN + ONE.replace("position = [0.3, 0.8]", "x = 0.3\ny = 0.8"), 1),
        (OPEN + ONE + "vx = 1\nvy = 2\n", 1),
        (OPEN + ONE.replace("radius = 0.05", "diameter = 0.1"), 1),
        (OPEN.replace('"open"', '"box"\nwidth = 2\nheight = 1') + ONE, 1),
        (OPEN + ONE + SEGMENT + "from = [4, 4]\nto = [5, 5]\n", 2),
        (OPEN + ONE.replace("radius = 0.05", "diameter = 0.1") + ONE.replace("radius = 0.05", "diameter = 0.1"), 2),
    ],
)
def test_one_mistake_is_one_problem(tmp_path, text, count):
    (tmp_path / "scene.toml").write_text(text)
    problems = told(tmp_path / "scene.toml")
    assert len(problems) == count
    keys = re.findall(r"(?m)^(x|y|vx|vy|diameter|width|height|from|to) =", text)
    shown = re.findall(r"line \d+: +(\w+) =", "\n".join(problems))
    assert sorted(shown) == sorted(keys)


def test_a_table_of_disks_may_have_semicolons(tmp_path):
    (tmp_path / "scene.toml").write_text(OPEN + '[[disks_file]]\npath = "disks.csv"\n')
    for between in ";\t":
        (tmp_path / "disks.csv").write_text("x,y,radius,species\n0,0,1,a\n3,3,1,b\n".replace(",", between))
        disks = load_scene(tmp_path / "scene.toml").disks
        assert disks.position.tolist() == [[0, 0], [3, 3]]
        assert list(disks.species) == ["a", "b"]
    (tmp_path / "disks.csv").write_text("x;y;radius\n0,5;0;1\n")
    assert "x = '0,5': must be a number, with a decimal point" in told(tmp_path / "scene.toml")[0]


def test_of_a_speed_and_its_angle_one_line_is_proposed(tmp_path):
    path = tmp_path / "ramp.toml"
    path.write_text(SCENE.replace("velocity = [1.0, 0.0]", "velocity = 3\nangle = 30"), encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        load_scene(path)
    assert str(caught.value).count("write:") == 1
    assert "leave this line out" in str(caught.value)


@pytest.mark.parametrize("arrangement", ["random", "square", "hexagonal", "compressed"])
def test_more_disks_than_any_arrangement_holds_are_told_their_bounds(tmp_path, arrangement):
    path = tmp_path / "dense.toml"
    gas = f'[[gas]]\ncount = 300\nradius = 0.05\nseed = 1\narrangement = "{arrangement}"\n'
    path.write_text(f'[domain]\nkind = "box"\nsize = [2.0, 1.0]\n{gas}', encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        load_scene(path)
    told = str(caught.value)
    on_lattice, words = arrangement in ("square", "hexagonal"), "at most 230 disks of radius 0.05 fit, or 300 of radius 0.04386"
    assert ("no arrangement holds more than 230" if on_lattice else words) in told  # pi / sqrt 12 of the area, no more
    assert "denser" not in told
    assert "use" not in told


def test_the_densest_packing_itself_is_held(tmp_path):
    """A period that just holds the hexagonal lattice."""
    path = tmp_path / "crystal.toml"
    gas = '[[gas]]\ncount = 4\nradius = 0.5\nseed = 1\narrangement = "hexagonal"\n'
    path.write_text(f'[domain]\nkind = "periodic"\nsize = [2.0, {3.0**0.5 + 1e-12!r}]\n{gas}', encoding="utf-8")
    assert len(load_scene(path).disks) == 4


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("disk.1.mass=1", "there is disk.0 alone; this would begin another one, which lacks position and radius"),
        ("disk.4.mass=1", "there is no disk.4: there is disk.0 alone (disk.1 would add one)"),
        ("wall.1.name=x", "there is wall.0 alone; this would begin another one, which lacks kind"),
        ("gas.1.seed=1", "there is gas.0 alone; this would begin another one, which lacks count"),
    ],
)
def test_a_setting_beyond_the_last_table_says_which_there_are(tmp_path, setting, words):
    path = tmp_path / "ramp.toml"
    path.write_text(SCENE, encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        load_scene(path, overrides=[setting])
    assert words in str(caught.value)


def test_a_whole_disk_that_settings_add_and_that_overlaps_is_told_like_any(tmp_path):
    path = tmp_path / "ramp.toml"
    path.write_text(SCENE, encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        load_scene(path, overrides=["disk.1.position=[0.3, 0.8]", "disk.1.radius=0.01"])
    assert "disk[0] and disk[1] overlap" in str(caught.value)
    assert "typed: disk.1.position=[0.3, 0.8]" in str(caught.value)


def test_a_disk_may_be_added_by_settings(tmp_path):
    path = tmp_path / "ramp.toml"
    path.write_text(SCENE, encoding="utf-8")
    added = load_scene(path, overrides=["disk.1.position=[1.5, 0.2]", "disk.1.radius=0.01"])
    assert len(added.disks) == len(load_scene(path).disks) + 1


def test_a_file_in_latin_1_tells_the_line(tmp_path):
    path = tmp_path / "ramp.toml"
    path.write_bytes(("until = 2.0\n# Kugelstoß\n" + SCENE).encode("latin-1"))
    with pytest.raises(SceneError) as caught:
        load_scene(path)
    assert str(caught.value).endswith("save it anew with this encoding (at line 2)\n    line 2: # Kugelstoß")

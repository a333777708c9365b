"""Scene files with mistakes: every problem is told at once, with the key or the disks, the value and the rule."""

import pytest

from eventsim.errors import SceneError
from eventsim.scene.files import load_scene

BOX = '[domain]\nkind = "box"\nsize = [10, 5]\n'
DISK = "[[disk]]\nposition = [2, 2]\nradius = 0.5\n"
ELLIPSE = '[[wall]]\nkind = "ellipse"\ncenter = [5, 2.5]\n'
GAS = "[[gas]]\ncount = 10\nradius = 0.1\nseed = 1\n"

# name: (text of the file, for each expected problem the words that must be in it)
BAD = {
    "unknown key": (
        "untill = 3\n" + BOX + DISK,
        [["untill", "unknown key", 'did you mean "until"']],
    ),
    "a key for what there is not": (
        "friction = 0.2\n" + BOX + DISK,
        [["friction", "unknown key", "tangential_restitution"]],
    ),
    "unknown key of a disk": (
        BOX + DISK + "colour = 3\n",
        [["disk[0].colour", "unknown key", "position, velocity, radius, mass"]],
    ),
    "missing domain": (DISK, [["domain is missing"]]),
    "missing radius": (BOX + "[[disk]]\nposition = [1, 1]\n", [["disk[0].radius is missing"]]),
    "wrong type": (
        BOX + '[[disk]]\nposition = [1, 1]\nradius = "big"\n',
        [["disk[0].radius = 'big'", "must be a number"]],
    ),
    "a position with three numbers": (
        BOX + "[[disk]]\nposition = [1, 1, 1]\nradius = 1\n",
        [["disk[0].position = [1, 1, 1]", "two numbers [x, y]"]],
    ),
    "negative radius": (
        BOX + "[[disk]]\nposition = [1, 1]\nradius = -1\n",
        [["disk[0].radius = -1.0", "at least 0"]],
    ),
    "nan": (
        BOX + "[[disk]]\nposition = [1, nan]\nvelocity = [inf, 0]\nradius = 1\nmass = nan\n",
        [
            ["disk[0].position = [1.0, nan]", "finite"],
            ["disk[0].velocity = [inf, 0.0]", "finite"],
            ["disk[0].mass = nan", "at least 0"],
        ],
    ),
    "overlap": (
        BOX + DISK + "[[disk]]\nposition = [2.5, 2]\nradius = 0.25\n",
        [["disk[0] and disk[1] overlap by 0.25", "touch, not overlap"]],
    ),
    "outside": (
        BOX + "[[disk]]\nposition = [9.75, 2]\nradius = 0.5\n",
        [["disk[0]", "(9.75, 2.0)", "0.25 beyond the right side", "[0.0, 10.0] x [0.0, 5.0]"]],
    ),
    "across a wall": (
        BOX + DISK + '[[wall]]\nkind = "segment"\nstart = [0, 2.25]\nend = [5, 2.25]\nname = "shelf"\n',
        [["disk[0]", "reaches 0.25 across segment shelf"]],
    ),
    "out of the container": (
        '[domain]\nkind = "open"\n' + DISK + '[[wall]]\nkind = "circle"\ncenter = [0, 2]\nradius = 2\n',
        [["disk[0]", "reaches 0.5 out of circle wall0", "inside its container"]],
    ),
    "unknown domain": (
        '[domain]\nkind = "torus"\nsize = [1, 1]\n' + DISK,
        [["domain.kind = 'torus'", '"box", "periodic", "channel", "open"']],
    ),
    "no size": ('[domain]\nkind = "box"\n' + DISK, [["domain.size is missing"]]),
    "a size of zero": (
        '[domain]\nkind = "box"\nsize = [10, 0]\n' + DISK,
        [["domain.size = [10.0, 0.0]", "above 0"]],
    ),
    "open with a size": (
        '[domain]\nkind = "open"\nsize = [1, 1]\n' + DISK,
        [["domain.size", "unknown key"]],
    ),
    "no disks": (BOX, [["at least one disk"]]),
    "missing seed": (
        BOX + "[[gas]]\ncount = 10\nradius = 0.1\n",
        [["gas[0].seed is missing", "chance"]],
    ),
    "gas with two radii and two speeds": (
        BOX + GAS + "packing_fraction = 0.1\ntemperature = 1\nspeed = 1\n",
        [["gas[0]: has both radius and packing_fraction", "give one"], ["gas[0]: has both temperature and speed", "give one"]],
    ),
    "gas too dense for random": (
        BOX + '[[gas]]\ncount = 300\npacking_fraction = 0.65\narrangement = "random"\nseed = 1\n',
        [["gas[0]", "packing fraction 0.65", '"square" or "hexagonal"']],
    ),
    "gas too large for a lattice": (
        BOX + '[[gas]]\ncount = 55\nradius = 0.5\narrangement = "square"\n',
        [["gas[0]", "55 disks of radius 0.5", "do not fit", "room for 50", "hexagonal"]],
    ),
    "gas outside": (
        BOX + GAS + "region = [8, 0, 12, 5]\n",
        [["gas[0].region = [8.0, 0.0, 12.0, 5.0]", "inside the domain"]],
    ),
    "gas of nothing": (
        BOX + "[[gas]]\ncount = 0\nradius = 0.1\nseed = 1\n",
        [["gas[0].count = 0", "at least 1"]],
    ),
    "gas of more than memory holds": (
        BOX + "[[gas]]\ncount = 10_000_000_000\nradius = 0\nseed = 1\n",
        [["gas[0].count = 10000000000", "at most 50000000"]],
    ),
    "hot posts": (BOX + GAS + "mass = inf\ntemperature = 1\n", [["gas[0].temperature", "inf", "use speed"]]),
    "misspelt arrangement": (
        BOX + GAS + 'arrangement = "hexagon"\n',
        [["gas[0].arrangement = 'hexagon'", 'did you mean "hexagonal"']],
    ),
    "gas in the open": ('[domain]\nkind = "open"\n' + GAS, [["gas[0].region is missing", "no size"]]),
    "restitution above one": (
        "restitution = {pair = 1.5, wall = -1}\n" + BOX + DISK,
        [["restitution.pair = 1.5", "from 0 to 1"], ["restitution.wall = -1.0", "from 0 to 1"]],
    ),
    "stop before the start": (
        "until = 1\nstart_time = 2\n" + BOX + DISK,
        [["until = 1.0", "start_time = 2.0"]],
    ),
    "half an event": ("events = 2.5\n" + BOX + DISK, [["events = 2.5", "whole number"]]),
    "walls that are none": (
        BOX
        + DISK
        + '[[wall]]\nkind = "segment"\nstart = [1, 1]\nend = [1, 1]\n'
        + '[[wall]]\nkind = "polygon"\npoints = [[0, 0], [1, 0]]\n'
        + '[[wall]]\nkind = "arc"\nstart = [0, 0]\nthrough = [1, 1]\nend = [2, 2]\n'
        + '[[wall]]\nkind = "circle"\ncenter = [0, 0]\nradius = 0\n',
        [
            ["wall[0]", "same point"],
            ["wall[1].points", "at least 3"],
            ["wall[2]", "not on a line"],
            ["wall[3].radius = 0.0", "above 0"],
        ],
    ),
    "lengths without squares": (
        '[domain]\nkind = "box"\nsize = [1e-160, 1]\n[[disk]]\nposition = [0, 0]\nradius = 1e-160\n'
        + '[[disk]]\nposition = [1e-161, 0.5]\nradius = 0\n'
        + '[[gas]]\ncount = 2\nradius = 1e-151\nseed = 1\n'
        + '[[wall]]\nkind = "segment"\nstart = [0, 0]\nend = [1e-160, 0]\n'
        + '[[wall]]\nkind = "polyline"\npoints = [[0, 0], [1, 0], [1, 1e-155]]\n'
        + '[[wall]]\nkind = "arc"\nstart = [0, 0]\nthrough = [1e-160, 1e-160]\nend = [0, 2e-160]\n'
        + '[[wall]]\nkind = "circle"\ncenter = [0, 0]\nradius = 1e-151\n',
        [
            ["domain.size = [1e-160, 1.0]", "above 0", "1e-150"],
            ["disk[0].radius = 1e-160", "0 is a point", "1e-150"],
            ["gas[0].radius = 1e-151", "0 is a point"],
            ["wall[0]", "length 1e-160", "at least 1e-150"],
            ["wall[1].points[1]", "length 1e-155", "at least 1e-150"],
            ["wall[2]", "do not determine a circle"],
            ["wall[3].radius = 1e-151", "above 0 (at least 1e-150)"],
        ],
    ),
    "wall names": (
        BOX
        + DISK
        + '[[wall]]\nkind = "segment"\nstart = [7, 1]\nend = [7, 2]\nname = "left"\n'
        + '[[wall]]\nkind = "segment"\nstart = [8, 1]\nend = [8, 2]\nname = "wall2"\n'
        + '[[wall]]\nkind = "segment"\nstart = [9, 1]\nend = [9, 2]\n',
        [["wall[0].name = 'left'", "sides of the domain"], ["wall[2]", "'wall2' is taken by wall[1]"]],
    ),
    "a wall without a kind": (
        BOX + DISK + "[[wall]]\nstart = [0, 0]\n",
        [["wall[0].kind is missing", '"segment"']],
    ),
    "single brackets": (
        BOX + "[disk]\nposition = [1, 1]\nradius = 0.5\n",
        [["disk = ", "[[disk]]", "double brackets"]],
    ),
    "outside the period": (
        '[domain]\nkind = "periodic"\nsize = [10, 5]\n[[disk]]\nposition = [10, 2]\nradius = 0.5\n',
        [["disk[0]", "x must be at least 0.0 and below 10.0", "periodic"]],
    ),
    "wider than the period": (
        '[domain]\nkind = "periodic"\nsize = [10, 5]\n[[disk]]\nposition = [1, 2]\nradius = 3\n',
        [["disk[0].radius = 3.0", "at most the period 5.0"]],
    ),
    "overlap with an image": (
        '[domain]\nkind = "periodic"\nsize = [10, 5]\n'
        "[[disk]]\nposition = [0.25, 2]\nradius = 0.5\n[[disk]]\nposition = [9.75, 2]\nradius = 0.5\n",
        [["disk[0] and disk[1] overlap by 0.5"]],
    ),
    "no disks file": (
        BOX + '[[disks_file]]\npath = "gone.csv"\n',
        [["disks_file[0].path", "gone.csv", "no such file"]],
    ),
    "mistakes of many kinds": (
        'colour = "red"\nrestitution = 2\n'
        + BOX
        + DISK
        + "[[disk]]\nposition = [2, 2]\nradius = 0.25\n[[disk]]\nposition = [2, 3]\n"
        + '[[wall]]\nkind = "segment"\nstart = [1, 1]\nend = [1, 1]\n[[wall]]\nkind = "line"\n',
        [
            ["colour", "unknown key"],
            ["restitution = 2.0", "from 0 to 1"],
            ["disk[2].radius is missing"],
            ["disk[0] and disk[1] overlap"],
            ["wall[0]", "same point"],
            ["wall[1].kind = 'line'"],
        ],
    ),
    "several mistakes in one table": (
        '[domain]\nkind = "box"\nsize = 10\norigin = [1e200, 0]\n[restitution]\npair = "x"\nwall = 2\n'
        + '[[disk]]\nposition = [1]\nradius = "x"\nmass = -1\nvelocity = [nan, 0]\n'
        + "[[gas]]\ncount = 0.5\nradius = -1\ntemperature = 1\nspeed = 1\nseed = 0.5\n"
        + '[[wall]]\nkind = "segment"\nstart = 0\nend = [1e200, 0]\n'
        + '[[wall]]\nkind = "circle"\ncenter = "x"\nradius = -1\n',
        [
            ["domain.size = 10", "two numbers"],
            ["domain.origin = [1e+200, 0.0]", "at most"],
            ["restitution.pair = 'x'", "a number"],
            ["restitution.wall = 2.0", "from 0 to 1"],
            ["disk[0].position = [1]", "two numbers"],
            ["disk[0].radius = 'x'", "a number"],
            ["disk[0].mass = -1.0", "at least 0"],
            ["disk[0].velocity = [nan, 0.0]", "finite"],
            ["gas[0].count = 0.5", "whole number"],
            ["gas[0].seed = 0.5", "whole number"],
            ["gas[0].radius = -1.0", "at least 0"],
            ["gas[0]: has both temperature and speed", "one of them"],
            ["wall[0].start = 0", "two numbers"],
            ["wall[0].end = [1e+200, 0.0]", "at most"],
            ["wall[1].center = 'x'", "two numbers"],
            ["wall[1].radius = -1.0", "above 0"],
        ],
    ),
    "a gas and a disk that are no tables": (
        "gas = [3]\ndisk = [3]\n" + BOX,
        [["gas[0] = 3", "must be a table"], ["disk[0] = 3", "must be a table"]],
    ),
    "a name of two lines": ('name = "a\\nb"\n' + BOX + DISK, [["name = 'a\\nb'", "one line without control characters"]]),
    "rougher than rough": (
        "tangential_restitution = 2\n" + BOX + DISK,
        [["tangential_restitution = 2.0", "from -1 (smooth) to 1 (perfectly rough)"]],
    ),
    "both rougher than rough": (
        "tangential_restitution = {pair = 2, wall = -2}\n" + BOX + DISK,
        [["tangential_restitution.pair = 2.0", "from -1"], ["tangential_restitution.wall = -2.0", "from -1"]],
    ),
    "spins without roughness": (
        BOX + "".join(f"[[disk]]\nposition = [{k}, 2]\nradius = 0.25\nspin = 1\n" for k in range(1, 6)),
        [*([f"disk[{k}].spin = 1.0", "say tangential_restitution = 0.5"] for k in range(3)), ["and 2 more disks", "(spin)"]],
    ),
    "disks that cannot turn": (
        "tangential_restitution = 0.5\n"
        + BOX
        + DISK
        + "spin = 1e-80\nmoment = 2\n[[disk]]\nposition = [4, 4]\nradius = 0\n"
        + "[[disk]]\nposition = [6, 4]\nradius = 0.25\nmass = 0\n",
        [
            ["disk[0].spin = 1e-80", "must be 0, or 1e-75 to 1e+75"],
            ["disk[0].moment = 2.0", "at most 1"],
            ["disk[1].radius = 0.0", "a point has no surface", "leave out tangential_restitution"],
            ["disk[2].mass = 0.0", "a tracer has no moment"],
        ],
    ),
    "shares of species that there are not": (
        'restitution = {pairs = {"a-b" = 0.5, "a-c" = 2}}\n' + BOX + DISK + 'species = "a"\n',
        [
            ["restitution.pairs.a-c = 2.0", "from 0 to 1"],
            ["restitution.pairs.a-b", "no disk is of the species b (there are a)"],
            ["restitution.pairs.a-c", "no disk is of the species c"],
        ],
    ),
    "shares of pairs that are none": (
        'restitution = {pairs = {"a" = 0.5, "a-b" = 0.5, "b-a" = 0.2}}\n' + BOX + DISK,
        [["restitution.pairs.a:", 'as in "a-b"'], ["restitution.pairs.b-a", "have a share already"]],
    ),
    "shares that are no table": ("restitution = {pairs = 3}\n" + BOX + DISK, [["restitution.pairs = 3", "a table of numbers"]]),
    "a speed below 0 at which disks yield": (
        "restitution = {yield_speed = -1}\n" + BOX + DISK,
        [["restitution.yield_speed = -1.0", "a finite speed above 0"]],
    ),
    "points that fall in an ellipse": (
        "gravity = [0, -1]\n" + BOX + "[[disk]]\nposition = [5, 2]\nradius = 0\n" + ELLIPSE + "semi_axes = [2, 1]\n",
        [["wall[0]: gravity = [0.0, -1.0]", "cannot meet this ellipse; leave gravity out"]],
    ),
    "a disk in an ellipse": (
        BOX + DISK.replace("2, 2", "5, 2.5") + ELLIPSE + "semi_axes = [2, 1]\n",
        [["wall[0]: disk[0] has radius 0.5", "only points (radius 0) meet this ellipse"]],
    ),
    "an ellipse that is none": (
        BOX
        + "[[disk]]\nposition = [2, 2]\nradius = 0\n"
        + ELLIPSE
        + "semi_axes = [0, 1]\ndirection = [0, 0]\n"
        + ELLIPSE
        + "semi_axes = [1e-9, 1]\n",
        [
            ["wall[0].semi_axes = [0.0, 1.0]", "two lengths above 0"],
            ["wall[0].direction = [0.0, 0.0]", "such as [1, 0]"],
            ["wall[1].semi_axes = [1e-09, 1.0]", "at least 1e-06 of the larger"],
        ],
    ),
    "a name that a line of the log cannot hold": (
        BOX + DISK + '[[wall]]\nkind = "segment"\nstart = [7, 1]\nend = [7, 2]\nname = "a,b"\n',
        [["wall[0].name = 'a,b'", "nor hold a comma"]],
    ),
    "points of a polygon that are the same": (
        BOX + DISK + '[[wall]]\nkind = "polygon"\npoints = [[5, 1], [6, 1], [6, 1], [6, 2], [5, 1]]\n',
        [
            ["wall[0].points[1] and the next point are the same, (6.0, 1.0)"],
            ["wall[0].points[4]", "(a polygon closes by itself)"],
        ],
    ),
    "an arc that is flat but for the last digits": (
        BOX + DISK + '[[wall]]\nkind = "arc"\nstart = [5, 1]\nthrough = [6, 1.0000000000000002]\nend = [7, 1]\n',
        [["wall[0]", "on a line, but for the last digits", "use a segment"]],
    ),
    "points that are no list": (
        BOX + DISK + '[[wall]]\nkind = "polygon"\npoints = 3\n[[wall]]\nkind = "polyline"\npoints = [3]\n',
        [["wall[0].points = 3", "a list of points [x, y]"], ["wall[1].points = [3]", "a list of points [x, y]"]],
    ),
    "a gas that cannot be": (
        BOX + "[[gas]]\ncount = 3\nseed = 1\nmass = -1\npacking_fraction = 2\ntemperature = -1\nregion = [3, 3, 1, 1]\n",
        [
            ["gas[0].packing_fraction = 2.0", "at most 0.9068997"],
            ["gas[0].mass = -1.0", "at least 0"],
            ["gas[0].temperature = -1.0", "finite and at least 0"],
            ["gas[0].region = [3.0, 3.0, 1.0, 1.0]", "x0 < x1 and y0 < y1"],
        ],
    ),
    "radii that are no list": (
        BOX + "[[gas]]\ncount = 3\nseed = 1\nradius = {values = 0.1}\n",
        [["gas[0].radius = {values = 0.1}", "a list of radii"]],
    ),
    "gases of more than memory holds together": (
        BOX + "[[gas]]\ncount = 30_000_000\nseed = 1\nradius = 0\nmass = 0\n" * 2,
        [["gas: 60000000 disks in all", "at most 50000000"]],
    ),
    "points that are to grow": (
        BOX + '[[gas]]\ncount = 30\nseed = 1\nradius = 0\narrangement = "compressed"\n',
        [['gas[0].arrangement = "compressed"', "a radius of 0 cannot grow", 'use "random"']],
    ),
    "a disk where others are to grow": (
        BOX + '[[gas]]\ncount = 12\nseed = 1\nradius = 0.5\narrangement = "compressed"\n' + DISK,
        [['gas[0].arrangement = "compressed"', "must be free of walls and of other disks"]],
    ),
    "disks wider than their region": (
        BOX + '[[gas]]\ncount = 2\nradius = 3\narrangement = "hexagonal"\n',
        [["gas[0]: a disk of radius 3 is wider than the region [0, 10] x [0, 5]"]],
    ),
    "too heavy a fall": (
        'gravity = [0, -1e100]\n[domain]\nkind = "box"\nsize = [1e90, 1e90]\n' + DISK,
        [["gravity: 1e+100 times the largest length, 1e+90", "at most 1e+150"]],
    ),
    "sides that are none": (
        BOX + "walls = {middle = {shaking = 1}, bottom = {mass = 2}}\n" + DISK,
        [["domain.walls.middle", "has the walls left, right, bottom, top"], ["domain.walls.bottom.mass", "unknown key"]],
    ),
    "a side that is no table": (BOX + "walls = {bottom = 2}\n" + DISK, [["domain.walls = {bottom = 2}", "tables of sides"]]),
    "sides of a period": (
        BOX.replace("box", "periodic") + "walls = {bottom = {restitution = 2}}\n" + DISK,
        [["domain.walls.bottom", "has no walls"]],
    ),
    "a side that gives back more": (
        BOX + "walls = {bottom = {restitution = 2}}\n" + DISK,
        [["domain.walls.bottom.restitution = 2.0", "from 0 to 1"]],
    ),
    "a species with a hyphen": (
        BOX + DISK + 'species = "a-b"\n',
        [["disk[0].species = 'a-b'", "without control characters and hyphens"]],
    ),
    "a file of disks whose path is a number": (
        BOX + DISK + "[[disks_file]]\npath = 3\n",
        [["disks_file[0].path = 3", "a text in quotation marks"]],
    ),
    "not TOML": ("until = \n", [["not valid TOML", "line 1"]]),
}


@pytest.mark.parametrize(("text", "expected"), BAD.values(), ids=BAD.keys())
def test_every_problem_of_a_bad_file_is_told_at_once(tmp_path, text, expected):
    file = tmp_path / "bad.toml"
    file.write_text(text)
    with pytest.raises(SceneError) as caught:
        load_scene(file)
    problems = list(caught.value.problems)
    assert len(problems) == len(expected), problems
    assert all(problem.startswith(f"{file}: ") for problem in problems)
    assert str(caught.value) == "\n".join(problems)
    for words in expected:
        fitting = [problem for problem in problems if all(word in problem for word in words)]
        assert fitting, f"no problem with {words} in {problems}"
        problems.remove(fitting[0])


def test_many_overlaps_are_counted_not_listed(tmp_path):
    file = tmp_path / "bad.toml"
    file.write_text(BOX + DISK * 20)
    with pytest.raises(SceneError) as caught:
        load_scene(file)
    assert len(caught.value.problems) == 4
    assert "and 187 more pairs of disks that overlap" in caught.value.problems[-1]


def test_a_single_problem_more_is_written_out(tmp_path):
    file = tmp_path / "bad.toml"
    outside = "".join(f"[[disk]]\nposition = [-3.0, 0.{k}]\nradius = 0.01\n" for k in range(1, 5))
    file.write_text(BOX + outside)
    with pytest.raises(SceneError) as caught:
        load_scene(file)
    assert len(caught.value.problems) == 4
    assert "disk[3]" in caught.value.problems[-1]


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("gone.toml", None, "no such file"),
        ("bad.json", '{"until": 3,\n"domain": }', "not valid JSON: a value is wanted here"),
        ("list.json", "[1, 2]", "JSON object"),
        ("nan.json", '{"domain": {"kind": "open"}, "disk": [{"position": [NaN, 0], "radius": 1}]}', "finite"),
    ],
)
def test_a_file_that_cannot_be_read_is_told_in_a_sentence(tmp_path, name, text, words):
    if text is not None:
        (tmp_path / name).write_text(text)
    with pytest.raises(SceneError, match=name) as caught:
        load_scene(tmp_path / name)
    assert len(caught.value.problems) == 1
    assert words in caught.value.problems[0]

"""Gases: disks placed by rule keep clear of each other, of walls and of what is there."""

import math

import numpy as np
import pytest

from eventsim.errors import SceneError
from eventsim.scene import Box, Channel, Circle, Disks, Open, Periodic, Polygon, Scene, Segment
from eventsim.scene.files import scene_from_dict
from eventsim.scene.fill import place_gas
from eventsim.scene.gas import Gas

NOBODY = Disks(np.empty((0, 2)), radius=0.0)
CLOSE = math.pi / math.sqrt(12)


def place(gas, domain, walls=(), present=NOBODY, seed=1):
    """The scene of a gas and the disks that are there; that it exists says that nothing overlaps."""
    placed = place_gas(gas, domain, walls, present, np.random.default_rng(seed))
    assert len(placed) == gas.count
    return Scene(
        Disks(
            np.concatenate([present.position, placed.position]),
            np.concatenate([present.velocity, placed.velocity]),
            np.concatenate([present.radius, placed.radius]),
            np.concatenate([present.mass, placed.mass]),
        ),
        domain,
        walls,
    )


@pytest.mark.parametrize("domain", [Box((2, 1), (5, -3)), Channel((2, 1), (5, -3)), Periodic((2, 1), (5, -3))])
@pytest.mark.parametrize(
    ("arrangement", "packing_fraction"),
    [("random", 0.3), ("random", 0.5), ("square", 0.7), ("hexagonal", 0.8)],
)
def test_a_gas_fills_its_domain_without_overlap(domain, arrangement, packing_fraction):
    disks = place(Gas(200, packing_fraction=packing_fraction, arrangement=arrangement), domain).disks
    assert 200 * math.pi * disks.radius[0] ** 2 == pytest.approx(2 * packing_fraction)
    # It fills the domain: each quarter of the length has about a quarter of the disks.
    share = np.histogram(disks.position[:, 0], bins=4, range=(5, 7))[0] / 200
    assert np.abs(share - 0.25).max() < 0.1


@pytest.mark.parametrize("rows", [2, 16, 100])
def test_a_hexagonal_lattice_reaches_close_packing_in_a_periodic_domain(rows):
    domain = Periodic((1.0, math.sqrt(3) / 2))
    scene = place(Gas(rows * rows, packing_fraction=CLOSE, arrangement="hexagonal"), domain)
    assert 2 * scene.disks.radius[0] == pytest.approx(1 / rows, rel=1e-15)


def test_a_square_lattice_reaches_touching_in_a_box():
    scene = place(Gas(100, radius=0.05, arrangement="square"), Box((1, 1)))
    assert scene.disks.position.min() == pytest.approx(0.05, rel=1e-15)


def test_a_row_of_disks_fits_between_walls_as_wide_as_a_disk():
    place(Gas(10, radius=0.5, arrangement="hexagonal"), Box((10, 1)))


@pytest.mark.parametrize("arrangement", ["random", "square", "hexagonal"])
def test_a_gas_keeps_clear_of_walls_and_of_disks_that_are_there(arrangement):
    present = Disks([[2, 2], [7, 7]], radius=[1.5, 0.01], mass=[math.inf, 1])
    walls = [Polygon([(5, 1), (9, 1), (7, 4)]), Segment((0, 5), (10, 5.5)), Circle((5, 5), 7)]
    place(Gas(80, radius=0.25, arrangement=arrangement), Box((10, 10)), walls, present)


@pytest.mark.parametrize("arrangement", ["random", "square", "hexagonal"])
def test_whole_disks_are_inside_a_region(arrangement):
    gas = Gas(30, radius=0.1, arrangement=arrangement, region=(1, 1, 3, 2))
    position = place(gas, Periodic((4, 4))).disks.position
    assert (position >= 1.1 - 1e-15).all()
    assert (position <= [2.9 + 1e-15, 1.9 + 1e-15]).all()


def test_a_gas_fills_a_container_in_the_open():
    place(Gas(100, radius=0.1, region=(-2, -2, 2, 2)), Open(), [Circle((0, 0), 2)])


@pytest.mark.parametrize("arrangement", ["random", "square", "hexagonal"])
def test_a_gas_that_is_walled_off_is_refused(arrangement):
    gas = Gas(10, radius=0.0, arrangement=arrangement, region=(5, 5, 6, 6))
    with pytest.raises(SceneError, match="do not fit"):
        place(gas, Open(), [Circle((0, 0), 1)])


def test_a_random_gas_is_what_dropping_one_disk_after_the_other_gives():
    gas = Gas(60, radius=0.05)
    domain = Box((1, 1))
    rng = np.random.default_rng(3)
    slow: list[list[float]] = []
    while len(slow) < gas.count:
        drop = 0.05 + 0.9 * rng.random(2)
        if all(math.dist(drop, other) >= 0.1 for other in slow):
            slow.append(drop.tolist())
    assert place(gas, domain, seed=3).disks.position == pytest.approx(np.array(slow), abs=1e-15)


def test_tracers_may_lie_on_each_other_but_not_on_massive_disks():
    present = Disks([[5, 5]], radius=1.0)
    disks = place(Gas(500, radius=0.5, mass=0.0, speed=1.0), Box((10, 10)), (), present).disks
    assert np.hypot(*(disks.position[1:] - 5).T).min() >= 1.5


def test_a_thermal_gas_has_its_temperature_and_no_momentum():
    velocity = place(Gas(1000, radius=0.0, mass=3.0, temperature=2.0), Box((1, 1))).disks.velocity
    # Rounding of a mean of 1000 numbers: about sqrt(1000) * 2^-53, here with room.
    assert 3.0 * (velocity**2).sum() / 2000 == pytest.approx(2.0, rel=1e-14)
    assert np.abs(velocity.mean(axis=0)).max() < 1e-15
    # Maxwell: <v^4> = 2 <v^2>^2 in the plane, with a standard error of about 4 / sqrt(1000) of <v^2>^2.
    square = (velocity**2).sum(axis=1)
    assert (square**2).mean() / square.mean() ** 2 == pytest.approx(2.0, abs=4 * 4 / math.sqrt(1000))


def test_velocities_do_not_depend_on_where_the_disks_are():
    first = place(Gas(50, radius=0.01, temperature=1.0), Box((1, 1))).disks.velocity
    second = place(Gas(50, radius=0.02, temperature=1.0, arrangement="square"), Box((3, 1))).disks.velocity
    assert np.array_equal(first, second)


def test_a_mixture_is_placed_table_after_table():
    tables = {
        "domain": {"kind": "periodic", "size": [20, 20]},
        "gas": [
            {"count": 20, "radius": 1.0, "seed": 1},
            {"count": 200, "radius": 0.3, "seed": 2, "temperature": 1.0},
        ],
    }
    assert scene_from_dict(tables).disks.radius.tolist() == [1.0] * 20 + [0.3] * 200


@pytest.mark.parametrize("arrangement", ["random", "hexagonal"])
def test_twenty_thousand_disks_are_placed_and_validated(arrangement):
    place(Gas(20_000, packing_fraction=0.3, arrangement=arrangement, temperature=1.0), Periodic((1, 1)))


def spread(sizes, arrangement="random", domain="box", count=300, **keys):
    table = {"count": count, "radius": sizes, "seed": 3, "arrangement": arrangement, **keys}
    table = {key: value for key, value in table.items() if value is not None}
    return scene_from_dict({"domain": {"kind": domain, "size": [2.0, 1.0]}, "gas": [table]}).disks


@pytest.mark.parametrize("domain", ["box", "periodic"])
def test_radii_follow_their_law(domain):
    uniform = spread({"uniform": [0.01, 0.02]}, domain=domain).radius
    assert (uniform.min() >= 0.01, uniform.max() <= 0.02) == (True, True)
    # 300 numbers: the mean has a standard error of 1 / sqrt(12 * 300) = .017 of the width; four of them
    assert uniform.mean() == pytest.approx(0.015, abs=4 * 0.017 * 0.01)
    lognormal = np.log(spread({"lognormal": [0.01, 0.3]}, domain=domain).radius / 0.01)
    assert abs(lognormal.mean()) < 4 * 0.3 / math.sqrt(300)
    assert lognormal.std() == pytest.approx(0.3, abs=4 * 0.3 / math.sqrt(600))
    values = spread({"values": [0.02, 0.01], "weights": [1, 3]}, domain=domain).radius
    assert set(values.tolist()) == {0.01, 0.02}
    assert (values == 0.02).mean() == pytest.approx(0.25, abs=4 * math.sqrt(0.25 * 0.75 / 300))
    # not sorted: that the largest are placed first does not show
    assert not np.all(np.diff(uniform) <= 0.0)


@pytest.mark.parametrize(("domain", "share"), [({"kind": "open"}, 0.5), ({"kind": "periodic", "size": [3.0, 12**0.5]}, 0.8)])
def test_equal_disks_grow_from_random_places_or_beyond_disorder_from_their_lattice(domain, share):
    region = [0, 0, 3, 12**0.5]
    gas = {"count": 12, "packing_fraction": share, "arrangement": "compressed", "region": region, "seed": 1}
    disks = scene_from_dict({"domain": domain, "gas": [gas]}).disks
    assert math.pi * (disks.radius**2).sum() == pytest.approx(share * 3 * 12**0.5)


def test_disks_of_a_law_too_dense_to_be_dropped_are_refused():
    with pytest.raises(SceneError, match=r"gas\[0\].*packing fraction 0\.[78]"):
        spread({"uniform": [0.1, 0.11]}, count=48)


def test_so_many_disks_too_dense_to_be_dropped_are_refused_at_once():
    with pytest.raises(SceneError, match=r"packing fraction 0\.6"):
        spread(None, count=2000, packing_fraction=0.6)


def test_more_disks_than_python_compresses_ask_for_the_compiler(monkeypatch):
    monkeypatch.setattr("eventsim.scene.compressed.has_compiler", lambda: False)
    with pytest.raises(SceneError, match=r"301 disks need the compiler \(plain Python does up to 300\): pip install"):
        spread(0.01, "compressed", count=301)


def test_a_single_disk_of_a_thermal_gas_moves():
    gas = {"count": 1, "radius": 0.1, "temperature": 1.0, "seed": 1}
    assert scene_from_dict({"domain": {"kind": "box", "size": [1.0, 1.0]}, "gas": [gas]}).disks.velocity.any()


def test_sizes_come_dense_too():
    disks = spread({"uniform": [0.03, 0.05]}, "compressed", "periodic", count=240)
    share = math.pi * (disks.radius**2).sum() / 2.0
    assert share > 0.55  # denser than random insertion comes


@pytest.mark.parametrize(
    ("wall", "area", "inside"),
    [
        ({"kind": "circle", "center": [1.0, 0.5], "radius": 0.5}, math.pi / 4, lambda x, y: np.hypot(x - 1, y - 0.5) < 0.5),
        ({"kind": "polygon", "points": [[0, 0], [2, 0], [1, 1]]}, 1.0, lambda x, y: (y < x) & (y < 2 - x)),
        (
            {"kind": "ellipse", "center": [1.0, 0.5], "semi_axes": [0.5, 0.25], "direction": [0.0, 1.0]},
            math.pi / 8,
            lambda x, y: ((x - 1) / 0.25) ** 2 + ((y - 0.5) / 0.5) ** 2 < 1,
        ),
    ],
)
@pytest.mark.parametrize("kind", ["open", "box"])
def test_points_lie_inside_a_closed_wall_evenly(kind, wall, area, inside):
    domain = {"kind": "open"} if kind == "open" else {"kind": "box", "size": [2.0, 1.0]}
    gas = {"count": 2000, "radius": 0.0, "mass": 0, "speed": 1.0, "inside": "table", "seed": 1}
    x, y = scene_from_dict({"domain": domain, "wall": [{**wall, "name": "table"}], "gas": [gas]}).disks.position.T
    assert inside(x, y).all()
    lower = np.random.default_rng(2).random((200_000, 2)) * [2.0, 1.0]
    expected = (inside(*lower.T) & (lower[:, 1] < 0.4)).sum() / inside(*lower.T).sum()
    assert (y < 0.4).mean() == pytest.approx(expected, abs=4 * math.sqrt(0.25 / 2000) + 0.01)


def test_disks_inside_a_wall_are_clear_of_it():
    wall = {"kind": "polygon", "points": [[0, 0], [2, 0], [2, 1], [1, 0.2], [0, 1]]}
    gas = {"count": 30, "radius": 0.03, "inside": "wall0", "seed": 1}
    assert len(scene_from_dict({"domain": {"kind": "open"}, "wall": [wall], "gas": [gas]}).disks) == 30


@pytest.mark.parametrize(
    ("gas", "said"),
    [
        ({"radius": {"uniform": [0.2, 0.1]}}, "gas[0].radius.uniform = [0.2, 0.1]: must be lengths [least, largest]"),
        ({"radius": {"lognormal": [0.1, -1.0]}}, "gas[0].radius.lognormal"),
        ({"radius": {"values": [0.1], "weights": [1, 2]}}, "weights = [1.0, 2.0]: must be one for each of the 1 values"),
        ({"radius": {"values": []}}, "at least one"),
        ({"radius": {"normal": [0.1, 0.1]}}, "must be a number, or one of {uniform"),
        ({"radius": {"uniform": [0.1, 0.1], "weights": [1]}}, "must be a number, or one of"),
        ({"radius": {"uniform": [0.01, 0.02]}, "arrangement": "square"}, "lie on no lattice"),
        ({"radius": 0.01, "inside": "left"}, 'must be the name of a wall (line)'),
        ({"radius": 0.01, "inside": "line"}, "must be a closed wall, and it is a segment"),
        ({"radius": 0.01, "inside": "line", "region": [0, 0, 1, 1]}, "has both inside and region"),
        ({"radius": 0.01, "inside": "line", "arrangement": "compressed"}, "fills rectangles alone"),
        ({"radius": {"uniform": [0.1, 0.2]}, "count": 40}, "no arrangement more than 1"),
    ],
)
def test_a_rule_that_cannot_be_kept_is_told(gas, said):
    wall = {"kind": "segment", "start": [0.1, 0.1], "end": [0.2, 0.1], "name": "line"}
    tables = {"domain": {"kind": "box", "size": [2.0, 1.0]}, "wall": [wall], "gas": [{"count": 3, "seed": 1, **gas}]}
    with pytest.raises(SceneError) as raised:
        scene_from_dict(tables)
    assert said in str(raised.value)

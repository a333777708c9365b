"""Contacts at exactly one time, which share a disk, are seen as such wherever they fall on the clock."""

import math
from fractions import Fraction

import pytest
from mpmath import mp, mpf

import eventsim as es
from tests.engines.exact_ties import falls_beside, falls_on_two, is_cluster, two_partners, two_walls

ENGINES = ["reference", "fast"]
FEW, MANY = range(40), range(1500)


def missed(make, seeds, engine):
    """The seeds whose tie an engine does not see."""
    found = []
    for seed in seeds:
        run = es.simulate(make(seed), events=3, engine=engine, log=True)
        if not is_cluster(run):
            found.append(seed)
    return found


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("make", [two_partners, two_walls, falls_beside, falls_on_two])
@pytest.mark.parametrize("seeds", [FEW, pytest.param(MANY, marks=pytest.mark.slow)])
def test_an_exact_tie_is_seen_wherever_it_falls_on_the_clock(make, seeds, engine):
    if engine == "fast":
        pytest.importorskip("numba")
    assert missed(make, seeds, engine) == []


@pytest.mark.parametrize("engine", ENGINES)
def test_a_symmetric_disk_between_two_walls_goes_straight_back(engine):
    """Mirror symmetric in the plane x = 3: the walls are met at one time, near the beginning of the clock."""
    walls = [es.Segment((0.0, 0.7), (3.0, 0.0)), es.Segment((3.0, 0.0), (6.0, 0.7))]
    disks = es.Disks([(3.0, 0.5636958593624257)], [(0.0, -1.0)], 0.5)
    run = es.simulate(es.Scene(disks, es.Box((6.0, 8.0)), walls), until=1.0, engine=engine)
    assert run.state.velocity.tolist() == [[0.0, 1.0]]


@pytest.mark.parametrize("engine", ENGINES)
def test_a_disk_that_meets_two_others_at_once_gives_to_both(engine):
    """Moreau's law in rationals: v0 = (5247, 1056) / 15811."""
    places = [(0.0, 0.0), (0.8865209077803513, 1.5), (1.0115209077803513, -1.0)]
    disks = es.Disks(places, [(1.0, 0.0), (0.0, 0.0), (0.0, 0.0)], [0.5, 1.125, 0.75])
    run = es.simulate(es.Scene(disks, es.Open()), events=2, engine=engine)
    expected = [(5247 / 15811, 1056 / 15811), (0.22073240, 0.52975776), (0.44741003, -0.59654671)]
    for velocity, true in zip(run.state.velocity.tolist(), expected, strict=True):
        assert velocity == pytest.approx(true, abs=1e-8)  # as many digits as are given


@pytest.mark.parametrize("engine", ENGINES)
def test_which_wall_of_a_corner_a_disk_meets_first_is_exact(engine):
    """It flies along the bisector but for the last bits, which are told by the exact normals, of 60 digits here."""
    mp.dps = 60
    for k in range(60):
        turn, half = 0.3 + 0.11 * k, 0.4 + 0.01 * k
        ends = [(5.0 * math.cos(turn + s * half), 5.0 * math.sin(turn + s * half)) for s in (-1, 1)]
        x, y = 3.0 * math.cos(turn), 3.0 * math.sin(turn)
        wall = es.Polyline((ends[0], (0.0, 0.0), ends[1]), name="corner")
        scene = es.Scene(es.Disks([(x, y)], [(-0.5 * x, -0.5 * y)], 0.1), es.Open(), [wall], until=6.0)
        run = es.simulate(scene, events=1, engine=engine, log=True)
        gaps = [abs(mpf(ex) * mpf(y) - mpf(ey) * mpf(x)) / mp.hypot(mpf(ex), mpf(ey)) for ex, ey in ends]
        times = [(gap - mpf(0.1)) / (gap / 2) for gap in gaps]
        first = f"corner.{int(times[1] < times[0])}"
        assert run.log.wall_name[0] == first or times[0] == times[1]


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(
    ("places", "velocities", "radius"),
    [
        pytest.param(
            [(63.25, 1.15625), (0.03125, 5.5625), (58.21875, 0.375)],
            [(-0.1875, 0.1484375), (0.1171875, -0.015625), (0.1328125, -0.15625)],
            2.125,
            id="behind it",
        ),
        pytest.param(
            [(63.78515625, 0.302734375), (0.01953125, 0.541015625), (0.013671875, 0.03125)],
            [(-0.21875, -0.84375), (-0.96875, -0.65625), (-0.875, -0.5)],
            0.15625,
            id="where it is passed",
        ),
        pytest.param(
            [(1.28125, 1.2578125), (2.1875, 2.9140625), (62.71875, 63.7265625)],
            [(0.21875, 0.03125), (-0.0625, -0.125), (1.28125, 0.9375)],
            0.8125,
            id="where another disk passes it",
        ),
    ],
)
def test_a_tie_is_seen_although_a_disk_passes_a_periodic_border_before(places, velocities, radius, engine):
    """Places of the starting floats, not of the flight behind the border, which begins at a rounded time."""
    scene = es.Scene(es.Disks(places, velocities, radius), es.Periodic((64.0, 64.0)))
    assert is_cluster(es.simulate(scene, events=2, engine=engine, log=True))


@pytest.mark.parametrize("engine", ENGINES)
def test_the_turn_of_the_clock_does_not_decide_which_wall_comes_first(engine):
    """Aimed at the joint of `top` and a segment; `top` comes 8e-18 earlier, the turn of the clock rounds places by 1e-16."""
    disk = es.Disks([(1.4190531704169334, 2.6698699743267973)], [(-0.48237677404447593, 0.8759638393577921)], 1e-18)
    walls = [es.Segment((0.0, 2.667109388752594), (1.2372567883696897, 3.0))]
    run = es.simulate(es.Scene(disk, es.Box((4.0, 3.0)), walls), events=1, engine=engine, log=True)
    assert run.log.wall_name[0] == "top"


@pytest.mark.parametrize("engine", ENGINES)
def test_a_kick_ends_what_the_starting_floats_say(engine):
    """Without a kick disk 0 meets both others at once; it is stopped and sent on its way again, too late for one of them."""
    places, velocities = [(8.0, 8.0), (11.0, 9.0), (11.0, 7.0)], [(1.0, 0.0), (0.0, 0.0), (0.0, 0.0)]
    scene = es.Scene(es.Disks(places, velocities, 0.75), es.Periodic((64.0, 64.0)))
    assert is_cluster(es.simulate(scene, events=2, engine=engine, log=True))
    sim = es.Simulation(scene, engine=engine)
    sim.advance_to(0.5)
    sim.set_velocity(1, (0.0, 1e-13))
    sim.set_velocity(0, (1.0, 0.0))
    sim.advance_to(3.0)
    assert sim.log.joint.tolist()[2:4] == [-1, -1]


@pytest.mark.parametrize("engine", ENGINES)
def test_a_tie_is_seen_where_all_fly_a_thousand_times_faster_than_they_close(engine):
    """Mirror images fly beside each other; a spectator between two walls turns the clock, which rounds their places."""
    places = [(0.0, 0.0), (1.0356054597480155, 0.7819657483600345), (1.0356054597480155, -0.7819657483600345), (50.0, 50.0)]
    velocities = [(0.206142029595752, 512.0), (0.0, 512.0), (0.0, 512.0), (0.0, 500.0)]
    walls = [es.Segment((48.0, y), (52.0, y)) for y in (47.0, 53.0)]
    disks = es.Disks(places, velocities, [0.5, 0.5, 0.5, 0.25])
    run = es.simulate(es.Scene(disks, es.Open(), walls, restitution=0.5), until=2.5, engine=engine, log=True)
    assert run.counters.clusters == 1
    assert run.state.velocity[0, 1] == 512.0


def beside_a_border(drift, extra):
    """Disk 0 meets disk 1, and disk 2 nearly along it, at 7.63671875, behind wraps; all drift.

    extra: the speed at which the gap of the latter closes, over .6; 0: they only touch.
    """
    time = Fraction("7.63671875")
    ends = [(Fraction("64.5"), Fraction(32)), (Fraction("64.6875"), Fraction("32.25")), (Fraction("64.25"), Fraction("31.8125"))]
    speeds = [("0.07421875", 0), ("0.12109375", Fraction("-0.0546875")), ("-0.0078125", Fraction("0.109375") + extra)]
    velocities = [(Fraction(u) + drift, Fraction(w)) for u, w in speeds]
    places = [((x - u * time) % 64, y - w * time) for (x, y), (u, w) in zip(ends, velocities, strict=True)]
    assert all(Fraction(float(number)) == number for place in places for number in place)
    numbers = ([tuple(map(float, pair)) for pair in pairs] for pairs in (places, velocities))
    disks = es.Disks(*numbers, 0.15625, [1.0, 2.0, 1.0])
    return es.Scene(disks, es.Channel((64.0, 64.0)), restitution=0.5, until=11.0)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_graze_takes_no_part_in_a_tie_but_comes_after_it(engine):
    """Rounding behind a border makes a contact of the graze, 9e-9 too early; decimals tell the velocities."""
    log = es.simulate(beside_a_border(Fraction(0), Fraction(0)), engine=engine, log=True).log
    assert list(zip(log.a.tolist(), log.b.tolist(), log.joint.tolist(), strict=True)) == [(0, 1, -1), (0, 2, -1), (0, 1, -1)]
    assert log.time == pytest.approx(7.63671875, abs=1e-11)
    assert log.rows["vxa"] == pytest.approx([0.06484375, 0.07384375, 0.07205125], abs=1e-12)
    assert log.rows["vya"] == pytest.approx([-0.0125, -0.00575, -0.00814], abs=1e-12)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_tie_is_at_the_time_of_the_contact_that_closes_fastest(engine):
    """The other one closes at 6e-7: its float time is off by 1.7e-9."""
    run = es.simulate(beside_a_border(Fraction(15, 64), Fraction(1, 2**20)), engine=engine, log=True)
    assert is_cluster(run)
    assert run.log.time[:2] == pytest.approx(7.63671875, abs=1e-12)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("radius", "ends"), [(0.5, "digits"), (0.5 - 2**-30, "quiet"), (0.5 + 2**-30, "until")])
def test_a_disk_that_exactly_fits_between_two_ends_is_not_thrown_back(engine, radius, ends):
    """It falls through a gap as wide as it is, which rounding would make narrower; a larger one comes back."""
    arcs = [es.Arc((s * 0.5, 0.4375), (s * 1.5, 1.1875), (s * 2.5, 0.4375)) for s in (1, -1)]
    disk = es.Disks([(0.0, 4.0)], [(0.0, -0.6875)], radius)
    run = es.simulate(es.Scene(disk, es.Open(), arcs, gravity=(0.0, -1.0), until=3.0), engine=engine)
    assert run.stopped == ends
    if ends != "digits":
        assert (run.state.velocity[0, 1] > 0.0) == (radius > 0.5)
    else:
        assert "whether they meet" in run.reason

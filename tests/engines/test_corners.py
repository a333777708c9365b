"""Disks and points that come to rest in a corner of two walls: the run ends there, by a word, and not before."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

import eventsim as es
from eventsim.formulas.corner import holds, is_spent, passes_sliding, slides_into

ENGINES = ["reference", pytest.param("fast", marks=pytest.mark.slow)]


def fall(position, radius, engine, restitution=0.6, **scene):
    made = es.Scene(
        disks=es.Disks([position], [(0.0, 0.0)], radius, 1.0), gravity=(0.0, -1.0), restitution=restitution, **scene
    )
    return es.simulate(made, until=30.0, events=3000, engine=engine, log=True)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("radius", [0.0, 0.25])
def test_a_central_drop_into_a_corner_ends_at_its_zeno_time(engine, radius):
    corner = es.Polyline(((0.0, 1.0), (1.0, 0.0), (2.0, 1.0)))
    run = fall((1.0, 3.0), radius, engine, restitution=0.5, domain=es.Open(), walls=(corner,))
    assert run.stopped == "collapse"
    assert "wall0.0" in str(run.reason)
    assert "wall0.1" in str(run.reason)
    height, e = 3.0 - radius * math.sqrt(2.0), 0.5
    assert run.time == pytest.approx(math.sqrt(2.0 * height) * (1.0 + e) / (1.0 - e), abs=1e-6)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("radius", [0.0, 0.1])
def test_bounces_in_a_corner_end_without_a_tail_of_rounding(engine, radius):
    """What rounding keeps up there bounces on at some 1e-15 of energy, for ever."""
    corner = es.Polyline(((0.0, 1.0), (1.0, 0.0), (2.5, 1.0)))
    run = fall((0.3, 2.0), radius, engine, domain=es.Open(), walls=(corner,))
    assert run.stopped == "collapse"
    assert "comes to rest on two walls" in str(run.reason)
    lowest = 1.0, radius * math.hypot(1.0, 1.5) / 1.5
    if radius == 0.0:
        assert run.state.position[0] == pytest.approx(lowest, abs=1e-13)
    energy = 0.5 * (run.log.vxa**2 + run.log.vya**2) + run.log.ya - run.log.ya[-1]
    assert energy[-1] > 5e-16


@pytest.mark.parametrize("engine", ENGINES)
def test_a_corner_of_a_border_and_a_face_ends_a_run_as_well(engine):
    floor = es.Segment((0.0, 1.0), (4.0, 0.0), name="floor")
    run = fall((3.0, 2.0), 0.0, engine, domain=es.Box((4.0, 4.0)), walls=(floor,))
    assert run.stopped == "collapse"
    assert "right" in str(run.reason)
    assert "floor" in str(run.reason)
    assert run.state.position[0] == pytest.approx((4.0, 0.0), abs=1e-13)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_disk_that_bends_off_on_its_way_down_is_not_held(engine):
    slopes = es.Polyline(((0.0, 3.0), (1.0, 1.0), (3.0, 0.5)))
    run = fall((0.5, 2.5), 0.1, engine, domain=es.Open(), walls=(slopes,))
    assert run.stopped == "quiet"
    assert run.state.position[0, 0] > 3.0


@pytest.mark.parametrize("engine", ENGINES)
def test_bounces_on_one_of_two_walls_along_the_axes_do_not_feel_the_other(engine):
    """On the floor it rests and slides, whatever the side does: each contact with that is e times as fast as the one before."""
    made = es.Scene(
        disks=es.Disks([(2.0, 0.25)], [(1.0, 0.0)], 0.25, 1.0),
        domain=es.Box((4.0, 4.0)),
        walls=(es.Segment((0.0, 0.0), (4.0, 0.0), name="floor"),),
        gravity=(1.0, -1.0),
        restitution=0.5,
    )
    run = es.simulate(made, until=30.0, events=3000, engine=engine, log=True)
    right = [row for row in run.log.rows if run.log.provenance.wall_names[row["wall"]] == "right" and row["kind"] == 1]
    speeds = [-float(row["vxa"]) for row in right]
    assert [after / before for before, after in pairwise(speeds[:21])] == pytest.approx([0.5] * 20, rel=1e-9)
    assert run.stopped == "collapse"


LEVEL_AND_ANOTHER = {
    "steep": ([(0.0, 3.0), (1.0, 1.0), (4.0, 1.0)], (1.0, 3.0), 0.0, "wall0.1"),
    "its mirror image": ([(4.0, 3.0), (3.0, 1.0), (0.0, 1.0)], (3.0, 3.0), 0.0, "wall0.1"),
    "told the other way": ([(4.0, 1.0), (1.0, 1.0), (0.25, 2.0)], (1.0, 3.0), 0.0, "wall0.0"),
    "shallow": ([(4.0, 1.0), (1.0, 1.0), (0.0, 1.125)], (1.0, 3.0), 0.0, "wall0.0"),
    "two steep ones": ([(0.0, 3.0), (1.0, 1.0), (2.0, 1.0), (3.0, 3.0)], (1.0, 3.0), 0.0, "wall0.1"),
    "a disk at a steep one": ([(0.25, 2.0), (1.0, 1.0), (4.0, 1.0)], (1.25, 3.5), 0.5, "wall0.1"),
    "a disk at a shallow one": ([(0.0, 1.75), (1.0, 1.0), (4.0, 1.0)], (1.25, 3.75), 0.75, "wall0.1"),
    "a disk at a vertical one": ([(4.0, 1.0), (1.0, 1.0), (1.0, 4.0)], (1.25, 3.25), 0.25, "wall0.0"),
    "a disk at the floor": ([(0.25, 1.0), (1.0, 0.0)], (1.25, 2.5), 0.5, "bottom"),
}
"""The chain, where the disk starts, 2 above its contact with both, its radius, and the wall that is level."""


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("kind", LEVEL_AND_ANOTHER)
def test_what_falls_into_a_corner_of_a_level_wall_rests_on_that_alone_at_its_zeno_time(engine, kind):
    """The other wall never gives it anything: they are one cluster at each bounce, and so they are at the end."""
    chain, start, radius, level = LEVEL_AND_ANOTHER[kind]
    run = fall(start, radius, engine, restitution=0.5, domain=es.Box((4.0, 8.0)), walls=(es.Polyline(chain),))
    assert {run.log.provenance.wall_names[row["wall"]] for row in run.log.rows} == {level}
    assert run.log.rows["kind"].tolist() == [1] * (len(run.log.rows) - 1) + [2]
    assert run.log.time[-1] == pytest.approx(2.0 * (1.0 + 0.5) / (1.0 - 0.5), rel=1e-14)
    assert (run.log.vxa[-1], run.log.vya[-1]) == (0.0, 0.0)
    assert (run.log.xa[-1], run.log.ya[-1]) == (start[0], start[1] - 2.0)
    assert run.stopped == "quiet"


@pytest.mark.parametrize("engine", ENGINES)
def test_what_falls_into_a_corner_of_a_side_and_a_wall_across_gravity_rests_on_that(engine):
    wall = es.Segment((0.0, 2.75), (3.0, 0.5))
    disk = es.Disks([(0.75, 3.75)], radius=0.0)
    made = es.Scene(disk, es.Box((4.0, 8.0)), (wall,), gravity=(-3.0, -4.0), restitution=0.5)
    run = es.simulate(made, until=5.0, engine=engine, log=True)
    assert {run.log.provenance.wall_names[row["wall"]] for row in run.log.rows} == {"wall0"}
    assert run.log.rows["kind"][-1] == 2
    assert run.log.time[-1] == pytest.approx(math.sqrt(2.0 * 1.25 / 5.0) * 3.0, rel=1e-14)
    assert (run.log.xa[-1], run.log.ya[-1]) == pytest.approx((0.0, 2.75), abs=1e-14)
    assert (run.log.vxa[-1], run.log.vya[-1]) == pytest.approx((0.0, 0.0), abs=1e-15)


@pytest.mark.parametrize("engine", ENGINES)
def test_bounces_where_a_floor_bends_down_end_on_the_part_that_leads_away(engine):
    """By 1e-13 it does: each bounce, of twice its speed in all, adds that share of 1 + e of the speed, to e v in the end."""
    bend = 1e-13
    floor = es.Polyline([(0.0, 3.0), (1.0, 1.0), (4.0, 1.0 - 3.0 * bend)])
    run = fall((1.0, 3.0), 0.0, engine, restitution=0.5, domain=es.Box((4.0, 8.0)), walls=(floor,))
    assert {run.log.provenance.wall_names[row["wall"]] for row in run.log.rows} == {"wall0.1"}
    assert run.log.rows["kind"].tolist() == [1] * (len(run.log.rows) - 1) + [2]
    assert run.log.time[-1] == pytest.approx(6.0, rel=1e-9)
    assert run.log.vxa[-1] == pytest.approx(6.0 * bend, rel=1e-3)


def test_a_corner_holds_where_gravity_lies_between_its_walls():
    assert holds(1.0, 1.0, -1.0, 2.0, 0.0, -1.0)
    assert holds(-1.0, 2.0, 1.0, 1.0, 0.0, -1.0)
    assert not holds(1.0, 1.0, 1.0, 2.0, 0.0, -1.0)
    assert not holds(1.0, -1.0, -1.0, -1.0, 0.0, -1.0)
    assert holds(1.0, 0.0, -0.1, 1.0, 0.0, -1.0)
    assert not holds(1.0, 0.0, 0.0, 1.0, -0.5, -1.0)


def test_a_disk_at_rest_on_a_wall_is_pressed_onto_another_one_where_it_would_slide_into_it():
    assert slides_into(1.0, 1.0, -1.0, 2.0, 0.0, -1.0)
    assert slides_into(-1.0, 2.0, 1.0, 1.0, 0.0, -1.0)
    assert slides_into(1.0, 1.0, 0.0, 1.0, 0.0, -1.0)
    assert not slides_into(0.0, 1.0, 1.0, 1.0, 0.0, -1.0)
    assert slides_into(2.0, 1.0, 1.0, 2.0, 0.0, -1.0)
    assert not slides_into(1.0, 2.0, 2.0, 1.0, 0.0, -1.0)
    assert not slides_into(1.0, 0.0, 0.0, 1.0, -0.5, -1.0)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_at_the_end_of_its_bounces_on_a_wall_a_disk_meets_what_it_slides_into(side):
    level, steep, overhanging, down = (0.0, 1.0), (side, 1.0), (side, -0.5), (0.0, -1.0)
    assert passes_sliding(*level, *steep, 0.0, 1e-8, *down)
    assert passes_sliding(*level, *steep, side, 1e-8, *down)
    assert not passes_sliding(*level, *steep, -1e-9 * side, 1e-8, *down)
    assert not passes_sliding(*level, *steep, 0.0, 1e-8, -0.5 * side, -1.0)
    assert not passes_sliding(*level, *overhanging, side, 1e-8, *down)
    assert passes_sliding(3.0 * side, 4.0, 4.0 * side, 0.1, 3e-8 * side, 4e-8 * (1.0 + 2.0**-52), -3.0 * side, -4.0)


def test_the_energy_left_in_a_corner_counts_from_its_lowest_place():
    """At (0, h) above the corner of walls at 45 degrees, on the second one after a way of h sqrt(2) from the first."""
    corner, pull = (1.0, 1.0, -1.0, 1.0), (0.0, -1.0)
    assert is_spent(*corner, *pull, 0.0, 0.0, 0.0, 1.0, 0.5)
    assert not is_spent(*corner, *pull, 1e-6, 0.0, 0.0, 1.0, 0.5)
    assert not is_spent(*corner, *pull, 1e-8, 0.0, 1e-4, 1.0, 0.5)
    assert is_spent(*corner, *pull, 1e-8, 0.0, 1e-9, 1.0, 0.5)


@pytest.mark.parametrize("engine", ["reference", "fast"])
def test_a_point_that_falls_into_a_corner_comes_back_the_way_it_came(engine):
    """Both walls turn it round together, and it is at the corner then, so that it falls into the corner again."""
    floor = es.Polyline([(0.0, 2.6471313603262714), (1.3258378352915325, 0.7045635217200495), (4.0, 1.2012323277492247)])
    scene = es.Scene(
        es.Disks([(1.3258378352915325, 2.42306320799595)], radius=0.0),
        es.Box((4.0, 8.0)),
        (floor,),
        gravity=(0.0, -9.81),
        restitution=0.6,
    )
    log = es.simulate(scene, events=8, engine=engine, log=True).log
    assert log.xa.tolist() == [1.3258378352915325] * 8
    assert log.vxa.tolist() == [0.0] * 8
    assert (log.vya[2::2] / log.vya[:-2:2]).tolist() == pytest.approx([0.6] * 3, rel=1e-14)

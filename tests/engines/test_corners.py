"""Disks and points that come to rest in a corner of two walls: the run ends there, by a word, and not before."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

import eventsim as es
from eventsim.formulas.corner import holds, is_spent

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


def test_a_corner_holds_where_gravity_lies_between_its_walls():
    assert holds(1.0, 1.0, -1.0, 2.0, 0.0, -1.0)
    assert holds(-1.0, 2.0, 1.0, 1.0, 0.0, -1.0)
    assert not holds(1.0, 1.0, 1.0, 2.0, 0.0, -1.0)
    assert not holds(1.0, -1.0, -1.0, -1.0, 0.0, -1.0)
    assert holds(1.0, 0.0, -0.1, 1.0, 0.0, -1.0)
    assert not holds(1.0, 0.0, 0.0, 1.0, -0.5, -1.0)


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

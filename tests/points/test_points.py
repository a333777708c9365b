"""Points hold to their side of walls, and nothing is met inside a joint that goes on."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

import eventsim as es
from tests.points.families import AIMS, above_floor, dropped
from tests.points.judge import is_inside
from tests.points.kicks import kicked

ENGINES = ["reference", pytest.param("fast", marks=pytest.mark.slow)]

SQUARE = (
    (7.9103366189665625, 4.272029695452981),
    (5.727970304547019, 7.9103366189665625),
    (2.0896633810334375, 5.727970304547019),
    (4.27202969545298, 2.0896633810334375),
)


def one(position, velocity=(0.0, 0.0), radius=0.0, **scene):
    return es.Scene(disks=es.Disks([position], [velocity], radius, 1.0), **scene)


def run_of(scene, engine, until, **stop):
    return es.simulate(scene, until=until, engine=engine, log=True, **stop)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_point_cannot_get_below_the_vertex_of_two_walls(engine):
    points = [(0.0, 4.0), (2.0, 0.5), (5.0, 4.0)]
    walls = (es.Polyline(tuple(points), name="ramp"),)
    scene = one((0.5, 4.5), domain=es.Box((5.0, 8.0)), walls=walls, gravity=(0.0, -1.0), restitution=0.3)
    assert above_floor(scene, points, 4.0, engine).wrong == ""


@pytest.mark.parametrize("engine", ENGINES)
def test_a_point_aimed_at_a_corner_stays_in_its_polygon(engine):
    walls = (es.Polygon(SQUARE),)
    velocity = 1.0463016360014148, 2.441779844628661
    run = run_of(one((4.681668668545604, 5.468556774337902), velocity, domain=es.Open(), walls=walls), engine, 10.0)
    assert len(run.log) == 9
    assert run.state.position[0] == pytest.approx((5.189171869397, 4.125313469149), abs=1e-11)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("turned", [False, True])
def test_a_disk_that_slides_along_a_flat_chain_meets_none_of_its_points(engine, turned):
    def place(x, y):
        return (y, x) if turned else (x, y)

    walls = (es.Polyline(tuple(place(x, 0.2) for x in (0.0, 0.4, 0.8, 3.0))),)
    run = run_of(one(place(0.3, 0.3), place(1.0, 0.0), 0.1, domain=es.Open(), walls=walls), engine, 3.0)
    assert len(run.log) == 0
    assert run.state_at(3.0).position[0].tolist() == list(place(3.3, 0.3))


@pytest.mark.parametrize("engine", ENGINES)
def test_a_disk_that_slides_along_slanted_chains_goes_straight(engine):
    rng = np.random.default_rng(5)
    for _ in range(20):
        angle, steps = rng.uniform(0.0, 2.0 * math.pi), np.cumsum(rng.uniform(0.1, 0.9, 5))
        along, across = np.array([math.cos(angle), math.sin(angle)]), np.array([-math.sin(angle), math.cos(angle)])
        points = [tuple((5.0 + s * along).tolist()) for s in steps]
        walls = tuple(es.Segment(a, b) for a, b in pairwise(points))
        start = 5.0 + (steps[0] + 0.05) * along + 0.1 * across
        run = run_of(one(tuple(start.tolist()), tuple(along.tolist()), 0.1, domain=es.Open(), walls=walls), engine, 5.0)
        assert run.state_at(5.0).position[0] == pytest.approx(start + 5.0 * along, abs=1e-14 * 50)
        assert all(run.log.impulse < 1e-14)


@pytest.mark.parametrize("engine", ENGINES)
def test_an_arc_that_goes_on_from_a_segment_has_no_post_between(engine):
    walls = es.Segment((0.0, 0.0), (2.0, 0.0)), es.Arc((2.0, 0.0), (3.0, 1.0), (2.0, 2.0))
    run = run_of(one((0.5, 0.1), (1.0, 0.0), 0.1, domain=es.Open(), walls=walls), engine, 1.5)
    assert len(run.log) == 0
    assert run.state_at(1.5).position[0].tolist() == [2.0, 0.1]


def test_a_post_that_sticks_out_is_met_and_one_in_a_concave_joint_is_not():
    chain = es.Polyline(((0.0, 1.0), (1.0, 0.0), (2.0, 1.0)))
    from_below = run_of(one((1.0, -1.0), (0.0, 1.0), 0.25, domain=es.Open(), walls=(chain,)), "reference", 2.0)
    assert from_below.log.time.tolist() == [0.75]
    from_above = run_of(one((1.0, 2.0), (0.0, -1.0), 0.25, domain=es.Open(), walls=(chain,)), "reference", 4.0)
    assert from_above.log.time[0] == pytest.approx(2.0 - 0.25 * math.sqrt(2.0), abs=1e-15)
    assert from_above.state.velocity[0] == pytest.approx((0.0, 1.0), abs=1e-15)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_point_that_hits_a_vertex_exactly_turns_round(engine):
    chain = es.Polyline(((0.0, 0.0), (1.0, 1.0), (3.0, 0.0)))
    run = run_of(one((0.0, 3.0), (0.5, -1.0), domain=es.Open(), walls=(chain,), restitution=0.5), engine, 4.0)
    assert run.log.time.tolist() == [2.0]
    assert run.state.velocity[0].tolist() == [-0.25, 0.5]
    end = run_of(one((0.0, 0.0), (1.0, 0.0), domain=es.Open(), walls=(es.Segment((1.0, 0.0), (2.0, 0.0)),)), engine, 3.0)
    assert end.log.time.tolist() == [1.0]
    assert end.state_at(3.0).position[0].tolist() == [-1.0, 0.0]


def test_both_faces_of_a_concave_corner_act_as_a_cluster():
    corner = es.Polyline(((0.0, 0.0), (1.0, -1.0), (3.0, 1.0)))
    run = run_of(one((1.0, 1.0), (0.0, -1.0), domain=es.Open(), walls=(corner,)), "reference", 4.0)
    assert run.log.joint.tolist() == [0, 0]
    assert run.state.velocity[0].tolist() == [0.0, 1.0]


@pytest.mark.parametrize("engine", ENGINES)
def test_a_point_whose_contact_comes_at_the_end_of_a_window_is_reflected(engine):
    """Contacts of a billiard between two slanted walls at 1, 3, 5, ...: some come when the clock turns over."""
    walls = es.Segment((-3.0, 3.0), (3.0, -3.0)), es.Segment((-1.0, 5.0), (5.0, -1.0))
    run = run_of(one((1.0, 1.0), (1.0, 1.0), domain=es.Open(), walls=walls), engine, 1024.0)
    assert len(run.log) == 512
    assert np.all(np.diff(run.log.time) == 2.0)


@pytest.mark.parametrize("sagitta", [1e-3, 1e-6, 1e-8, 1e-9, 1e-10, 1e-12])
@pytest.mark.parametrize("gravity", [None, (0.0, -1.0)])
@pytest.mark.parametrize("engine", ENGINES)
def test_a_nearly_flat_arc_is_met_where_it_is(sagitta, gravity, engine):
    mpmath = pytest.importorskip("mpmath")
    walls = (es.Arc((1.0, 1.0), (2.0, 1.0 + sagitta), (3.0, 1.0)),)
    speed = 1.0 if gravity is None else 3.0
    scene = one((1.5, 0.25), (0.0, speed), domain=es.Open(), walls=walls, gravity=gravity)
    run = run_of(scene, engine, 3.0)
    with mpmath.workdps(60):
        bulge = mpmath.mpf(1.0 + sagitta) - 1
        radius = (1 + bulge**2) / (2 * bulge)
        way = 1 + bulge - radius + mpmath.sqrt(radius**2 - mpmath.mpf("0.25")) - mpmath.mpf("0.25")
        time = way if gravity is None else speed - mpmath.sqrt(speed**2 - 2 * way)
        assert abs(run.log.time[0] - time) < 1e-12
        assert run.log.vxa[0] == pytest.approx(float(2 * speed / radius) * 0.5 if gravity is None else run.log.vxa[0], rel=1e-3)


def test_an_arc_whose_bulge_is_below_the_digits_is_refused():
    for bulge in (0.0, 2.0**-52, 1e-15):
        with pytest.raises(es.SceneError, match="on a line"):
            one((2.0, 0.5), domain=es.Open(), walls=(es.Arc((1.0, 1.0), (2.0, 1.0 + bulge), (3.0, 1.0)),))


@pytest.mark.parametrize("size", [1e104, 1e-110])
def test_arcs_of_any_size_have_their_circle(size):
    from eventsim.formulas.walls.arc import arc

    shape = arc(size, size, 2.0 * size, 2.0 * size, 3.0 * size, size)
    assert (shape.ux / size, shape.uy / size, shape.radius / size) == pytest.approx((1.0, 0.0, 1.0), rel=1e-15, abs=1e-15)


@pytest.mark.parametrize("family", AIMS)
def test_points_aimed_at_ends_of_walls_stay_on_their_side(family):
    verdicts = [AIMS[family](np.random.default_rng([3, k]), "reference") for k in range(12)]
    assert [verdict.wrong for verdict in verdicts if verdict.wrong] == []


def test_points_kicked_when_they_meet_a_wall_stay_on_their_side():
    verdicts = [kicked(np.random.default_rng([3, k]), "reference") for k in range(20)]
    assert [verdict.wrong for verdict in verdicts if verdict.wrong] == []


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["reference", "fast"])
def test_points_dropped_onto_random_floors_stay_above(engine):
    verdicts = [dropped(np.random.default_rng([3, k]), engine) for k in range(200)]
    assert [verdict.wrong for verdict in verdicts if verdict.wrong] == []
    assert [verdict.refused for verdict in verdicts if verdict.refused] == []


@pytest.mark.slow
@pytest.mark.parametrize("family", AIMS)
def test_engines_agree_on_points_and_compact_logs_hold(family, tmp_path, monkeypatch):
    from tests.points import families

    def both(scene, until, engine):
        one, other = (es.simulate(scene, until=until, events=3000, engine=name, log=True) for name in ("reference", "fast"))
        assert one.log.digest() == other.log.digest()
        assert one.stopped == other.stopped
        one.log.save(tmp_path / "log.npz", compact=True)
        assert es.load_log(tmp_path / "log.npz").expand().digest() == one.log.digest()
        return one

    monkeypatch.setattr(families, "simulate", both)
    verdicts = [AIMS[family](np.random.default_rng([4, k]), "") for k in range(100)]
    assert [verdict.wrong for verdict in verdicts if verdict.wrong] == []


def test_the_judge_knows_inside_from_outside():
    assert is_inside(SQUARE, 5.0, 5.0)
    assert not is_inside(SQUARE, 8.0, 5.0)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("below", [es.Segment((1.5, -1.0), (1.5, 0.0)), es.Arc((1.5, 0.0), (1.6, -0.5), (1.5, -1.0))])
def test_a_wall_that_hangs_below_a_straight_joint_does_not_open_it(below, engine):
    """A point that hit the joint exactly was let through: of three walls there each left it to the others."""
    walls = [es.Segment((0.0, 0.0), (1.5, 0.0)), below, es.Segment((4.0, 0.0), (1.5, 0.0))]
    for slope in (0.0, 0.5, -0.5):
        for miss in (0.0, 2.0**-40, -(2.0**-40)):
            disk = es.Disks([(1.5 - slope + miss, 1.0)], [(slope, -1.0)], 0.0)
            run = es.simulate(es.Scene(disk, es.Open(), walls, until=1.5), engine=engine)
            assert run.state.velocity.tolist() == [[slope, 1.0]]
            assert run.state.position[0, 1] == pytest.approx(0.5, abs=1e-12)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("joints", [(), (0.5,), (0.5, 1.0, 2.0)])
@pytest.mark.parametrize("turned", [False, True])
def test_a_point_that_rests_on_pieces_in_line_stays_on_them_where_the_last_one_ends_at_a_side(turned, joints, engine):
    """It landed on another piece: the side of the last one was taken for the one below."""
    floor = [(x, 1.25) for x in (0.0, *joints, 4.0)] + [(5.0, 2.25)]
    walls = [es.Polyline(floor[::-1] if turned else floor, name="floor")]
    scene = one((3.0, 1.26), (-1.0, 0.0), domain=es.Box((5.0, 8.0)), walls=walls, gravity=(0.0, -9.81), restitution=0.3)
    run = es.simulate(scene, until=4.0, engine=engine)
    assert run.state.position[0].tolist() == pytest.approx([0.3, 1.25], abs=1e-12)

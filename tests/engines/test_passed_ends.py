"""What leaves a wall over its end, or comes round it, meets it from where it is."""

from __future__ import annotations

import math

import pytest

import eventsim as es

ENGINES = ["reference", pytest.param("fast", marks=pytest.mark.slow)]

BOWL = es.Arc((-1.0, 0.0), (0.0, -1.0), (1.0, 0.0))


def run_of(position, velocity, radius, engine, until, **scene):
    made = es.Scene(disks=es.Disks([position], [velocity], radius, 1.0), domain=es.Open(), **scene)
    return es.simulate(made, until=until, events=1000, engine=engine, log=True)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_disk_that_slides_over_the_end_of_a_slope_does_not_meet_its_end(engine):
    slope = es.Segment((0.0, 0.0), (1.0, -0.48))
    run = run_of((0.23, 1.0), (0.0, 0.0), 0.2, engine, 20.0, walls=(slope,), gravity=(0.0, -1.0), restitution=0.3)
    assert run.stopped == "quiet"
    assert run.log.kind[-2:].tolist() == [2, 1]
    assert run.log.impulse[-1] == 0.0
    pull = 0.48 / math.hypot(1.0, 0.48)
    speed = math.hypot(run.log.vxa[-1], run.log.vya[-1])
    slid = math.hypot(run.log.xa[-1] - run.log.xa[-2], run.log.ya[-1] - run.log.ya[-2])
    before = math.hypot(run.log.vxa[-2], run.log.vya[-2])
    assert speed**2 == pytest.approx(before**2 + 2.0 * pull * slid, rel=1e-12)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_disk_that_creeps_over_an_end_rolls_and_has_no_answer(engine):
    """v.v < r g.n: gravity presses it onto the end."""
    slope = es.Segment((0.0, 0.0), (1.0, -0.01))
    run = run_of((0.9, 0.25), (0.0, 0.0), 0.2, engine, 60.0, walls=(slope,), gravity=(0.0, -1.0), restitution=0.3)
    assert run.stopped == "collapse"


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("radius", [0.0, 0.05])
def test_a_disk_behind_a_wall_that_it_met_in_front_is_behind_it_when_the_clock_turns_over(engine, radius):
    wall = es.Segment((0.0, -9.0), (0.0, 1.0))
    run = run_of((0.5, 0.2), (-1.0, 1.5), radius, engine, 60.0, walls=(wall,), gravity=(-0.5, -0.1))
    first = -2.0 + 2.0 * math.sqrt(1.0 + 0.5 - radius)
    assert run.log.time.tolist() == pytest.approx([first], abs=1e-14)
    assert run.stopped == "quiet"


@pytest.mark.parametrize("engine", ENGINES)
def test_a_disk_outside_an_arc_that_it_met_inside_is_outside_when_the_clock_turns_over(engine):
    velocity = 0.86806943, -0.87207197
    run = run_of((-0.53092139, 1.62971612), velocity, 0.05, engine, 6.0, walls=(BOWL,), gravity=(0.0, -1.0))
    assert len(run.log) == 2
    assert run.stopped == "quiet"


@pytest.mark.parametrize("engine", ENGINES)
def test_a_point_whose_bounces_in_a_bowl_are_over_does_not_fall_through_it(engine):
    velocity = -0.36451485, 0.03764259
    gravity = 0.0, -1.0
    run = run_of(
        (-0.03565945, 0.50050161), velocity, 0.0, engine, 6.0, walls=(BOWL,), gravity=gravity, restitution=0.5
    )
    assert run.stopped == "collapse"
    assert run.time == pytest.approx(3.527322967, abs=1e-7)
    assert math.hypot(*run.state.position[0]) == pytest.approx(1.0, abs=1e-14)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("beside", "told"), [(0.0, ("digits", 0)), (1e-12, ("until", 1)), (-1e-12, ("until", 1))])
def test_a_point_that_hits_the_tip_of_two_walls_behind_a_wrap_is_refused(engine, beside, told):
    """Exactly, in the starting floats: k (11, 9) / 16 away, at velocity s (11, 9); the wrap rounds its place."""
    walls = [es.Polyline(((32.7118396316418, 1.5703349343344906), (32.0, 0.25), (33.35441137562694, 0.8946470550404634)))]
    disks = es.Disks([(27.1875, 60.3125)], [(0.0722094947398952, 0.05908049569627788 + beside)], 0.0)
    scene = es.Scene(disks, es.Periodic((64.0, 64.0)), walls)
    run = es.simulate(scene, until=67.0, engine=engine, log=True)
    assert (run.stopped, len(run.log)) == told
    assert (run.reason is None) == (told[0] == "until")


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("off", [0.0, 2.0**-50, -(2.0**-50), 2.0**-41, -(2.0**-41)])
def test_walls_that_share_an_end_agree_on_whether_a_disk_is_a_point(engine, off):
    """It is smaller than the last bits of the long wall, and larger than those of the short one."""
    roof = es.Polyline([(0.0, 1.5), (1.0, 2.0), (8.0, 1.0)])
    run = run_of((1.0 + off, 4.0), (0.0, 0.0), 2.0**-40, engine, 2.5, walls=(roof,), gravity=(0.0, -1.0), restitution=0.5)
    assert run.log.time[0] == pytest.approx(2.0, rel=1e-12)
    assert (run.log.xa[0], run.log.ya[0]) == pytest.approx((1.0, 2.0), abs=1e-11)


PEAKS = {
    "faces": [es.Polyline([(0.0, 1.5), (1.0, 2.0), (8.0, 1.0)])],
    "arc and face": [es.Arc((0.0, 1.0), (0.2, 1.5), (1.0, 2.0)), es.Segment((1.0, 2.0), (8.0, 1.0))],
    "arcs": [es.Arc((0.0, 1.0), (0.2, 1.5), (1.0, 2.0)), es.Arc((1.0, 2.0), (5.0, 2.5), (8.0, 1.0))],
}


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("speed", [0.0, 0.3, -1.5])
@pytest.mark.parametrize("peak", PEAKS)
def test_a_point_that_has_a_radius_does_not_fall_between_two_walls(engine, peak, speed):
    """It touches one of them where its foot is beyond the end of that, and its centre passes the end on the side of this wall."""
    for radius in (2.0**-45, 2.0**-42, 2.0**-41, 2.0**-40):
        for off in (-1.0, -0.25, -(2.0**-10), 2.0**-10, 0.25, 1.0):
            start = 1.0 + off * radius - 2.0 * speed, 4.0
            run = run_of(start, (speed, 0.0), radius, engine, 2.1, walls=PEAKS[peak], gravity=(0.0, -1.0), restitution=0.5)
            assert run.log.time[:1].tolist() == pytest.approx([2.0], rel=1e-11)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("radius", [0.0, 2.0**-45, 2.0**-41])
@pytest.mark.parametrize("far", [3.0, 8.0])
def test_a_point_that_bounces_where_one_level_wall_goes_on_in_another_comes_to_rest_there(engine, radius, far):
    floor = es.Polyline([(0.0, 2.0), (1.0, 2.0), (3.0, 2.0), (far, 1.0)])
    run = run_of((1.0, 4.0), (0.0, 0.0), radius, engine, 9.0, walls=(floor,), gravity=(0.0, -1.0), restitution=0.5)
    assert run.log.kind[-1] == 2
    assert run.log.time[-1] == pytest.approx(6.0, rel=1e-11)

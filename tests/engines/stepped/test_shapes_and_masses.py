"""Walls of every shape, periods, immovable disks and gravity, as the stepped engines see them: near what is exact."""

import math

import numpy as np
import pytest

import eventsim as es
from eventsim.engines import ENGINES, STEPPED
from eventsim.engines.base import Stop
from eventsim.engines.stepped.penalty import damping_ratio
from eventsim.engines.stepped.stepped import time_of_pair
from eventsim.runner.residuals import residuals_of
from eventsim.scene.stage import stage_of

WALLS = {
    "face": [es.Segment((3.0, 0.5), (5.0, 3.5))],
    "end": [es.Segment((3.5, 2.1), (5.0, 3.5))],
    "arc": [es.Arc((4.0, 1.0), (3.5, 2.0), (4.0, 3.0))],
    "container": [es.Circle((2.0, 2.0), 1.5)],
}
STEPS = [("stepped", {}), ("stepped", {"locate": True}), ("penalty", {})]


def needs(engine):
    if engine == "pymunk":
        pytest.importorskip("pymunk")


@pytest.mark.parametrize(("engine", "options"), STEPS, ids=["stepped", "located", "penalty"])
@pytest.mark.parametrize("shape", WALLS)
def test_a_disk_is_thrown_back_by_every_shape(engine, options, shape):
    scene = es.Scene(es.Disks([(1.5, 1.9)], [(1.0, 0.1)], 0.25), es.Open(), WALLS[shape])
    exact = es.simulate(scene, until=3.0, log=True)
    run = es.simulate(scene, until=3.0, engine=engine, dt=0.001, log=True, **options)
    assert run.counters.wall_contacts == exact.counters.wall_contacts == 1
    assert run.log.wall_name[0] == exact.log.wall_name[0]
    assert np.allclose(run.state.position, exact.state.position, atol=0.1)
    assert abs(run.log.impulse[0] - exact.log.impulse[0]) < 0.05


@pytest.mark.parametrize("engine", STEPPED)
def test_disks_are_wrapped_along_both_periods_and_counted(engine):
    needs(engine)
    scene = es.Scene(es.Disks([(0.5, 0.5), (3.0, 3.0)], [(-2.0, 3.0), (1.0, 0.0)], 0.25), es.Periodic((4.0, 4.0)))
    if engine == "frames" or engine == "pymunk":
        with pytest.raises(es.EventsimError, match="period"):
            es.simulate(scene, until=1.0, engine=engine, dt=0.01)
        return
    run, exact = es.simulate(scene, until=2.3, engine=engine, dt=0.01), es.simulate(scene, until=2.3)
    assert np.allclose(run.state.position, exact.state.position, atol=1e-9)
    session = ENGINES[engine].open(stage_of(scene), False, ENGINES[engine].options(dt=0.01))
    session.advance(Stop(until=2.3), 1000)
    motion = session.motion()
    assert (motion.wraps_x.tolist(), motion.wraps_y.tolist()) == ([-2, 1], [1, 0])


@pytest.mark.parametrize("engine", STEPPED)
@pytest.mark.parametrize("first", [True, False], ids=["a post first", "a post last"])
def test_what_an_immovable_disk_gives_is_momentum_from_outside(engine, first):
    needs(engine)
    if engine == "frames":
        pytest.skip("it has no masses")
    places, velocities, masses = [(2.0, 2.1), (0.6, 2.0)], [(0.0, 0.0), (1.0, 0.0)], [math.inf, 2.0]
    order = slice(None) if first else slice(None, None, -1)
    scene = es.Scene(es.Disks(places[order], velocities[order], 0.25, masses[order]), es.Box((4.0, 4.0)))
    run = es.simulate(scene, until=1.5, engine=engine, dt=0.002)
    mover = 1 if first else 0
    assert run.counters.pair_contacts >= 1
    assert run.state.velocity[mover, 0] < 0.0
    assert np.allclose(run.state.velocity[1 - mover], 0.0)
    assert np.allclose(run.counters.outer_momentum, 2.0 * (run.state.velocity[mover] - (1.0, 0.0)), atol=1e-9)


@pytest.mark.parametrize(("engine", "options"), STEPS, ids=["stepped", "located", "penalty"])
def test_a_crowd_that_falls_keeps_its_books(engine, options):
    rng = np.random.default_rng(5)
    places = np.array([(0.5 + i, 0.5 + j) for i in range(7) for j in range(5)])
    scene = es.Scene(
        es.Disks(places, rng.normal(0.0, 1.0, places.shape), 0.3, rng.uniform(0.5, 2.0, len(places))),
        es.Channel((7.0, 5.0)),
        gravity=(0.0, -1.0),
        restitution=0.9,
    )
    run = es.simulate(scene, until=0.6, engine=engine, dt=0.005, log=True, **options)
    assert run.counters.pair_contacts > 3 < run.counters.wall_contacts
    assert len(run.log) == run.counters.events
    assert run.residuals.momentum < (0.01 if engine == "penalty" else 1e-12)  # springs that push at the end have no row
    assert np.all((run.state.position[:, 0] >= 0.0) & (run.state.position[:, 0] < 7.0))


def test_disks_that_overlap_without_a_relative_velocity_never_touched():
    disks = es.Disks([(1.0, 1.0), (1.4, 1.0)], [(1.0, 0.5), (1.0, 0.5)], 0.25)
    scene = es.Scene(es.Disks([(1.0, 1.0), (2.0, 1.0)], disks.velocity, 0.25), es.Open())
    session = ENGINES["stepped"].open(stage_of(scene), keep_rows=False)
    session.disks.x[1] = 1.4
    assert time_of_pair(session.disks, session.ground, 0, 1) == math.inf
    assert residuals_of(session) is not None


@pytest.mark.parametrize(
    ("engine", "options", "words"),
    [
        ("penalty", {"stiffness": 0.0}, "stiffness = 0.0"),
        ("pymunk", {"iterations": 0}, "iterations = 0"),
        ("pymunk", {"slop": -1.0}, "slop = -1.0"),
        ("stepped", {"dt": 0.0}, "dt = 0.0"),
    ],
)
def test_options_that_make_no_sense_are_refused(engine, options, words):
    needs(engine)
    with pytest.raises(es.EventsimError, match=words):
        es.simulate(es.gallery("two-disks"), until=1.0, engine=engine, **options)


def test_springs_have_no_answer_for_a_disk_without_mass():
    scene = es.Scene(es.Disks([(1.0, 1.0), (2.0, 1.0)], [(1.0, 0.0), (0.0, 0.0)], 0.25, [0.0, 1.0]), es.Open())
    with pytest.raises(es.EventsimError, match="a disk of mass 0"):
        es.simulate(scene, until=1.0, engine="penalty")


@pytest.mark.parametrize("engine", STEPPED)
def test_a_run_stops_after_so_many_events_and_goes_on(engine):
    needs(engine)
    scene = es.gallery("two-disks")
    run = es.simulate(scene, until=11.0, events=1, engine=engine, dt=0.002, log=True)
    assert (run.stopped, run.counters.events, len(run.log)) == ("events", 1, 1)


@pytest.mark.parametrize("engine", STEPPED)
def test_what_only_steps_moves_as_what_is_watched(engine):
    needs(engine)
    stage = stage_of(es.gallery("two-disks"))
    watched, bare = (ENGINES[engine].open(stage, False, ENGINES[engine].options(dt=0.002)) for _ in range(2))
    bare.only_step()
    for session in (watched, bare):
        session.advance(Stop(until=11.0), 10**6)
    assert watched.motion().x.tolist() == bare.motion().x.tolist()


def test_pymunk_without_walls_has_nothing_from_outside():
    needs("pymunk")
    scene = es.Scene(es.Disks([(0.0, 0.0), (1.0, 0.1)], [(1.0, 0.0), (-1.0, 0.0)], 0.25), es.Open())
    run = es.simulate(scene, until=2.0, engine="pymunk", dt=0.002)
    assert run.counters.pair_contacts >= 1
    assert run.counters.outer_momentum == [0.0, 0.0]


@pytest.mark.parametrize("engine", STEPPED)
def test_a_piece_of_wall_in_the_box_is_met(engine):
    needs(engine)
    scene = es.Scene(es.Disks([(1.0, 2.0)], [(1.0, 0.0)], 0.25), es.Box((4.0, 4.0)), [es.Segment((3.0, 1.0), (3.0, 3.0))])
    run = es.simulate(scene, until=2.5, engine=engine, dt=0.002, log=True)
    assert run.counters.wall_contacts >= 1
    assert run.log.wall_name[0] == es.simulate(scene, until=2.5, log=True).log.wall_name[0]
    assert run.state.velocity[0, 0] < 0.0


def test_a_spring_without_restitution_is_damped_to_the_limit():
    assert (damping_ratio(0.0), damping_ratio(1.0)) == (1.0, 0.0)
    assert 0.0 < damping_ratio(0.5) < 1.0

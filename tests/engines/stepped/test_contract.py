"""The contract that every stepped engine keeps: a log, a trajectory, counters, and sentences about what it cannot do."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

import eventsim as es
from eventsim.engines import STEPPED
from eventsim.engines.base import Stop
from eventsim.engines.stepped.clock import StepClock
from eventsim.engines.trajectory import MOST_SAMPLES
from eventsim.replay.replay import Replay
from eventsim.runner.residuals import residuals_of
from eventsim.scene.stage import stage_of

TWO = es.gallery("two-disks")
EXACT = es.simulate(TWO, until=11.0, log=True)


def needs(engine):
    if engine == "pymunk":
        pytest.importorskip("pymunk")


@pytest.mark.parametrize("engine", STEPPED)
def test_a_run_has_a_log_a_trajectory_and_counters(engine):
    needs(engine)
    run = es.simulate(TWO, until=11.0, engine=engine, log=True, dt=0.002)
    assert run.counters.pair_contacts == EXACT.counters.pair_contacts == 2
    assert run.counters.wall_contacts == EXACT.counters.wall_contacts == 2
    assert run.counters.steps == 5500
    assert len(run.log) == 4
    assert np.all(np.diff(run.log.time) >= 0.0)
    # A late contact moves a disk by less than a step; a contact of a spring lasts 20 steps.
    late = 0.3 if engine == "penalty" else 0.02
    assert np.allclose(run.log.time, EXACT.log.time, atol=late)
    assert np.allclose(run.state_at(5.0).position, EXACT.state_at(5.0).position, atol=late)
    assert run.state_at(11.0).time == run.time == 11.0
    with pytest.raises(es.LogError, match="the run is from"):
        run.state_at(12.0)


@pytest.mark.parametrize("engine", ["frames", "stepped"])
def test_replay_of_the_log_follows_the_engine_but_not_its_bits(engine):
    run = es.simulate(es.gallery("gas", n=30), until=0.3, engine=engine, log=True)
    replayed = Replay(run.log).final()
    assert np.allclose(replayed.position, run.state.position, atol=1e-11)


@pytest.mark.parametrize("engine", STEPPED)
def test_every_engine_comes_to_the_event_driven_answer_as_its_step_goes_to_zero(engine):
    needs(engine)
    for scene in (TWO, es.gallery("corner", vy=0.5)):
        until = 11.3
        exact = es.simulate(scene, until=until).state.position
        errors = [
            np.abs(es.simulate(scene, until=until, engine=engine, dt=dt).state.position - exact).max()
            for dt in (0.02, 0.004, 0.001)
        ]
        assert errors[2] < 0.15 * errors[0]
        assert errors[2] < 0.1


def test_a_located_contact_is_exact_in_straight_flight():
    run = es.simulate(TWO, until=11.0, engine="stepped", log=True, dt=0.1, locate=True)
    assert np.allclose(run.log.time, EXACT.log.time, atol=1e-13)


@pytest.mark.parametrize("engine", ["frames", "stepped", "penalty"])
def test_a_restored_run_goes_on_with_the_same_bits(engine):
    stage = stage_of(es.gallery("gas", n=30))
    straight = STEPPED[engine].open(stage)
    while straight.advance(Stop(until=0.2), 100) is None:
        pass
    session = STEPPED[engine].open(stage)
    while session.advance(Stop(until=0.1), 100) is None:
        pass
    saved = session.snapshot()
    other = STEPPED[engine].open(stage)
    other.restore(saved)
    while other.advance(Stop(until=0.2), 100) is None:
        pass
    for one, two in zip(straight.motion(), other.motion(), strict=True):
        assert np.array_equal(one, two)


def test_a_run_stops_by_events_and_by_patience_with_a_scene_where_nothing_comes(monkeypatch):
    run = es.simulate(es.gallery("gas", n=30), events=50, engine="stepped")
    assert run.stopped == "events"
    assert 50 <= run.counters.events < 60
    monkeypatch.setattr(sys.modules["eventsim.engines.stepped.session"], "VAIN_STEPS", 1000)
    alone = es.Scene(es.Disks([(0, 0)], [(1, 0)], radius=1.0), es.Open())
    assert es.simulate(alone, events=1, engine="stepped").stopped == "quiet"


def test_the_trajectory_is_bounded():
    run = es.simulate(TWO, until=20.0, engine="stepped", dt=0.001)
    times = run.trajectory.times
    assert len(times) <= MOST_SAMPLES
    assert times[0] == 0.0
    assert times[-1] > 19.9


def test_a_kick_is_logged():
    sim = es.Simulation(TWO, engine="stepped", dt=0.01)
    sim.advance_to(1.0)
    sim.set_velocity(0, (0.0, 0.0))
    sim.advance_to(3.0)
    assert sim.log.kinds.tolist() == ["kick"]
    assert sim.state.position[0, 0] == pytest.approx(3.0, abs=0.011)


@pytest.mark.parametrize("engine", ["frames", "stepped", "penalty", "pymunk"])
def test_a_kick_books_its_momentum_and_tells_its_impulse(engine):
    needs(engine)
    scene = es.Scene(es.Disks([(0.5, 0.5), (1.5, 0.5)], [(0.1, 0), (0, 0)], radius=0.1, mass=[2.0, 3.0]), es.Box((2, 1)))
    session = STEPPED[engine].open(stage_of(scene), options=STEPPED[engine].options(dt=0.01))
    session.advance(Stop(until=0.5), 1000)
    session.kick(1, 0.3, -0.4)
    session.advance(Stop(until=0.7), 1000)
    assert session.take_rows()["impulse"].tolist() == [pytest.approx(3.0 * 0.5)]
    assert residuals_of(session).momentum < 1e-12


def test_a_kick_of_an_immovable_disk_has_no_impulse():
    post = es.Scene(es.Disks([(0, 0)], [(1, 0)], radius=0.1, mass=float("inf")), es.Open())
    sim = es.Simulation(post, engine="stepped", dt=0.01)
    sim.set_velocity(0, (0.0, 1.0))
    assert np.isnan(sim.log.impulse[0])


@pytest.mark.parametrize(
    ("engine", "scene", "message"),
    [
        ("frames", "periodic-fluid", "it knows no periodic boundaries"),
        ("frames", "bounce", "contacts are elastic"),
        ("frames", "stadium", "parallel to the axes"),
        ("pymunk", "jar", "it knows no round walls"),
    ],
)
def test_a_scene_that_an_engine_does_not_know_is_refused_with_a_sentence(engine, scene, message):
    needs(engine)
    with pytest.raises(es.EventsimError, match=message):
        es.simulate(es.gallery(scene), engine=engine, until=0.1)


@pytest.mark.parametrize("dt", [0.0, -1.0, float("nan"), float("inf")])
def test_a_step_is_a_finite_time_above_zero(dt):
    with pytest.raises(es.EventsimError, match="a step must be a finite time above 0"):
        es.simulate(TWO, engine="stepped", dt=dt)


def test_an_unknown_memory_is_refused():
    with pytest.raises(es.EventsimError, match="must be apart or frame"):
        es.simulate(TWO, engine="frames", memory="for ever")


def test_a_missing_chipmunk_is_one_sentence(monkeypatch):
    monkeypatch.setitem(sys.modules, "pymunk", None)
    with pytest.raises(es.EventsimError, match=r"pip install 'eventsim-disks\[pymunk\]'"):
        es.simulate(TWO, engine="pymunk")


def test_without_numba_the_loops_run_as_plain_python_with_the_same_contacts():
    code = (
        "import sys; {block}\n"
        "import eventsim as es\n"
        "for engine in ('frames', 'stepped'):\n"
        "    run = es.simulate(es.gallery('gas', n=12), until=0.05, engine=engine, log=True)\n"
        "    print(engine, run.counters.pair_contacts, run.counters.wall_contacts, run.state.position.sum().round(9))\n"
    )
    said = [
        subprocess.run(
            [sys.executable, "-c", code.format(block=block)], capture_output=True, text=True, check=True
        ).stdout
        for block in ("sys.modules['numba'] = None", "pass")
    ]
    assert said[0] == said[1]
    assert said[0].count("\n") == 2


def test_a_clock_of_steps_passes_any_number_of_windows_without_a_row_at_once():
    """A disk thrown at 1e15 makes epochs so short that a second has 1e15 of them: the clock counted each window."""
    stage = stage_of(es.gallery("two-disks"))
    short = replace(stage, clock=stage.clock._replace(epoch_length=2.0**-50))
    clock = StepClock(short, 0.01)
    clock.now = 3.0
    epoch, remainder = clock.reading
    assert epoch * 2.0**-50 + remainder == 3.0
    assert 0.0 <= remainder < 2.0 ** (stage.clock.window_cap + 1 - 50)
    clock.now = 3e5
    with pytest.raises(es.EventsimError, match="where the clock of a scene so fast ends"):
        _ = clock.reading

"""What an engine is asked for: when to stop, and from where to go on."""

import math
from copy import copy

import pytest

import eventsim as es
from eventsim.engines.ends import end_of_clock
from eventsim.scene.stage import stage_of
from eventsim.validation.stress.catalogue.scenes import on_plane
from tests.engines.scenes import lattice_gas


@pytest.mark.parametrize(
    ("wrong", "word"),
    [
        ({"until": math.inf}, "finite"),
        ({"until": -1.0}, "before the start"),
        ({"until": "4"}, "must be a number"),
        ({"events": 2.5}, "whole number"),
        ({"events": True}, "whole number"),
        ({"events": -3}, "at least 0"),
        ({}, "nothing says when to stop"),
    ],
)
def test_a_stop_that_makes_no_sense_is_refused(wrong, word):
    with pytest.raises(es.SceneError, match=word):
        es.simulate(on_plane([[0.0, 0.0]], [[1.0, 0.0]]), **wrong)
    with pytest.raises(es.SceneError, match="not a scene"):
        es.simulate("break")


def test_a_time_that_the_clock_cannot_count_is_refused_where_events_go_on():
    moving = es.Disks([[1.0, 1.0]], [[1.0, 0.0]], 0.5)
    with pytest.raises(es.EventsimError, match="the clock of this scene ends at"):
        es.simulate(es.Scene(moving, es.Box((4.0, 4.0))), until=1e300)


@pytest.mark.parametrize("engine", ["reference", "fast"])
def test_a_time_that_the_clock_cannot_count_is_reached_where_nothing_happens(engine):
    if engine == "fast":
        pytest.importorskip("numba")
    run = es.simulate(on_plane([[0.0, 0.0]], [[1.0, 0.0]]), until=1e200, engine=engine, log=True)
    assert (run.state.position.tolist(), run.state_at(5e199).position.tolist()) == ([[1e200, 0.0]], [[5e199, 0.0]])


def test_a_snapshot_of_another_scene_is_refused():
    saved = es.Simulation(lattice_gas(5, 0.1)).snapshot()
    with pytest.raises(es.EventsimError, match="same scene"):
        es.Simulation(lattice_gas(6, 0.1)).restore(saved)


def test_every_engine_of_the_list_takes_a_scene_and_a_stop():
    run = es.ENGINES["reference"].run(lattice_gas(5, 0.1), es.Stop(events=3))
    assert run.counters.events == 3
    assert es.ENGINES["reference"].run(lattice_gas(5, 0.1), 0.5).time == 0.5


@pytest.mark.parametrize("engine", ["reference", "fast"])
def test_a_prediction_that_came_to_nothing_is_no_event_ahead(engine):
    """The disk in the middle was to be met by the slow one at 20, but another disk hits it away before."""
    if engine == "fast":
        pytest.importorskip("numba")
    disks = es.Disks([[0.0, 0.0], [-21.0, 0.0], [0.0, -3.0]], [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], 0.5, [1, 1, 3])
    run = es.simulate(es.Scene(disks, es.Open()), until=10.0, engine=engine)
    assert (run.counters.events, run.stopped) == (1, "quiet")


@pytest.mark.parametrize("engine", ["reference", "fast"])
def test_a_clock_that_ends_before_the_next_contact_says_so(engine):
    """After 49 ever lower bounces only the wall is ahead, in 1e19 time units, of which the clock counts some 2^61."""
    if engine == "fast":
        pytest.importorskip("numba")
    slow = es.Disks([[1.0, 1.0]], [[1e-19, 0.0]], 0.5)
    scene = es.Scene(slow, es.Box((2.5, 2.0)), gravity=(0.0, -1.0), restitution=0.5)
    run = es.simulate(scene, events=90, engine=engine)
    assert (run.counters.events, run.stopped) == (49, "digits")
    assert "the clock of this scene ends at t = 4.61169e+18, and a contact is still ahead" in run.reason
    assert "(t = 1e+19)" in run.reason
    assert run.time == 2.0**62


@pytest.mark.parametrize("engine", ["reference", "fast"])
def test_disks_that_part_for_ever_need_no_clock(engine):
    if engine == "fast":
        pytest.importorskip("numba")
    apart = es.Disks([[0.0, 0.0], [3.0, 0.0]], [[0.0, 0.0], [1.0, 0.0]], 0.5)
    run = es.simulate(es.Scene(apart, es.Open()), events=9, engine=engine)
    assert (run.stopped, run.reason) == ("quiet", None)


def test_a_clock_that_ends_before_a_contact_that_nobody_can_name_says_so():
    """The time of no contact is no number that could be told."""
    stage = stage_of(es.gallery("two-disks"))
    word, sentence = end_of_clock(stage, 5, 0.5, math.inf, ahead=True)
    assert word == "digits"
    assert "a contact may still be ahead; a scene" in sentence


@pytest.mark.parametrize("engine", ["reference", "fast"])
def test_kicks_alone_let_no_speeds_sink(engine):
    """A lone disk that wraps has no speed as others see it; no contact has taken any."""
    scene = es.Scene(es.Disks([(1.0, 1.0)], [(0.0, 0.0)], 0.25), es.Periodic((2.0, 2.0)), restitution=0.5)
    sim = es.Simulation(scene, engine=engine)
    for k in range(1, 5):
        sim.advance_to(k)
        sim.set_velocity(0, (0.5 * k, 0.25))
    sim.advance_to(1e5)
    assert sim.time == 1e5


def giving(restitution, approach, mass):
    """A law that says nothing of disks of equal mass."""
    return -1.0 if 0.45 < mass < 0.55 else 1.0


def refusing():
    return es.Scene(es.Disks([(0.5, 0.5), (1.5, 0.5)], [(2.0, 0.0), (0.0, 0.0)], 0.1), es.Box((2.0, 1.0)), law=giving)


@pytest.mark.parametrize(
    ("engine", "scene", "end"),
    [("auto", refusing(), 0.4), ("reference", refusing(), 0.4), ("reference", "collapse", None), ("fast", "collapse", None)],
)
def test_what_has_stopped_a_simulation_stops_it_for_good(engine, scene, end):
    if engine == "fast":
        pytest.importorskip("numba")
    scene = es.gallery(scene, restitution=0.05) if isinstance(scene, str) else scene
    sim = es.Simulation(scene, engine)
    sim.advance_to(0.1)
    begun = sim.snapshot()
    with pytest.raises(es.CollapseError, match="stopped by") as first:
        sim.advance_to(9.0)
    rows, state = len(sim.log), sim.state
    assert end is None or sim.time == pytest.approx(end)
    assert sim.log.provenance.ending.reason in ("collapse", "law")
    asked = (sim.step, lambda: sim.advance_to(9.5), lambda: sim.set_velocity(0, (0.0, 1.0)), copy(sim).step)
    for ask in asked:
        with pytest.raises(es.CollapseError) as again:
            ask()
        assert str(again.value) == str(first.value)
    assert (len(sim.log), sim.time, sim.state.position.tolist()) == (rows, state.time, state.position.tolist())
    sim.restore(begun)
    sim.set_velocity(0, (0.0, 0.0))
    sim.set_velocity(1, (0.0, 0.0))
    sim.advance_to(0.2)
    assert sim.time == 0.2

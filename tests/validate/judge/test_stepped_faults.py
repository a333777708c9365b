"""A time-stepped engine of a lossy box with one usual bug at a time: the verdict names it."""

from dataclasses import replace

import numpy as np
import pytest

import eventsim as es
from tests.validate.judge.stepper import Stepper, box_of, run

BOX = box_of()


@pytest.mark.parametrize("duration", [1e-6, 1e-3])
def test_an_elastic_contact_is_excused_only_soon_after_another_one(duration):
    scene = replace(BOX, contact_duration=duration, until=0.5)
    first = es.validate(scene, trajectory=run(Stepper(scene, restitution=1.0), scene)[:2]).first_fault
    assert first.kind == "restitution"
    assert first.time == pytest.approx(es.simulate(scene, events=1, log=True).log.time[0], abs=0.001)  # a step


def test_elastic_contacts_within_the_duration_are_right():
    scene = replace(BOX, contact_duration=0.2, until=0.9)
    exact = es.simulate(scene, log=True)
    times = np.arange(0.0, 0.9, 0.005)
    places = np.array([exact.state_at(float(time)).position for time in times])
    judged = es.validate(scene, trajectory=(times, places))
    assert judged.first_fault is None
    assert judged.judgement.charge.found > 5
    none = replace(scene, contact_duration=None)
    assert es.validate(none, trajectory=(times, places)).first_fault.kind == "restitution"


@pytest.mark.parametrize("told", [False, True])
def test_a_start_in_another_direction_is_refused(told):
    """Of the right speed: what differs is a sign."""
    scene = replace(BOX, until=0.2)
    times, places, speeds = run(Stepper(scene), scene, velocity=scene.disks.velocity * [1, -1])
    with pytest.raises(es.EventsimError, match=r"disk 1 begins with velocity \(-0.5, -0.2.*\), in the scene, .* \(-0.5, 0.2\)"):
        es.validate(scene, trajectory=(times, places, speeds) if told else (times, places))


@pytest.fixture(scope="module")
def right():
    scene = replace(BOX, until=0.3)
    return scene, run(Stepper(scene), scene)


@pytest.mark.parametrize(
    ("clock", "said"),
    [
        (lambda times: 1000.0 * times, "of its 61 times, from 0 to 300, only one is within the scene, which ends at t = 0.3"),
        (lambda times: times + 10.0, "of its 61 times, from 10 to 10.3, none is within the scene"),
        (lambda times: 10.0 * times, "its disks begin with 0.0999.* times the velocities of the scene: another unit of time"),
    ],
)
def test_times_on_another_clock_are_refused(right, clock, said):
    scene, (times, places, _) = right
    with pytest.raises(es.EventsimError, match=said):
        es.validate(scene, trajectory=(clock(times), places))


def test_a_limit_that_leaves_one_time_does_not_say_that_there_is_only_one(right):
    scene, (times, places, _) = right
    with pytest.raises(es.EventsimError, match=r"of its 61 times, .* only one is within what is asked for, until t = 0.3"):
        es.validate(scene, trajectory=(1000.0 * times, places), until=0.3)


def test_a_clock_is_compared_before_a_run_that_nothing_ends(right):
    """No end of the scene bounds it: the first step tells that the unit is another one."""
    scene, (times, places, _) = right
    with pytest.raises(es.EventsimError, match=r"its disks begin with 9.99\d*e-06 times the velocities of the scene"):
        es.validate(replace(scene, until=None), trajectory=(1e5 * times, places))


def test_a_motion_is_judged_until_the_scene_ends(right):
    scene, (times, places, _) = right
    judged = es.validate(replace(scene, until=0.2), trajectory=(times, places))
    assert judged.judgement.times[-1] == pytest.approx(0.2)
    assert "the motion goes on to t = 0.3: it is judged until the scene ends, t = 0.2" in judged.verdict
    longer = es.validate(replace(scene, until=0.2), trajectory=(times, places), until=0.25)
    assert longer.judgement.times[-1] == pytest.approx(0.25)


@pytest.mark.parametrize(("every", "told"), [(1, False), (1, True), (2, True), (5, False)])
def test_two_impulses_of_one_contact_are_judged_by_their_sum(every, told):
    """Half an impulse, and what is left of the approach a step later: however much is told, it is named."""
    scene = replace(BOX, until=0.5)
    times, places, speeds = run(Stepper(scene, halved=1), scene, every=every)
    first = es.validate(scene, trajectory=(times, places, speeds) if told else (times, places)).first_fault
    assert first.kind == "restitution"
    assert first.disks == (0, 1)
    assert first.time == pytest.approx(0.377, abs=0.001)


def test_a_contact_whose_impulse_cannot_be_told_is_counted():
    """Its second disk meets a third one before the next sample."""
    scene = replace(BOX, until=1.05)
    judged = es.validate(scene, trajectory=run(Stepper(scene, halved=5), scene)[:2])
    exact = es.simulate(scene, log=True).log
    time = exact.time[(exact.a == 2) & (exact.b == 4)][0]
    assert judged.first_fault is None
    assert time in judged.judgement.charge.untold_at


def test_of_nothing_nothing_is_wrong(right):
    """Until nothing has met anything: a test of another program can tell that from a right engine."""
    scene, (times, places, _) = right
    none = es.validate(scene, trajectory=(times[:2], places[:2]))
    assert none.verdict[0] == "Nothing was compared: no disk that was still in its place met anything until t = 0.005."
    assert none.first_fault is None
    assert none.compared == none.to_dict()["compared"] == 0


def test_the_verdict_on_a_right_engine_begins_with_what_is_right():
    scene = replace(BOX, until=0.7)
    judged = es.validate(scene, trajectory=run(Stepper(scene), scene)[:2])
    assert judged.verdict[0].startswith(f"No wrong event: {judged.compared} of {judged.compared} contacts compared are ")
    assert judged.to_dict()["compared"] == judged.judgement.charge.found > 2


def test_energy_that_is_lost_is_told_beside_what_should_be():
    scene = replace(BOX, until=0.7)
    judged = es.validate(scene, trajectory=run(Stepper(scene), scene)[:2])
    right, seen = judged.judgement.lawful, judged.judgement.energy[-1]
    assert right < -0.05
    assert seen == pytest.approx(right, rel=0.05)  # of steps of .001
    assert any(f"That of the event-driven run changes by {right:+.2e} in all." in text for text in judged.verdict)


@pytest.mark.parametrize("pull", [(0.0, 0.0), (0.0, -2.1), (-2.0, 0.0)])
def test_another_gravity_is_told_by_the_flights(pull):
    scene = replace(BOX, until=0.6)
    first = es.validate(scene, trajectory=run(Stepper(scene, gravity=pull), scene)).first_fault
    assert first.kind == "gravity"
    assert first.sentence == f"gravity: disks fly with acceleration ({pull[0]:g}, {pull[1]:g}), not (0, -2), from t = 0 on"


def test_gravity_where_there_is_none_is_told_and_a_drag_is_none():
    scene = replace(BOX, gravity=None, until=0.6)
    first = es.validate(scene, trajectory=run(Stepper(scene, gravity=(0.0, -0.2)), scene)[:2]).first_fault
    assert first.kind == "gravity"
    assert "acceleration (0, -0.2), not (0, 0)" in first.sentence
    engine = Stepper(scene)
    engine.drag = 0.1
    assert es.validate(scene, trajectory=run(engine, scene)[:2]).first_fault.kind == "drift"


def test_disks_that_lie_still_fly_nowhere():
    """They do not fall: the ground holds them."""
    scene = es.Scene(es.Disks([(0.3, 0.1), (1.0, 1.0)], [(0.0, 0.0), (0.1, 0.0)], 0.1), es.Box((2.0, 2.0)), gravity=(0.0, -1.0))
    times = np.arange(0.0, 1.0, 0.005)
    places = np.tile(scene.disks.position, (len(times), 1, 1))
    places[:, 1, 0] += 0.1 * times
    places[:, 1, 1] -= 0.5 * times**2
    assert es.validate(scene, trajectory=(times, places)).first_fault is None


@pytest.mark.parametrize(("swell", "told"), [(1.03, False), (0.97, True)])
def test_other_radii_are_told_by_the_distance_at_which_disks_turn(swell, told):
    motion = run(Stepper(BOX, swell=swell), BOX)
    first = es.validate(BOX, trajectory=motion if told else motion[:2]).first_fault
    assert first.kind == "radius"
    assert float(first.sentence.split("turn at ")[1].split()[0]) == pytest.approx(swell, abs=0.005)  # half of what counts


@pytest.mark.parametrize("dt", [0.001, 0.005])
def test_contacts_that_are_late_by_a_step_tell_of_no_other_radii(dt):
    motion = run(Stepper(BOX), BOX, dt=dt, every=1)
    assert es.validate(BOX, trajectory=motion).first_fault is None


def test_positions_of_two_decimals_are_said_to_be_rounded(right):
    """And no other unit of time, though most disks seem to stand still in the first step."""
    scene, (times, places, speeds) = right
    judged = es.validate(scene, trajectory=(times, places.round(2)))
    assert "positions are rounded to 0.01, and disks move about 0.00" in judged.verdict[0]
    told = es.validate(scene, trajectory=(times, places.round(2), speeds))
    assert told.first_fault is None
    assert told.judgement.blind is None
    assert any(text.startswith("positions are rounded to 0.01") for text in told.verdict)


def test_disks_that_move_in_whole_hundredths_are_not_rounded():
    scene = es.Scene(es.Disks([(0.5, 1.0), (1.5, 1.0)], [(1.0, 0.0), (-1.0, 0.0)], 0.1), es.Box((2.0, 2.0)), until=1.0)
    times = np.arange(101) / 100
    way = np.where(times < 0.4, times, 0.8 - times)
    places = np.stack([np.column_stack([0.5 + way, np.ones(101)]), np.column_stack([1.5 - way, np.ones(101)])], axis=1)
    judged = es.validate(scene, trajectory=(times, places.round(2)))
    assert judged.first_fault is None
    assert judged.compared == 1
    assert not any("rounded" in text for text in judged.verdict)

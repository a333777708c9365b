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

"""The plain formula in an engine of its own: worse near contact, and nothing else."""

import pytest

import eventsim as es
from eventsim.engines.base import Stop
from eventsim.engines.reference.loop import ReferenceSession
from eventsim.scene.stage import stage_of
from eventsim.validation.precision import PlainSession


def first_contact(session_type, scene):
    session = session_type(stage_of(scene))
    session.advance(Stop(events=1), 100)
    return float(session.take_rows()["time"][0])


def test_the_plain_formula_loses_a_small_gap():
    # d^2 - reach^2 of a gap of 1e-12 at d = .6 is off by some 2**-54 / 1e-12, or 1e-5 of it; head on, the gap itself is exact.
    x = 0.6 + 1e-12
    scene = es.Scene(es.Disks([(0.0, 0.0), (x, 0.0)], [(1.0, 0.0), (0.0, 0.0)], radius=0.3), es.Open())
    gap = x - 0.6
    assert first_contact(ReferenceSession, scene) / gap == pytest.approx(1.0, rel=0.0, abs=1e-15)
    assert first_contact(PlainSession, scene) / gap != pytest.approx(1.0, rel=0.0, abs=1e-7)


def test_far_from_contact_both_are_the_same():
    scene = es.gallery("two-disks")
    assert first_contact(ReferenceSession, scene) == first_contact(PlainSession, scene)

"""What `check=True` looks at by brute force, in sessions that are damaged."""

import math

import pytest

import eventsim as es
from eventsim.engines.reference.invariants import check_invariants
from eventsim.engines.reference.loop import ReferenceSession
from eventsim.scene.stage import stage_of
from tests.engines.scenes import lattice_gas

POSTS = es.Scene(
    es.Disks([(1.0, 1.0), (2.0, 1.0), (3.0, 1.2)], [(1.0, 0.0), (0.0, 0.0), (0.0, 0.0)], 0.25, [1.0, math.inf, math.inf]),
    es.Box((4.0, 4.0)),
)


@pytest.mark.parametrize("scene", [POSTS, lattice_gas(100, 0.3)], ids=["posts", "cells"])
def test_a_session_is_sound_until_its_calendar_is_lost(scene):
    session = ReferenceSession(stage_of(scene))
    check_invariants(session)
    while session.calendar.first() is not None:
        session.calendar.pop()
    with pytest.raises(AssertionError, match="the calendar lacks"):
        check_invariants(session)


def test_a_later_event_does_not_stand_for_the_first_contact():
    session = ReferenceSession(stage_of(POSTS))
    session.calendar.pop()
    with pytest.raises(AssertionError, match="the calendar lacks"):
        check_invariants(session)


def test_disks_that_overlap_are_told():
    session = ReferenceSession(stage_of(POSTS))
    session.state.x[1] = 1.2
    with pytest.raises(AssertionError, match="disks 0 and 1 overlap"):
        check_invariants(session)

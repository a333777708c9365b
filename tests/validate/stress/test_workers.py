"""Processes that come back, that end, that hang."""

import os
import signal
import time

import pytest

from eventsim.validation.stress.workers import WAITED_FOR, Silence, answers


def answer(item):
    """Its square, but -1 ends the process, -2 sleeps and -3 computes for ever."""
    if item == -1:
        os._exit(1)
    if item == -2:
        time.sleep(60.0)
    while item == -3:
        pass
    return None if item == 0 else item * item


def test_a_process_that_ends_or_hangs_costs_only_its_own_item():
    told = dict(answers(answer, [[-1, 2], [3, -2, 4, 0], []], workers=2, patience=0.4))
    assert {item: told[item] for item in (2, 3, 4, 0)} == {2: 4, 3: 9, 4: 16, 0: None}
    assert isinstance(told[-1], Silence)
    assert isinstance(told[-2], Silence)
    assert str(told[-1]).startswith("its process ended after ")
    assert str(told[-2]).startswith("did not come back after 4.")


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="the system does not count seconds of computing")
def test_who_computes_too_long_is_not_waited_for_by_the_wall_clock():
    ((_, told),) = answers(answer, [[-3]], workers=1, patience=2.0)
    assert isinstance(told, Silence)
    assert not told.ended
    assert told.seconds < 2.0 * WAITED_FOR


def test_answers_of_one_job_come_in_order():
    assert [item for item, _ in answers(answer, [[5, 1, 3]], workers=1, patience=30.0)] == [5, 1, 3]

"""Two logs tell the same story where each disk meets the same things in the same order."""

import numpy as np

from eventsim.record.compare import Comparison, agreement, deviations
from eventsim.record.events import ROW


def rows(*contacts, x=0.0):
    """Pair contacts (a, b), or wall contacts (a, -1 - wall)."""
    table = np.zeros(len(contacts), ROW)
    for k, (a, b) in enumerate(contacts):
        table[k]["event"], table[k]["a"], table[k]["xa"] = k, a, x
        table[k]["kind"], table[k]["b"], table[k]["wall"] = (0, b, -1) if b >= 0 else (1, -1, -1 - b)
    return table


def test_contacts_that_share_no_disk_may_swap():
    found = agreement(rows((0, 1), (2, 3), (1, 2)), rows((2, 3), (0, 1), (1, 2)))
    assert found.difference is None
    assert found.pairs.tolist() == [[0, 1], [1, 0], [2, 2]]


def test_contacts_that_share_a_disk_may_not():
    assert agreement(rows((0, 1), (1, 2)), rows((1, 2), (0, 1))).difference == 0
    assert agreement(rows((0, 1), (2, 3), (1, 2)), rows((2, 3), (0, 1), (1, 3))).difference == 2


def test_walls_count():
    assert agreement(rows((0, -1), (1, -2)), rows((1, -2), (0, -1))).difference is None
    assert agreement(rows((0, -1)), rows((0, -2))).difference == 0


def test_the_end_of_a_log_is_no_difference():
    found = agreement(rows((0, 1), (1, 2), (0, 1)), rows((0, 1), (1, 2)))
    assert (found.difference, len(found.pairs)) == (None, 2)
    assert agreement(rows((0, 1)), rows()).difference is None


def test_rows_that_one_of_two_ended_logs_lacks_are_a_difference():
    for one, other, first in ((((0, 1), (1, 2)), ((0, 1),), 1), (((0, 1),), ((0, 1), (1, 2)), 1), (((0, 1),), ((0, 1),), None)):
        comparison = Comparison()
        comparison.add(rows(*one), rows(*other))
        comparison.end()
        assert comparison.difference == first
    found = agreement(rows((0, 1), (1, 2)), rows((0, 1)))
    assert (found.missing, found.surplus) == (1, 0)


def test_blocks_make_no_difference():
    one, other = rows((0, 1), (2, 3), (1, 2), (0, 3)), rows((2, 3), (0, 1), (1, 2), (0, 2))
    comparison = Comparison()
    for k in range(4):
        comparison.add(one[k : k + 1], other[k : k + 1])
    assert comparison.difference == agreement(one, other).difference == 3
    assert comparison.agreement().pairs.tolist() == agreement(one, other).pairs.tolist()


def test_deviations_are_the_largest_of_a_contact():
    one, other = rows((0, 1), (0, 1)), rows((0, 1), (0, 1), x=0.25)
    assert deviations(one, other, agreement(one, other).pairs).tolist() == [0.25, 0.25]

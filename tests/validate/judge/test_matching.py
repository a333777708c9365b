"""Contacts are matched pair by pair, in order, with the least total difference of times: against all assignments."""

from itertools import combinations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from eventsim.validation.judge.matching import assigned, matched

TIMES = st.lists(st.integers(0, 40), max_size=4).map(sorted)


def cost(exact, told, pairs, tolerance):
    apart = sum(abs(exact[i] - told[j]) for i, j in pairs)
    return apart + tolerance * (len(exact) + len(told) - 2 * len(pairs))


def all_assignments(n, m):
    for k in range(min(n, m) + 1):
        for some in combinations(range(n), k):
            for others in combinations(range(m), k):
                yield list(zip(some, others, strict=True))


@given(exact=TIMES, told=TIMES, tolerance=st.integers(1, 12))
def test_no_assignment_in_order_costs_less(exact, told, tolerance):
    found = assigned(exact, told, tolerance)
    assert all(abs(exact[i] - told[j]) <= tolerance for i, j in found)
    allowed = [
        pairs
        for pairs in all_assignments(len(exact), len(told))
        if all(abs(exact[i] - told[j]) <= tolerance for i, j in pairs)
    ]
    assert cost(exact, told, found, tolerance) == min(cost(exact, told, pairs, tolerance) for pairs in allowed)


def test_counts_that_agree_hide_nothing():
    """As many contacts as there should be, and every one of them of another pair: none is found."""
    exact = [((0, 0, 1), 1.0), ((0, 2, 3), 1.1)]
    told = [((0, 0, 2), 1.0), ((0, 1, 3), 1.1)]
    assert matched(exact, told, 0.5) == ([], [0, 1], [0, 1])


def test_a_contact_is_matched_with_the_nearest_of_its_pair():
    exact = [((0, 0, 1), 1.0), ((0, 0, 1), 2.0)]
    told = [((0, 0, 1), 1.9), ((0, 0, 1), 2.1)]
    found = matched(exact, told, 0.5)
    assert found.pairs == [(1, 0)] or found.pairs == [(1, 1)]
    assert found.missed == [0]
    assert matched(exact, told, 1.0).pairs == [(0, 0), (1, 1)]


@pytest.mark.parametrize("late", [0.4, 0.6])
def test_the_tolerance_is_a_bound(late):
    found = matched([((1, 0, 2), 1.0)], [((1, 0, 2), 1.0 + late)], 0.5)
    assert bool(found.pairs) == (late <= 0.5)

"""Matching: which contact that an engine tells is which contact of the truth, disk pair by disk pair."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from typing import NamedTuple

from eventsim.record.contacts import Key


class Matching(NamedTuple):
    """Contacts by their places: pairs (of the truth, of the engine), and those that are left on both sides."""

    pairs: list[tuple[int, int]]
    missed: list[int]
    surplus: list[int]


def matched(exact: Sequence[tuple[Key, float]], told: Sequence[tuple[Key, float]], tolerance: float) -> Matching:
    """Match contacts (who, when), each list in order of time, with the least total difference of times.

    Contacts of the same two disks keep their order, and none is matched over more than the tolerance.
    """
    of_exact, of_told = _by_key(exact), _by_key(told)
    pairs: list[tuple[int, int]] = []
    for key, places in of_exact.items():
        others = of_told.get(key, [])
        found = assigned([exact[k][1] for k in places], [told[k][1] for k in others], tolerance)
        pairs += [(places[i], others[j]) for i, j in found]
    pairs.sort()
    left = set(range(len(exact))) - {i for i, _ in pairs}
    more = set(range(len(told))) - {j for _, j in pairs}
    return Matching(pairs, sorted(left), sorted(more))


def _by_key(contacts: Sequence[tuple[Key, float]]) -> dict[Key, list[int]]:
    places: dict[Key, list[int]] = defaultdict(list)
    for place, (key, _) in enumerate(contacts):
        places[key].append(place)
    return places


def assigned(exact: Sequence[float], told: Sequence[float], tolerance: float) -> list[tuple[int, int]]:
    """The assignment in order, of times within the tolerance, that costs least; O(n m).

    A pair costs its difference of times, a time that is left alone the tolerance.
    """
    n, m = len(exact), len(told)
    cost = [[tolerance * (i + j) if not (i and j) else 0.0 for j in range(m + 1)] for i in range(n + 1)]
    for i in range(1, n + 1):
        for j in range(1, m + 1):
            apart = abs(exact[i - 1] - told[j - 1])
            alone = min(cost[i - 1][j], cost[i][j - 1]) + tolerance
            cost[i][j] = min(alone, cost[i - 1][j - 1] + apart) if apart <= tolerance else alone
    pairs: list[tuple[int, int]] = []
    i, j = n, m
    while i and j:
        apart = abs(exact[i - 1] - told[j - 1])
        if apart <= tolerance and cost[i][j] == cost[i - 1][j - 1] + apart:
            pairs.append((i - 1, j - 1))
            i, j = i - 1, j - 1
        elif cost[i][j] == cost[i - 1][j] + tolerance:
            i -= 1
        else:
            j -= 1
    return pairs[::-1]

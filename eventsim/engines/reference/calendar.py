"""The event calendar: what is predicted, the earliest first."""

from __future__ import annotations

from collections.abc import Iterator
from enum import IntEnum
from itertools import takewhile
from typing import NamedTuple

from sortedcontainers import SortedList

from eventsim.formulas.real import Real


class Rank(IntEnum):
    """The order of events of equal time: wraps, then cell crossings, then contacts."""

    WRAP = 0
    CROSSING = 1
    CONTACT = 2


WRAP, CROSSING, CONTACT = int(Rank.WRAP), int(Rank.CROSSING), int(Rank.CONTACT)


class Event(NamedTuple):
    """A prediction; the order of its fields is the total order of the calendar.

    a: the disk (of a pair the smaller).  b: the other disk; for a wall -1 - the place of its shape; for a wrap or a
    crossing the axis.  image: of b as seen from a, (kx, ky); for a wall (side, 0); for a wrap or a crossing (direction, 0).
    count_a, count_b: the invalidation counts at the time of prediction.
    """

    time: Real
    rank: int
    a: int
    b: int
    image: tuple[int, int]
    count_a: int
    count_b: int


class Calendar:
    """A sorted list of events: push and pop in O(log n)."""

    def __init__(self) -> None:
        self._events: SortedList[Event] = SortedList()
        self.push = self._events.add

    def first(self) -> Event | None:
        """The earliest event, which stays in the calendar."""
        return self._events[0] if self._events else None

    def pop(self) -> Event:
        """Take out the earliest event."""
        event: Event = self._events.pop(0)
        return event

    def until(self, latest: Real) -> list[Event]:
        """All events up to a time, which stay in the calendar."""
        return list(takewhile(lambda event: event.time <= latest, self._events))

    def remove(self, event: Event) -> None:
        """Take out an event, which may have been predicted from both sides."""
        while event in self._events:
            self._events.remove(event)

    def clear(self) -> None:
        """Forget all predictions."""
        self._events.clear()

    def __len__(self) -> int:
        return len(self._events)

    def __iter__(self) -> Iterator[Event]:
        return iter(self._events)

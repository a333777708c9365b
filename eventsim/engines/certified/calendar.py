"""The calendar of balls: the earliest event is found by floats below and above its time, and proven where these are close."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Iterator

from eventsim.engines.certified.ball import Undecided, bounds
from eventsim.engines.reference.calendar import Event


class CertifiedCalendar:
    """A heap of events by a lower bound of their time; stale ones leave it unseen, so that they need not be told apart.

    A pair that is predicted from both sides is one event.
    """

    def __init__(self, is_stale: Callable[[Event], bool]) -> None:
        self._is_stale = is_stale
        self._heap: list[tuple[float, float, int, Event]] = []
        self._known: set[tuple[object, ...]] = set()
        self._first: tuple[float, float, int, Event] | None = None
        self._serial = 0

    def push(self, event: Event) -> None:
        """Add a prediction."""
        what = event[1:]
        if what in self._known:
            return
        self._known.add(what)
        self._serial += 1
        entry = (*bounds(event.time), self._serial, event)
        if self._first is not None and entry[0] <= self._first[1]:
            self._put_back()
        heapq.heappush(self._heap, entry)

    def first(self) -> Event | None:
        """The event that is proven to be the earliest.

        Raises Undecided where the times of two events overlap.
        """
        if self._first is None:
            self._find_first()
        return None if self._first is None else self._first[3]

    def pop(self) -> Event:
        """Take out the earliest event."""
        event = self.first()
        assert event is not None
        self._first = None
        self._known.discard(event[1:])
        return event

    def clear(self) -> None:
        """Forget all predictions."""
        self._heap.clear()
        self._known.clear()
        self._first = None

    def _put_back(self) -> None:
        if self._first is not None:
            heapq.heappush(self._heap, self._first)
            self._first = None

    def _find_first(self) -> None:
        heap = self._heap
        later = []
        best = None
        while heap and (best is None or heap[0][0] <= best[1]):
            entry = heapq.heappop(heap)
            if self._is_stale(entry[3]):
                self._known.discard(entry[3][1:])
            elif best is None:
                best = entry
            elif _is_earlier(entry[3], best[3]):
                later.append(best)
                best = entry
            else:
                later.append(entry)
        for entry in later:
            heapq.heappush(heap, entry)
        self._first = best

    def __len__(self) -> int:
        return len(self._heap) + (self._first is not None)

    def __iter__(self) -> Iterator[Event]:
        self._put_back()
        return (entry[3] for entry in sorted(self._heap))


def _is_earlier(one: Event, other: Event) -> bool:
    try:
        return one < other
    except Undecided as undecided:
        raise Undecided(str(undecided), (other, one)) from None

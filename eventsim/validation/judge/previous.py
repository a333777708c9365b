"""Previous contacts: how long ago those who meet have met something before, where that makes a contact elastic."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections import defaultdict

from eventsim.record.contacts import Key, contacts_of, keys_of
from eventsim.record.events import Kind, Rows
from eventsim.validation.judge.flights import Flights
from eventsim.validation.judge.told import Met


class Previous:
    """What is known of the contacts before a contact: from the engine's own turns, and from the event-driven run.

    Args:
        flights: the paths.
        rows: of the event-driven run, where contacts may be that are too weak to be seen in the samples.
        tolerance: how far apart the times of one contact may be.
        duration: how long a contact matters to the next one of its disks; None where it does not.
    """

    def __init__(self, flights: Flights, rows: Rows, tolerance: float, duration: float | None) -> None:
        self._flights, self._tolerance, self._duration = flights, tolerance, duration
        self._over: dict[int, list[int]] = defaultdict(lambda: [0])
        self._soon: dict[Key, list[float]] = defaultdict(list)
        if duration is None:
            return
        for turn in flights.turns():
            self._over[turn.disk].append(turn.last)
        last: dict[int, float] = {}
        met = contacts_of(rows)
        for key, time in zip(keys_of(met), met["time"].tolist(), strict=True):
            disks = key[1:] if key[0] == Kind.PAIR else key[1:2]
            if any(time - last.get(disk, -math.inf) <= duration for disk in disks):
                self._soon[key].append(time)
            last.update(dict.fromkeys(disks, time))

    def since(self, met: Met) -> float:
        """The least time since the contact before of one of those who meet; what was before the first sample nobody knows."""
        if self._duration is None:
            return math.inf
        if any(abs(time - met.time) <= self._tolerance for time in self._soon.get(met.key, ())):
            return 0.0
        times = self._flights.times
        turns = [turn for turn in met.turns if turn is not None]
        before = [(turn, self._over[turn.disk]) for turn in turns]
        ago = [float(times[turn.first] - times[over[bisect_right(over, turn.first) - 1]]) for turn, over in before]
        return min(ago, default=0.0)

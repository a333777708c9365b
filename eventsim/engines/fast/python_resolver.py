"""What kernels leave to the reference engine's rules: contacts of one instant, disks at rest, kicks."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.base import Counters, rows_from
from eventsim.engines.fast.instant import contacts_between, due_at
from eventsim.engines.fast.machine import Machine
from eventsim.engines.reference.aimed import Aimed
from eventsim.engines.reference.calendar import CONTACT, Event
from eventsim.engines.reference.generation import Ties, components, disks_of, row_order
from eventsim.engines.reference.resolve import Resolver
from eventsim.engines.reference.rests import TwoSupportsError
from eventsim.engines.reference.sunk import Sunk
from eventsim.engines.reference.unresolvable import UnlawfulError, endless, refused
from eventsim.formulas.doubt import latest_tie
from eventsim.formulas.simultaneous import SqueezedError


class PythonResolver:
    """Resolves by rules, in the memory of a machine, and predicts anew what that changes.

    reason: a sentence on why a run stops here, None where it goes on.  refused: whether the rules have no answer.
    sunk: whether it stops at a gap below the digits.
    """

    def __init__(self, machine: Machine, counters: Counters) -> None:
        self._machine = machine
        self._counters = counters
        self.reason: str | None = None
        self.refused = self.sunk = False
        self._ties = Ties(machine.stage, machine.state)
        self._sunk = Sunk(machine.stage, machine.state)
        self._aimed = Aimed(machine.stage, machine.state)
        self._spent: set[Event] = set()
        self._found, self._times = np.empty((64, 4), np.int64), np.empty(64)
        self._resolver: Resolver | None = None

    def resolve_instant(self) -> str | None:
        """Resolve the contacts of the present instant that are predicted by now; why the run stops here, None: it goes on."""
        machine = self._machine
        state, now = machine.state, machine.state.now
        machine.flush()
        near = self.contacts_until(latest_tie(now, machine.rules.tie_screen))
        generation = self._ties.settle(near) if any(event.time == now for event in near) else []
        if (sunk := self._sunk.reason(generation)) is not None:
            self.reason, self.sunk = sunk, self._sunk.sank and machine.stage.law.loses_energy()
            return "digits"
        if (doubtful := self._aimed.reason(generation)) is not None:
            self.reason = doubtful
            return "digits"
        resolver = self._opened_resolver()
        waiting = self.waiting()
        changed: list[int] = []
        for component in components(generation):
            try:
                changed += resolver.resolve(component)
            except (SqueezedError, TwoSupportsError, UnlawfulError) as refusal:
                self._keep(resolver)
                self.refused = True
                stopped, self.reason = refused(refusal, component)
                return stopped
        self._keep(resolver)
        for i in set(changed):
            machine.predict_one(i, now)
        self._fly_on(near, generation, set(changed), waiting)
        stuck = next((i for i in changed if state.at_once[i] >= resolver.at_once_limit), None)
        return None if stuck is None else self.give_up(stuck)

    def give_up(self, i: int) -> str:
        """Stop at an instant that does not end, at disk i: why."""
        stopped, self.reason = endless(self._machine.state, self._machine.stage, i)
        return stopped

    def kick(self, i: int, vx: float, vy: float) -> None:
        """Set the velocity of disk i from outside, now."""
        self._machine.flush()
        resolver = self._opened_resolver()
        resolver.kick(i, vx, vy)
        self._keep(resolver)
        self._machine.predict_one(i, self._machine.state.now)

    def forget(self) -> None:
        """Forget which contacts came to nothing: the clock has turned over, or goes on from somewhere else."""
        self._spent.clear()

    def _fly_on(self, near: list[Event], resolved: list[Event], changed: set[int], waiting: list[int]) -> None:
        """Predict disks anew whose contacts at the present time, resolved or not, came to nothing.

        Under gravity, which closes the gap, such a contact is still due.
        """
        machine = self._machine
        now, falls = machine.state.now, machine.stage.gravity is not None
        if not falls:
            self._spent = {event for event in self._spent if event.time >= now}
            self._spent.update(event for event in resolved if changed.isdisjoint(disks_of(event)))
        left = {i for event in set(near).difference(resolved) if event.time == now for i in disks_of(event)}
        for i in waiting:
            if i not in changed:
                machine.predict_one(i, now if falls or i in left else math.nextafter(now, math.inf))

    def waiting(self) -> list[int]:
        """The disks whose next events are due now."""
        state = self._machine.state
        return [int(state.labels[i]) for i in self._find(due_at, self._machine.counts, state.now)[:, 0]]

    def contacts_until(self, latest: float) -> list[Event]:
        """All contacts from the present time on that have not come to nothing, each once, in the order of rows."""
        machine = self._machine
        labels, count = machine.state.labels, machine.state.count
        events = set()
        found = self._find(contacts_between, machine.rules, machine.counts, machine.state.now, latest)
        for (i, partner, kx, ky), time in zip(found.tolist(), self._times.tolist(), strict=False):
            a = int(labels[i])
            b = int(labels[partner]) if partner >= 0 else partner
            if b >= 0 and b < a:
                a, b, kx, ky = b, a, -kx, -ky
            events.add(Event(time, CONTACT, a, b, (kx, ky), count[a], count[b] if b >= 0 else 0))
        return sorted(events - self._spent, key=lambda event: (row_order(event), event.image))

    def _find(self, search: Any, *where: Any) -> NDArray[np.int64]:
        """What a search finds, with as much room as it needs."""
        while True:
            times = (self._times,) if search is contacts_between else ()
            count = search(self._machine.arrays, self._machine.grid, *where, self._found, *times)
            if count <= len(self._found):
                return self._found[:count].copy()
            self._found, self._times = np.empty((2 * count, 4), np.int64), np.empty(2 * count)

    def _opened_resolver(self) -> Resolver:
        """The reference engine's resolver on these records; it keeps its own lists, so only who needs it opens it."""
        machine = self._machine
        if self._resolver is None:
            self._resolver = Resolver(machine.stage, machine.state, self._counters, machine.keep_rows)
        machine.tell_counters(self._counters)
        return self._resolver

    def _keep(self, resolver: Resolver) -> None:
        """Take over what the resolver has counted and logged."""
        machine, rows = self._machine, resolver.take_rows()
        if rows:
            machine.add_rows(rows_from(rows, machine.stage))
        machine.take_counters(self._counters)

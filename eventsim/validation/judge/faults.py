"""Faults: what an engine does that the laws of its scene forbid, each with its time and what was seen.

A difference from the truth is a fault where the engine's own path asks for something else.  Where the path itself is off, by
errors before, a contact more or less is a consequence of these.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from eventsim.record.contacts import Key
from eventsim.record.events import Floats, Kind
from eventsim.scene.stage import Stage
from eventsim.validation.judge.flights import Flights, Gained, Turn
from eventsim.validation.judge.outcome import named, outcome_of, restitutions, wrong_outcome
from eventsim.validation.judge.previous import Previous
from eventsim.validation.judge.surroundings import Surroundings
from eventsim.validation.judge.told import NEAR, Met

GRAZE = 0.02
"""In reaches: a missed contact whose own path overlaps by less is called a graze."""

THROUGH = 3.0
"""Radii that a disk flies after a missed contact with a wall, while it is looked at whether it gets through."""

SURE = 6.0
"""Standard errors by which a drift has to be above the noise of positions."""

DRIFT = 1e-3
"""Of the energy: what free flights may gain or lose in all."""


@dataclass(frozen=True, slots=True)
class Fault:
    """Something that cannot be: when, of which kind, and a sentence.

    kind: missed, leak, doubled, false, turn, masses, restitution, double impulse, friction, gravity, radius, drift, energy,
    momentum, overlap, jump.  disks: whose; none: of all.  clear: whether it is larger than what can happen between two samples.
    """

    time: float
    kind: str
    sentence: str
    disks: tuple[int, ...] = ()
    clear: bool = True


class Witness:
    """What looks at the engine's own path around a time.

    previous: what is known of contacts before.  window: how long before and after, time.  resolution: a smaller overlap cannot
    be told, length.
    """

    def __init__(
        self, flights: Flights, around: Surroundings, mass: Floats, previous: Previous, window: float, resolution: float
    ) -> None:
        self._previous = previous
        self._flights, self._around, self._mass, self._window = flights, around, mass, window
        self._stage: Stage = around.stage
        self._resolution = resolution

    def is_blurred(self, key: Key, time: float) -> bool:
        """Whether those who should meet turn then, all of them that can: the contact may be there, entangled with others."""
        disks = key[1:] if key[0] == Kind.PAIR else key[1:2]
        near = self._flights.turned[self._span(time)]
        return all(near[:, disk].any() for disk in disks if np.isfinite(self._mass[disk]))

    def missed(self, key: Key, time: float) -> Fault | None:
        """The fault of a contact that is not found; None where the own path does not come to it."""
        span = self._span(time)
        kind, a, other = key
        who = named(key, self._stage)
        if kind == Kind.WALL:
            return self._leak(a, other, time, span)
        reach = float(self._stage.radius[a] + self._stage.radius[other])
        gap = self._around.gap(a, other, self._flights.place[span, a], self._flights.place[span, other])
        if gap >= -self._resolution:
            return None
        deep = -gap / reach if reach > 0.0 else 0.0
        how = f"a graze: their paths overlap by {deep:.2%} of their reach" if deep < GRAZE else f"they overlap by {deep:.0%}"
        clear = -gap > self._flown(span, a) + self._flown(span, other)
        return Fault(time, "missed", f"missed: the contact of {who} at t = {time:.6g} ({how})", (a, other), clear)

    def _flown(self, span: slice, disk: int) -> float:
        """How far a disk flies from one sample to the next."""
        step = float(np.diff(self._flights.times[span]).max(initial=0.0))
        return step * float(np.hypot(*self._flights.after[span, disk].T).max())

    def _leak(self, a: int, wall: int, time: float, span: slice) -> Fault | None:
        close, who = self._flights.place[span, a], named((int(Kind.WALL), a, wall), self._stage)
        radius = float(self._stage.radius[a])
        for surface in self._around.surfaces:
            if self._around.wall_of(surface) != wall:
                continue
            normal, _ = self._around.to_wall(surface, close[0])
            speed = abs(float(self._flights.after[span.start, a] @ np.array(normal)))
            through = self._span(time, THROUGH * radius / speed if speed > 0.0 else 0.0)
            if self._around.beyond(surface, self._flights.place[through, a]):
                return Fault(time, "leak", f"leak: {who} at t = {time:.6g}: it goes through", (a,))
            depth = max(radius - self._around.to_wall(surface, place)[1] for place in close)
            if self._resolution < depth < np.inf:
                said = f"missed: the contact of {who} at t = {time:.6g} (it is {depth:.3g} deep)"
                return Fault(time, "missed", said, (a,), depth > self._flown(span, a))
        return None

    def surplus(self, met: Met, nearest: Met | None) -> Fault | None:
        """The fault of a contact that there is not; None where the own path comes to it.

        nearest: the nearest other contact of the same two.
        """
        kind, a, other = met.key
        who, time = named(met.key, self._stage), met.time
        disks = (a,) if kind == Kind.WALL else (a, other)
        if nearest is not None and abs(time - nearest.time) < 2.0 * self._window and not self._parted(met, nearest):
            said = f"doubled: the contact of {who} at t = {time:.6g}, with that at {nearest.time:.6g}"
            return Fault(time, "doubled", said, disks)
        span = self._span(time)
        if kind == Kind.WALL:
            places = self._flights.place[span, a]
            near = [
                self._around.to_wall(surface, place)[1]
                for surface in self._around.surfaces
                if other < 0 or self._around.wall_of(surface) == other
                for place in places
            ]
            gap, scale = min(near, default=np.inf) - float(self._stage.radius[a]), float(self._stage.radius[a])
        else:
            gap = self._around.gap(a, other, self._flights.place[span, a], self._flights.place[span, other])
            scale = float(self._stage.radius[a] + self._stage.radius[other])
        if gap <= NEAR * scale:
            return None
        return Fault(time, "false", f"false: a contact of {who} at t = {time:.6g}, which are {gap:.3g} apart", disks)

    def _parted(self, one: Met, other: Met) -> bool:
        """Whether something else happened to one of the two between two contacts of theirs, so that they may meet again."""
        before, met = sorted((one, other), key=lambda each: each.time)
        if self._stage.gravity is not None or 0 < met.first <= before.last + 1:
            return True
        disks = met.key[1:] if met.key[0] == Kind.PAIR else met.key[1:2]
        times = self._flights.times
        first, last = (int(place) for place in np.searchsorted(times, [before.time, met.time]))
        return bool(self._flights.turned[first + 1 : max(last - 2, first + 1), list(disks)].any())

    def outcome(self, met: Met) -> Fault | None:
        """The fault of what a contact did; None where it is right, or where a wall may have had its part in it."""
        found = outcome_of(met, self._mass, self._flights.least)
        said = None if found is None else wrong_outcome(met, found, self._stage, self._mass, self._previous.since(met))
        if said is None or self._may_be_shared(met):
            return None
        kind = said.split(":")[0]
        disks = tuple(disk for disk in met.key[1:] if disk >= 0) if met.key[0] == Kind.PAIR else met.key[1:2]
        return Fault(met.time, kind, f"{said} (t = {met.time:.6g})", disks)

    def tells(self, met: Met) -> bool:
        """Whether the paths tell what a contact did, and the law what it should have done."""
        found = outcome_of(met, self._mass, self._flights.least)
        return found is not None and restitutions(met, found, self._stage) is not None and not self._may_be_shared(met)

    def _may_be_shared(self, met: Met) -> bool:
        """Whether one of two disks, or a disk at a wall for several samples, may have met a wall unseen besides."""
        turns = [turn for turn in met.turns if turn is not None]
        if met.key[0] == Kind.WALL and all(turn.is_sharp for turn in turns):
            return False
        own = met.key[2] if met.key[0] == Kind.WALL else None
        return any(self._may_have_met_more(turn, own) for turn in turns)

    def _may_have_met_more(self, turn: Turn, own: int | None) -> bool:
        """Whether a disk can have flown to a wall, or an immovable disk, and from there on, from the first sample to the last.

        own: the wall that it has met; None where that is a disk.
        """
        times, ends = self._flights.times, self._flights.place[[turn.first, turn.last]]
        speed = max(math.hypot(*turn.before), math.hypot(*(turn.before + turn.change)))
        flown = speed * float(times[turn.last] - times[turn.first])
        radius = self._stage.radius
        mine = ends[:, turn.disk]
        for surface in self._around.surfaces:
            if self._around.wall_of(surface) == own:
                continue
            if sum(self._around.to_wall(surface, place)[1] - float(radius[turn.disk]) for place in mine) < flown:
                return True
        for other in np.flatnonzero(~np.isfinite(self._mass)).tolist():
            if other != turn.disk:
                reach = float(radius[other] + radius[turn.disk])
                away = self._around.apart(mine, ends[:, other])
                if float(np.hypot(away[:, 0], away[:, 1]).sum()) - 2.0 * reach < flown:
                    return True
        return False

    def turn(self, turn: Turn) -> Fault:
        """The fault of a disk that turns with nothing near."""
        said = f"turn: disk {turn.disk} turns at t = {turn.time:.6g}, where nothing is near"
        return Fault(turn.time, "turn", said, (turn.disk,))

    def drift(self, gained: Gained, energy: float) -> Fault | None:
        """The fault of energy that free flights gain or lose, of `energy` at the start."""
        if not energy > 0.0:
            return None
        without = np.maximum(np.abs(gained.energy) - gained.largest, 0.0)
        share = np.copysign(without, gained.energy) / energy
        over = np.flatnonzero(np.abs(share) > np.maximum(DRIFT, SURE * gained.error / energy))
        if not len(over):
            return None
        times = self._flights.times
        rate = float(share[over[0]]) / float(times[over[0]] - times[0])
        time = float(times[over[0]])
        said = f"drift: free flights change the energy by {rate:+.2e} of it per time unit, {DRIFT:g} by t = {time:.6g}"
        return Fault(time, "drift", said)

    def _span(self, time: float, longer: float = 0.0) -> slice:
        """The samples around a time, for so much longer after it."""
        times = self._flights.times
        first = int(np.searchsorted(times, time - self._window)) - 1
        last = int(np.searchsorted(times, time + self._window + longer)) + 1
        return slice(max(first, 0), max(last, first + 2))

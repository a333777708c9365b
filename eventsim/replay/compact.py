"""The disks of a compact log on their way from row to row: every contact is resolved again, with the formulas of the engine."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from itertools import groupby
from typing import NamedTuple, TypeAlias

import numpy as np

from eventsim.errors import LogError
from eventsim.formulas.careful_impulse import careful_pair_update, careful_wall_update
from eventsim.formulas.doubt import latest_tie, screen_in
from eventsim.formulas.impulse import (
    flat_update,
    mass_fractions,
    pair_update,
    reduced_mass,
    wall_impulse,
    wall_update,
)
from eventsim.formulas.rest import STRUCK, SUPPORTED, rebound
from eventsim.formulas.simultaneous import JointContact, resolve_together
from eventsim.formulas.walls.face import slope
from eventsim.formulas.walls.point import is_still_rising
from eventsim.record.events import Column, Kind, Rows
from eventsim.record.provenance import Provenance
from eventsim.replay.clock_windows import Windows, stage_of_log
from eventsim.replay.contacts import Contact, Contacts
from eventsim.replay.disk_flight import DiskFlight
from eventsim.replay.flight import Flights, start_flights
from eventsim.replay.runs import Runs
from eventsim.scene.sides import Sides
from eventsim.scene.stage import Stage

Numbers: TypeAlias = tuple[float, float, float, float, float, float, float, float, float]
MISSING = math.nan
BLOCK = 1 << 14
"""Rows held as Python objects at a time."""


class Entry(NamedTuple):
    """What a compact row says."""

    event: int
    kind: int
    a: int
    b: int
    wall: int
    joint: int
    epoch: int
    remainder: float


class Disks(dict[int, DiskFlight]):
    """The flights of the disks that somebody has asked for."""

    def __init__(self, stage: Stage, mass: list[float]) -> None:
        super().__init__()
        self._stage = stage
        self._mass = mass
        self._walls = Sides(stage) if stage.points else None

    def __missing__(self, i: int) -> DiskFlight:
        flight = self[i] = DiskFlight(self._stage, i, math.isinf(self._mass[i]), self._walls)
        return flight


class Expansion:
    """The disks of a compact log on their way from row to row."""

    def __init__(self, provenance: Provenance, rows: Rows, schedule: type[Windows] = Windows) -> None:
        """schedule: of the clock."""
        stage = self.stage = stage_of_log(provenance)
        self._rows = rows
        self.windows = schedule(stage, Runs([rows]), self._changes, lambda row: self._set[int(rows["event"][row])])
        self.windows.resolved = 0
        masses = [stage.common_mass] * stage.n if stage.mass is None else stage.mass.tolist()
        self._mass: list[float] = masses
        self.disks = Disks(stage, masses)
        self._contacts = Contacts(stage, self.disks)
        self._set = {event: (vx, vy) for event, vx, vy in provenance.kicks}

    def numbers(self, first: int = 0, end: int | None = None) -> Iterator[Numbers]:
        """Yield what the rows from `first` on leave out, in order; clusters must be whole."""
        entries = self._entries(self._rows[first:end])
        for joint, group in groupby(entries, key=lambda entry: (entry.joint, entry.event * (entry.joint < 0))):
            cluster = list(group)
            for entry in cluster:
                window = self.windows.window_at(entry.epoch)
                for i in (entry.a, entry.b):
                    if i >= 0:
                        self.disks[i].fly(self.stage.period, self.windows, window, entry.remainder)
            if joint[0] >= 0:
                impulses = self._resolve_cluster(cluster)
            elif cluster[0].kind == Kind.KICK:
                impulses = [self._set_velocity(cluster[0])]
            elif cluster[0].b >= 0:
                impulses = [self._resolve_pair(cluster[0])]
            else:
                impulses = [self._resolve_wall(cluster[0])]
            first += len(cluster)
            self.windows.resolved = first
            for entry, impulse in zip(cluster, impulses, strict=True):
                one = self.disks[entry.a]
                other = (MISSING, MISSING, MISSING, MISSING)
                if entry.b >= 0:
                    disk = self.disks[entry.b]
                    other = (disk.x, disk.y, disk.vx, disk.vy)
                yield (one.x, one.y, one.vx, one.vy, *other, impulse)

    def _entries(self, rows: Rows) -> Iterator[Entry]:
        for first in range(0, len(rows), BLOCK):
            block = rows[first : first + BLOCK]
            columns: list[Column] = [block[name] for name in Entry._fields]
            yield from map(Entry, *(column.tolist() for column in columns))

    def _changes(self, windows: Windows, first: int, last: int) -> tuple[Column, Flights]:
        """How the disks fly that are in some rows."""
        rows = self._rows[first:last]
        disks = np.unique(np.concatenate([rows["a"], rows["b"][rows["b"] >= 0]])).astype(np.int64)
        flights = start_flights(self.stage).take(disks)
        for k, i in enumerate(disks.tolist()):
            disk = self.disks[i]
            flights.window[k], flights.t[k] = disk.window, disk.t
            flights.x[k], flights.y[k], flights.vx[k], flights.vy[k] = disk.x, disk.y, disk.vx, disk.vy
            if flights.gx is not None and flights.gy is not None:
                flights.gx[k], flights.gy[k] = disk.gx, disk.gy
        return disks, flights

    def _set_velocity(self, entry: Entry) -> float:
        disk, mass = self.disks[entry.a], self._mass[entry.a]
        if entry.event not in self._set:
            raise self._unfit(entry, "its velocity is not in the metadata (the log was not closed)")
        disk.settle(entry.remainder)
        before, speed = disk.speed(entry.remainder), self._set[entry.event]
        disk.keep_sides(entry.remainder, disk.place(entry.remainder), speed)
        disk.anchor(entry.remainder, disk.place(entry.remainder), speed)
        disk.low = 0.0, 0.0
        disk.meet(())
        return mass * math.hypot(speed[0] - before[0], speed[1] - before[1]) if math.isfinite(mass) else MISSING

    def _resolve_pair(self, entry: Entry) -> float:
        t, a, b = entry.remainder, entry.a, entry.b
        contact = self._only(entry, self._contacts.of_pair(a, b, t, t))
        one, other = self.disks[a], self.disks[b]
        one.settle(t)
        other.settle(t)
        place_a, place_b = one.place(t), other.place(t)
        dx, dy = self._contacts.apart(contact.image, place_a, place_b, one.low_place, other.low_place)
        shares, reduced = self._shares(a, b)
        restitution = self._restitution(self.stage.law.pair, t, a, b)
        if self.stage.low_parts:
            speeds, masses = (one.vx, one.vy, other.vx, other.vy), (self._mass[a], self._mass[b])
            ua, wa, ub, wb, *low, q = careful_pair_update(dx, dy, *speeds, *one.low, *other.low, *masses, restitution)
            one.low, other.low = (low[0], low[1]), (low[2], low[3])
        else:
            ua, wa, ub, wb, q = pair_update(dx, dy, *one.speed(t), *other.speed(t), *shares, restitution)
        self._begin(contact, a, t, place_a, (ua, wa))
        self._begin(contact, b, t, place_b, (ub, wb))
        return float(-(q * reduced) * math.sqrt(dx * dx + dy * dy))

    def _resolve_wall(self, entry: Entry) -> float:
        t, a = entry.remainder, entry.a
        found = self._contacts.of_wall(a, entry.wall, t, t)
        of_kind = [one for one in found if (one.image[1] == SUPPORTED) == (entry.kind == Kind.REST)]
        contact = self._only(entry, of_kind)
        disk = self.disks[a]
        disk.settle(t)
        place, before = disk.place(t), disk.speed(t)
        if contact.image[1] != STRUCK:
            return self._rest_or_leave(contact, t, place, before)
        restitution = self._restitution(self.stage.law.wall, t, a, a)
        u, w = before
        axis = self._contacts.boundary_axis(contact)
        again = self._contacts.launched(contact)
        if self.stage.is_exact_hit(-1 - contact.b, disk.radius):
            place = self._contacts.on_boundary(contact, place)
            if not is_still_rising(disk.x, disk.y, disk.gx, disk.gy, *place, u, w):
                u, w = -(restitution * u), -(restitution * w)
                disk.low = -(restitution * disk.low[0]), -(restitution * disk.low[1])
        elif again > 0.0:
            u, w = rebound(*self._contacts.normal(contact, place), u, w, restitution * again)
        elif self.stage.low_parts:
            normal = self._contacts.normal(contact, place, disk.low_place)
            u, w, *low, _ = careful_wall_update(*normal, u, w, *disk.low, restitution)
            disk.low = low[0], low[1]
        elif axis is None:
            u, w, _ = wall_update(*self._contacts.normal(contact, place, disk.low_place), u, w, restitution)
        elif axis == 0:
            u, _ = flat_update(u, contact.image[0], restitution)
        else:
            w, _ = flat_update(w, contact.image[0], restitution)
        self._begin(contact, a, t, self._contacts.on_boundary(contact, place), (u, w))
        return float(wall_impulse(self._mass[a], u - before[0], w - before[1]))

    def _rest_or_leave(
        self, contact: Contact, t: float, place: tuple[float, float], before: tuple[float, float]
    ) -> float:
        """Let a disk come to rest on a wall, or slide over its end."""
        supports, speed = self.stage.supports, before
        assert supports is not None
        if contact.image[1] == SUPPORTED:
            support = supports[-1 - contact.b]
            assert support is not None
            place = support.face.touching(contact.image[0], *place, self.disks[contact.a].radius)
            speed = slope(support.face, *before)
        self._begin(contact, contact.a, t, place, speed)
        return float(wall_impulse(self._mass[contact.a], speed[0] - before[0], speed[1] - before[1]))

    def _resolve_cluster(self, cluster: list[Entry]) -> list[float]:
        """Resolve all contacts that the disks of the rows have at their time; rows stand for those with an impulse."""
        t = cluster[0].remainder
        found = self._together(cluster)
        disks = sorted({i for contact in found for i in (contact.a, contact.b) if i >= 0})
        number = {disk: k for k, disk in enumerate(disks)}
        places = {i: self.disks[i].place(t) for i in disks}
        before = [self.disks[i].speed(t) for i in disks]
        joint = [self._joint_contact(contact, number, places, t) for contact in found]
        outcome = resolve_together(joint, before, [self._mass[i] for i in disks])
        active = [k for k, taken in enumerate(outcome.active) if taken]
        rows = self._matched(cluster, [found[k] for k in active])
        for i in sorted({i for contact in rows for i in (contact.a, contact.b) if i >= 0}):
            own = [contact for contact in rows if i in (contact.a, contact.b)]
            disk = self.disks[i]
            if disk.low_place is not None:
                disk.settle(t)
                places[i] = disk.place(t)
            for contact in own:
                if contact.b < 0:
                    places[i] = self._contacts.on_boundary(contact, places[i])
            leaves = outcome.velocities[number[i]]
            disk.keep_sides(t, places[i], leaves, _walls_of(own))
            disk.anchor(t, places[i], leaves)
            disk.low = 0.0, 0.0
            disk.meet(tuple(self._contacts.met(contact, i) for contact in own))
            disk.contact_time = t
        impulse = {found[k]: outcome.impulses[k] for k in active}
        return [impulse[contact] for contact in rows]

    def _together(self, cluster: list[Entry]) -> list[Contact]:
        """Return the contacts, at exactly one time, of the pairs and walls that the rows of a cluster name."""
        t = cluster[0].remainder
        length = self.windows.length[self.windows.window_at(cluster[0].epoch)]
        latest = latest_tie(t, screen_in(self.stage.tie_screen, length, self.stage.epoch_length))
        span = t - (latest - t), latest
        wanted = Counter((entry.a, entry.b, entry.wall) for entry in cluster)
        near: list[Contact] = []
        for a, b, wall in sorted(wanted):
            if b >= 0:
                near += self._contacts.of_pair(a, b, *span)
            else:
                near += [one for one in self._contacts.of_wall(a, wall, *span) if one.image[1] == STRUCK]
        if len(near) == len(cluster):
            return near
        for group in self._contacts.by_exact_time(near):
            if wanted <= Counter(map(self._key, group)):
                return sorted(group, key=near.index)
        raise self._unfit(cluster[0], "its cluster of simultaneous contacts has other members")

    def _key(self, contact: Contact) -> tuple[int, int, int]:
        """Return what the row of a contact says: (a, b, wall)."""
        return contact.a, max(contact.b, -1), self._contacts.wall_of(contact) if contact.b < 0 else -1

    def _matched(self, cluster: list[Entry], active: list[Contact]) -> list[Contact]:
        """Return the contact that each row stands for; those of the same pair or wall by image or shape."""
        waiting: dict[tuple[int, int, int], list[Contact]] = {}
        for contact in sorted(active, key=lambda contact: (-contact.b, contact.image), reverse=True):
            waiting.setdefault(self._key(contact), []).append(contact)
        rows = [waiting[key].pop() for entry in cluster if waiting.get(key := (entry.a, entry.b, entry.wall))]
        if len(rows) != len(cluster) or any(waiting.values()):
            raise self._unfit(cluster[0], "its cluster of simultaneous contacts has other members")
        return rows

    def _joint_contact(
        self, contact: Contact, number: dict[int, int], places: dict[int, tuple[float, float]], t: float
    ) -> JointContact:
        a, b = contact.a, contact.b
        if b >= 0:
            low = (self.disks[i].low_place_at(t) for i in (a, b))
            dx, dy = self._contacts.apart(contact.image, places[a], places[b], *low)
            e = self._restitution(self.stage.law.pair, t, a, b)
            return JointContact(number[a], number[b], dx, dy, e)
        nx, ny = self._contacts.normal(contact, places[a], self.disks[a].low_place_at(t))
        if self.stage.is_exact_hit(-1 - b, self.disks[a].radius):
            u, w = self.disks[a].speed(t)
            nx, ny = (-u, -w) if u or w else (0.0, 1.0)
        return JointContact(number[a], None, nx, ny, self._restitution(self.stage.law.wall, t, a, a))

    def _begin(
        self, contact: Contact, i: int, t: float, place: tuple[float, float], speed: tuple[float, float]
    ) -> None:
        disk = self.disks[i]
        disk.keep_sides(t, place, speed, _walls_of([contact]))
        disk.anchor(t, place, speed)
        disk.meet((self._contacts.met(contact, i),))
        disk.contact_time = t

    def _shares(self, a: int, b: int) -> tuple[tuple[float, float], float]:
        """Return the mass fractions of a pair and its reduced mass."""
        if self.stage.mass is None:
            return (0.5, 0.5), 0.5 * self.stage.common_mass
        return mass_fractions(self._mass[a], self._mass[b]), reduced_mass(self._mass[a], self._mass[b])

    def _restitution(self, restitution: float, t: float, a: int, b: int) -> float:
        since = t - self.disks[a].contact_time, t - self.disks[b].contact_time
        return float(self.stage.law.restitution(restitution, *since))

    def _only(self, entry: Entry, found: list[Contact]) -> Contact:
        if not found:
            raise self._unfit(entry, "at its time there is no such contact")
        if len(found) == 1:
            return found[0]
        return self._contacts.by_exact_time(found)[0][0]  # several that came to nothing together are met one by one

    def _unfit(self, entry: Entry, why: str) -> LogError:
        return LogError(f"the log does not fit its scene at event {entry.event}: {why}")


def _walls_of(contacts: list[Contact]) -> tuple[tuple[int, int], ...]:
    """What is met among contacts: (number, side) of each wall."""
    return tuple((-1 - contact.b, contact.image[0]) for contact in contacts if contact.b < 0)

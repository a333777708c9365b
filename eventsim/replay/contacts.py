"""Which contact a row of a log stands for: the image of a pair, the shape and side of a wall.

A row does not say. But a contact time is a pure function of the flights, so the contact is the one whose
time has the bits of the row; of several, and of those of a cluster, whose float times may differ in the last bits, the exact
times decide.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cmp_to_key
from itertools import product
from typing import NamedTuple

from eventsim.engines.exact_times import ExactTimes, Flight, exact_place
from eventsim.formulas.contact import rescaled_pair_delay, screened_pair_delay
from eventsim.formulas.digits import careful_pair_delay
from eventsim.formulas.low_place import Low, apart, wide_border_delay, wide_pair_delay
from eventsim.formulas.parabola import ANY_OVERLAP, circle_delays
from eventsim.formulas.real import NEVER
from eventsim.formulas.rest import STRUCK, border_contact, has_struck, launch, shape_contact
from eventsim.formulas.roots import Moment, order_of
from eventsim.formulas.walls.boundary import Boundary
from eventsim.formulas.walls.shape import seen
from eventsim.replay.disk_flight import DiskFlight
from eventsim.scene.stage import Stage


class Contact(NamedTuple):
    """A contact of disk a, in the order in which the engine resolves those of one time.

    b: the other disk, or -1 - place of the wall shape. image: of b as seen from a, (kx, ky); of a wall the side, and
    STRUCK, SUPPORTED or LEFT. time: the float time.
    """

    a: int
    b: int
    image: tuple[int, int]
    time: float


class Contacts:
    """The contacts that disks in flight have at one time."""

    def __init__(self, stage: Stage, disks: Mapping[int, DiskFlight]) -> None:
        self._stage = stage
        self._disks = disks
        self._moments = ExactTimes(stage, self._flight)
        along_x, along_y = ((0,) if length is None else (-1, 0, 1) for length in stage.period)
        self._images = list(product(along_x, along_y))
        self._surfaces_of: dict[int, list[int]] = {}
        for number, surface in enumerate(stage.surfaces):
            self._surfaces_of.setdefault(surface.wall, []).append(number)

    def of_pair(self, a: int, b: int, first: float, latest: float) -> list[Contact]:
        """Return the contacts of two disks in a span of remainders; several where a disk is as wide as the domain."""
        found = [Contact(a, b, image, self._pair_time(a, b, image)) for image in self._images]
        return [contact for contact in found if first <= contact.time <= latest]

    def of_wall(self, a: int, wall: int, first: float, latest: float) -> list[Contact]:
        """Return the contacts of a disk with the shapes of a wall in a span of remainders."""
        found = [self._of_surface(a, number) for number in self._surfaces_of.get(wall, ())]
        return [contact for contact in found if first <= contact.time <= latest]

    def by_exact_time(self, contacts: list[Contact]) -> list[list[Contact]]:
        """Return contacts in groups that have exactly one time, the earliest first."""
        timed = [(self._moments.of(*contact), contact) for contact in contacts]
        timed.sort(key=cmp_to_key(_order))
        groups: list[list[Contact]] = []
        for k, (moment, contact) in enumerate(timed):
            if k and order_of(timed[k - 1][0], moment) == 0:
                groups[-1].append(contact)
            else:
                groups.append([contact])
        return groups

    def apart(
        self,
        image: tuple[int, int],
        place_a: tuple[float, float],
        place_b: tuple[float, float],
        low_a: Low = None,
        low_b: Low = None,
    ) -> tuple[float, float]:
        """Return the vector from b (its image) to a; low_a, low_b: the low parts of their places."""
        return apart(place_a, place_b, self._stage.shifts(image), low_a, low_b)

    def normal(self, contact: Contact, place: tuple[float, float], low: Low = None) -> tuple[float, float]:
        """Return the normal, of any length, of a wall towards a disk at `place`; low: the low parts of that."""
        return self._stage.normal(-1 - contact.b, contact.image[0], *place, low)

    def on_boundary(self, contact: Contact, place: tuple[float, float]) -> tuple[float, float]:
        """Return the place of a disk on the boundary of the domain, or on the support, if that is what it meets."""
        number, disk = -1 - contact.b, self._disks[contact.a]
        boundary = self._stage.boundary(number)
        if boundary is not None and disk.low_place is not None:
            left = boundary.left_over(disk.radius)
            disk.low_place = (left, disk.low_place[1]) if boundary.axis == 0 else (disk.low_place[0], left)
        return self._stage.touching(number, contact.image[0], *place, disk.radius)

    def launched(self, contact: Contact) -> float:
        """Return the speed, in terms of the normal, at which a disk left the straight wall that it falls back to; else 0."""
        number, side, supports, disk = -1 - contact.b, contact.image[0], self._stage.supports, self._disks[contact.a]
        if supports is None or supports[number] is None or not has_struck(supports, disk.met, number):
            return 0.0
        nx, ny = self._stage.normal(number, side, disk.x, disk.y)
        fall = nx * disk.gx + ny * disk.gy
        return launch(nx * disk.vx + ny * disk.vy, fall, disk.since_met(contact.b)) if fall < 0.0 else 0.0

    def boundary_axis(self, contact: Contact) -> int | None:
        """Return the axis across which a boundary of the domain is met; None for other walls."""
        boundary = self._stage.boundary(-1 - contact.b)
        return None if boundary is None else boundary.axis

    def wall_of(self, contact: Contact) -> int:
        """Return the number of the wall that is met."""
        return self._stage.surfaces[-1 - contact.b].wall

    def met(self, contact: Contact, i: int) -> tuple[int, int, int]:
        """Return what disk i of a contact remembers of it."""
        if contact.b < 0:
            return contact.b, *contact.image
        kx, ky = self._unwrapped(contact.a, contact.b, contact.image)
        return (contact.b, kx, ky) if i == contact.a else (contact.a, -kx, -ky)

    def _unwrapped(self, a: int, b: int, image: tuple[int, int]) -> tuple[int, int]:
        one, other = self._disks[a].wraps, self._disks[b].wraps
        return image[0] + one[0] - other[0], image[1] + one[1] - other[1]

    def _just_met(self, a: int, b: int, image: tuple[int, int]) -> bool:
        """Return whether both disks remember each other, in an image, as what they met last."""
        kx, ky = self._unwrapped(a, b, image)
        return (b, kx, ky) in self._disks[a].met and (a, -kx, -ky) in self._disks[b].met

    def _pair_time(self, a: int, b: int, image: tuple[int, int]) -> float:
        """Return the remainder at which two disks meet in an image; NEVER where they just met."""
        one, other = self._disks[a], self._disks[b]
        t = max(one.t, other.t)
        if one.low_place is not None:
            if self._just_met(a, b, image):
                return NEVER
            return float(t + wide_pair_delay(*one.fine(), *other.fine(), *self._stage.shifts(image)))
        (ua, wa), (ub, wb) = one.speed(t), other.speed(t)
        dx, dy = self.apart(image, one.place(t), other.place(t))
        du, dw, reach = ua - ub, wa - wb, one.radius + other.radius
        if one.gx != other.gx or one.gy != other.gy:
            begun = one.t == other.t == one.contact_time == other.contact_time
            touches = self._stage.settles and begun and self._just_met(a, b, image)
            pull = one.gx - other.gx, one.gy - other.gy
            first, _ = circle_delays(dx, dy, du, dw, *pull, reach, 1.0, ANY_OVERLAP, touches)
            return float(t + first)
        if self._just_met(a, b, image):
            return NEVER
        delay = screened_pair_delay(dx, dy, du, dw, reach)
        if math.isnan(delay) and one.gx is None:
            delay = rescaled_pair_delay(dx, dy, du, dw, reach)
        if math.isnan(delay):
            if one.gx is None:
                delay = careful_pair_delay(*one.anchored(), *other.anchored(), *self._stage.shifts(image))
            else:
                delay = careful_pair_delay(
                    *(dx, dy, du, dw, 0.0, one.radius), *(0.0, 0.0, 0.0, 0.0, 0.0, other.radius), 0.0, 0.0
                )
        return float(t + delay)

    def _of_surface(self, a: int, number: int) -> Contact:
        """Return the next contact of a disk with a surface."""
        time, side, how = self._wall_time(a, number)
        return Contact(a, -1 - number, (side, how), time)

    def _flight(self, i: int) -> Flight:
        disk = self._disks[i]
        if disk.low_place is not None:
            x, y = exact_place(disk.x, disk.y, disk.low_place)
            return disk.t, x, y, disk.vx, disk.vy, None, None
        return disk.t, disk.x, disk.y, disk.vx, disk.vy, disk.gx, disk.gy

    def _wall_time(self, a: int, number: int) -> tuple[float, int, int]:
        """Return (remainder, side, how) of the next contact of a disk with a surface."""
        disk, stage = self._disks[a], self._stage
        surface, e, since = stage.surfaces[number], stage.law.series(), disk.since_met(-1 - number)
        if isinstance(surface, Boundary):
            axis, side = surface.axis, surface.side
            x, v, g = (disk.x, disk.vx, disk.gx) if axis == 0 else (disk.y, disk.vy, disk.gy)
            if disk.low_place is not None:
                delay = wide_border_delay(x, disk.low_place[axis], v, surface.position, disk.radius, side)
                return disk.t + delay, int(side), STRUCK
            target = surface.target(disk.radius)
            size = abs(disk.x) + abs(disk.y) + abs(target)
            delay, how = border_contact(stage.supports, disk.held, number, side, target, x, v, g, size, e, disk.t, since)
            return disk.t + delay, int(side), how
        met = next((last[1] for last in disk.met if last[0] == -1 - number), 0)
        shape, x, y = seen(surface.shape, disk.x, disk.y, disk.low_place)
        flight = (x, y, disk.vx, disk.vy, disk.gx, disk.gy)
        beside = disk.side_beside(number)
        touches = stage.settles and met != 0 and since == 0.0
        delay, met_side, how = shape_contact(
            stage.supports, disk.held, number, shape, flight, disk.radius, met, e, disk.t, since, touches, beside
        )
        return disk.t + delay, met_side, how


def _order(one: tuple[Moment, Contact], other: tuple[Moment, Contact]) -> int:
    return order_of(one[0], other[0])

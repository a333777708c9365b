"""Sides of a table: straight and round pieces with a direction, the table to their left, and where they cross."""

from __future__ import annotations

import math
from typing import NamedTuple, TypeAlias

Point: TypeAlias = tuple[float, float]

CLOSE = 1e-9
"""Share of the table's size below which places are one: some 2^22 times what their rounding makes."""


class Line(NamedTuple):
    """From (x0, y0) to (x1, y1), the table to the left; `hard`: not the border of a period."""

    x0: float
    y0: float
    x1: float
    y1: float
    hard: bool

    def at(self, share: float) -> Point:
        """The place at a share of its way."""
        return self.x0 + share * (self.x1 - self.x0), self.y0 + share * (self.y1 - self.y0)

    def normal(self, _share: float) -> Point:
        """To the inside of the table, of length 1; the same all along."""
        return (self.y0 - self.y1) / self.length, (self.x1 - self.x0) / self.length

    def cut(self, low: float, high: float) -> Line:
        """The part between two shares."""
        return Line(*self.at(low), *self.at(high), self.hard)

    @property
    def length(self) -> float:
        """How long it is."""
        return math.hypot(self.x1 - self.x0, self.y1 - self.y0)

    @property
    def area(self) -> float:
        """Its part of the line integral of (x dy - y dx) / 2."""
        return 0.5 * (self.x0 * self.y1 - self.x1 * self.y0)

    def share_of(self, x: float, y: float) -> float:
        """Where along it the foot of a place lies."""
        dx, dy = self.x1 - self.x0, self.y1 - self.y0
        return ((x - self.x0) * dx + (y - self.y0) * dy) / (dx * dx + dy * dy)

    def off(self, x: float, y: float) -> float:
        """How far a place is from its continuation."""
        nx, ny = self.normal(0.0)
        return abs(nx * (x - self.x0) + ny * (y - self.y0))


class Bow(NamedTuple):
    """About (x, y), from angle `start` over `turn`; the table to the left: turn > 0 has it inside, turn < 0 outside."""

    x: float
    y: float
    radius: float
    start: float
    turn: float
    hard: bool = True

    def at(self, share: float) -> Point:
        """The place at a share of its way."""
        angle = self.start + share * self.turn
        return self.x + self.radius * math.cos(angle), self.y + self.radius * math.sin(angle)

    def normal(self, share: float) -> Point:
        """To the inside of the table, of length 1."""
        angle = self.start + share * self.turn
        sign = -1.0 if self.turn > 0.0 else 1.0
        return sign * math.cos(angle), sign * math.sin(angle)

    def cut(self, low: float, high: float) -> Bow:
        """The part between two shares."""
        return self._replace(start=self.start + low * self.turn, turn=(high - low) * self.turn)

    @property
    def length(self) -> float:
        """How long it is."""
        return self.radius * abs(self.turn)

    @property
    def area(self) -> float:
        """Its part of the line integral of (x dy - y dx) / 2."""
        (x0, y0), (x1, y1) = self.at(0.0), self.at(1.0)
        return 0.5 * (self.radius**2 * self.turn + self.x * (y1 - y0) - self.y * (x1 - x0))

    def off(self, x: float, y: float) -> float:
        """How far a place is from its circle."""
        return abs(math.hypot(x - self.x, y - self.y) - self.radius)

    def share_of(self, x: float, y: float) -> float:
        """Where along it a place lies, seen from the middle."""
        angle = math.copysign(1.0, self.turn) * (math.atan2(y - self.y, x - self.x) - self.start) % (2.0 * math.pi)
        if 2.0 * math.pi - angle < CLOSE:  # just before its start
            angle -= 2.0 * math.pi
        return angle / abs(self.turn)


Side: TypeAlias = Line | Bow


def joined(one: Side, other: Side) -> Side | None:
    """Two sides, the second of which goes on where the first one ends, as one; None where there is a bend between them."""
    if isinstance(one, Line) and isinstance(other, Line):
        (ax, ay), (bx, by) = one.normal(0.0), other.normal(0.0)
        straight = ax * bx + ay * by > 0.0 and abs(ax * by - ay * bx) < CLOSE
        return Line(one.x0, one.y0, other.x1, other.y1, one.hard) if straight else None
    if isinstance(one, Bow) and isinstance(other, Bow):
        same = (one.x, one.y, one.radius) == (other.x, other.y, other.radius) and one.turn * other.turn > 0.0
        return one._replace(turn=one.turn + other.turn) if same else None
    return None


def crossings(one: Side, other: Side) -> list[Point]:
    """Where two pieces, or their continuations, meet."""
    if isinstance(one, Line):
        return line_crossings(one, other)
    if isinstance(other, Line):
        return line_crossings(other, one)
    dx, dy = other.x - one.x, other.y - one.y
    d2 = dx * dx + dy * dy
    if d2 == 0.0 or d2 > (one.radius + other.radius) ** 2 or d2 < (one.radius - other.radius) ** 2:
        return []
    along = 0.5 * (d2 + one.radius**2 - other.radius**2) / d2
    across = math.sqrt(max(one.radius**2 / d2 - along * along, 0.0))
    return [(one.x + along * dx - s * across * dy, one.y + along * dy + s * across * dx) for s in (1.0, -1.0)]


def line_crossings(line: Line, other: Side) -> list[Point]:
    """Where a line, or its continuation, meets a side, or the continuation of that."""
    dx, dy = line.x1 - line.x0, line.y1 - line.y0
    if isinstance(other, Line):
        ex, ey = other.x1 - other.x0, other.y1 - other.y0
        cross = dx * ey - dy * ex
        if abs(cross) <= CLOSE * math.hypot(dx, dy) * math.hypot(ex, ey):
            return []
        share = ((other.x0 - line.x0) * ey - (other.y0 - line.y0) * ex) / cross
        return [line.at(share)]
    a, fx, fy = dx * dx + dy * dy, line.x0 - other.x, line.y0 - other.y
    b, c = fx * dx + fy * dy, fx * fx + fy * fy - other.radius**2
    root = b * b - a * c
    return [] if root < 0.0 else [line.at((-b + s * math.sqrt(root)) / a) for s in (1.0, -1.0)]

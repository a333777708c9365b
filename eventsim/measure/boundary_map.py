"""The boundary map of a billiard: where along the boundary each contact is, and the sine of the angle at which it leaves.

In these coordinates the area ds d(sin) is kept from contact to contact.  The boundary is that of the table that the centre sees,
with the table to its left: outer walls counter-clockwise, posts clockwise, one after the other.

Source: G. D. Birkhoff, Acta Math. 50, 359 (1927), doi:10.1007/BF02421325; N. Chernov, R. Markarian, Chaotic Billiards (2006),
section 2.9.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np

from eventsim.measure.billiard_table import Table
from eventsim.measure.ensemble import ensemble_of
from eventsim.measure.sides import Line, Side
from eventsim.record.events import Column, Floats, Kind, Rows
from eventsim.record.places import on_scene_axes
from eventsim.replay.clock_windows import stage_of_log
from eventsim.replay.log import AnyLog
from eventsim.scene.stage import Stage
from eventsim.scene.walls import Ellipse, parts_of

GAUSS = np.polynomial.legendre.leggauss(8)
"""Nodes and weights by which an ellipse is measured."""

PIECES = 1024
"""Pieces of an ellipse, each measured by these."""


class Contacts(NamedTuple):
    """Contacts (n,) with the boundary: the event and disk, the time, the arc length, and the sine of the angle of leaving.

    sine: above 0 along the boundary, 0 straight away from it.
    """

    event: Column
    disk: Column
    time: Floats
    arc: Floats
    sine: Floats


class Oval:
    """An ellipse as a side, met from inside: it begins at the end of the first semi-axis, counter-clockwise."""

    def __init__(self, wall: Ellipse) -> None:
        self._wall = wall
        grid = np.linspace(0.0, 2.0 * math.pi, PIECES + 1)
        self._arc = np.concatenate([[0.0], np.cumsum(self._length(grid[:-1], grid[1:]))])
        self.length = float(self._arc[-1])

    def _length(self, low: Floats, high: Floats) -> Floats:
        """Of the pieces between two angles (n,)."""
        (a, b), (nodes, weights) = self._wall.semi_axes, GAUSS
        half = 0.5 * (high - low)
        angle = 0.5 * (high + low)[:, None] + half[:, None] * nodes
        length: Floats = half * (np.hypot(a * np.sin(angle), b * np.cos(angle)) @ weights)
        return length

    def along(self, x: Floats, y: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """How far places are away, how far along, and the normals there; see `_along`."""
        (a, b), (ex, ey) = self._wall.semi_axes, np.array(self._wall.direction) / math.hypot(*self._wall.direction)
        dx, dy = x - self._wall.center[0], y - self._wall.center[1]
        u, w = ex * dx + ey * dy, ex * dy - ey * dx
        angle = np.arctan2(w / b, u / a) % (2.0 * math.pi)
        place = np.minimum((angle * (PIECES / (2.0 * math.pi))).astype(np.int64), PIECES - 1)
        arc = self._arc[place] + self._length(place * (2.0 * math.pi / PIECES), angle)
        nu, nw = -np.cos(angle) * b, -np.sin(angle) * a
        size = np.hypot(nu, nw)
        return np.zeros(len(x)), arc, (ex * nu - ey * nw) / size, (ey * nu + ex * nw) / size


AnySide: TypeAlias = Side | Oval


@dataclass(frozen=True)
class BoundaryMap:
    """The boundary of a table, and what meets it.

    Attributes:
        table: area and perimeter.
        sides: in order.
        begins: (sides,) the arc length at which each begins.
        movers: (N,) which disks are followed.
        stage: of the log.
    """

    table: Table
    sides: list[AnySide]
    begins: Floats
    movers: Column
    stage: Stage

    def contacts(self, rows: Rows) -> Contacts:
        """Return the contacts of movers among rows."""
        met = rows[(rows["kind"] == Kind.WALL) | ((rows["kind"] == Kind.PAIR) & (rows["b"] >= 0))]
        first = self.movers[met["a"]]
        met, first = met[first | self.movers[met["b"]]], first[first | self.movers[met["b"]]]

        def of(name: str) -> Floats:
            """Return a column of the mover."""
            values: Floats = np.where(first, met[f"{name}a"], met[f"{name}b"])
            return values

        corner, period = self.stage.corner, self.stage.period
        x, y = (on_scene_axes(of(name), corner[k], period[k]) for k, name in enumerate("xy"))
        vx, vy = of("vx"), of("vy")
        best, arc, sine = np.full(len(met), math.inf), np.zeros(len(met)), np.zeros(len(met))
        speed = np.hypot(vx, vy)
        for side, begin in zip(self.sides, self.begins.tolist(), strict=True):
            away, along, nx, ny = side.along(x, y) if isinstance(side, Oval) else _along(side, x, y)
            nearer = away < best
            best = np.where(nearer, away, best)
            arc = np.where(nearer, begin + along, arc)
            sine = np.where(nearer, (ny * vx - nx * vy) / np.where(speed > 0.0, speed, 1.0), sine)
        return Contacts(met["event"], np.where(first, met["a"], met["b"]), met["time"], arc, sine)

    def all_contacts(self, log: AnyLog) -> Iterator[Contacts]:
        """Yield the contacts of a log, block by block."""
        return (self.contacts(rows) for rows in log.blocks())


def boundary_map(log: AnyLog) -> BoundaryMap | str:
    """Return the boundary map of the table of a log; where there is none, why, a clause."""
    scene = log.scene
    ensemble = ensemble_of(scene, bool(log.provenance.kicks))
    if not ensemble.billiard:
        why = (
            ensemble.no_equilibrium
            or "a boundary map is of points or one disk that fly straight among what stands still"
        )
        return f"no billiard: {why}"
    if ensemble.table is None:
        return "the centre sees no closed table of straight and round sides"
    ovals = [wall for wall in parts_of(scene.walls) if isinstance(wall, Ellipse)]
    sides: list[AnySide] = [Oval(ovals[0])] if ovals else [*ensemble.sides]
    lengths = [side.length for side in sides]
    return BoundaryMap(
        table=ensemble.table,
        sides=sides,
        begins=np.concatenate([[0.0], np.cumsum(lengths)[:-1]]),
        movers=ensemble.movers,
        stage=stage_of_log(log.provenance),
    )


def _along(side: Side, x: Floats, y: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """How far places (n,) are from a side, how far along it they lie, and the normals there, into the table."""
    if isinstance(side, Line):
        dx, dy = (side.x1 - side.x0) / side.length, (side.y1 - side.y0) / side.length
        along = np.clip((x - side.x0) * dx + (y - side.y0) * dy, 0.0, side.length)
        away = np.hypot(x - side.x0 - along * dx, y - side.y0 - along * dy)
        return away, along, np.full(len(x), -dy), np.full(len(x), dx)
    sense = math.copysign(1.0, side.turn)
    angle = (sense * (np.arctan2(y - side.y, x - side.x) - side.start)) % (2.0 * math.pi)
    turn = abs(side.turn)
    beyond = angle > turn
    angle = np.where(beyond, np.where(angle - turn < 2.0 * math.pi - angle, turn, 0.0), angle)
    ux, uy = np.cos(side.start + sense * angle), np.sin(side.start + sense * angle)
    away = np.hypot(x - side.x - side.radius * ux, y - side.y - side.radius * uy)
    return away, side.radius * angle, -sense * ux, -sense * uy

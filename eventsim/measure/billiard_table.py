"""The table that a disk's centre sees: its area and perimeter, exact for straight and round walls and posts.

A centre keeps a disk's radius away from walls, and the sum of two radii from a post.  So its table is bounded by segments and
arcs that are parallel to these.  They are cut where they cross, and what lies within reach of another obstacle goes; the area
follows from Green's theorem.

Source of pi A / P, the mean free path of every planar billiard: N. Chernov, J. Stat. Phys. 88, 1 (1997),
doi:10.1007/BF02508462.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from eventsim.measure.sides import CLOSE, Bow, Line, Point, Side, crossings, joined, line_crossings
from eventsim.record.events import Floats
from eventsim.scene.domain import Box, Channel, Open
from eventsim.scene.scene import Scene
from eventsim.scene.walls import Arc, Circle, Ellipse, Part, Segment, parts_of

MOST_PIECES = 800
"""More pieces of boundary than this are not cut with each other: it takes a second."""

LOOKS = 16
"""Directions in which a disk looks for walls."""


class Table(NamedTuple):
    """Area, length^2, and perimeter, length, of the region of a centre."""

    area: float
    perimeter: float

    @property
    def mean_free_path(self) -> float:
        """Pi A / P, length; inf without a perimeter."""
        return math.pi * self.area / self.perimeter if self.perimeter > 0.0 else math.inf


def table_of(scene: Scene, radius: float, starts: Floats) -> Table | None:
    """The table that centres of a radius at places (K, 2) live in, in one or several parts.

    None where a part of it is the open plane, where there are too many pieces, and where an ellipse is not alone.
    """
    curved = [wall for wall in parts_of(scene.walls) if not isinstance(wall, Circle | Arc | Segment)]
    if curved:
        return _oval_table(scene, curved, starts)
    lined = _lined_parts(scene, radius, starts)
    if lined is None:
        return None
    parts, seen = lined
    area = sum(part.area for k, part in enumerate(parts) if k in seen or not part.hard)
    perimeter = sum(part.length for k, part in enumerate(parts) if k in seen and part.hard)
    return Table(area, perimeter) if area > 0.0 else None


def sides_of_table(scene: Scene, radius: float, starts: Floats) -> list[Side] | None:
    """The sides of the same table, each with the table to its left, in the order in which one goes on where another ends.

    None where it has no straight and round sides alone, and wherever `table_of` gives None.
    """
    if any(not isinstance(wall, Circle | Arc | Segment) for wall in parts_of(scene.walls)):
        return None
    lined = _lined_parts(scene, radius, starts)
    if lined is None:
        return None
    left = [lined[0][k] for k in sorted(lined[1]) if lined[0][k].hard]
    found: list[Side] = []
    while left:
        here = found[-1].at(1.0) if found else left[0].at(0.0)
        nearest = min(range(len(left)), key=lambda k: math.dist(here, left[k].at(0.0)))
        goes_on = math.dist(here, left[nearest].at(0.0)) < 8.0 * CLOSE * _Reach(scene, radius).size
        side = left.pop(nearest if goes_on else 0)
        both = joined(found[-1], side) if goes_on and found else None
        found[-1 if both else len(found) :] = [both or side]
    return found


def _lined_parts(scene: Scene, radius: float, starts: Floats) -> tuple[list[Side], set[int]] | None:
    """All parts of boundaries that a centre may touch, and which of them line the table of some places; None as above."""
    pieces = list(dict.fromkeys(_pieces(scene, radius)))  # edges that meet have one end
    if len(pieces) > MOST_PIECES:
        return None
    reach = _Reach(scene, radius)
    parts = [part for piece in pieces for part in _parts(piece, pieces, reach)]
    lined = _seen_from(parts, starts, reach)
    return None if lined is None else (parts, lined)


def _oval_table(scene: Scene, curved: list[Part], starts: Floats) -> Table | None:
    """The table of points in an ellipse, where nothing else is."""
    (wall, *others), alone = curved, len(scene.walls) == 1 and not np.isinf(scene.disks.mass).any()
    if others or not alone or not isinstance(wall, Ellipse):
        return None
    x, y = (starts - wall.center).T
    (a, b), (ex, ey) = wall.semi_axes, np.array(wall.direction) / math.hypot(*wall.direction)
    inside = np.all(((ex * x + ey * y) / a) ** 2 + ((ex * y - ey * x) / b) ** 2 <= 1.0)
    return Table(math.pi * a * b, wall.length()) if inside else None


def _pieces(scene: Scene, r: float) -> Iterator[Side]:
    """All boundaries of centres of radius r, not cut yet."""
    domain = scene.domain
    if not isinstance(domain, Open):
        (x0, y0), (width, height) = domain.origin, domain.size
        x1, y1 = x0 + width, y0 + height
        hard_x, hard_y = isinstance(domain, Box), isinstance(domain, Box | Channel)
        ix, iy = (r if hard_x else 0.0), (r if hard_y else 0.0)
        corners = [(x0 + ix, y0 + iy), (x1 - ix, y0 + iy), (x1 - ix, y1 - iy), (x0 + ix, y1 - iy)]
        for k, hard in enumerate((hard_y, hard_x, hard_y, hard_x)):
            yield Line(*corners[k], *corners[(k + 1) % 4], hard)
    for shift in _shifts(scene):
        for wall in parts_of(scene.walls):
            yield from _around(wall, r, shift)
        disks = scene.disks
        for k in np.flatnonzero(np.isinf(disks.mass)).tolist():
            place = disks.position[k] + shift
            yield Bow(float(place[0]), float(place[1]), float(disks.radius[k]) + r, math.pi, -2.0 * math.pi)


def _shifts(scene: Scene) -> list[Floats]:
    """Translations by periods that bring obstacles into the domain."""
    size = scene.domain.size
    if size is None:
        return [np.zeros(2)]
    along = [
        (-length, 0.0, length) if wraps else (0.0,) for length, wraps in zip(size, scene.domain.periodic, strict=True)
    ]
    return [np.array([dx, dy]) for dx in along[0] for dy in along[1]]


def _around(wall: Part, r: float, shift: Floats) -> Iterator[Side]:
    """What a wall keeps a centre away from."""
    sx, sy = float(shift[0]), float(shift[1])
    if isinstance(wall, Circle):
        if not shift.any():
            yield Bow(wall.center[0], wall.center[1], wall.radius - r, -math.pi, 2.0 * math.pi)
        return
    if not isinstance(wall, Arc | Segment):  # alone (`_oval_table`), or no table at all
        return
    ends = [(wall.start[0] + sx, wall.start[1] + sy), (wall.end[0] + sx, wall.end[1] + sy)]
    if isinstance(wall, Segment):
        (ax, ay), (bx, by) = ends
        length = math.hypot(bx - ax, by - ay)
        nx, ny = -(by - ay) / length * r, (bx - ax) / length * r
        yield Line(ax + nx, ay + ny, bx + nx, by + ny, hard=True)
        yield Line(bx - nx, by - ny, ax - nx, ay - ny, hard=True)
    else:
        (x, y), radius, start, turn = wall.sweep()
        if radius > r:
            bow = Bow(x + sx, y + sy, radius - r, start, turn)
            yield bow if turn > 0.0 else bow.cut(1.0, 0.0)
        bow = Bow(x + sx, y + sy, radius + r, start, turn)
        yield bow if turn < 0.0 else bow.cut(1.0, 0.0)
    if r > 0.0:
        for x, y in ends:
            yield Bow(x, y, r, math.pi, -2.0 * math.pi)


class _Reach:
    """How far places are from obstacles, beyond what the radius keeps away."""

    def __init__(self, scene: Scene, r: float) -> None:
        self.scene, self.r = scene, r
        posts = np.isinf(scene.disks.mass)
        self.posts, self.keep = scene.disks.position[posts], scene.disks.radius[posts] + r
        self.shifts = _shifts(scene)
        self.walls = [wall for wall in parts_of(scene.walls) if isinstance(wall, Circle | Arc | Segment)]
        size = scene.domain.size
        places = [p for wall in self.walls for p in _extent(wall)]
        if size is not None:
            self.size = max(size)
        else:
            places += scene.disks.position.tolist()
            self.size = float(np.ptp(np.array(places), axis=0).max()) if places else 1.0
        self.tolerance = CLOSE * self.size

    def free(self, x: float, y: float) -> bool:
        """Whether a centre may be at a place."""
        return all(self._free(x - float(shift[0]), y - float(shift[1])) for shift in self.shifts) and self._inside(x, y)

    def _inside(self, x: float, y: float) -> bool:
        domain, slack = self.scene.domain, self.tolerance
        if isinstance(domain, Open):
            return True
        (x0, y0), (width, height) = domain.origin, domain.size
        ix = self.r if isinstance(domain, Box) else 0.0
        iy = self.r if isinstance(domain, Box | Channel) else 0.0
        return ix - slack <= x - x0 <= width - ix + slack and iy - slack <= y - y0 <= height - iy + slack

    def _free(self, x: float, y: float) -> bool:
        slack = self.tolerance
        if len(self.posts) and (np.hypot(self.posts[:, 0] - x, self.posts[:, 1] - y) < self.keep - slack).any():
            return False
        for wall in self.walls:
            if isinstance(wall, Circle):
                if math.hypot(x - wall.center[0], y - wall.center[1]) > wall.radius - self.r + slack:
                    return False
            elif self.r > 0.0 and _distance(wall, x, y) < self.r - slack:
                return False
        return True


def _extent(wall: Segment | Arc | Circle) -> list[Point]:
    if isinstance(wall, Circle):
        (x, y), r = wall.center, wall.radius
        return [(x - r, y - r), (x + r, y + r)]
    return [wall.start, wall.end] if isinstance(wall, Segment) else [wall.start, wall.through, wall.end]


def _distance(wall: Segment | Arc, x: float, y: float) -> float:
    """From a place to a wall."""
    ends = min(math.hypot(x - px, y - py) for px, py in (wall.start, wall.end))
    if isinstance(wall, Segment):
        line = Line(*wall.start, *wall.end, hard=True)
        share = line.share_of(x, y)
        if 0.0 < share < 1.0:
            px, py = line.at(share)
            return math.hypot(x - px, y - py)
        return ends
    (cx, cy), radius, start, turn = wall.sweep()
    if Bow(cx, cy, radius, start, turn).share_of(x, y) <= 1.0:
        return min(ends, abs(math.hypot(x - cx, y - cy) - radius))
    return ends


def _parts(piece: Side, pieces: Iterable[Side], reach: _Reach) -> Iterator[Side]:
    """The parts of a piece that bound the table."""
    if not piece.length > reach.tolerance:
        return
    cuts = {0.0, 1.0}
    for other in pieces:
        if other is not piece:
            ends = [p for p in (other.at(0.0), other.at(1.0)) if piece.off(*p) < reach.tolerance]  # where they touch
            cuts.update(share for p in crossings(piece, other) + ends if 0.0 < (share := piece.share_of(*p)) < 1.0)
    ordered = sorted(cuts)
    for low, high in pairwise(ordered):
        part = piece.cut(low, high)
        if part.length > reach.tolerance and reach.free(*part.at(0.5)):
            yield part


def _seen_from(parts: list[Side], starts: Floats, reach: _Reach) -> set[int] | None:
    """Which hard parts line the table of some places; None where one looks into the open.

    Looks go on from every part that was seen: straight away from it and to both sides; and the part that goes on where it
    ends, if there is but one, lines the table too.
    """
    open_plane = isinstance(reach.scene.domain, Open)
    far = 4.0 * reach.size
    turns = [2.0 * math.pi * (k + 0.37) / LOOKS for k in range(LOOKS)]
    looks = [(float(x), float(y), math.cos(t), math.sin(t)) for x, y in starts for t in turns]
    seen: set[int] = set()
    known: list[int] = []
    while looks or known:
        if known:
            hit = known.pop()
        else:
            x, y, dx, dy = looks.pop()
            first = _first_hit(parts, x, y, dx, dy, far, reach)
            if first is None:
                if open_plane:
                    return None
                continue
            hit = first
        if hit in seen:
            continue
        seen.add(hit)
        known += _next(parts, hit, reach)
        part = parts[hit]
        for share in (0.03, 0.5, 0.97):
            (px, py), (nx, ny) = part.at(share), part.normal(share)
            px, py = px + 4.0 * reach.tolerance * nx, py + 4.0 * reach.tolerance * ny
            looks += [(px, py, nx, ny), (px, py, nx - 0.9 * ny, ny + 0.9 * nx), (px, py, nx + 0.8 * ny, ny - 0.8 * nx)]
    return seen


def _next(parts: list[Side], k: int, reach: _Reach) -> list[int]:
    """The parts that meet part k at its ends, where there is but one that can."""
    found = []
    for here, there in ((1.0, 0.0), (0.0, 1.0)):
        x, y = parts[k].at(here)
        near = [
            other
            for other, part in enumerate(parts)
            if other != k and math.hypot(part.at(there)[0] - x, part.at(there)[1] - y) < 8.0 * reach.tolerance
        ]
        found += near if len(near) == 1 else []
    return found


def _first_hit(parts: list[Side], x: float, y: float, dx: float, dy: float, far: float, reach: _Reach) -> int | None:
    """The part that a look meets first; in a periodic domain it goes on in the images."""
    best, found = math.inf, None
    size = reach.scene.domain.size
    images: list[Point] = [(0.0, 0.0)]
    if size is not None:
        spans = [(-2, -1, 0, 1, 2) if wraps else (0,) for wraps in reach.scene.domain.periodic]
        images = [(i * size[0], j * size[1]) for i in spans[0] for j in spans[1]]
    for sx, sy in images:
        line = Line(x - sx, y - sy, x - sx + far * dx, y - sy + far * dy, hard=False)
        for k, part in enumerate(parts):
            if not part.hard:
                continue
            for p in line_crossings(line, part):
                share = line.share_of(*p)
                along = part.share_of(*p)
                if not (0.0 < share < best and -CLOSE <= along <= 1.0 + CLOSE):
                    continue
                nx, ny = part.normal(along)
                if nx * dx + ny * dy < 0.0:
                    best, found = share, k
    return found

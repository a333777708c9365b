"""The rules of walls: shapes that are shapes, and names that tell them apart."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import TYPE_CHECKING, Any

from eventsim.scene.domain import BOUNDARY_NAMES, Domain, Open
from eventsim.scene.numbers import LENGTHS, LONGEST, SHORTEST, Point, is_length, is_place
from eventsim.scene.outlines import bounds, circle_through
from eventsim.scene.walls import Arc, Circle, Polygon, Polyline, Segment, Wall, features, wall_names

if TYPE_CHECKING:
    from eventsim.scene.scene import Scene

# Each period that a wall stretches over is one more image to look at.
MOST_PERIODS = 1000


def wall_problems(scene: Scene) -> list[str]:
    """Every rule that the walls of a scene break, one sentence each."""
    problems = list(_name_problems(scene.walls))
    for i, wall in enumerate(scene.walls):
        broken = list(shape_problems(wall)) or list(_period_problems(wall, scene.domain))
        problems += [f"wall[{i}]{key}" for key in broken]
    return problems


def _name_problems(walls: tuple[Wall, ...]) -> Iterator[str]:
    """Names are unique in the log, edges included, and fit into a line of it."""
    owner: dict[str, int] = {}
    for i, (wall, name) in enumerate(zip(walls, wall_names(walls), strict=True)):
        if not name.strip() or any(mark in name for mark in ',"\n\r'):
            rule = "must not be empty nor hold a comma, a quotation mark or a line end"
            yield f"wall[{i}].name = {name!r}: {rule}"
        elif name in BOUNDARY_NAMES:
            yield f"wall[{i}].name = {name!r}: left, right, bottom and top are the sides of the domain"
        edges = len(wall.edges()) if isinstance(wall, Polygon | Polyline) else 0
        taken = {name, *(f"{name}.{k}" for k in range(edges))}
        for used in sorted(taken & owner.keys()):
            yield f"wall[{i}]: the name {used!r} is taken by wall[{owner[used]}]: names must be unique"
        owner |= dict.fromkeys(taken, i)


def key_problems(values: Mapping[str, Any]) -> Iterator[str]:
    """Rules of the single values of a wall, by key; some may be missing. Each problem begins with the key that breaks it."""
    if "radius" in values and not is_length(values["radius"]):
        yield f".radius = {values['radius']}: {LENGTHS}"
    keys = {f".{key}": values[key] for key in ("center", "start", "through", "end") if key in values}
    keys |= {f".points[{k}]": p for k, p in enumerate(values.get("points", ()))}
    for key, p in keys.items():
        if not is_place(p):
            yield f"{key} = {list(p)}: must be two finite numbers, at most {LONGEST}"


def shape_problems(wall: Wall) -> Iterator[str]:
    """Rules of one wall, each beginning with the key that breaks it."""
    broken = list(key_problems({item.name: getattr(wall, item.name) for item in fields(wall)}))
    yield from broken
    if broken:
        return
    if isinstance(wall, Segment) and wall.start == wall.end:
        yield f": start and end are the same point {wall.start}: a segment needs a length"
    elif isinstance(wall, Segment):
        yield from _length_problems("", wall.start, wall.end)
    elif isinstance(wall, Arc) and not _is_round(wall):
        yield (
            f": start {wall.start}, through {wall.through} and end {wall.end} do not determine a circle:"
            " they must be three points that are not on a line (use a segment)"
        )
    elif not isinstance(wall, Segment | Arc | Circle):
        least = 3 if isinstance(wall, Polygon) else 2
        if len(wall.points) < least:
            yield f".points has {len(wall.points)} point(s): a {wall.kind} needs at least {least}"
            return
        for k, (start, end) in enumerate(wall.edges()):
            if start == end:
                hint = " (a polygon closes by itself)" if k == len(wall.points) - 1 else ""
                yield f".points[{k}] and the next point are the same, {start}: an edge needs a length{hint}"
            else:
                yield from _length_problems(f".points[{k}]", start, end)


def _length_problems(key: str, start: Point, end: Point) -> Iterator[str]:
    """The rule that the square of an edge's length is a number."""
    length = math.dist(start, end)
    if length < SHORTEST:
        yield f"{key}: the edge from {start} to {end} has the length {length}: must be at least {SHORTEST}"


def _is_round(arc: Arc) -> bool:
    """Whether three points determine a circle that floats can hold."""
    (x, y), radius = circle_through(arc.start, arc.through, arc.end)
    chords = math.dist(arc.start, arc.through), math.dist(arc.through, arc.end)
    return is_place((x, y)) and is_length(radius) and min(chords) >= SHORTEST


def _period_problems(wall: Wall, domain: Domain) -> Iterator[str]:
    """Rules of a wall in a domain that repeats: a bounded number of images, and none of a container.

    Disks cannot be inside a container and inside its image, so it must not stick out of a period.
    """
    if isinstance(domain, Open) or not is_place(domain.origin) or not all(map(is_length, domain.size)):
        return
    for axis in (0, 1):
        if not domain.periodic[axis]:
            continue
        length, letter = domain.size[axis], "xy"[axis]
        if isinstance(wall, Circle):
            low = wall.center[axis] - wall.radius - domain.origin[axis]
            if low < 0.0 or low + 2.0 * wall.radius > length:
                yield f".radius = {wall.radius}: the circle must not reach beyond the period in {letter}"
            continue
        extents = [bounds(feature) for feature in features([wall])]
        if max(high[axis] - low[axis] for low, high in extents) > MOST_PERIODS * length:
            yield f": must not stretch over more than {MOST_PERIODS} periods in {letter} (an arc: its whole circle)"

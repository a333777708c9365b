"""What every wall of a scene knows: all that reading, checking, staging and drawing a scene ask of it."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import MISSING, dataclass, fields
from fractions import Fraction
from itertools import product
from typing import Any, ClassVar, TypeAlias

import numpy as np
from numpy.typing import NDArray

from eventsim.errors import SceneError
from eventsim.formulas.walls.shape import Shape
from eventsim.scene.disks import Floats
from eventsim.scene.manner import Manner, manner_problems
from eventsim.scene.numbers import (
    LENGTHS,
    LONGEST,
    SHORTEST,
    Point,
    is_length,
    is_place,
    number,
    optional_number,
    point,
)

Bounds: TypeAlias = tuple[Point, Point]
"""A rectangle: its lower-left and its upper-right corner."""

POINT, POINTS, LENGTH, NAME, OWN = "Point", "tuple[Point, ...]", "float", "str | None", "float | None"
"""The types that a wall's keys may have, as its class writes them."""


MOST_PERIODS = 1000
"""Each period that a wall stretches over is one more image to look at."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Wall(Manner, ABC):
    """A wall at rest that reflects every disk.

    Its class is a frozen dataclass.  The fields are the keys of its [[wall]] table, each a Point, a tuple[Point, ...] or a float,
    which is a length; a name; and what every wall may have of its own (`Manner`).  One with a default may be left out.

    Attributes:
        kind: what a scene file calls it.
        made_of: the shapes that `pieces` gives.
        holds: whether disks live inside of it, so that it has no periodic images.
        for_points: whether only points that fly straight can meet it.
        scatters: whether flights that meet it forget where they come from, as at an arc; False keeps a billiard integrable.
    """

    kind: ClassVar[str]
    made_of: ClassVar[tuple[type[Shape], ...]]
    holds: ClassVar[bool] = False
    scatters: ClassVar[bool] = True
    for_points: ClassVar[bool] = False

    def __post_init__(self) -> None:
        """Store points and lengths as floats.

        Raises:
            SceneError: if a value is not what its key says.
        """
        for key, kind in keys_of(type(self)).items():
            if kind in _IN_FLOATS:
                object.__setattr__(self, key, _IN_FLOATS[kind](getattr(self, key), f"wall.{key}"))

    @property
    def name(self) -> str | None:
        """Its name; None for the usual one."""
        return None

    @abstractmethod
    def parts(self, name: str) -> tuple[Part, ...]:
        """What has a name of its own in the log, if the wall is called `name`: the wall itself, of a chain its edges."""

    @abstractmethod
    def pieces(self, moved: Callable[[Point], Point]) -> list[tuple[Shape, int]]:
        """The shapes that disks meet, each with the number of its part; `moved` says where a point is on the stage."""

    def contains(self, position: Floats) -> NDArray[np.bool_] | None:
        """Which places `position` (M, 2) lie inside of a closed wall; None for one that is not closed."""
        return None

    @abstractmethod
    def shape_problems(self) -> Iterator[str]:
        """Rules of a shape whose single numbers are sound; each problem begins with the key that breaks it."""

    @classmethod
    def number_problems(cls, values: Mapping[str, Any]) -> Iterator[str]:
        """Rules of single values by key, of which some may be missing; each problem begins with the key that breaks it."""
        for key, kind in keys_of(cls).items():
            if key in values and kind == LENGTH and not is_length(values[key]):
                yield f".{key} = {values[key]}: {LENGTHS}"
            elif key in values and kind in (POINT, POINTS):
                places = {key: values[key]}
                if kind == POINTS:
                    places = {f"{key}[{k}]": place for k, place in enumerate(values[key])}
                for name, place in places.items():
                    if not is_place(place):
                        yield f".{name} = {list(place)}: must be two finite numbers, at most {LONGEST}"
        yield from manner_problems(values)

    def period_problems(self, axis: int, origin: float, length: float) -> Iterator[str]:
        """Rules along an `axis` that repeats, a `length` from `origin` on; each begins with the key that breaks it."""
        low, high = self.rectangle()
        if high[axis] - low[axis] > MOST_PERIODS * length:
            letter = "xy"[axis]
            yield f": must not stretch over more than {MOST_PERIODS} periods in {letter} (an arc: its whole circle)"

    def most_periods(self, period: Sequence[float]) -> float:
        """Over how many periods it stretches, in x times in y; period: of each axis, inf where it has none."""
        low, high = self.rectangle()
        return math.prod(max((high[k] - low[k]) / period[k], 1.0) for k in (0, 1))

    def rectangle(self) -> Bounds:
        """The rectangle that all of its parts lie in."""
        found = [part.bounds() for part in self.parts("")]
        x0, y0 = (min(low[axis] for low, _ in found) for axis in (0, 1))
        x1, y1 = (max(high[axis] for _, high in found) for axis in (0, 1))
        return (x0, y0), (x1, y1)

    def image_problems(self, period: Sequence[float]) -> Iterator[str]:
        """Pieces that lie on images of themselves; period: of each axis, inf where it has none."""
        for part in self.parts(""):
            yield from part.own_image_problems(period)

    def problems(self) -> Iterator[str]:
        """Every rule that the wall breaks, each problem beginning with the key that breaks it."""
        broken = list(self.number_problems({key: getattr(self, key) for key in keys_of(type(self))}))
        yield from broken or self.shape_problems()


@dataclass(frozen=True, slots=True, kw_only=True)
class Part(Wall):
    """A wall that is one piece, with one name in the log.

    sides: what its left or inner side and its right or outer side are called; empty where disks meet but one.
    """

    sides: ClassVar[tuple[str, str]] = ("", "")

    @abstractmethod
    def bounds(self) -> Bounds:
        """A rectangle that the piece lies in."""

    def own_image_problems(self, period: Sequence[float]) -> Iterator[str]:
        """As `image_problems`, of this piece by `period`: what bends lies on no image of itself."""
        return iter(())

    def span(self, axis: int) -> tuple[Fraction, Fraction]:
        """Where its points, as they are given, begin and end along an axis, exactly."""
        places = [Fraction(getattr(self, key)[axis]) for key, kind in keys_of(type(self)).items() if kind == POINT]
        return min(places), max(places)

    @abstractmethod
    def depth(self, position: Floats, radius: Floats | float) -> Floats:
        """How deep disks at `position` (M, 2) reach into the piece, or out of one that holds them, (M,)."""

    @abstractmethod
    def outline(self) -> Floats:
        """The piece as a line of points (K, 2)."""

    def length(self) -> float:
        """How long it is; here, as long as its outline."""
        steps = np.diff(self.outline(), axis=0)
        return float(np.hypot(steps[:, 0], steps[:, 1]).sum())

    def curvature_radius(self) -> float:
        """The radius of what is round; 0 of what is straight."""
        return 0.0

    def scale(self, corner: Point = (0.0, 0.0)) -> float:
        """The largest length that the piece is rounded to, as given and counted from a corner."""
        points = [getattr(self, key) for key, kind in keys_of(type(self)).items() if kind == POINT]
        places = [max(abs(p[k]), abs(p[k] - corner[k])) for p in points for k in (0, 1)]
        return float(max(self.curvature_radius(), *places))


def keys_of(kind: type[Wall]) -> dict[str, str]:
    """The keys of the [[wall]] table of a kind, with the types that the class writes; what all have, last."""
    return {item.name: str(item.type) for item in sorted(fields(kind), key=lambda item: item.kw_only is True)}


def optional_keys(kind: type[Wall]) -> frozenset[str]:
    """Those of them that may be left out."""
    return frozenset(item.name for item in fields(kind) if item.default is not MISSING)


def shifts(bounds: Bounds, corner: Point, period: Point, reach: float) -> list[Point]:
    """The translations by periods (inf: none) that bring a wall within reach of a domain with this corner; the nearest first."""

    def along(axis: int) -> list[float]:
        length = period[axis]
        if math.isinf(length):
            return [0.0]
        low, high = (bound[axis] - corner[axis] for bound in bounds)
        near = min(reach, length)  # of what is wider than a period the nearest images tell all there is
        first, last = math.ceil((-near - high) / length), math.floor((length + near - low) / length)
        return sorted((k * length for k in range(first, last + 1)), key=abs)

    return list(product(along(0), along(1)))


def length_problems(key: str, start: Point, end: Point) -> Iterator[str]:
    """The rule that the square of an edge's length is a number."""
    length = math.dist(start, end)
    if length < SHORTEST:
        yield f"{key}: the edge from {start} to {end} has the length {length}: must be at least {SHORTEST}"


def distances(position: Floats, center: Point) -> Floats:
    """Distances (M,) of positions (M, 2) from a point."""
    distance: Floats = np.hypot(position[:, 0] - center[0], position[:, 1] - center[1])
    return distance


def _chain(value: Any, key: str) -> tuple[Point, ...]:
    try:
        points = tuple(value)
    except TypeError:
        raise SceneError(f"{key} = {value!r}: must be a list of points") from None
    return tuple(point(p, f"{key}[{i}]") for i, p in enumerate(points))


_IN_FLOATS: dict[str, Callable[[Any, str], Any]] = {POINT: point, POINTS: _chain, LENGTH: number, OWN: optional_number}

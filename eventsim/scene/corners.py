"""Corners of two walls that hold a disk under gravity: which of those that it met last make one with what it meets now."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from eventsim.formulas.corner import holds, slides_into
from eventsim.formulas.real import Real, is_float
from eventsim.formulas.rest import LEFT, SUPPORTED
from eventsim.scene.stage import Stage


class Corner(NamedTuple):
    """The place of the wall met last, whether the disk rests on that, and its normal; the normal of the wall met now."""

    place: int
    rests: bool
    first: tuple[Real, Real]
    second: tuple[Real, Real]


def corners_of(
    stage: Stage, met: Sequence[tuple[int, int, int]], place: int, side: int, x: Real, y: Real
) -> Iterator[Corner]:
    """The corners that a wall, met from a side, makes with others that a disk at (x, y) met last, and that hold it."""
    assert stage.gravity is not None
    for corner in _beside(stage, met, place, side, x, y):
        if holds(*corner.first, *corner.second, *stage.gravity):
            yield corner


def _beside(
    stage: Stage, met: Sequence[tuple[int, int, int]], place: int, side: int, x: Real, y: Real
) -> Iterator[Corner]:
    """All of them; none where nothing settles.  Walls in line make none."""
    others = [last for last in met if last[0] < 0 and last[2] != LEFT and not _is_one(stage, place, -1 - last[0])]
    if not others or not stage.settles or not is_float(x):
        return
    second = stage.normal(place, side, x, y)
    for wall, from_side, how in others:
        yield Corner(-1 - wall, how == SUPPORTED, stage.normal(-1 - wall, from_side, x, y), second)


def _is_one(stage: Stage, place: int, other: int) -> bool:
    """Whether two walls are one, or in line."""
    if place == other or stage.supports is None:
        return place == other
    one, last = stage.supports[place], stage.supports[other]
    return one is not None and last is not None and one.line == last.line


def is_cornered(stage: Stage, met: Sequence[tuple[int, int, int]], place: int, side: int, x: Real, y: Real) -> bool:
    """Whether a disk that comes to rest on a wall would be pressed onto another one as well that it met last."""
    gravity = stage.gravity
    if gravity is None:
        return False
    return any(slides_into(*corner.second, *corner.first, *gravity) for corner in _beside(stage, met, place, side, x, y))

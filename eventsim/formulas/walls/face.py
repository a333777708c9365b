"""The straight part of a segment, hard on both sides; its ends are posts."""

import math
from typing import NamedTuple

from eventsim.formulas.crossing import closing_delay, reopening_delay
from eventsim.formulas.real import NEVER, Acceleration, Real


class Face(NamedTuple):
    """A segment from (x, y) along (ex, ey); normal (nx, ny), not of unit length; norm = |n|; norm2 = n.n; along2 = e.e."""

    x: float
    y: float
    ex: float
    ey: float
    nx: float
    ny: float
    norm: float
    norm2: float
    along2: float


def face(x0: float, y0: float, x1: float, y1: float) -> Face:
    """The face from (x0, y0) to (x1, y1).  Parallel to an axis: a unit normal, so that reflection is exact."""
    ex, ey = x1 - x0, y1 - y0
    if ex == 0.0:
        nx, ny = -math.copysign(1.0, ey), 0.0
    elif ey == 0.0:
        nx, ny = 0.0, math.copysign(1.0, ex)
    else:
        nx, ny = -ey, ex
    norm2 = nx * nx + ny * ny
    return Face(x0, y0, ex, ey, nx, ny, math.sqrt(norm2), norm2, ex * ex + ey * ey)


def face_side(shape: Face, x: Real, y: Real, vx: Real, vy: Real) -> int:
    """The side of the face that a centre is on; a point exactly on the line is on the side that it moves to."""
    distance = shape.nx * (x - shape.x) + shape.ny * (y - shape.y)
    if distance > 0.0:
        return 1
    if distance < 0.0:
        return -1
    return 1 if shape.nx * vx + shape.ny * vy > 0.0 else -1


def face_normal(shape: Face, side: int) -> tuple[float, float]:
    """The normal, of any length, that points to the disk."""
    return side * shape.nx, side * shape.ny


def face_delay(
    shape: Face,
    x: Real,
    y: Real,
    vx: Real,
    vy: Real,
    gx: Acceleration,
    gy: Acceleration,
    radius: Real,
    met: int,
) -> tuple[Real, int]:
    """(delay, side) of the next contact with the face; met: the side last met, 0 if another contact came since."""
    if gx is None and met != 0:
        return NEVER, met
    distance = shape.nx * (x - shape.x) + shape.ny * (y - shape.y)
    rate = shape.nx * vx + shape.ny * vy
    width = radius * shape.norm
    side = met if met != 0 else face_side(shape, x, y, vx, vy)
    if gx is None:
        delay = closing_delay(side * distance - width, side * rate, None)
        if delay < NEVER and _within(shape, x + vx * delay, y + vy * delay):
            return delay, side
        return NEVER, side
    fall = shape.nx * gx + shape.ny * gy
    delay = closing_delay(side * distance - width, side * rate, side * fall)
    if delay < NEVER and _within(shape, x + delay * (vx + (0.5 * gx) * delay), y + delay * (vy + (0.5 * gy) * delay)):
        return delay, side
    delay = reopening_delay(-(side * distance) - width, -(side * rate), -(side * fall))
    if delay < NEVER and _within(shape, x + delay * (vx + (0.5 * gx) * delay), y + delay * (vy + (0.5 * gy) * delay)):
        return delay, -side
    return NEVER, side


def _within(shape: Face, x: Real, y: Real) -> bool:
    """Whether the foot of a centre lies on the segment, ends included."""
    along = shape.ex * (x - shape.x) + shape.ey * (y - shape.y)
    return bool(not along < 0.0 and not along > shape.along2)

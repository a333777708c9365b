"""Round walls: a post (a point), a container (a circle from inside), an arc (hard on both sides; its ends are posts)."""

from typing import NamedTuple

from eventsim.formulas.contact import circle_delay, leaving_delay
from eventsim.formulas.parabola import NO_OVERLAP, PRESENT_OVERLAP, circle_delays
from eventsim.formulas.real import NEVER, Acceleration, Real, sqrt


class Post(NamedTuple):
    """A hard point at (x, y)."""

    x: float
    y: float


class Container(NamedTuple):
    """A circle around (x, y); disks live inside."""

    x: float
    y: float
    radius: float


class Arc(NamedTuple):
    """The part of a circle that lies beyond its chord: from (x0, y0) along (ex, ey), on the side where the cross product has
    the given sign."""

    x: float
    y: float
    radius: float
    x0: float
    y0: float
    ex: float
    ey: float
    sign: float


def arc(x0: float, y0: float, xm: float, ym: float, x1: float, y1: float) -> Arc:
    """The arc from (x0, y0) through (xm, ym) to (x1, y1): the circle through three points, not on one line."""
    ax, ay = xm - x0, ym - y0
    bx, by = x1 - x0, y1 - y0
    cross = ax * by - ay * bx
    a2, b2 = ax * ax + ay * ay, bx * bx + by * by
    ux, uy = (by * a2 - ay * b2) / (2.0 * cross), (ax * b2 - bx * a2) / (2.0 * cross)
    sign = 1.0 if bx * ay - by * ax > 0.0 else -1.0
    return Arc(x0 + ux, y0 + uy, float(sqrt(ux * ux + uy * uy)), x0, y0, bx, by, sign)


def round_normal(shape: Post | Container | Arc, side: int, x: Real, y: Real) -> tuple[Real, Real]:
    """The normal, of any length, that points to a disk at (x, y): away from the centre outside (+1), to it inside (-1)."""
    return side * (x - shape.x), side * (y - shape.y)


def post_delay(
    shape: Post,
    x: Real,
    y: Real,
    vx: Real,
    vy: Real,
    gx: Acceleration,
    gy: Acceleration,
    radius: Real,
    met: int,
) -> tuple[Real, int]:
    """(delay, 1) of the next contact with a post."""
    if gx is None:
        return _straight_to_post(shape, x, y, vx, vy, radius, met)
    if gx == 0.0 and gy == 0.0:  # an immovable disk, on which gravity does not act
        return _straight_to_post(shape, x, y, vx, vy, radius, met)
    return circle_delays(x - shape.x, y - shape.y, vx, vy, gx, gy, radius, 1.0)[0], 1


def _straight_to_post(shape: Post, x: Real, y: Real, vx: Real, vy: Real, radius: Real, met: int) -> tuple[Real, int]:
    if met != 0:
        return NEVER, 1
    return circle_delay(x, y, vx, vy, radius, shape.x, shape.y, 0.0), 1


def container_delay(
    shape: Container,
    x: Real,
    y: Real,
    vx: Real,
    vy: Real,
    gx: Acceleration,
    gy: Acceleration,
    radius: Real,
    met: int,
) -> tuple[Real, int]:
    """(delay, -1) of the next contact with the container from inside."""
    if gx is None:
        return leaving_delay(x, y, vx, vy, radius, shape.x, shape.y, shape.radius), -1
    if gx == 0.0 and gy == 0.0:
        return leaving_delay(x, y, vx, vy, radius, shape.x, shape.y, shape.radius), -1
    return circle_delays(x - shape.x, y - shape.y, vx, vy, gx, gy, shape.radius - radius, -1.0)[0], -1


def on_arc(shape: Arc, x: Real, y: Real) -> bool:
    """Whether the ray from the centre of the circle through (x, y) meets the arc: its foot lies beyond the chord."""
    dx, dy = x - shape.x, y - shape.y
    distance = sqrt(dx * dx + dy * dy)
    if not distance > 0.0:
        return False
    scale = shape.radius / distance
    fx, fy = (shape.x + dx * scale) - shape.x0, (shape.y + dy * scale) - shape.y0
    return bool(not shape.sign * (shape.ex * fy - shape.ey * fx) < 0.0)


def arc_side(shape: Arc, x: Real, y: Real, vx: Real, vy: Real) -> int:
    """+1 outside the circle of the arc, -1 inside; a point exactly on it is on the side that it moves to."""
    dx, dy = x - shape.x, y - shape.y
    excess = (dx * dx + dy * dy) - shape.radius * shape.radius
    if excess > 0.0:
        return 1
    if excess < 0.0:
        return -1
    return 1 if dx * vx + dy * vy > 0.0 else -1


def arc_delay(
    shape: Arc,
    x: Real,
    y: Real,
    vx: Real,
    vy: Real,
    gx: Acceleration,
    gy: Acceleration,
    radius: Real,
    met: int,
) -> tuple[Real, int]:
    """(delay, side) of the next contact with the arc: with its outside at radius R + r, with its inside at R - r.

    A disk that is outside may pass through the open part and meet the inside, and the other way round.
    """
    if gx is None:
        return _straight_to_arc(shape, x, y, vx, vy, radius, met)
    if gx == 0.0 and gy == 0.0:
        return _straight_to_arc(shape, x, y, vx, vy, radius, met)
    dx, dy = x - shape.x, y - shape.y
    side = met if met != 0 else arc_side(shape, x, y, vx, vy)
    outer, inner = shape.radius + radius, shape.radius - radius
    best, best_side = NEVER, side
    for face_side in (1, -1):
        reach = outer if face_side > 0 else inner
        if not reach > 0.0 and not (reach == 0.0 and face_side > 0):
            continue
        overlap = PRESENT_OVERLAP if face_side == side else NO_OVERLAP
        first, second = circle_delays(dx, dy, vx, vy, gx, gy, reach, float(face_side), overlap)
        for delay in (first, second):
            if delay < best and on_arc(
                shape, x + delay * (vx + (0.5 * gx) * delay), y + delay * (vy + (0.5 * gy) * delay)
            ):
                best, best_side = delay, face_side
    return best, best_side


def _straight_to_arc(shape: Arc, x: Real, y: Real, vx: Real, vy: Real, radius: Real, met: int) -> tuple[Real, int]:
    side = met if met != 0 else arc_side(shape, x, y, vx, vy)
    best, best_side = NEVER, side
    if side > 0 and met == 0:
        delay = circle_delay(x, y, vx, vy, radius, shape.x, shape.y, shape.radius)
        if delay < best and on_arc(shape, x + vx * delay, y + vy * delay):
            best, best_side = delay, 1
    if shape.radius - radius > 0.0 and (side < 0 or best == NEVER):
        delay = _inner_from(shape, x, y, vx, vy, radius, side)
        if delay < best and on_arc(shape, x + vx * delay, y + vy * delay):
            best, best_side = delay, -1
    return best, best_side


def _inner_from(shape: Arc, x: Real, y: Real, vx: Real, vy: Real, radius: Real, side: int) -> Real:
    """Contact with the inside of a circle, for a disk that is inside or will be: a flight from outside must pass through it."""
    if side > 0:
        entered = circle_delay(x, y, vx, vy, -radius, shape.x, shape.y, shape.radius)
        if not entered < NEVER:
            return NEVER
    return leaving_delay(x, y, vx, vy, radius, shape.x, shape.y, shape.radius)

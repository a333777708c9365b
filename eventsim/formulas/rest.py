"""Coming to rest on a flat wall under gravity: when a series of bounces is over, and how the disk slides from there on.

A disk that leaves a wall at speed v against the pull a flies for 2 v / a, then for e times as long, and so on: after
2 v / (a (1 - e)), the Zeno time, infinitely many bounces are over.  The series is cut where float64 cannot tell it from its
end, and the disk is supported: it has the part of gravity that is along the wall, until the next impulse or the wall's end.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

from eventsim.formulas.crossing import closing_delay, crossing_delay
from eventsim.formulas.real import NEVER, Real
from eventsim.formulas.walls.face import TOUCHING, Face, face_side, slope
from eventsim.formulas.walls.shape import Shape

AT_ONCE = 2.0**-48
"""Events closer than this part of the clock are at one instant: a few of its last bits."""

LATEST = 1024.0
"""A Zeno time further off than so many instants, of an almost elastic disk, is not waited for: it would fall through the wall."""

STRUCK, SUPPORTED, LEFT = 0, 1, 2
"""What a contact with a wall is, and what the disk remembers of it: an impact; it came to rest there; it slid over the end."""


def is_still(x: Real, y: Real, u0: Real, w0: Real, u1: Real, w1: Real, lag: Real) -> bool:
    """Whether a flight to (x, y), with these velocities at its ends, was shorter than the last bits of the place."""
    way = (abs(u0) + abs(w0) + abs(u1) + abs(w1)) * lag
    return bool(not way > TOUCHING * (abs(x) + abs(y)))


class Support(NamedTuple):
    """A straight wall that disks may rest on.

    face: its line; of a wall of the domain, a piece of unit length.  ax, ay: gravity along it, what a disk on it has.  low,
    high: where the support ends, in terms of e.(p - start); walls that go on in line belong to it, a wall of the domain has
    no end.
    """

    face: Face
    ax: float
    ay: float
    low: float
    high: float


class Held(NamedTuple):
    """The wall that a disk rests on (SUPPORTED) or has slid over the end of (LEFT): its place, the disk's side, which of both."""

    place: int
    side: int
    how: int


def held_by(met: tuple[tuple[int, int, int], ...]) -> Held | None:
    """What a disk that remembers `met` is held by; None where it is free of all walls."""
    if len(met) == 1 and met[0][0] < 0 and met[0][2] != STRUCK:
        return Held(-1 - met[0][0], met[0][1], met[0][2])
    return None


def rest_delay(gap: Real, rate: Real, fall: Real, scale: Real, restitution: Real, t: Real) -> Real:
    """The delay until a disk that touches a flat wall has come to rest there; NEVER if it is to bounce on.

    gap, rate, fall: of its distance from contact, in terms of the wall's normal.  scale: the coordinates that the gap was
    calculated from.  t: the clock at the beginning of the flight.

    It rests at its Zeno time where the next flight is over at the same instant of the clock; at once where a bounce is no higher
    than those that rounding keeps up: the energy of a gap that it has left is lost with v^2 = 2 a gap / (1 - e^2).  (On a wall of
    the domain there is no such gap, and forty and more halvings of a flight are rows.)
    """
    if not fall < 0.0:
        return NEVER
    if gap > TOUCHING * scale or gap < -(TOUCHING * scale):
        return NEVER
    if not rate < 0.0:
        instant = AT_ONCE * t
        flight = (2.0 * rate) / -fall
        if not rate > 0.0:
            return 0.0
        if not flight > instant:
            late = LATEST * instant
            return flight / (1.0 - restitution) if flight < (1.0 - restitution) * late else late
    loss = 1.0 - restitution * restitution if restitution < 1.0 else 1.0
    noise, bounce = (-8.0 * fall) * gap, loss * (rate * rate)
    if bounce > noise and bounce > -noise:
        return NEVER
    return 0.0


def rest_on_face_delay(
    shape: Face,
    side: int,
    low: float,
    high: float,
    x: Real,
    y: Real,
    vx: Real,
    vy: Real,
    gx: Real,
    gy: Real,
    radius: Real,
    restitution: Real,
    t: Real,
) -> Real:
    """The same for a face that supports from `low` to `high` of its e.(p - start); at an end nothing rests that moves out."""
    nx, ny = side * shape.nx, side * shape.ny
    fall = nx * gx + ny * gy
    if not fall < 0.0:
        return NEVER
    gap = (nx * (x - shape.x) + ny * (y - shape.y)) - radius * shape.norm
    scale = shape.norm * (abs(x) + abs(y) + abs(shape.x) + abs(shape.y) + radius)
    delay = rest_delay(gap, nx * vx + ny * vy, fall, scale, restitution, t)
    if not delay < NEVER:
        return NEVER
    along = shape.ex * (x - shape.x) + shape.ey * (y - shape.y)
    if along < low or along > high:
        return NEVER
    ax, ay = slope(shape, gx, gy)
    return delay if slide_delay(shape, low, high, x, y, vx, vy, ax, ay) > 0.0 else NEVER


def slide_delay(shape: Face, low: float, high: float, x: Real, y: Real, vx: Real, vy: Real, ax: Real, ay: Real) -> Real:
    """The delay until a disk that slides along a face passes the end of its support."""
    along = shape.ex * (x - shape.x) + shape.ey * (y - shape.y)
    rate = shape.ex * vx + shape.ey * vy
    pull = shape.ex * ax + shape.ey * ay
    down, up = closing_delay(along - low, rate, pull), closing_delay(high - along, -rate, -pull)
    return down if down < up else up


def resting_place(shape: Face, side: int, x: Real, y: Real, radius: Real) -> tuple[Real, Real]:
    """Where a centre at (x, y) rests: exactly on contact where the face is along an axis, else where it is."""
    if shape.ey == 0.0:
        return x, shape.y + (side * shape.ny) * radius
    if shape.ex == 0.0:
        return shape.x + (side * shape.nx) * radius, y
    return x, y


def border_contact(
    supports: Sequence[Support | None] | None,
    held: Held | None,
    place: int,
    side: float,
    target: Real,
    x: Real,
    v: Real,
    g: Any,
    size: Real,
    restitution: Real,
    t: Real,
) -> tuple[Real, int]:
    """(delay, STRUCK or SUPPORTED) of the next event at a wall of the domain that keeps a coordinate at `target`.

    size: the coordinates that matter for rounding.  supports: None in a scene without rest.
    """
    if supports is not None:
        if held is not None and held.place == place and held.how == SUPPORTED:
            return NEVER, STRUCK
        delay = rest_delay(side * (x - target), side * v, side * g, size, restitution, t)
        if delay < NEVER:
            return delay, SUPPORTED
    return crossing_delay(x, v, g, target, side), STRUCK


def shape_contact(
    supports: Sequence[Support | None] | None,
    held: Held | None,
    place: int,
    shape: Shape,
    flight: tuple[Real, Real, Real, Real, Real, Real],
    radius: Real,
    met: int,
    restitution: Real,
    t: Real,
) -> tuple[Real, int, int]:
    """(delay, side, how) of the next event at a shape inside the domain: an impact, coming to rest, or sliding over its end.

    flight: x, y, vx, vy and the acceleration that the disk has.  met: the side last met.  supports: None in a scene without rest.
    """
    if supports is None:
        return *shape.delay(*flight, radius, met), STRUCK
    if held is not None:
        on = supports[held.place]
        assert on is not None
        if held.place == place and held.how == SUPPORTED:
            return slide_delay(on.face, on.low, on.high, *flight), held.side, LEFT
        if _is_beside(on.face, shape, held.how):
            return NEVER, met, STRUCK
    support = supports[place]
    if support is not None:
        side = met if met != 0 else face_side(support.face, *flight[:4])
        delay = rest_on_face_delay(support.face, side, support.low, support.high, *flight, radius, restitution, t)
        if delay < NEVER:
            return delay, side, SUPPORTED
    return *shape.delay(*flight, radius, met), STRUCK


def _is_beside(line: Face, shape: Shape, how: int) -> bool:
    """Whether a disk passes a shape because it slides on its line, or left that line at its end."""
    return (how == SUPPORTED or shape.line() is not None) and shape.lies_on(line)

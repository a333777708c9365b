"""Coming to rest on a flat wall under gravity: when a series of bounces is over, and how the disk slides from there on.

A disk that leaves a wall at speed v against the pull a is back after 2 v / a, at speed v, and leaves at e v: after
2 v / (a (1 - e)), the Zeno time, infinitely many bounces are over.  The series is cut where float64 cannot tell it from its
end, and the disk is supported: it has the part of gravity that is along the wall, until the next impulse or the wall's end.

A bounce is reckoned from the contact where it began: there the disk touches the wall, wherever rounding has put it.  So each
bounce is e times as fast as the one before to the last bits, and rounding keeps none of them up.  Reckoned from the rounded
place, bounces would never become shorter than sqrt(2 ulp(place) / (a (1 - e))); from the rounded clock, than ulp(t) / (1 - e).
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

from eventsim.formulas.crossing import crossing_delay
from eventsim.formulas.doubt import AT_ONCE, BELOW, FLOORS, LEAST_LOSS, NO_SPEED, TOUCHING, rounding_of
from eventsim.formulas.real import NEVER, Real, is_float, sqrt
from eventsim.formulas.slide import end_delay, slide_delay
from eventsim.formulas.walls.face import Face, flight_side, hangs_below, is_met, slope
from eventsim.formulas.walls.post import Post
from eventsim.formulas.walls.shape import Shape

NOT_LAST, AS_AT_START = -1.0, -2.0
"""Something else was met since the wall; or nothing was met yet, so that the flight is the one that the scene tells."""

STRUCK, SUPPORTED, LEFT = 0, 1, 2
"""What a contact with a wall is, and what the disk remembers of it: an impact; it came to rest there; it slid over the end."""


class Support(NamedTuple):
    """A straight wall that disks may rest on.

    face: its line; of a wall of the domain, a piece of unit length.  ax, ay: gravity along it, what a disk on it has.  low,
    high: where the support ends, in terms of e.(p - start); walls that go on in line belong to it, a wall of the domain has
    no end.  line: the same number for walls that are in line, for which a series of bounces is one.
    """

    face: Face
    ax: float
    ay: float
    low: float
    high: float
    line: int


class Held(NamedTuple):
    """The wall that a disk rests on (SUPPORTED) or has slid over the end of (LEFT): its place, the disk's side, which of both."""

    place: int
    side: int
    how: int


def has_struck(supports: Sequence[Support | None] | None, met: tuple[tuple[int, int, int], ...], place: int) -> bool:
    """Whether a disk that remembers `met` struck a wall last, or one in line with it."""
    if any(one[0] == -1 - place and one[2] == STRUCK for one in met):
        return True
    if supports is None or len(met) != 1 or met[0][0] >= 0 or met[0][2] != STRUCK:
        return False
    one, last = supports[place], supports[-1 - met[0][0]]
    return one is not None and last is not None and one.line == last.line


def held_by(met: tuple[tuple[int, int, int], ...]) -> Held | None:
    """What a disk that remembers `met` is held by; None where it is free of all walls."""
    if len(met) == 1 and met[0][0] < 0 and met[0][2] != STRUCK:
        return Held(-1 - met[0][0], met[0][1], met[0][2])
    return None


def launch(rate: Real, fall: Real, since: Real) -> Real:
    """The speed at which a disk left a flat wall `since` before its flight, which has this rate and fall, began."""
    return rate - fall * since


def hop_delay(rate: Real, fall: Real, since: Real) -> Real:
    """The delay until a disk is back on the flat wall that it left `since` ago, pulled onto it (fall < 0)."""
    delay = (2.0 * launch(rate, fall, since)) / -fall - since
    return delay if delay > 0.0 else 0.0


def hop_on_face_delay(
    shape: Face,
    side: int,
    x: Real,
    y: Real,
    vx: Real,
    vy: Real,
    gx: Real,
    gy: Real,
    since: Real,
    radius: Real,
    beside: int | None = None,
) -> Real:
    """The same for a face; NEVER where the disk is not pulled onto it, or comes down beside it."""
    nx, ny = side * shape.nx, side * shape.ny
    fall = nx * gx + ny * gy
    if not fall < 0.0:
        return NEVER
    delay = hop_delay(nx * vx + ny * vy, fall, since)
    return delay if is_met(shape, beside, side, x, y, vx, vy, gx, gy, radius, delay) else NEVER


def rest_delay(
    gap: Real,
    rate: Real,
    fall: Real,
    scale: Real,
    restitution: Real,
    t: Real,
    since: Real,
    rounds: bool = False,
    blur: Real = 0.0,
) -> Real:
    """The delay until a disk that touches a flat wall has come to rest there; NEVER if it is to bounce on.

    gap, rate, fall: of its distance from contact, in terms of the wall's normal.  scale: the coordinates that the gap was
    calculated from.  t: the clock at the beginning of the flight.  since: the time from the contact with the wall until then,
    NOT_LAST or AS_AT_START if it was not met last.  rounds: whether rounding moves a disk that touches the wall.  blur: what it
    may do to the rate, 0 where that is one component; what comes no faster does not come.

    It rests at its Zeno time where the next bounce is over at the same instant of the clock, or so slow that rounding may keep it
    up; earlier if until then it would fall through the wall by more than the last bits of its place (a share of the whole series
    as small as that of the last bounce).  On a wall where those are rounded the series is cut once it would not fall so far.
    At once where it does not leave the wall, or comes to it no faster than from the gap that rounding may have left: behind a
    contact with something else that is few last bits, and from a larger gap it falls and bounces.
    """
    if not fall < 0.0:
        return NEVER
    if gap > (BELOW if since == NOT_LAST else TOUCHING) * scale or gap < -(TOUCHING * scale):
        return NEVER
    lag = since if since > 0.0 else 0.0
    if lag > 0.0 or not rate < 0.0:
        speed = launch(rate, fall, lag)
        if not speed > 0.0:
            return 0.0
        flight = (2.0 * speed) / -fall
        late = sqrt((2.0 * TOUCHING) * scale / -fall)
        ends = flight < (1.0 - restitution) * late
        if (rounds and ends) or not flight > AT_ONCE * t or _is_blurred(speed, restitution, blur):
            delay = (flight / (1.0 - restitution) if ends else late) - lag
            return delay if delay > 0.0 else 0.0
        if not since < 0.0:
            return NEVER
    if blur > 0.0 and abs(rate) <= NO_SPEED * blur:
        return 0.0
    noise, bounce = (-8.0 * fall) * gap, rate * rate
    if bounce > noise and bounce > -noise:
        return NEVER
    return 0.0


def _is_blurred(speed: Real, restitution: Real, blur: Real) -> bool:
    """Whether rounding may keep up bounces as slow as this one."""
    if not restitution < 1.0:
        return False
    loss = 1.0 - restitution
    return bool(speed * (loss if loss > LEAST_LOSS else LEAST_LOSS) < FLOORS * blur)


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
    since: Real,
) -> Real:
    """The same for a face that supports from `low` to `high` of its e.(p - start); at an end nothing rests that moves out.

    A series that would be over beyond the end is so at the end, where the disk leaves the face.
    """
    nx, ny = side * shape.nx, side * shape.ny
    fall = nx * gx + ny * gy
    if not fall < 0.0:
        return NEVER
    gap = (nx * (x - shape.x) + ny * (y - shape.y)) - radius * shape.norm
    scale = shape.norm * (abs(x) + abs(y) + abs(shape.x) + abs(shape.y) + radius)
    across, upwards = nx * vx, ny * vy
    blur = 0.0
    if nx != 0.0 and ny != 0.0 and is_float(x):
        blur = rounding_of(across, upwards)
    delay = rest_delay(gap, across + upwards, fall, scale, restitution, t, since, True, blur)
    if not delay < NEVER:
        return NEVER
    along = shape.ex * (x - shape.x) + shape.ey * (y - shape.y)
    if along < low or along > high:
        return NEVER
    ax, ay = slope(shape, gx, gy)
    end = slide_delay(shape, low, high, x, y, vx, vy, ax, ay)
    if not end > 0.0:
        return NEVER
    return delay if delay < end else end


def rebound(nx: Real, ny: Real, u: Real, w: Real, speed: Real) -> tuple[Real, Real]:
    """The velocity (u, w) with its part along the normal such that n.v is `speed`; exact along an axis, where n has length 1."""
    if nx == 0.0:
        return u, ny * speed
    if ny == 0.0:
        return nx * speed, w
    share = (nx * u + ny * w - speed) / (nx * nx + ny * ny)
    return u - share * nx, w - share * ny


def border_size(x: Real, both: Real, target: Real, as_at_start: Any) -> Real:
    """The coordinates that a gap to a wall of the domain, which keeps x at `target`, may have been rounded with.

    both: the sum of the disk's coordinates.  as_at_start: whether it flies as the scene says, whose places are good to the last
    bits of both.  Behind a contact the gap is known to the last bits of x, and a disk that falls from there bounces.
    """
    return (both if as_at_start else abs(x)) + abs(target)


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
    since: Real,
) -> tuple[Real, int]:
    """(delay, STRUCK or SUPPORTED) of the next event at a wall of the domain that keeps a coordinate at `target`.

    size: `border_size`.  supports: None in a scene without rest.  since: see `rest_delay`.
    """
    if supports is not None:
        if held is not None and held.place == place and held.how == SUPPORTED:
            return NEVER, STRUCK
        return free_border_contact(side, target, x, v, g, size, restitution, t, since)
    return crossing_delay(x, v, g, target, side), STRUCK


def free_border_contact(
    side: float, target: Real, x: Real, v: Real, g: Real, size: Real, restitution: Real, t: Real, since: Real
) -> tuple[Real, int]:
    """The same for a disk that does not rest there."""
    rate, fall = side * v, side * g
    delay = rest_delay(side * (x - target), rate, fall, size, restitution, t, since)
    if delay < NEVER:
        return delay, SUPPORTED
    if not since < 0.0 and fall < 0.0:
        return hop_delay(rate, fall, since), STRUCK
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
    since: Real,
    touches: bool,
    beside: int | None = None,
) -> tuple[Real, int, int]:
    """(delay, side, how) of the next event at a shape inside the domain: an impact, coming to rest, or sliding over its end.

    flight: x, y, vx, vy and the acceleration that the disk has.  met: the side last met.  supports: None in a scene without rest.
    since: see `rest_delay`.  touches: whether the flight begins on contact with the shape.  beside: the side of a point that is
    close to the shape.
    """
    if supports is None:
        return *shape.delay(*flight, radius, met, touches, beside), STRUCK
    if held is not None:
        on = supports[held.place]
        assert on is not None
        if held.place == place and held.how == SUPPORTED:
            return slide_delay(on.face, on.low, on.high, *flight), held.side, LEFT
        if _is_beside(on.face, shape, held):
            return NEVER, met, STRUCK
        if held.how == LEFT and isinstance(shape, Post) and shape.lies_on(on.face) and radius > 0.0:
            delay = end_delay(shape.x, shape.y, *flight, radius, since)
            if not delay < 0.0:
                return delay, 1, STRUCK
        if held.how == LEFT:
            since = NOT_LAST
    support = supports[place]
    if support is not None:
        side = flight_side(support.face, met, beside, *flight[:4], radius)
        if met != 0 and side != met:  # it has come round an end since
            since = NOT_LAST
        delay = rest_on_face_delay(support.face, side, support.low, support.high, *flight, radius, restitution, t, since)
        if delay < NEVER:
            return delay, side, SUPPORTED
        if not since < 0.0:
            delay = hop_on_face_delay(support.face, side, *flight, since, radius, beside)
            if delay < NEVER:
                return delay, side, STRUCK
    return *shape.delay(*flight, radius, met, touches, beside), STRUCK


def _is_beside(line: Face, shape: Shape, held: Held) -> bool:
    """Whether a disk passes a shape because it slides on its line, or above it, or left that line at its end."""
    face = shape.line()
    if held.how == SUPPORTED and face is not None and hangs_below(line, held.side, face.x, face.y, face.x1, face.y1):
        return True
    return (held.how == SUPPORTED or face is not None) and shape.lies_on(line)

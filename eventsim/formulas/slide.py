"""Sliding along a straight wall, and over its end: from there a disk flies on, in contact with the point at the end."""

from eventsim.formulas.crossing import closing_delay
from eventsim.formulas.real import NEVER, Real, sqrt
from eventsim.formulas.walls.face import Face

BEHIND = 2.0**-40
"""A post is the end that a disk has left if it touched it then, but for this part of the coordinates: rounding is far below."""


def slide_delay(shape: Face, low: float, high: float, x: Real, y: Real, vx: Real, vy: Real, ax: Real, ay: Real) -> Real:
    """The delay until a disk that slides along a face passes the end of its support."""
    along = shape.ex * (x - shape.x) + shape.ey * (y - shape.y)
    rate = shape.ex * vx + shape.ey * vy
    pull = shape.ex * ax + shape.ey * ay
    down = closing_delay(along - low, rate, pull) if low > -NEVER else NEVER  # a sealed end is never passed
    up = closing_delay(high - along, -rate, -pull) if high < NEVER else NEVER
    return down if down < up else up


def end_delay(
    px: Real, py: Real, x: Real, y: Real, vx: Real, vy: Real, gx: Real, gy: Real, radius: Real, since: Real
) -> Real:
    """The delay until a disk meets the post (px, py), at the end of the wall that it slid over `since` ago; NEVER if it does not.

    -1: it is another post.  It left tangentially, at d from the post, with v: so T later
    |d + v T + g T^2/2|^2 - r^2 = T^2 (v.v + d.g + (v.g) T + g.g T^2/4), whose first two terms rounding would leave behind.
    """
    u, w = vx - gx * since, vy - gy * since
    dx, dy = (x - px) - since * (u + (0.5 * gx) * since), (y - py) - since * (w + (0.5 * gy) * since)
    gap = sqrt(dx * dx + dy * dy) - radius
    if not abs(gap) <= BEHIND * (abs(x) + abs(y) + abs(px) + abs(py) + radius):
        return -1.0
    rises, rate, pull = u * u + w * w + (dx * gx + dy * gy), u * gx + w * gy, gx * gx + gy * gy
    if not rises > 0.0:
        return 0.0
    discriminant = rate * rate - pull * rises
    if not (rate < 0.0 and discriminant > 0.0):
        return NEVER
    delay = (2.0 * rises) / (sqrt(discriminant) - rate) - since
    return delay if delay > 0.0 else 0.0

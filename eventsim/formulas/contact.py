"""When round things meet: the delay until the gap of a pair in straight relative flight closes, or that to a circle around it."""

import math

from eventsim.formulas.digits import careful_pair_delay
from eventsim.formulas.real import NEVER, Real, is_float, sqrt

DOUBT = math.nan
"""The delay of a contact that the plain formula cannot tell: `digits.careful_pair_delay` can."""

DIGITS_LOST = 2.0**-12
"""A part of a d^2 (a radius^2 inside of a circle) below which a positive D has lost too many bits to be trusted.

So whatever is hit from further than 64 reaches is in doubt: far away, D has lost one bit for each that the distance is larger.
"""

NEAR = 2.01e-3
"""A part of reach^2 below which c has lost too many bits: nearer than a thousandth of a reach.

With 2**-12 a contact of a gas is no cheaper; with 2**-8, at a packing fraction of .7, it is 5 % dearer.
"""

SMALLEST = 1e-290
"""What underflow may have taken from D."""


def pair_delay(dx: Real, dy: Real, du: Real, dw: Real, reach: Real) -> Real:
    """The delay until two disks at relative position (dx, dy) with relative velocity (du, dw) are `reach` apart.

    Signs before numbers: b = d.v >= 0, they recede: NEVER; they overlap and approach: now; then
    D = a reach^2 - (d x v)^2 decides hit or miss (Lagrange's identity: equal to b^2 - a c, but free of its cancellation
    far away and at a graze), and t = c / (sqrt D - b).  Exchange of the two disks changes no bit of it.

    Source: Bannerman, Strobl, Formella, Poeschel, Comp. Part. Mech. 1, 191 (2014), doi:10.1007/s40571-014-0021-8.
    """
    b = dx * du + dy * dw
    if not b < 0.0:
        return NEVER
    reach2 = reach * reach
    c = (dx * dx + dy * dy) - reach2
    if not c > 0.0:
        return 0.0
    cross = dx * dw - dy * du
    discriminant = (du * du + dw * dw) * reach2 - cross * cross
    if not discriminant > 0.0:
        return NEVER
    return c / (sqrt(discriminant) - b)


def screened_pair_delay(dx: float, dy: float, du: float, dw: float, reach: float) -> float:
    """The same where floats can tell; DOUBT (nan) near contact, at a graze, and where squares overflow or underflow.

    The signs of b = d.v, c = d^2 - reach^2 and D are certain where they are not small against a reach^2 and reach^2 (for disks
    up to 2**40 reaches apart), and with these the contact or the miss is.  Exchange of the two disks changes no bit of it.
    """
    b = dx * du + dy * dw
    d2 = dx * dx + dy * dy
    reach2 = reach * reach
    c = d2 - reach2
    a = du * du + dw * dw
    bound = a * reach2
    if not c > NEAR * reach2:
        return NEVER if b > 0.0 and b * b > DIGITS_LOST * bound + SMALLEST else DOUBT
    if b > 0.0:
        return NEVER
    cross = dx * dw - dy * du
    discriminant = bound - cross * cross
    if discriminant > DIGITS_LOST * (a * d2) + SMALLEST:
        return c / (math.sqrt(discriminant) - b)
    return NEVER if discriminant < -(DIGITS_LOST * bound + SMALLEST) or (du == 0.0 and dw == 0.0) else DOUBT


def inner_delay(dx: Real, dy: Real, du: Real, dw: Real, radius: Real) -> Real:
    """The delay until a straight flight reaches a circle of the given radius from inside; NEVER at rest.

    c = radius^2 - d^2, b = d.v; outward (b > 0): c / (b + sqrt D), now if c <= 0; inward: (sqrt D - b) / a.
    """
    b = dx * du + dy * dw
    a = du * du + dw * dw
    if not a > 0.0:
        return NEVER
    radius2 = radius * radius
    c = radius2 - (dx * dx + dy * dy)
    cross = dx * dw - dy * du
    discriminant = a * radius2 - cross * cross
    root = sqrt(discriminant) if discriminant > 0.0 else 0.0
    if b > 0.0:
        if not c > 0.0:
            return 0.0
        return c / (b + root)
    return (root - b) / a


def screened_inner_delay(dx: float, dy: float, du: float, dw: float, radius: float) -> float:
    """The same where floats can tell; DOUBT (nan) on the way out near the circle, along it, and where squares are no floats."""
    b = dx * du + dy * dw
    radius2 = radius * radius
    c = radius2 - (dx * dx + dy * dy)
    a = du * du + dw * dw
    bound = a * radius2
    cross = dx * dw - dy * du
    discriminant = bound - cross * cross
    if not discriminant > DIGITS_LOST * bound + SMALLEST:
        return NEVER if du == 0.0 and dw == 0.0 else DOUBT
    if b > 0.0:
        return c / (b + math.sqrt(discriminant)) if c > DIGITS_LOST * radius2 else DOUBT
    return (math.sqrt(discriminant) - b) / a


def circle_delay(x: Real, y: Real, u: Real, w: Real, radius: Real, cx: Real, cy: Real, circle: Real) -> Real:
    """The delay until a disk in straight flight meets a fixed circle around (cx, cy) from outside; floats to the last bit."""
    if not is_float(x):
        return pair_delay(x - cx, y - cy, u, w, radius + circle)
    dx, dy, reach = x - cx, y - cy, radius + circle
    delay = screened_pair_delay(dx, dy, u, w, reach)
    if delay == delay:
        return delay
    return careful_pair_delay(x, y, u, w, 0.0, radius, cx, cy, 0.0, 0.0, 0.0, circle, 0.0, 0.0)


def leaving_delay(x: Real, y: Real, u: Real, w: Real, radius: Real, cx: Real, cy: Real, circle: Real) -> Real:
    """The delay until a disk in straight flight meets a fixed circle around (cx, cy) from inside; floats to the last bit."""
    if not is_float(x):
        return inner_delay(x - cx, y - cy, u, w, circle - radius)
    dx, dy, inner = x - cx, y - cy, circle - radius
    delay = screened_inner_delay(dx, dy, u, w, inner)
    if delay == delay:
        return delay
    return careful_pair_delay(x, y, u, w, 0.0, -radius, cx, cy, 0.0, 0.0, 0.0, circle, 0.0, 0.0, -1.0)

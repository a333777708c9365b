"""When a gap closes: the delay until a coordinate reaches a flat boundary, straight or along a parabola."""

from eventsim.formulas.real import NEVER, Acceleration, Real, sqrt


def closing_delay(gap: Real, rate: Real, acceleration: Acceleration) -> Real:
    """The earliest delay >= 0 at which gap + rate t + acceleration t^2 / 2 is <= 0 and falling; NEVER if there is none.

    Decided by signs first: a gap that is open and does not fall is no event, a gap that is closed and falls is due now.
    The roots are written so that nothing cancels: 2 gap / (-rate + sqrt D) while it falls, (rate + sqrt D) / -acceleration
    where it rises first.  A parabola that touches the boundary with its apex (D = 0) does not cross it.
    """
    if rate < 0.0:
        if not gap > 0.0:
            return 0.0
        if acceleration is None:
            return gap / -rate
        discriminant = rate * rate - (2.0 * acceleration) * gap
        if not discriminant > 0.0:
            return NEVER
        return (2.0 * gap) / (sqrt(discriminant) - rate)
    if acceleration is None:
        return NEVER
    if not acceleration < 0.0:
        return NEVER
    discriminant = rate * rate - (2.0 * acceleration) * gap
    if discriminant > 0.0:
        return (rate + sqrt(discriminant)) / -acceleration
    return rate / -acceleration


def reopening_delay(gap: Real, rate: Real, acceleration: Acceleration) -> Real:
    """The delay at which a gap that is closed now, first opens and then closes again, closes; NEVER if it does not open.

    This is the far side of a thin wall: it is met only by a parabola that passes beside the wall and comes back.
    """
    if acceleration is None:
        return NEVER
    if not (acceleration < 0.0 and rate > 0.0):
        return NEVER
    discriminant = rate * rate - (2.0 * acceleration) * gap
    if not discriminant > 0.0:
        return NEVER
    return (rate + sqrt(discriminant)) / -acceleration


def crossing_delay(x: Real, v: Real, g: Acceleration, target: Real, side: float) -> Real:
    """When a coordinate passes `target` coming from its `side` (+1: from above, falling; -1: from below, rising)."""
    if g is None:
        return closing_delay(side * (x - target), side * v, None)
    return closing_delay(side * (x - target), side * v, side * g)

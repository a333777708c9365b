"""Images across a period: which copy of a thing is nearest."""

from eventsim.formulas.real import Real


def nearest_image(d: Real, period: float | None) -> Real:
    """A difference of two coordinates in the domain to the nearest image; period None or inf: there are no images."""
    if period is not None:
        if d > 0.5 * period:
            return d - period
        if d < -(0.5 * period):
            return d + period
    return d

"""Free flight: where a disk is, and how fast, some time after its anchor; how far away its images are."""

from eventsim.formulas.real import Acceleration, Real


def position(x: Real, v: Real, lag: Real, g: Acceleration) -> Real:
    """One coordinate after a flight of duration lag: x + v lag + g lag^2 / 2; g is None where there is no gravity."""
    if g is None:
        return x + v * lag
    return x + lag * (v + (0.5 * g) * lag)


def velocity(v: Real, lag: Real, g: Acceleration) -> Real:
    """One velocity component after a flight of duration lag."""
    if g is None:
        return v
    return v + g * lag


def periods(k: int, length: float | None) -> float:
    """The distance of image k; 0 without a period."""
    return k * length if k and length is not None else 0.0

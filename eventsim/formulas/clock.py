"""A clock that keeps its digits: whole epochs and a remainder, and when the clock turns over."""

import math
from fractions import Fraction

FIRST_WINDOW = 5
"""The first window is 2**5 epochs long."""

MOST_EPOCHS = 2**61
"""What the column `epoch` of a log can count, and a clock is sure not to pass within a window."""

FEW, MANY = 8, 32
"""Rows per disk and window below which the next window is doubled, above which it is halved."""


EARLY = 0.25
"""Part of an epoch that the clock keeps between the epoch it jumps to and what is due there: however its time is rounded, it
comes behind the jump."""


def next_window(exponent: int, rows: int, n: int, cap: int) -> int:
    """The exponent of the next window, from the number of rows logged in the one that ends; n is the number of disks.

    It makes turnovers a few per cent of the work whatever the scene does, and depends on the log alone.
    """
    if rows < FEW * n:
        return min(exponent + 1, cap)
    if rows > MANY * n:
        return max(exponent - 1, 0)
    return exponent


def window_after_idle(exponent: int, wrapped: bool, cap: int) -> int:
    """The exponent of the window behind one without a row; wrapped: whether a disk passed a periodic boundary in that.

    It does not grow while nothing happens, so what comes after a long time finds a young clock; who only wraps has windows
    long enough to pay for their turnovers.
    """
    return cap if wrapped else max(1, min(exponent, cap))


def epochs_before(due: float, exponent: int, epoch_length: float) -> int:
    """How many whole epochs the clock jumps to what is due (a remainder) behind the end of a window without a row.

    That is at most EARLY epochs and one before it, and not before the end of the window.
    """
    epochs = due / epoch_length - EARLY
    return max(math.floor(epochs), 1 << exponent) if epochs < 2 * MOST_EPOCHS else 2 * MOST_EPOCHS


def end_of_epoch(time: float, epoch_length: float) -> float:
    """Where the epoch ends that a time lies in, or begins with; both are remainders."""
    return (time // epoch_length + 1.0) * epoch_length


def window_length(exponent: int, epoch_length: float) -> float:
    """The length of a window; exact, a power of two."""
    return math.ldexp(epoch_length, exponent)


def remainder_since(epoch: int, epoch_length: float, time: float | Fraction, start_time: float = 0.0) -> float:
    """The scene's clock time `time` as a remainder in the given epoch, rounded once; inf stays inf."""
    if isinstance(time, float) and math.isinf(time):
        return time
    exact = Fraction(time) - Fraction(start_time) - epoch * Fraction(epoch_length)
    return _rounded(exact)


def clock_time(epoch: int, remainder: float, epoch_length: float, start_time: float = 0.0) -> float:
    """The time on the scene's clock, rounded once."""
    return _rounded(Fraction(start_time) + epoch * Fraction(epoch_length) + Fraction(remainder))


def _rounded(exact: Fraction) -> float:
    try:
        return float(exact)
    except OverflowError:
        return math.inf if exact > 0 else -math.inf

"""The numbers of the oracle: decimals of 60 to 1000 digits, made from floats without rounding.

A scene is followed with 60 digits first.  Where a decision cannot be told from an exact tie with so many (a sum of
terms of size 1 that is 0 to 40 digits), `TooFewDigits` is raised, and the scene is followed anew with more.  What is
0 to 600 digits in the last of these rounds is 0: what the numbers of a scene give by additions, products and the few
roots of a contact time has no smaller value other than 0 (polynomials of degree 16 in numbers of 53 bits).
"""

from __future__ import annotations

import decimal
from collections.abc import Iterator
from contextlib import contextmanager
from decimal import Decimal

ROUNDS = (60, 240, 1000)
"""The digits of the first attempt, the second, the last."""

ZERO, ONE, TWO, HALF = Decimal(0), Decimal(1), Decimal(2), Decimal("0.5")

UNIT = 2.0**-53
"""What rounding a float takes, of its size."""


class TooFewDigitsError(Exception):
    """A decision needs more digits than this round has."""


class _Round:
    """The round that is being followed: digits, the size below which a sum counts as 0, and whether more digits could
    follow.
    """

    digits = ROUNDS[0]
    tiny = Decimal(10) ** -(2 * ROUNDS[0] // 3)
    is_last = False


@contextmanager
def working_with(digits: int) -> Iterator[None]:
    """Calculate with so many digits inside the block."""
    before = _Round.digits, _Round.tiny, _Round.is_last
    _Round.digits, _Round.is_last = digits, digits >= ROUNDS[-1]
    _Round.tiny = Decimal(10) ** -(3 * digits // 5 if _Round.is_last else 2 * digits // 3)
    with decimal.localcontext() as context:
        context.prec = digits
        context.Emin, context.Emax = -999_999, 999_999
        try:
            yield
        finally:
            _Round.digits, _Round.tiny, _Round.is_last = before


def exact(value: float) -> Decimal:
    """A float as it is."""
    return Decimal(float(value))


def sign(value: Decimal, scale: Decimal) -> int:
    """-1, 0 or 1: the sign of a sum of terms of size `scale`; raises TooFewDigitsError where this round cannot tell
    it from 0.
    """
    if value > 0:
        if value > scale * _Round.tiny:
            return 1
    elif value < 0:
        if -value > scale * _Round.tiny:
            return -1
    elif scale == 0:
        return 0
    if _Round.is_last:
        return 0
    raise TooFewDigitsError


def is_float(value: Decimal) -> bool:
    """Whether a number is a float, so that nothing is lost where it is rounded to one."""
    return Decimal(float(value)) == value


def root(value: Decimal) -> Decimal:
    """The square root."""
    return value.sqrt()

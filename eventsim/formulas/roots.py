"""Which of two moments comes first, where each is a root of a quadratic with rational coefficients: decided exactly.

Roots of quartics are worked out to many bits, and are the same where these are.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import NamedTuple, TypeAlias

ROOT_BITS = 256
"""Of a root that is no rational: what floats and their products cannot tell from it."""

STEPS = 12
"""Each doubles the bits that are right: from twenty to ROOT_BITS in four."""

CLOSE = Fraction(1, 1 << 20)
"""A root further from a float time is another one than that of the contact."""

Line: TypeAlias = tuple[Fraction, Fraction, Fraction]
"""A coordinate as a polynomial in time: its value at time 0, its rate there, half its acceleration."""


class Moment(NamedTuple):
    """The number place + side * sqrt(square), known to +- doubt; side is +1 or -1, square >= 0."""

    place: Fraction
    side: int = 1
    square: Fraction = Fraction(0)
    doubt: Fraction = Fraction(0)


class Quartic(NamedTuple):
    """A polynomial in time, from its leading coefficient on, whose root is the time of a contact."""

    coefficients: tuple[Fraction, ...]

    def root_near(self, time: float) -> Moment | None:
        """The root that a float stands for; None where Newton's method finds none within a part CLOSE of it."""
        t, near = Fraction(time), abs(Fraction(time))
        bits = 2 * ROOT_BITS - math.frexp(time)[1]
        for _ in range(STEPS):
            value = slope = Fraction(0)
            for coefficient in self.coefficients:
                value, slope = value * t + coefficient, slope * t + value
            if value == 0:
                return Moment(t)
            if slope == 0 or abs(t - Fraction(time)) > CLOSE * near:
                return None
            step = value / slope
            t = Fraction(round((t - step) * Fraction(2) ** bits)) / Fraction(2) ** bits
            if abs(step) < near / 2**ROOT_BITS:
                return Moment(t, doubt=near / 2 ** (ROOT_BITS // 2))
        return None


def rational(t: float) -> Moment:
    """A float as a moment."""
    return Moment(Fraction(t))


def quadratic_root(a: Fraction, b: Fraction, c: Fraction, side: int) -> Moment | None:
    """(-b + side sqrt(b^2 - a c)) / a, a root of a t^2 + 2 b t + c; of a linear equation its only one; None without roots."""
    if a == 0:
        return None if b == 0 else Moment(-c / (2 * b))
    discriminant = b * b - a * c
    if discriminant < 0:
        return None
    return Moment(-b / a, side if a > 0 else -side, discriminant / (a * a))


def less_number(line: Line, number: float | Fraction) -> Line:
    """A coordinate counted from a number."""
    return line[0] - Fraction(number), line[1], line[2]


def root_of(square: Fraction) -> Fraction:
    """The square root of a rational, exact if that is one, else to ROOT_BITS bits after its first one."""
    whole = square.numerator * square.denominator << 2 * ROOT_BITS
    return Fraction(math.isqrt(whole), square.denominator << ROOT_BITS)


def falls_to(line: Line, target: float | Fraction, side: int) -> Moment | None:
    """When side * (line - target) sinks to 0: of a parabola the time at which it falls."""
    at, rate, half = less_number(line, target)
    return quadratic_root(side * half, side * rate / 2, side * at, -1)


def reaches(x: Line, y: Line, reach: Fraction, side: int) -> Moment | Quartic | None:
    """When a distance (x, y) is `reach`: the first time (side -1: from outside) or the last one (+1: from inside).

    Along a parabola the quartic of which that is a root.
    """
    if x[2] or y[2]:
        return Quartic(
            (
                x[2] * x[2] + y[2] * y[2],
                2 * (x[1] * x[2] + y[1] * y[2]),
                x[1] * x[1] + y[1] * y[1] + 2 * (x[0] * x[2] + y[0] * y[2]),
                2 * (x[0] * x[1] + y[0] * y[1]),
                x[0] * x[0] + y[0] * y[0] - reach * reach,
            )
        )
    return quadratic_root(
        x[1] * x[1] + y[1] * y[1], x[0] * x[1] + y[0] * y[1], x[0] * x[0] + y[0] * y[0] - reach * reach, side
    )


def order_of(one: Moment, other: Moment) -> int:
    """-1 if one moment is before the other, 0 if they are the same, +1 if it is after it.

    Moments that are not known exactly are the same where they may be.

    With p = p1 - p2 and u = s1 sqrt q1 - s2 sqrt q2: the sign of p + u; where those of p and u differ, that of the larger,
    and u^2 = q1 + q2 - 2 s1 s2 sqrt(q1 q2).
    """
    doubt = one.doubt + other.doubt
    if doubt:
        early, late = (order_of(Moment(one.place + by, *one[1:3]), Moment(*other[:3])) for by in (-doubt, doubt))
        return early if early == late else 0
    p = one.place - other.place
    product = one.side * other.side
    u = one.side * (_sign(one.square - other.square) if product > 0 else _sign(one.square + other.square))
    if _sign(p) * u >= 0:
        return _sign(p) or u
    return _sign(p) * _sign_with_root(p * p - one.square - other.square, product, 4 * one.square * other.square)


def _sign_with_root(p: Fraction, side: int, square: Fraction) -> int:
    """The sign of p + side sqrt(square)."""
    u = side * _sign(square)
    if _sign(p) * u >= 0:
        return _sign(p) or u
    return _sign(p) * _sign(p * p - square)


def _sign(x: Fraction) -> int:
    return (x > 0) - (x < 0)

"""The real roots of polynomials of degree up to four, isolated by the roots of their derivatives.

A contact of a parabola with a line is a root of a quadratic, with a circle of a quartic.  Between two neighbouring
roots of its derivative a polynomial is monotone, so it has one root there if its signs differ, and none if they are
equal: no root is lost and none is invented.  Signs are decided by `digits.sign`; the roots themselves are those of
Newton's method inside their brackets.

A polynomial is the tuple of its coefficients, the constant first.
"""

from __future__ import annotations

from decimal import Decimal
from typing import NamedTuple

from tests.oracle.digits import ZERO, _Round, root, sign

Polynomial = tuple[Decimal, ...]

MOST_STEPS = 4000
"""Halvings of a bracket before a root counts as lost: more than the digits of the last round need."""


class Crossing(NamedTuple):
    """A root at which the sign changes: when, and whether the polynomial falls there."""

    time: Decimal
    falls: bool


class Turn(NamedTuple):
    """An extremum: when, the value there, and whether it is a minimum."""

    time: Decimal
    value: Decimal
    is_minimum: bool


def value(p: Polynomial, t: Decimal) -> Decimal:
    """p(t), by Horner's rule."""
    total = p[-1]
    for coefficient in p[-2::-1]:
        total = total * t + coefficient
    return total


def size(p: Polynomial, t: Decimal) -> Decimal:
    """The sum of the sizes of the terms of p(t)."""
    total = abs(p[-1])
    for coefficient in p[-2::-1]:
        total = total * t + abs(coefficient)
    return total


def derivative(p: Polynomial) -> Polynomial:
    """p'."""
    return tuple(k * c for k, c in enumerate(p) if k)


def survey(p: Polynomial) -> tuple[list[Crossing], list[Turn]]:
    """The crossings and the turns of p at t > 0, in order.

    A root at t = 0 is no crossing; the sign that p has just after 0 is that of its first derivative there that is not
    0. A turn of value 0 (a double root) is no crossing.
    """
    while len(p) > 1 and p[-1] == 0:
        p = p[:-1]
    if len(p) == 1:
        return [], []
    if len(p) == 2:
        return _straight(p), []
    if len(p) == 3:
        return _parabola(p)
    changes, _ = survey(derivative(p))
    turns = [Turn(c.time, value(p, c.time), not c.falls) for c in changes]
    stops = [(turn.time, sign(turn.value, size(p, turn.time))) for turn in turns]
    end = _bound(p)
    if stops:
        end = max(end, 2 * stops[-1][0])
    stops.append((end, 1 if p[-1] > 0 else -1))
    crossings = []
    low, before = ZERO, _sign_after_zero(p)
    for high, after in stops:
        if before * after < 0:
            crossings.append(Crossing(_root_between(p, low, high, before), after < 0))
        if after != 0:
            before = after
        low = high
    return crossings, turns


def _straight(p: Polynomial) -> list[Crossing]:
    t = -p[0] / p[1]
    return [Crossing(t, p[1] < 0)] if t > 0 else []


def _parabola(p: Polynomial) -> tuple[list[Crossing], list[Turn]]:
    c, b, a = p
    middle = -b / (2 * a)
    if not middle > 0:  # monotone from 0 on
        first = _sign_after_zero(p)
        if c == 0 or (first > 0) == (a > 0):
            return [], []
        return [Crossing(middle + root(middle * middle - c / a), a < 0)], []
    depth = c - b * b / (4 * a)
    turn = Turn(middle, depth, a > 0)
    side = sign(depth, size(p, middle))
    if side == 0 or (side > 0) == (a > 0):
        return [], [turn]
    way = root(-depth / a)
    early, late = Crossing(middle - way, a > 0), Crossing(middle + way, a < 0)
    starts_beyond = c != 0 and (c > 0) != (a > 0)
    return [late] if starts_beyond or c == 0 else [early, late], [turn]


def _sign_after_zero(p: Polynomial) -> int:
    for coefficient in p:
        if coefficient != 0:
            return 1 if coefficient > 0 else -1
    return 0


def _bound(p: Polynomial) -> Decimal:
    """A time beyond all roots.  Source: Fujiwara, Tohoku Math. J. 10, 167 (1916), with room to spare."""
    n, lead = len(p) - 1, abs(p[-1])
    best = ZERO
    for k, c in enumerate(p[:-1]):
        if c != 0:
            best = max(best, _power(abs(c) / lead, n - k))
    return 2 * best * Decimal("1.01") + Decimal("1e-300")


def _power(x: Decimal, n: int) -> Decimal:
    """x to the power 1/n, n from 1 to 4, to a few digits."""
    if n == 1:
        return x
    tens = x.adjusted() // n
    return Decimal(float(x.scaleb(-n * tens)) ** (1.0 / n)).scaleb(tens)


def _root_between(p: Polynomial, low: Decimal, high: Decimal, before: int) -> Decimal:
    """The one root between low and high, where the sign is `before` first and the other one at the end."""
    slope = derivative(p)
    goal = Decimal(10) ** -(_Round.digits - 5)
    t = _guess(p, low, high, before)
    for _ in range(MOST_STEPS):
        v = value(p, t)
        if v == 0:
            return t
        if (v > 0) == (before > 0):
            low = t
        else:
            high = t
        d = value(slope, t)
        following = t - v / d if d != 0 else low
        if not low < following < high:
            following = (low + high) / 2
        if abs(following - t) <= goal * abs(following):
            return following
        t = following
    raise ArithmeticError("a root was lost between two others")


def _guess(p: Polynomial, low: Decimal, high: Decimal, before: int) -> Decimal:
    """That root to the digits of floats, where it is one: Newton's method in floats; else the middle."""
    try:
        cs = [float(c) for c in reversed(p)]
        a, b = float(low), float(high)
        t = 0.5 * (a + b)
        for _ in range(60):
            v = d = 0.0
            for c in cs:
                d = d * t + v
                v = v * t + c
            if (v > 0.0) == (before > 0):
                a = t
            else:
                b = t
            following = t - v / d if d != 0.0 else a
            if not a < following < b:
                following = 0.5 * (a + b)
            if abs(following - t) <= 1e-15 * abs(t):
                break
            t = following
        found = Decimal(t)
    except (OverflowError, ValueError):
        return (low + high) / 2
    return found if low < found < high else (low + high) / 2

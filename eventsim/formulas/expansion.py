"""Exact sums and products: a number is a list of floats that do not overlap, the smallest first, and their sum is its value.

Operations without rounding, for signs that no fixed precision can decide.  Exact as long as no product underflows: the
numbers that go in should be of order 1, and not smaller than about 2**-400.

Source: J. R. Shewchuk, Discrete Comput. Geom. 18, 305 (1997), doi:10.1007/PL00009321, theorem 10; for the products
T. J. Dekker, Numer. Math. 18, 224 (1971), doi:10.1007/BF01397083.
"""

from typing import Any, TypeVar

Number = TypeVar("Number", float, Any)

SPLITTER = 134217729.0
"""2**27 + 1: cuts a float into two halves whose products are exact (Veltkamp)."""


def two_sum(a: Number, b: Number | float) -> tuple[Number, Number]:
    """(s, e), floats or arrays, with s = fl(a + b) and s + e = a + b exactly; exchange of a and b changes no bit."""
    s = a + b
    bb = s - a
    return s, (a - (s - bb)) + (b - bb)


def two_product(a: float, b: float) -> tuple[float, float]:
    """(p, e) with p = fl(a b) and p + e = a b exactly; without a fused multiply-add, and so the same bits everywhere."""
    p = a * b
    c = SPLITTER * a
    a_high = c - (c - a)
    a_low = a - a_high
    c = SPLITTER * b
    b_high = c - (c - b)
    b_low = b - b_high
    return p, a_low * b_low - (((p - a_high * b_high) - a_low * b_high) - a_high * b_low)


def grown(e: list[float], b: float) -> list[float]:
    """The exact value of e plus a float."""
    total = b
    result = [0.0 for _ in range(0)]
    for part in e:
        total, rest = two_sum(total, part)
        if rest != 0.0:
            result.append(rest)
    if total != 0.0:
        result.append(total)
    return result


def added(e: list[float], f: list[float]) -> list[float]:
    """The exact sum e + f."""
    result = e
    for part in f:
        result = grown(result, part)
    return result


def scaled(e: list[float], b: float) -> list[float]:
    """The exact product of e with a float."""
    result = [0.0 for _ in range(0)]
    for part in e:
        product, rest = two_product(part, b)
        result = grown(grown(result, rest), product)
    return result


def multiplied(e: list[float], f: list[float]) -> list[float]:
    """The exact product e f."""
    result = [0.0 for _ in range(0)]
    for part in f:
        result = added(result, scaled(e, part))
    return result


def negated(e: list[float]) -> list[float]:
    """The exact value of -e."""
    return [-part for part in e]


def leading(e: list[float]) -> tuple[float, float]:
    """The value of e as a sum of two floats, the first one rounded; its sign is exact, (0, 0) for nothing."""
    high, low = 0.0, 0.0
    for part in e:
        high, rest = two_sum(high, part)
        low += rest
    return two_sum(high, low)

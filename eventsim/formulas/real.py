"""The number type: what the formulas calculate with, and the one function of it that Python's operators lack."""

import math
from typing import Any, TypeAlias

Real: TypeAlias = Any
"""A float; or, in the certified engine, a ball that supports the same operators and has a method `sqrt`."""

Acceleration: TypeAlias = Any
"""A Real, or None where the scene has no gravity (a branch that compilers prune)."""

NEVER = math.inf
"""The delay of a contact that does not come."""


def is_float(x: Real) -> bool:
    """Whether a number is a float, whose rounding has to be watched."""
    return isinstance(x, float)


def root_between(like: Real, coefficients: tuple[Real, ...], low: Real, high: Real) -> Real:
    """The one root of a polynomial that is monotone from low to high, where its signs differ.

    For number types other than float, of which `like` is one; floats are bisected.  coefficients: that of t^0 first.
    """
    return like.root_between(coefficients, low, high)


def sqrt(x: Real) -> Real:
    """The square root; a number type other than float brings its own."""
    if isinstance(x, float):
        return math.sqrt(x)
    return x.sqrt()

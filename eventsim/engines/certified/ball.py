"""Balls: numbers that are known to lie in an interval.  Operators enclose, comparisons answer or raise Undecided."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from flint import arb, arb_poly, ctx

if TYPE_CHECKING:
    from eventsim.engines.reference.calendar import Event


CUTS = (0.5, 0.4375, 0.5625)
"""Where an interval is cut in search of a root; a root may be in one of these places, but in no two of them."""


class Undecided(ArithmeticError):
    """Two balls overlap: at this precision it is not known which of the numbers is larger.

    events: two events whose order hangs on it; disks: those that it is about; both empty where nobody has said.
    """

    def __init__(self, comparison: str, events: tuple[Event, ...] = ()) -> None:
        super().__init__(comparison)
        self.events = events
        self.disks: tuple[int, ...] = ()


class Irrational(Undecided):
    """A number is not known to be rational where only rational ones are of use."""


@contextmanager
def about(disks: Iterable[int]) -> Iterator[None]:
    """Let an Undecided from within know which disks it is about, unless it knows more."""
    try:
        yield
    except Undecided as undecided:
        undecided.disks = undecided.disks or tuple(sorted(disks))
        raise


class Ball:
    """A real number in an interval of arb; mixes with floats, which are exact."""

    __slots__ = ("value",)

    def __init__(self, value: arb) -> None:
        self.value = value

    def __repr__(self) -> str:
        return f"Ball({self.value})"

    def __hash__(self) -> int:
        raise TypeError("a ball may hold more than one number: it is no key")

    def __float__(self) -> float:
        return float(self.value)

    def __add__(self, other: Any) -> Any:
        if type(other) is Ball:
            return Ball(self.value + other.value)
        return Ball(self.value + other) if math.isfinite(other) else other

    __radd__ = __add__

    def __sub__(self, other: Any) -> Any:
        if type(other) is Ball:
            return Ball(self.value - other.value)
        return Ball(self.value - other) if math.isfinite(other) else -other

    def __rsub__(self, other: Any) -> Any:
        return Ball(other - self.value) if math.isfinite(other) else other

    def __mul__(self, other: Any) -> Any:
        return Ball(self.value * (other.value if type(other) is Ball else other))

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Any:
        return Ball(self.value / (other.value if type(other) is Ball else other))

    def __rtruediv__(self, other: Any) -> Any:
        return Ball(other / self.value)

    def __neg__(self) -> Any:
        return Ball(-self.value)

    def __abs__(self) -> Any:
        return self if not self < 0.0 else -self

    def sqrt(self) -> Any:
        """The square root of a number that is known to be positive."""
        return Ball(self.value.sqrt())

    def root_between(self, coefficients: tuple[Any, ...], low: Any, high: Any) -> Any:
        """The one root of a polynomial that is monotone from low to high, where its signs differ.

        Raises Undecided where the coefficients are not known well enough.
        """
        return Ball(_root_between(*([_arb(c) for c in each] for each in (coefficients, (low, high)))))

    def __lt__(self, other: Any) -> bool:
        value, bound = self.value, (other.value if isinstance(other, Ball) else other)
        if value < bound:
            return True
        if value >= bound:
            return False
        return self._unclear(other) < 0

    def __le__(self, other: Any) -> bool:
        value, bound = self.value, (other.value if isinstance(other, Ball) else other)
        if value <= bound:
            return True
        if value > bound:
            return False
        return self._unclear(other) <= 0

    def __gt__(self, other: Any) -> bool:
        return not self <= other

    def __ge__(self, other: Any) -> bool:
        return not self < other

    def __eq__(self, other: object) -> bool:
        bound = other.value if isinstance(other, Ball) else other
        if self.value == bound:
            return True
        if self.value != bound:
            return False
        return self._unclear(other) == 0

    def _unclear(self, other: Any) -> int:
        """The sign of self - other where the intervals overlap: 0 for a number and itself, else not known.

        Raises Undecided.
        """
        if self is other:
            return 0
        raise Undecided(f"{self.value} against {other.value if isinstance(other, Ball) else other}")

    @property
    def rational(self) -> Fraction | None:
        """The number itself where it is known to be rational; a plain ball knows that of floats only."""
        return None


def _arb(number: Ball | float) -> arb:
    return number.value if isinstance(number, Ball) else arb(number)


def _root_between(coefficients: list[arb], ends: list[arb]) -> arb:
    """By the interval Newton method, N(X) = m - f(m) / f'(X), and by bisection until that contracts.

    Source: R. E. Moore, Interval Analysis (1966), chapter 7.
    """
    f = arb_poly(coefficients)
    slope = f.derivative()
    low, high = ends[0].mid(), ends[1].mid()  # the signs there are known on all of their balls
    if f(low).is_zero():  # a disk at rest in the middle of a circle
        return low
    rises = bool(f(high) > 0)
    if not (rises or f(high) < 0):
        rises = bool(f(low) < 0)
    x = low.union(high)
    while True:
        middle, rate = x.mid(), slope(x)
        known = not rate.contains(0)
        closer = x.intersection(middle - f(middle) / rate) if known else x
        if not 2 * closer.rad() < x.rad():
            closer = _half(f, x, rises)
        if not closer.rad() < x.rad():
            break
        x = closer
    if not known:
        raise Undecided(f"a root in {x}")
    return x


def _half(f: arb_poly, x: arb, rises: bool) -> arb:
    """About the half of an interval that holds the root of f; the interval where the root may be at each place to cut it."""
    low, high = x.lower().mid(), x.upper().mid()
    for share in CUTS:
        cut = (low + share * (high - low)).mid()
        here = f(cut)
        if not here.contains(0):
            return low.union(cut) if bool(here > 0) == rises else cut.union(high)
    return x


def ball(x: float) -> Ball:
    """A float as a ball without radius."""
    return Ball(arb(x))


def radius_of(number: Ball | float) -> float:
    """How far from the middle of its ball a number may be; a float is itself."""
    return float(number.value.rad()) if isinstance(number, Ball) else 0.0


def deviation(number: Ball | float, x: float) -> float:
    """How far a number may be from the float x."""
    return float((number.value - x).abs_upper()) if isinstance(number, Ball) else abs(number - x)


def bounds(number: Ball | float) -> tuple[float, float]:
    """Floats below and above all that the ball holds."""
    if not isinstance(number, Ball):
        return number, number
    return (
        math.nextafter(float(number.value.lower()), -math.inf),
        math.nextafter(float(number.value.upper()), math.inf),
    )


def working_precision(bits: int) -> Any:
    """A context in which balls are computed with so many bits."""
    return ctx.workprec(bits)

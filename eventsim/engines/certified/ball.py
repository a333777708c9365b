"""Balls: numbers that are known to lie in an interval.  Operators enclose, comparisons answer or raise Undecided."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from flint import arb, ctx, fmpq

from eventsim.engines.certified.fingerprint import Fingerprint, product, quotient, root, total
from eventsim.engines.certified.fingerprint import of_rational as fingerprint_of

if TYPE_CHECKING:
    from eventsim.engines.reference.calendar import Event

LONGEST_RATIONAL = 4096
"""Bits of a numerator or denominator beyond which a traced number is no longer kept as a rational."""


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


class Traced(Ball):
    """A ball that knows where it comes from: as a rational number as long as it is one, then by the expression that it is.

    So it decides ties: of rational numbers, and of numbers that the same operations were done for.  Several times slower.
    """

    __slots__ = ("_fingerprint", "_rational")

    def __init__(self, value: arb, rational: Fraction | None, fingerprint: Fingerprint | None = None) -> None:
        super().__init__(value)
        self._rational = rational
        self._fingerprint = fingerprint

    @property
    def rational(self) -> Fraction | None:
        """The number itself where it is known to be rational."""
        return self._rational

    @property
    def fingerprint(self) -> Fingerprint:
        """What the number is, as the expression that it was made by."""
        if self._fingerprint is None:
            assert self._rational is not None
            self._fingerprint = fingerprint_of(self._rational)
        return self._fingerprint

    def _exactly(self, rational: Fraction) -> Traced:
        if max(rational.numerator.bit_length(), rational.denominator.bit_length()) > LONGEST_RATIONAL:
            fingerprint = fingerprint_of(rational)
            return Traced(arb(fmpq(rational.numerator, rational.denominator)), None, fingerprint)
        return of_rational(rational)

    def __add__(self, other: Any) -> Any:
        if not isinstance(other, Traced):
            if not math.isfinite(other):
                return other
            other = traced(other)
        if self._rational is not None and other._rational is not None:
            return self._exactly(self._rational + other._rational)
        if self._rational == 0:
            return other
        if other._rational == 0:
            return self
        fingerprint = total(self.fingerprint, other.fingerprint)
        if fingerprint is None:
            return self._exactly(Fraction(0))
        return Traced(self.value + other.value, None, fingerprint)

    __radd__ = __add__

    def __sub__(self, other: Any) -> Any:
        return self + -other

    def __rsub__(self, other: Any) -> Any:
        return -self + other

    def __neg__(self) -> Any:
        if self._rational is not None:
            return Traced(-self.value, -self._rational)
        sign, digest = self.fingerprint
        return Traced(-self.value, None, (-sign, digest))

    def __mul__(self, other: Any) -> Any:
        if not isinstance(other, Traced):
            other = traced(other)
        if self._rational is not None and other._rational is not None:
            return self._exactly(self._rational * other._rational)
        for one, factor in ((self, other), (other, self)):
            if factor._rational is not None and abs(factor._rational) <= 1 and factor._rational.denominator == 1:
                return factor if factor._rational == 0 else one if factor._rational == 1 else -one
        return Traced(self.value * other.value, None, product(self.fingerprint, other.fingerprint))

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Any:
        if not isinstance(other, Traced):
            other = traced(other)
        if self._rational is not None and other._rational is not None:
            return self._exactly(self._rational / other._rational)
        if self._rational == 0:
            return self
        return Traced(self.value / other.value, None, quotient(self.fingerprint, other.fingerprint))

    def __rtruediv__(self, other: Any) -> Any:
        return traced(other) / self

    def sqrt(self) -> Any:
        """The square root of a number that is known to be positive; rational where it is the square of a rational."""
        if self._rational is not None:
            top, bottom = math.isqrt(self._rational.numerator), math.isqrt(self._rational.denominator)
            if top * top == self._rational.numerator and bottom * bottom == self._rational.denominator:
                return self._exactly(Fraction(top, bottom))
        return Traced(self.value.sqrt(), None, root(self.fingerprint))

    def _unclear(self, other: Any) -> int:
        other = other if isinstance(other, Traced) else traced(other)
        if self._rational is not None and other._rational is not None:
            return int(self._rational > other._rational) - int(self._rational < other._rational)
        if self.fingerprint == other.fingerprint:
            return 0
        return super()._unclear(other)


def ball(x: float) -> Ball:
    """A float as a ball without radius."""
    return Ball(arb(x))


def traced(x: float) -> Traced:
    """A float as a traced number."""
    return Traced(arb(x), Fraction(x))


def of_rational(x: Fraction) -> Traced:
    """A rational as a traced number."""
    return Traced(arb(fmpq(x.numerator, x.denominator)), x)


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

"""Traced numbers: balls that know where they come from, and so decide ties of rational numbers and of equal expressions."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from functools import lru_cache
from typing import Any

from flint import arb, fmpq

from eventsim.engines.certified import forms
from eventsim.engines.certified.ball import Ball
from eventsim.engines.certified.forms import Form


class Traced(Ball):
    """A ball with the form of its number, which is worked out when somebody asks.

    rule, parts: what makes the form from those of other numbers.
    """

    __slots__ = ("_form", "_parts", "_rule")

    def __init__(self, value: arb, rule: Callable[..., Form], *parts: Traced) -> None:
        super().__init__(value)
        self._form: Form | None = None
        self._rule, self._parts = rule, parts
        if all(part._form is not None and forms.rational_of(part._form) is not None for part in parts):
            self._work_out()

    def _work_out(self) -> None:
        self._form = self._rule(*(part._form for part in self._parts))
        self._parts = ()
        rational = forms.rational_of(self._form)
        if rational is not None:
            self.value = arb(rational)

    @property
    def form(self) -> Form:
        """What the number is."""
        ahead = [self]
        while ahead:
            number = ahead[-1]
            unknown = [part for part in number._parts if part._form is None]
            if unknown and number._form is None:
                ahead += unknown
                continue
            if number._form is None:
                number._work_out()
            ahead.pop()
        assert self._form is not None
        return self._form

    @property
    def rational(self) -> Fraction | None:
        """The number itself where it is known to be rational."""
        own = forms.rational_of(self.form)
        return None if own is None else Fraction(int(own.numerator), int(own.denominator))

    def __add__(self, other: Any) -> Any:
        if not isinstance(other, Traced):
            if not math.isfinite(other):
                return other
            other = traced(other)
        return Traced(self.value + other.value, forms.total, self, other)

    __radd__ = __add__

    def __sub__(self, other: Any) -> Any:
        return self + -other

    def __rsub__(self, other: Any) -> Any:
        return -self + other

    def __neg__(self) -> Any:
        return Traced(-self.value, forms.negative, self)

    def __mul__(self, other: Any) -> Any:
        other = _traced(other)
        return Traced(self.value * other.value, forms.product, self, other)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Any:
        other = _traced(other)
        return Traced(self.value / other.value, forms.quotient, self, other)

    def __rtruediv__(self, other: Any) -> Any:
        return traced(other) / self

    def sqrt(self) -> Any:
        """The square root of a number that is known to be positive."""
        return Traced(self.value.sqrt(), forms.root, self)

    def root_between(self, coefficients: tuple[Any, ...], low: Any, high: Any) -> Any:
        """The one root of a polynomial that is monotone from low to high, where its signs differ."""
        value = super().root_between(coefficients, low, high).value
        return Traced(value, forms.root_between, *map(_traced, (*coefficients, low, high)))

    def _unclear(self, other: Any) -> int:
        apart = forms.rational_of(forms.total(self.form, forms.negative(_traced(other).form)))
        return super()._unclear(other) if apart is None else int(apart > 0) - int(apart < 0)


@lru_cache(4096)
def traced(x: float) -> Traced:
    """A float as a traced number."""
    return _of(fmpq(*x.as_integer_ratio()))


def of_rational(x: Fraction) -> Traced:
    """A rational as a traced number."""
    return _of(fmpq(x.numerator, x.denominator))


def _of(x: fmpq) -> Traced:
    return Traced(arb(x), lambda: forms.of_rational(x))


def _traced(number: Any) -> Traced:
    return number if isinstance(number, Traced) else traced(number)

"""Forms: a number by the expressions that made it, so that equal numbers are seen to be equal.

A form is a sum of atoms with rational factors, {atom: factor}.  The atom b"" is 1, so a rational number has no other, and 0 has
none at all.  Every other atom is a digest, of 128 bits that nobody finds a collision of, of a product, quotient or root of forms.
So sums and rational multiples are exact; products do not depend on the order of their factors, nor do digests on common factors.
"""

from __future__ import annotations

from hashlib import blake2b
from typing import TypeAlias

from flint import fmpq

Form: TypeAlias = dict[bytes, fmpq]

ONE = b""

ZERO = fmpq(0)

LONGEST_RATIONAL = 4096
"""Bits of a numerator or denominator beyond which a factor is no longer kept."""

MOST_TERMS = 24
"""A longer sum becomes one atom."""


def of_rational(number: fmpq) -> Form:
    """The form of a rational number."""
    return {ONE: number} if number != 0 else {}


def rational_of(form: Form) -> fmpq | None:
    """The number that a form is; None where it is not known to be rational."""
    return (form.get(ONE) if form else ZERO) if len(form) < 2 else None


def negative(form: Form) -> Form:
    """The form of -1 times a number."""
    return {atom: -factor for atom, factor in form.items()}


def scaled(form: Form, factor: fmpq) -> Form:
    """A rational multiple of a form."""
    if factor == 1:
        return form
    return _kept({atom: own * factor for atom, own in form.items()}) if factor != 0 else {}


def total(one: Form, other: Form) -> Form:
    """The sum of two forms."""
    found = dict(one)
    for atom, factor in other.items():
        both = found.pop(atom, ZERO) + factor
        if both != 0:
            found[atom] = both
    return _kept(found)


def product(one: Form, other: Form) -> Form:
    """The product of two forms."""
    for form, factor in ((one, rational_of(other)), (other, rational_of(one))):
        if factor is not None:
            return scaled(form, factor)
    (own, a), (others, b) = _atom(one), _atom(other)
    return {_digest(b"*", *sorted((a, b))): own * others}


def quotient(one: Form, other: Form) -> Form:
    """The quotient of two forms; the second one is not 0."""
    divisor = rational_of(other)
    if divisor is not None:
        return scaled(one, 1 / divisor)
    if not one:
        return {}
    (own, a), (others, b) = _atom(one), _atom(other)
    return {ONE if a == b else _digest(b"/", a, b): own / others}


def root(form: Form) -> Form:
    """The square root of a form, a number >= 0."""
    if not form:
        return {}
    factor, atom = _atom(form)
    whole = _square_root(abs(factor))
    if whole is None:
        return {_digest(b"s", str(factor).encode(), atom): fmpq(1)}
    return {ONE if atom == ONE else _digest(b"s", b"-"[: factor < 0], atom): whole}


def root_between(*forms: Form) -> Form:
    """The root of a polynomial between two numbers: its coefficients, then these."""
    return {_digest(b"r", *(part for form in forms for part in _written(form))): fmpq(1)}


def _square_root(number: fmpq) -> fmpq | None:
    """The square root of a rational number >= 0 where that is rational, too."""
    top, bottom = number.numerator.isqrt(), number.denominator.isqrt()
    square = top * top == number.numerator and bottom * bottom == number.denominator
    return fmpq(top, bottom) if square else None


def _atom(form: Form) -> tuple[fmpq, bytes]:
    """A form that is not 0 as a rational multiple of one atom."""
    first = min(form)
    factor = form[first]
    if len(form) == 1:
        return factor, first
    return factor, _digest(b"+", *_written({atom: own / factor for atom, own in form.items()}))


def _kept(form: Form) -> Form:
    """A form; one atom instead of it where it has become too long."""
    if len(form) <= MOST_TERMS and all(factor.height_bits() <= LONGEST_RATIONAL for factor in form.values()):
        return form
    sign = fmpq(-1 if form[min(form)] < 0 else 1)
    return {_digest(b"=", *_written({atom: sign * own for atom, own in form.items()})): sign}


def _written(form: Form) -> list[bytes]:
    return [part for atom in sorted(form) for part in (atom, str(form[atom]).encode())]


def _digest(operation: bytes, *parts: bytes) -> bytes:
    return blake2b(operation + b"|".join(parts), digest_size=16).digest()

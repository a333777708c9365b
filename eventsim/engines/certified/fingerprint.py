"""Fingerprints: a number by the expression that made it, so that equal expressions are seen to be equal.

A fingerprint is (sign, digest): a and -a share the digest, and sums and products do not depend on the order of their terms,
so that mirror images and exchanged disks are recognised.  The digest is one of 128 bits that nobody finds a collision of.
"""

from __future__ import annotations

from fractions import Fraction
from hashlib import blake2b
from typing import TypeAlias

Fingerprint: TypeAlias = tuple[int, bytes]


def of_rational(number: Fraction) -> Fingerprint:
    """The fingerprint of a rational number."""
    sign = -1 if number < 0 else 1
    return sign, _digest(b"q", f"{abs(number.numerator)}/{number.denominator}".encode())


def total(a: Fingerprint, b: Fingerprint) -> Fingerprint | None:
    """Of the sum a + b; None where it is 0, because b is -a."""
    (sign_a, one), (sign_b, other) = a, b
    if one == other and sign_a != sign_b:
        return None
    if other < one:
        sign_a, one, sign_b, other = sign_b, other, sign_a, one
    return sign_a, _digest(b"+" if sign_a == sign_b else b"-", one, other)


def product(a: Fingerprint, b: Fingerprint) -> Fingerprint:
    """Of the product a b."""
    return a[0] * b[0], _digest(b"*", *sorted((a[1], b[1])))


def quotient(a: Fingerprint, b: Fingerprint) -> Fingerprint:
    """Of the quotient a / b."""
    return a[0] * b[0], _digest(b"/", a[1], b[1])


def root(a: Fingerprint) -> Fingerprint:
    """Of the square root of a."""
    return 1, _digest(b"s", a[1])


def _digest(operation: bytes, *parts: bytes) -> bytes:
    return blake2b(operation + b"|".join(parts), digest_size=16).digest()

"""The law of large clusters: the same complementarity problem as of small ones, by descent in integers.

Exact rational numbers of hundreds of contacts have hundreds of thousands of digits, and redundant contacts (a triangular
lattice has them) make the impulses many, though the velocities are one.  Accelerated projected descent from zero impulses
needs neither a factorisation nor a choice: every step treats all contacts alike, and sums of integers have no order.  So its
result does not depend on the labels either, bit for bit, and it converges to velocities far below their last bit.

Source: Y. Nesterov, Soviet Math. Dokl. 27, 372 (1983); restart: B. O'Donoghue, E. Candes, Found. Comput. Math. 15, 715 (2015),
doi:10.1007/s10208-013-9150-3.
"""

import math
from fractions import Fraction

BITS = 192
"""Binary digits behind the point of the integers."""

DONE, GOOD = 2.0**-90, 2.0**-44
"""Largest step, relative to the largest approach, at which to stop; and at which the result is good when there are no more."""

MOST_STEPS = 4000
"""Descent needs about 60 steps for each disk across the cluster."""


class StrainedError(ArithmeticError):
    """The impulses do not settle: something is squeezed."""


def relaxed(matrix: list[list[Fraction]], q: list[Fraction]) -> list[Fraction]:
    """x >= 0 with matrix x + q >= 0 and x complementary to it, to about BITS/2 digits; matrix is positive semidefinite.

    O(contacts) a step.  Raises StrainedError where no x is found.
    """
    n = len(q)
    # Scaled by powers of two the diagonal is between 1 and 4, whatever the masses; approaches are at most 1.
    scale = [_half_exponent(matrix[k][k]) for k in range(n)]
    size = _power(math.frexp(float(max(-value for value in q)))[1])
    rows = [
        [(j, _whole(matrix[k][j] / _power(scale[k] + scale[j]))) for j in range(n) if matrix[k][j]] for k in range(n)
    ]
    offset = [_whole(q[k] / (_power(scale[k]) * size)) for k in range(n)]
    bound = max(sum(abs(value) for _, value in row) for row in rows)
    largest = max(abs(value) for value in offset)
    done, good = int(DONE * largest), int(GOOD * largest)
    x, y, since, step = [0] * n, [0] * n, 0, 0
    for _ in range(MOST_STEPS):
        new = []
        for k, row in enumerate(rows):
            slope = (sum(value * y[j] for j, value in row) >> BITS) + offset[k]
            moved = y[k] - (slope << BITS) // bound
            new.append(moved if moved > 0 else 0)
        step = max(abs(a - b) for a, b in zip(new, y, strict=True))
        if step <= done:
            break
        uphill = sum((b - a) * (a - c) for a, b, c in zip(new, y, x, strict=True)) > 0
        since = 0 if uphill else since + 1
        y = [a + ((a - c) * since) // (since + 3) for a, c in zip(new, x, strict=True)]
        x = new
    if step > good:
        raise StrainedError
    # what is left of an impulse that vanishes is noise of the last step
    return [Fraction(value if value > good else 0, 1 << BITS) * size / _power(scale[k]) for k, value in enumerate(new)]


def snapped(value: Fraction, size: float) -> Fraction:
    """A velocity without the noise below 2**-70 of the largest one: what vanishes is 0, what is a float is that float."""
    unit = _power(math.frexp(size)[1] - 70) if size > 0.0 else Fraction(1)
    return round(value / unit) * unit


def _half_exponent(value: Fraction) -> int:
    """s with value / 4**s in [1, 4), or nearly."""
    return (value.numerator.bit_length() - value.denominator.bit_length()) // 2 if value else 0


def _power(exponent: int) -> Fraction:
    return Fraction(1 << exponent) if exponent >= 0 else Fraction(1, 1 << -exponent)


def _whole(value: Fraction) -> int:
    return (value.numerator << BITS) // value.denominator

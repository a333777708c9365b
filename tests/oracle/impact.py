"""What contacts do: Newton's law with restitution for one, Moreau's law for several at one instant that share disks.

Source: J. J. Moreau, in: Nonsmooth Mechanics and Applications, CISM 302 (1988), doi:10.1007/978-3-7091-2624-0_1.
"""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal
from itertools import combinations

from tests.oracle.digits import ONE, ZERO, sign
from tests.oracle.table import Vector

MOST_TOGETHER = 10
"""Contacts of a cluster: the law is solved by trying which of them have an impulse."""


class SqueezedError(Exception):
    """No impulses part these contacts: a disk is squeezed between others that it cannot deflect."""


@dataclass(frozen=True)
class Together:
    """One of several contacts at an instant.

    a, b: disks, b = -1 for a wall.  normal: unit, pointing to a.
    """

    a: int
    b: int
    normal: Vector
    restitution: Decimal


def lightness(mass: Decimal | None) -> Decimal:
    """1 / mass; 0 of an infinite one."""
    return ZERO if mass is None else ONE / mass


def shares(mass_a: Decimal | None, mass_b: Decimal | None) -> tuple[Decimal, Decimal]:
    """What part of the change of their relative velocity each disk takes."""
    if mass_a is None or mass_b == 0:
        return ZERO, ONE
    if mass_b is None or mass_a == 0:
        return ONE, ZERO
    return mass_b / (mass_a + mass_b), mass_a / (mass_a + mass_b)


def parted(
    contacts: list[Together], velocity: dict[int, Vector], mass: list[Decimal | None]
) -> tuple[dict[int, Vector], list[Decimal], bool]:
    """(velocities after, impulses, whether the impulses are the only ones) of contacts at one instant.

    impulses q >= 0 with A q + (1 + e) u >= 0, complementary; A: what an impulse at one contact does to the approach
    at another. A wall that meets immovable disks alone has no finite impulse: such disks count with mass 1 here, as
    nothing else is in their cluster.
    """
    n = len(contacts)
    if n > MOST_TOGETHER:
        raise NotImplementedError(f"{n} contacts at one instant")
    light = {i: lightness(mass[i]) for i in velocity}
    if all(value == 0 for value in light.values()):
        light = dict.fromkeys(light, ONE)
    jacobian = [_row(c, velocity) for c in contacts]
    u = [_dot(row, velocity) for row in jacobian]
    a = [
        [
            sum(light[i] * (row[i][0] * other[i][0] + row[i][1] * other[i][1]) for i in row if i in other)
            for other in jacobian
        ]
        for row in jacobian
    ]
    a = [[Decimal(value) for value in row] for row in a]
    wanted = [-(1 + c.restitution) * value for c, value in zip(contacts, u, strict=True)]
    size = max(abs(value) for value in u)
    answers: list[list[Decimal]] = []
    for count in range(n + 1):
        for active in combinations(range(n), count):
            q = _solve(a, wanted, active)
            if q is None or any(sign(q[k], abs(q[k]) + size / _largest(a)) < 0 for k in active):
                continue
            after = [sum((a[k][j] * q[j] for j in active), ZERO) - wanted[k] for k in range(n)]
            if all(k in active or sign(after[k], abs(wanted[k]) + size) >= 0 for k in range(n)):
                answers.append(q)
        if answers:
            break
    if not answers:
        raise SqueezedError
    q = answers[0]
    result = dict(velocity)
    for row, impulse in zip(jacobian, q, strict=True):
        for i, (nx, ny) in row.items():
            result[i] = result[i][0] + light[i] * impulse * nx, result[i][1] + light[i] * impulse * ny
    return result, q, _solve(a, wanted, tuple(range(n))) is not None


def _row(contact: Together, velocity: dict[int, Vector]) -> dict[int, Vector]:
    nx, ny = contact.normal
    row = {contact.a: (nx, ny)}
    if contact.b >= 0 and contact.b in velocity:
        row[contact.b] = (-nx, -ny)
    return row


def _dot(row: dict[int, Vector], velocity: dict[int, Vector]) -> Decimal:
    return sum((n[0] * velocity[i][0] + n[1] * velocity[i][1] for i, n in row.items()), ZERO)


def _largest(a: list[list[Decimal]]) -> Decimal:
    return max(abs(value) for row in a for value in row)


def _solve(a: list[list[Decimal]], wanted: list[Decimal], active: tuple[int, ...]) -> list[Decimal] | None:
    """The impulses of the active contacts for which they part as wanted, 0 for the others; None where the equations
    are dependent.
    """
    rows = [[a[i][j] for j in active] + [wanted[i]] for i in active]
    n = len(active)
    for k in range(n):
        pivot = max(range(k, n), key=lambda r: abs(rows[r][k]))
        size = _largest(a)
        if sign(rows[pivot][k], size) == 0:
            return None
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for r in range(n):
            if r != k:
                factor = rows[r][k] / rows[k][k]
                rows[r] = [x - factor * y for x, y in zip(rows[r], rows[k], strict=True)]
    q = [ZERO] * len(a)
    for k, i in enumerate(active):
        q[i] = rows[k][n] / rows[k][k]
    return q

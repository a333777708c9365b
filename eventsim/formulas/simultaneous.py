"""Simultaneous contacts: one law for contacts that share disks and have the same time.

Moreau's impact law: the impulses lambda >= 0 of the approaching contacts are complementary to A lambda + (1+e) u >= 0, with
A = J M^-1 J^T and u the normal velocities.  It is symmetric in the labels, and so is this solution bit for bit: it is computed in
rational numbers, where the order of operations changes nothing, and rounded once.

Source: J. J. Moreau, in Nonsmooth Mechanics and Applications, CISM 302 (1988), doi:10.1007/978-3-7091-2624-0_1;
R. W. Cottle, J.-S. Pang, R. E. Stone, The Linear Complementarity Problem (1992), section 4.4 (Lemke's method).
"""

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import combinations
from typing import NamedTuple, TypeAlias

from eventsim.formulas.real import is_float
from eventsim.formulas.relaxation import StrainedError, relaxed, snapped


class SqueezedError(ArithmeticError):
    """No impulses part the contacts of a cluster: something is squeezed between bodies that it cannot deflect."""


class JointContact(NamedTuple):
    """One contact of a cluster: body a, body b (None: a wall), direction (dx, dy) from b to a of any length, restitution."""

    a: int
    b: int | None
    dx: float
    dy: float
    restitution: float


class Outcome(NamedTuple):
    """Velocities after the cluster, one (vx, vy) a body, and the momentum that each contact exchanged (0: it took no part)."""

    velocities: list[tuple[float, float]]
    impulses: list[float]
    active: list[bool]


Vector = tuple[Fraction, Fraction]
Solver: TypeAlias = Callable[[list[list[Fraction]], list[Fraction]], list[Fraction]]

MOST_EXACT = 40
"""Contacts of a cluster up to which rational numbers are fast, whatever the directions: about a second."""


def resolve_together(
    contacts: Sequence[JointContact], velocities: Sequence[tuple[float, float]], masses: Sequence[float]
) -> Outcome:
    """Resolve a cluster; its velocities are rounded once.

    The impulse between an immovable disk and a wall is nan: it has no finite size.  Clusters of more than MOST_EXACT contacts
    are resolved to many more digits than a float has, and not exactly.
    """
    exact: list[Vector] = [(Fraction(u), Fraction(w)) for u, w in velocities]
    if len(contacts) <= MOST_EXACT:
        after, magnitudes, active = resolve_exactly(contacts, exact, masses)
    else:
        try:
            after, magnitudes, active = resolve_exactly(contacts, exact, masses, relaxed)
        except StrainedError:
            raise SqueezedError from None
        size = max(max(abs(u), abs(w)) for u, w in velocities)
        after = [(snapped(u, size), snapped(w, size)) for u, w in after]
    return Outcome([(_float(u), _float(w)) for u, w in after], magnitudes, active)


def resolve_exactly(
    contacts: Sequence[JointContact],
    velocities: Sequence[Vector],
    masses: Sequence[float],
    solve: Solver | None = None,
) -> tuple[list[Vector], list[float], list[bool]]:
    """Resolve a cluster without rounding: immovable disks at walls, then the massive ones, then the tracers against these.

    Directions and restitutions of the contacts may be rational.  Returns velocities, magnitudes of the impulses (rounded;
    nan between an immovable disk and a wall) and which contacts took part.  solve: what solves the complementarity problem,
    `complementary` if None.
    """
    solver = complementary if solve is None else solve
    exact = list(velocities)
    impulses = [Fraction(0)] * len(contacts)
    tracers = {body for body, mass in enumerate(masses) if mass == 0.0}
    immovable = {body for body, mass in enumerate(masses) if math.isinf(mass)}
    braced = [k for k, c in enumerate(contacts) if c.b is None and c.a in immovable]
    for body in sorted({contacts[k].a for k in braced}):
        _resolve_alone(body, [k for k in braced if contacts[k].a == body], contacts, exact, impulses, solver)
    inverse = [Fraction(0) if m == 0.0 or math.isinf(m) else 1 / Fraction(m) for m in masses]
    massive = [k for k, c in enumerate(contacts) if k not in braced and c.a not in tracers and c.b not in tracers]
    _resolve(contacts, massive, exact, inverse, impulses, solver)
    norms = [math.hypot(c.dx, c.dy) for c in contacts]
    magnitudes = [_product(value, norm) for value, norm in zip(impulses, norms, strict=True)]
    for k in braced:
        magnitudes[k] = math.nan
    for body in sorted(tracers):
        _resolve_alone(body, [k for k, c in enumerate(contacts) if body in (c.a, c.b)], contacts, exact, impulses, solver)
    return exact, magnitudes, [value > 0 for value in impulses]


def are_apart(contacts: Sequence[JointContact]) -> bool:
    """Whether each contact of a cluster is what it would be alone: all are at walls, at exact right angles to each other."""
    numbers = [number for contact in contacts for number in (contact.dx, contact.dy)]
    if any(contact.b is not None for contact in contacts) or not all(map(is_float, numbers)):
        return False
    return all(
        Fraction(one.dx) * Fraction(other.dx) + Fraction(one.dy) * Fraction(other.dy) == 0
        for one, other in combinations(contacts, 2)
    )


def _resolve_alone(
    body: int,
    own: Sequence[int],
    contacts: Sequence[JointContact],
    velocities: list[Vector],
    impulses: list[Fraction],
    solve: Solver,
) -> None:
    """Resolve contacts as if only this body could change its velocity; its mass does not matter then."""
    inverse = [Fraction(int(k == body)) for k in range(len(velocities))]
    _resolve(contacts, own, velocities, inverse, impulses, solve)


def _resolve(
    contacts: Sequence[JointContact],
    chosen: Sequence[int],
    velocities: list[Vector],
    inverse: Sequence[Fraction],
    impulses: list[Fraction],
    solve: Solver,
) -> None:
    """Solve for the approaching ones among the chosen contacts; change velocities and impulses."""
    normals = {k: (Fraction(contacts[k].dx), Fraction(contacts[k].dy)) for k in chosen}
    approach = {k: _normal_velocity(contacts[k], normals[k], velocities) for k in chosen}
    rows = [k for k in chosen if approach[k] < 0]
    if not rows:
        return
    factors = [(1 + Fraction(contacts[k].restitution)) * approach[k] for k in rows]
    for k, value in zip(rows, solve(_matrix(contacts, rows, normals, inverse), factors), strict=True):
        if value == 0:
            continue
        impulses[k] = value
        contact, (nx, ny) = contacts[k], normals[k]
        for body, sign in ((contact.a, 1), (contact.b, -1)):
            if body is not None and inverse[body]:
                u, w = velocities[body]
                change = sign * value * inverse[body]
                velocities[body] = (u + change * nx, w + change * ny)


def _normal_velocity(contact: JointContact, normal: Vector, velocities: Sequence[Vector]) -> Fraction:
    u, w = velocities[contact.a]
    if contact.b is not None:
        u, w = u - velocities[contact.b][0], w - velocities[contact.b][1]
    return u * normal[0] + w * normal[1]


def _matrix(
    contacts: Sequence[JointContact], rows: list[int], normals: dict[int, Vector], inverse: Sequence[Fraction]
) -> list[list[Fraction]]:
    """J M^-1 J^T; contacts that share no body are not coupled."""
    at: dict[int, list[int]] = {}
    for place, k in enumerate(rows):
        for body in (contacts[k].a, contacts[k].b):
            if body is not None:
                at.setdefault(body, []).append(place)
    zero = Fraction(0)
    matrix = [[zero] * len(rows) for _ in rows]
    for places in at.values():
        for one in places:
            for other in places:
                j, k = rows[one], rows[other]
                matrix[one][other] = _coupling(contacts[j], normals[j], contacts[k], normals[k], inverse)
    return matrix


def _coupling(one: JointContact, n: Vector, other: JointContact, m: Vector, inverse: Sequence[Fraction]) -> Fraction:
    """An element of J M^-1 J^T: what a unit impulse at one contact does to the normal velocity at the other."""
    total = Fraction(0)
    for body, sign in ((one.a, 1), (one.b, -1)):
        if body is None or not inverse[body]:
            continue
        if body == other.a:
            total += sign * inverse[body]
        if body == other.b:
            total -= sign * inverse[body]
    if not total:
        return total
    return total * (n[0] * m[0] + n[1] * m[1])


def complementary(matrix: list[list[Fraction]], q: list[Fraction]) -> list[Fraction]:
    """x >= 0 with matrix x + q >= 0 and x complementary to it; matrix is positive semidefinite.

    All contacts active is what happens most often: that is tried first, by elimination; else Lemke's method, with the
    lexicographic rule against cycling.
    """
    guess = _eliminate(matrix, [-value for value in q])
    if guess is not None and all(value >= 0 for value in guess):
        return guess
    return _lemke(matrix, q)


def _eliminate(matrix: list[list[Fraction]], right: list[Fraction]) -> list[Fraction] | None:
    """The solution of a linear system, sparse rows first served; None if it is singular."""
    n = len(right)
    rows = [{k: value for k, value in enumerate(row) if value} for row in matrix]
    values = list(right)
    order: list[int] = []
    left = set(range(n))
    while left:
        pivot = min(left, key=lambda r: (len(rows[r]), r))
        if pivot not in rows[pivot]:
            return None
        left.discard(pivot)
        order.append(pivot)
        head, head_value = rows[pivot], values[pivot]
        for r in left:
            factor = rows[r].pop(pivot, None)
            if factor is None:
                continue
            ratio = factor / head[pivot]
            for column, value in head.items():
                if column != pivot:
                    changed = rows[r].get(column, Fraction(0)) - ratio * value
                    if changed:
                        rows[r][column] = changed
                    else:
                        rows[r].pop(column, None)
            values[r] -= ratio * head_value
    solution = [Fraction(0)] * n
    for pivot in reversed(order):
        head = rows[pivot]
        known = sum((value * solution[column] for column, value in head.items() if column != pivot), Fraction(0))
        solution[pivot] = (values[pivot] - known) / head[pivot]
    return solution


def _lemke(matrix: list[list[Fraction]], q: list[Fraction]) -> list[Fraction]:
    """Lemke's method on w = M z + q + z0; the tableau's columns are w, z, z0, and the right side."""
    n = len(q)
    if min(q) >= 0:
        return [Fraction(0)] * n
    z0, right = 2 * n, 2 * n + 1
    tableau = []
    for i in range(n):
        unit = [Fraction(int(i == j)) for j in range(n)]
        tableau.append([*unit, *(-value for value in matrix[i]), Fraction(-1), q[i]])
    basis = list(range(n))
    row = min(range(n), key=lambda i: (q[i], [-value for value in tableau[i][:n]]))
    entering = z0
    while True:
        leaving = basis[row]
        _pivot(tableau, row, entering)
        basis[row] = entering
        if leaving == z0:
            break
        entering = leaving + n if leaving < n else leaving - n
        candidates = [i for i in range(n) if tableau[i][entering] > 0]
        if not candidates:
            raise SqueezedError
        with_z0 = [i for i in candidates if basis[i] == z0]
        row = min(candidates, key=lambda i: _lexicographic(tableau[i], entering, right, n))
        ratio = tableau[row][right] / tableau[row][entering]
        for i in with_z0:
            if tableau[i][right] / tableau[i][entering] == ratio:
                row = i
    solution = [Fraction(0)] * n
    for i, variable in enumerate(basis):
        if n <= variable < z0:
            solution[variable - n] = tableau[i][right]
    return solution


def _lexicographic(row: list[Fraction], entering: int, right: int, n: int) -> list[Fraction]:
    pivot = row[entering]
    return [row[right] / pivot, *(value / pivot for value in row[:n])]


def _pivot(tableau: list[list[Fraction]], row: int, column: int) -> None:
    head = tableau[row]
    scale = head[column]
    head[:] = [value / scale for value in head]
    for i, other in enumerate(tableau):
        factor = other[column]
        if i != row and factor:
            other[:] = [value - factor * h for value, h in zip(other, head, strict=True)]


def _product(value: Fraction, norm: float) -> float:
    return _float(value * Fraction(norm)) if value else 0.0


def _float(value: Fraction) -> float:
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf

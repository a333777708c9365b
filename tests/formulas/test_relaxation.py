"""Large clusters: the same law, to more digits than a float has, and the same for every order of the labels."""

import math
from fractions import Fraction

import numpy as np
import pytest

from eventsim.formulas.relaxation import StrainedError, _half_exponent, _power, relaxed, snapped
from eventsim.formulas.simultaneous import JointContact, SqueezedError, complementary, resolve_together


def problem(seed):
    """A semidefinite matrix, often singular, and approaches that its columns reach."""
    rng = np.random.default_rng(seed)
    n, rank = int(rng.integers(2, 9)), int(rng.integers(2, 9))
    j = [[Fraction(int(value)) for value in row] for row in rng.integers(-3, 4, size=(n, rank))]
    j = [row if any(row) else [Fraction(1)] * rank for row in j]
    v = [Fraction(int(value)) for value in rng.integers(-5, 6, size=rank)]
    matrix = [[sum((a * b for a, b in zip(r, s, strict=True)), Fraction(0)) for s in j] for r in j]
    return j, matrix, [sum((a * b for a, b in zip(r, v, strict=True)), Fraction(0)) for r in j]


@pytest.mark.parametrize("seed", range(40))
def test_relaxation_and_elimination_give_the_same_velocities(seed):
    j, matrix, q = problem(seed)
    if min(q) >= 0:
        q = [-value for value in q]
    if min(q) >= 0:
        return
    changes = []
    for x in (complementary(matrix, q), relaxed(matrix, q)):
        changes.append([float(sum(a * row[k] for a, row in zip(x, j, strict=True))) for k in range(len(j[0]))])
    # relaxation stops at 2^-90 of the largest approach; the conditioning of these small integers costs less than 2^40
    assert changes[1] == pytest.approx(changes[0], abs=2.0**-50)


def triangular(shells):
    """The places of a hexagonal patch of touching disks, and all contacts in it."""
    sites = [(q, r) for q in range(-shells, shells + 1) for r in range(-shells, shells + 1) if abs(q + r) <= shells]
    place = np.array([(q + 0.5 * r, r * math.sqrt(0.75)) for q, r in sites])
    pairs = [(i, j) for i in range(len(place)) for j in range(i) if math.dist(place[i], place[j]) < 1.01]
    return place, pairs


@pytest.mark.parametrize("shells", [2, 4])
def test_a_triangular_lattice_that_contracts_flies_apart_as_it_came(shells):
    """90 contacts of 37 disks are redundant: impulses are many, velocities one."""
    place, pairs = triangular(shells)
    contacts = [JointContact(i, j, *(place[i] - place[j]).tolist(), 1.0) for i, j in pairs]
    masses = [1.0] * len(place)
    outcome = resolve_together(contacts, [tuple(v) for v in (-place).tolist()], masses)
    # the directions are rounded to an ulp of the coordinates, below 4: so are the velocities
    assert np.array(outcome.velocities) == pytest.approx(place, abs=2.0**-48)
    order = np.random.default_rng(1).permutation(len(place))
    label = np.argsort(order).tolist()
    moved = [JointContact(label[c.a], label[c.b], c.dx, c.dy, 1.0) for c in reversed(contacts)]
    other = resolve_together(moved, [tuple(v) for v in (-place[order]).tolist()], masses)
    assert other.velocities == [outcome.velocities[k] for k in order.tolist()]
    assert other.impulses == outcome.impulses[::-1]
    assert other.active == outcome.active[::-1]


def test_a_long_row_squeezed_between_immovable_ends_is_refused():
    n = 50
    contacts = [JointContact(k + 1, k, 1.0, 0.0, 1.0) for k in range(n - 1)]
    velocities = [(1.0, 0.0)] + [(0.5 - k / n, 0.0) for k in range(1, n - 1)] + [(-1.0, 0.0)]
    with pytest.raises(SqueezedError):
        resolve_together(contacts, velocities, [math.inf, *[1.0] * (n - 2), math.inf])


def test_relaxation_says_when_nothing_settles():
    with pytest.raises(StrainedError):
        relaxed([[Fraction(1), Fraction(-1)], [Fraction(-1), Fraction(1)]], [Fraction(-1), Fraction(-1)])


TWO = [[Fraction(2), Fraction(1)], [Fraction(1), Fraction(2)]]


def test_a_contact_without_impulse_has_exactly_none():
    x = relaxed(TWO, [Fraction(-2), Fraction(5)])
    assert float(x[0]) == 1.0
    assert x[1] == 0


def test_contacts_of_very_uneven_masses_relax_as_fast():
    """With the scaled matrix of these units the solution is (1, 1); unscaled its condition would be 2**40."""
    units = [Fraction(2**10), Fraction(1, 2**10)]
    matrix = [[TWO[j][k] * units[j] * units[k] for k in range(2)] for j in range(2)]
    x = relaxed(matrix, [-3 * unit for unit in units])
    # 2^-90 of the largest approach, which is 2^20 times the other one
    assert [float(value * unit) for value, unit in zip(x, units, strict=True)] == pytest.approx(
        [1.0, 1.0], abs=2.0**-50
    )


@pytest.mark.parametrize(
    ("value", "size", "kept"),
    [
        (Fraction(1, 3), 0.0, 0),
        (Fraction(2, 3), 0.0, 1),
        (Fraction(1, 2**70), 1.0, 0),  # half a unit of 2^-69
        (Fraction(3, 2**70), 1.0, Fraction(1, 2**68)),
        (Fraction(1, 2**71), 0.5, 0),
        (Fraction(3, 2**71), 0.5, Fraction(1, 2**69)),
        (Fraction(0.1) + Fraction(1, 2**75), 1.0, Fraction(0.1)),
        (-Fraction(0.1) - Fraction(1, 2**75), 1.0, -Fraction(0.1)),
    ],
)
def test_what_is_below_70_bits_of_the_largest_velocity_is_noise(value, size, kept):
    assert snapped(value, size) == kept


def test_powers_of_two():
    assert [_power(k) for k in (-2, -1, 0, 1, 2)] == [Fraction(1, 4), Fraction(1, 2), 1, 2, 4]
    values = [Fraction(0), Fraction(1), Fraction(4), Fraction(1, 4), Fraction(2**10), Fraction(1, 2**10)]
    assert [_half_exponent(value) for value in values] == [0, 0, 1, -1, 5, -5]

"""The law of simultaneous contacts: complementary, conserving, and the same for every order of the contacts."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, reject, settings
from hypothesis import strategies as st

from eventsim.formulas.simultaneous import JointContact, SqueezedError, complementary, resolve_together


def random_cluster(seed):
    """A chain or star of disks whose contacts all approach more or less."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(3, 7))
    contacts = []
    for k in range(1, n):
        angle = rng.uniform(0.0, 2.0 * math.pi)
        other = int(rng.integers(0, k))
        contacts.append(JointContact(k, other, math.cos(angle), math.sin(angle), float(rng.choice([1.0, 0.5, 0.0]))))
    if rng.random() < 0.5:
        contacts.append(JointContact(0, None, 0.0, 1.0, 0.7))
    velocities = [tuple(v) for v in rng.normal(size=(n, 2)).tolist()]
    masses = rng.choice([1.0, 3.0, math.inf, 0.0, 2.0], size=n).tolist()
    contacts = [
        c for c in contacts if c.b is None or not (masses[c.a] == masses[c.b] and masses[c.a] in (0.0, math.inf))
    ]
    return contacts, velocities, masses


@settings(max_examples=150, deadline=None)
@given(st.integers(0, 10**6), st.integers(0, 10**6))
def test_the_order_of_contacts_and_labels_changes_no_bit(seed, shuffle):
    contacts, velocities, masses = random_cluster(seed)
    rng = np.random.default_rng(shuffle)
    label = rng.permutation(len(masses)).tolist()
    order = rng.permutation(len(contacts)).tolist()
    try:
        expected = resolve_together(contacts, velocities, masses)
    except SqueezedError:
        reject()
    moved = [
        JointContact(label[c.a], None if c.b is None else label[c.b], c.dx, c.dy, c.restitution)
        for c in (contacts[k] for k in order)
    ]
    at = [label.index(k) for k in range(len(masses))]
    got = resolve_together(moved, [velocities[k] for k in at], [masses[k] for k in at])
    assert [got.velocities[label[k]] for k in range(len(masses))] == expected.velocities
    assert got.active == [expected.active[k] for k in order]


@settings(max_examples=150, deadline=None)
@given(st.integers(0, 10**6))
def test_massive_disks_obey_moreaus_law(seed):
    contacts, velocities, masses = random_cluster(seed)
    masses = [2.0 if m == 0.0 or math.isinf(m) else m for m in masses]
    outcome = resolve_together(contacts, velocities, masses)
    momentum = np.zeros(2)
    for c, impulse, active in zip(contacts, outcome.impulses, outcome.active, strict=True):
        before = normal_velocity(c, velocities)
        after = normal_velocity(c, outcome.velocities)
        assert impulse >= 0.0
        if before < 0.0:
            assert after + c.restitution * before >= -1e-12
        if active:
            assert before < 0.0
            assert after == pytest.approx(-c.restitution * before, abs=1e-12)
        if c.b is None:
            momentum += impulse * np.array([c.dx, c.dy])
    change = sum(
        m * (np.array(v) - np.array(u)) for m, u, v in zip(masses, velocities, outcome.velocities, strict=True)
    )
    assert change == pytest.approx(momentum, abs=1e-12)


def normal_velocity(c, velocities):
    u, w = velocities[c.a]
    if c.b is not None:
        u, w = u - velocities[c.b][0], w - velocities[c.b][1]
    return u * c.dx + w * c.dy


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10**6))
def test_a_complementary_solution_is_found_for_every_semidefinite_matrix(seed):
    rng = np.random.default_rng(seed)
    n, rank = int(rng.integers(1, 7)), int(rng.integers(1, 7))
    j = [[Fraction(int(value)) for value in row] for row in rng.integers(-3, 4, size=(n, rank))]
    matrix = [[sum((a * b for a, b in zip(r, s, strict=True)), Fraction(0)) for s in j] for r in j]
    v = [Fraction(int(value)) for value in rng.integers(-5, 6, size=rank)]
    q = [sum((a * b for a, b in zip(r, v, strict=True)), Fraction(0)) for r in j]
    x = complementary(matrix, q)
    w = [
        sum((a * b for a, b in zip(row, x, strict=True)), Fraction(0)) + value
        for row, value in zip(matrix, q, strict=True)
    ]
    assert min(x) >= 0
    assert min(w) >= 0
    assert sum(a * b for a, b in zip(x, w, strict=True)) == 0


def test_an_immovable_disk_at_a_wall_is_reflected_and_tracers_come_last():
    contacts = [JointContact(0, None, 0.0, 1.0, 1.0), JointContact(1, 0, 0.0, 1.0, 1.0)]
    outcome = resolve_together(contacts, [(0.0, -1.0), (0.0, -1.0)], [math.inf, 1.0])
    assert outcome.velocities == [(0.0, 1.0), (0.0, 3.0)]
    contacts = [JointContact(0, 1, 1.0, 0.0, 1.0), JointContact(2, 1, 0.0, 1.0, 1.0)]
    outcome = resolve_together(contacts, [(-1.0, 0.0), (0.0, 0.0), (0.0, -1.0)], [1.0, 1.0, 0.0])
    assert outcome.velocities == [(0.0, 0.0), (-1.0, 0.0), (0.0, 1.0)]


def test_a_disk_between_immovable_ones_that_close_in_on_it_is_squeezed():
    contacts = [JointContact(1, 0, 1.0, 0.0, 1.0), JointContact(1, 2, -1.0, 0.0, 1.0)]
    with pytest.raises(SqueezedError):
        resolve_together(contacts, [(1.0, 0.0), (0.0, 0.0), (-1.0, 0.0)], [math.inf, 1.0, math.inf])


def test_impulses_are_momenta_whatever_the_length_of_the_directions():
    for length in (1.0, 128.0):
        contacts = [
            JointContact(0, 1, 3.0 * length, 4.0 * length, 1.0),
            JointContact(2, 1, -4.0 * length, 3.0 * length, 1.0),
        ]
        outcome = resolve_together(contacts, [(-3.0, -4.0), (0.0, 0.0), (0.0, 0.0)], [1.0, 1.0, 1.0])
        assert outcome.velocities == [(0.0, 0.0), (-3.0, -4.0), (0.0, 0.0)]
        assert outcome.impulses == [5.0, 0.0]
        assert outcome.active == [True, False]


def test_the_impulse_between_an_immovable_disk_and_a_wall_has_no_size():
    contacts = [JointContact(0, None, 0.0, 1.0, 1.0), JointContact(1, 0, 0.0, 1.0, 1.0)]
    outcome = resolve_together(contacts, [(0.0, -1.0), (0.0, -1.0)], [math.inf, 1.0])
    assert math.isnan(outcome.impulses[0])
    assert outcome.impulses[1] == 4.0
    assert outcome.active == [True, True]


def test_an_immovable_disk_may_be_named_first():
    contacts = [JointContact(0, 1, 1.0, 0.0, 1.0), JointContact(2, 1, 0.0, 1.0, 0.5)]
    outcome = resolve_together(contacts, [(-1.0, 0.0), (0.0, 0.0), (0.0, -2.0)], [math.inf, 1.0, math.inf])
    assert outcome.velocities == [(-1.0, 0.0), (-2.0, -3.0), (0.0, -2.0)]


def test_two_images_of_one_disk_push_it_together():
    one, other, turned = (
        JointContact(0, 1, 5.0, 0.0, 1.0),
        JointContact(0, 1, 3.0, 4.0, 1.0),
        JointContact(1, 0, -3.0, -4.0, 1.0),
    )
    velocities, masses = [(-4.0, -2.0), (0.0, 0.0)], [1.0, 3.0]
    outcome = resolve_together([one, other], velocities, masses)
    assert outcome.velocities == [(2.0, 1.0), (-2.0, -1.0)]  # both approaches turn round: the relative velocity does
    assert resolve_together([one, turned], velocities, masses) == outcome


@pytest.mark.parametrize("n", [2, 3, 4, 5])
def test_contacts_that_are_all_coupled_are_all_turned_round(n):
    """A matrix without zeros: 1 beside the diagonal, 2 on it."""
    matrix = [[Fraction(1 + (j == k)) for k in range(n)] for j in range(n)]
    assert complementary(matrix, [Fraction(-n - 1)] * n) == [1] * n
    assert complementary(matrix, [Fraction(-1)] + [Fraction(3)] * (n - 1)) == [Fraction(1, 2)] + [0] * (n - 1)
    assert complementary(matrix, [Fraction(3)] * (n - 1) + [Fraction(-1)]) == [0] * (n - 1) + [Fraction(1, 2)]
    approaches = [Fraction(-sum(range(1, n + 1)) - k) for k in range(1, n + 1)]
    assert complementary(matrix, approaches) == list(range(1, n + 1))


def test_velocities_beyond_all_floats_are_infinite_with_their_sign():
    outcome = resolve_together(
        [JointContact(0, 1, 1.0, 0.0, 1.0), JointContact(2, 0, 0.0, 1.0, 1.0)],
        [(1e308, 0.0), (1.7e308, 0.0), (0.0, 0.0)],
        [1.0, math.inf, 1.0],
    )
    assert outcome.velocities[0] == (math.inf, 0.0)
    outcome = resolve_together([JointContact(0, 1, -1.0, 0.0, 1.0)], [(-1e308, 0.0), (-1.7e308, 0.0)], [1.0, math.inf])
    assert outcome.velocities[0] == (-math.inf, 0.0)


def test_contacts_in_a_ring_are_coupled_by_elimination_too():
    """Of four in a ring, the neighbours of one are not coupled before it is eliminated."""
    matrix = [[Fraction({0: 4, 1: 1, 2: 0, 3: 1}[abs(j - k)]) for k in range(4)] for j in range(4)]
    assert complementary(matrix, [Fraction(-value) for value in (10, 12, 18, 20)]) == [1, 2, 3, 4]

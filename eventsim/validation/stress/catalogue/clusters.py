"""Simultaneous contacts: racks, cradles, corners, clusters, lattices."""

from __future__ import annotations

import math
from itertools import permutations

import numpy as np

from eventsim.scene import Disks, Scene
from eventsim.scene.gallery import gallery
from eventsim.validation.stress.case import Bench, Case, off
from eventsim.validation.stress.catalogue.scenes import in_box, on_plane, relabelled

ULP = 2.0**-52


PERIOD = 18.0
"""Of `diagonal`."""


def diagonal() -> Scene:
    """A disk that flies between two corners of a box and meets both walls of each at once."""
    return in_box(10.0, [[5.0, 5.0]], [[1.0, 1.0]])


def _corner(bench: Bench) -> float:
    run = bench.run(diagonal(), until=PERIOD * 200)
    return max(off(run.state.position, [[5.0, 5.0]]), off(run.state.velocity, [[1.0, 1.0]]))


def _cradle(bench: Bench) -> float:
    worst = 0.0
    for moving in (1, 2, 3):
        x = [-2.0 - k for k in range(moving, 0, -1)] + [float(k) for k in range(5 - moving)]
        v = [[1.0, 0.0]] * moving + [[0.0, 0.0]] * (5 - moving)
        run = bench.run(on_plane([[value, 0.0] for value in x], v), until=20.0)
        worst = max(worst, off(run.state.velocity, v[::-1]))
    return worst


def _unequal_cradle(bench: Bench) -> float:
    """1 hits 3 and 1, touching, e = 1/2: one by one 1 -> 3, then 3 -> 1."""
    scene = on_plane(
        [[-3.0, 0.0], [0.0, 0.0], [1.0, 0.0]],
        [[1.0, 0.0], [0.0, 0.0], [0.0, 0.0]],
        mass=[1.0, 3.0, 1.0],
        restitution=0.5,
    )
    run = bench.run(scene, until=10.0)
    # e = 1/2: v0 = 1 - 1.5 * 3/4, v1 = 1.5/4; then v1 falls by 1.5/4 of itself and v2 gains 1.5 * 3/4 of it
    return off(run.state.velocity[:, 0], [-0.125, 0.375 * 0.625, 0.375 * 1.125])


AFTER_BREAK = np.array([[-7 / 57, 0.0], [32 / 57, 24 / 57], [32 / 57, -24 / 57]])
"""(3, 2) the velocities that the disks of `symmetric_break` leave with."""


def symmetric_break() -> Scene:
    """A disk meets two at rest at once, along the hypotenuses of 3-4-5 triangles."""
    return on_plane([[-3.0, 0.0], [4.0, 3.0], [4.0, -3.0]], [[1.0, 0.0], [0.0, 0.0], [0.0, 0.0]], 2.5)


def _break(bench: Bench) -> float:
    scene = symmetric_break()
    worst = 0.0
    for order in permutations(range(3)):
        run = bench.run(relabelled(scene, list(order)), until=3.5)
        worst = max(worst, off(run.state.velocity, AFTER_BREAK[list(order)]))
    return worst


def _rack(bench: Bench) -> float:
    """The break of fifteen touching disks, mirrored and relabelled: the largest difference of velocities."""
    scene = gallery("break")
    first = bench.run(scene, events=60)
    reference = first.state.velocity
    order = np.random.default_rng(5).permutation(len(scene.disks))
    other = bench.run(relabelled(scene, order), until=first.time)
    back = np.empty_like(reference)
    back[order] = other.state.velocity
    return off(back, bench.run(scene, until=first.time).state.velocity)


def _three_onto_one(bench: Bench) -> float:
    """Labels: coordinates at 120 degrees are not exactly symmetric in floats, so the outcome itself is not that of symmetry."""
    angles = 2.0 * math.pi * np.arange(3) / 3.0
    ring = np.column_stack([np.cos(angles), np.sin(angles)])
    scene = on_plane(np.vstack([[[0.0, 0.0]], 3.0 * ring]), np.vstack([[[0.0, 0.0]], -ring]))
    first = bench.run(scene, until=4.0).state.velocity
    orders = ([3, 1, 0, 2], [2, 3, 1, 0], [1, 2, 3, 0])
    return max(off(bench.run(relabelled(scene, order), until=4.0).state.velocity, first[order]) for order in orders)


def _four_onto_one(bench: Bench) -> float:
    ring = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
    scene = on_plane(np.vstack([[[0.0, 0.0]], 3.0 * ring]), np.vstack([[[0.0, 0.0]], -ring]))
    expected = np.vstack([[[0.0, 0.0]], ring])
    orders = ([0, 1, 2, 3, 4], [3, 1, 0, 4, 2], [4, 2, 3, 1, 0])
    return max(off(bench.run(relabelled(scene, order), until=4.0).state.velocity, expected[order]) for order in orders)


def _heavy_middle(bench: Bench) -> float:
    scene = on_plane(
        [[-3.0, 0.0], [0.0, 0.0], [3.0, 0.0]], [[1.0, 0.0], [0.0, 0.0], [-1.0, 0.0]], mass=[1.0, 1000.0, 1.0]
    )
    worst = 0.0
    for order in permutations(range(3)):
        run = bench.run(relabelled(scene, list(order)), until=4.0)
        worst = max(worst, off(run.state.velocity[:, 0], np.array([-1.0, 0.0, 1.0])[list(order)]))
    return worst


def _mixed(bench: Bench) -> float:
    """A disk between a tracer, an immovable disk and two heavier ones; against itself in another order of labels."""
    scene = on_plane(
        [[0.0, 0.0], [3.0, 0.0], [-3.0, 0.0], [0.0, 3.0], [0.0, -3.0]],
        [[0.0, 0.0], [-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0]],
        mass=[1.0, math.inf, 2.0, 3.0, 0.0],
    )
    first = bench.run(scene, until=2.5).state.velocity
    order = [4, 2, 0, 3, 1]
    other = bench.run(relabelled(scene, order), until=2.5).state.velocity
    # between the immovable one at -1 and m = 2 at 1: 0 leaves along x with what Moreau's law gives, 2 is thrown back
    return max(off(other, first[order]), off(first[1], [-1.0, 0.0]))


def contracting_lattice(columns: int) -> Scene:
    """A square lattice of touching disks that moves onto its centre: every contact approaches at once."""
    sites = np.array([(i, j) for i in range(columns) for j in range(columns)], float) - 0.5 * (columns - 1)
    return Scene(Disks(sites, -sites, 0.5), on_plane([[0.0, 0.0]], [[0.0, 0.0]]).domain)


def _lattice(bench: Bench) -> float:
    """Elastic: by the symmetry of the lattice every gap opens as fast as it closed, so it flies apart as it came."""
    scene = contracting_lattice(20)
    order = np.random.default_rng(3).permutation(len(scene.disks))
    one = bench.run(scene, until=1.0).state.velocity
    other = bench.run(relabelled(scene, order), until=1.0).state.velocity
    return max(off(one, -scene.disks.velocity), off(other, one[order]))


CASES = (
    Case(
        "f4-corner",
        "a disk that meets both walls of a corner at once",
        "One of two simultaneous contacts is lost, or they are taken one by one with a step between.",
        "Both components turn round; period 18, bit-exact.",
        0.0,
        "All numbers are dyadic.",
        _corner,
    ),
    Case(
        "f5-cradle",
        "a touching cradle: one, two, three in",
        "Solved at once the impulse spreads over all disks; in steps it depends on their order.",
        "As many leave as came, the others stop exactly.",
        0.0,
        "Exchange of velocities of equal disks along x is exact.",
        _cradle,
    ),
    Case(
        "f5-unequal-cradle",
        "a cradle of unequal masses that loses energy",
        "As the cradle, and velocities must go through the middle disk.",
        "Pair by pair, in closed form.",
        4 * ULP,
        "A few rounded operations.",
        _unequal_cradle,
    ),
    Case(
        "f6-break",
        "a disk meets two at once",
        "Taken one by one, the outcome flips with the order of the labels.",
        "Exact rationals: targets 40/57 along (.8, +-.6), cue -7/57; for every order of labels.",
        ULP / 2,
        "Rational numbers, rounded once.",
        _break,
    ),
    Case(
        "f6-rack",
        "the touching break of fifteen, relabelled",
        "Dozens of simultaneous contacts whose outcome follows the order in memory.",
        "Invariance: another order of labels, the same velocities.",
        0.0,
        "The law of simultaneous contacts is symmetric, bit for bit.",
        _rack,
    ),
    Case(
        "f6-three-onto-one",
        "three disks at 120 degrees onto one at rest",
        "Taken one by one, the outcome flips with the order of the labels.",
        "Invariance: another order of labels, the same velocities.",
        0.0,
        "Contact times are symmetric in the labels.",
        _three_onto_one,
    ),
    Case(
        "f6-four-onto-one",
        "four disks at right angles onto one at rest",
        "Taken one by one, the one in the middle is left with a velocity.",
        "By symmetry the four go back as they came.",
        0.0,
        "Symmetric in floats.",
        _four_onto_one,
    ),
    Case(
        "f6-heavy-middle",
        "two light disks onto a heavy one, from both sides",
        "Taken one by one, the heavy one is left with a velocity.",
        "It stays at rest, the others turn round; for every order of labels.",
        0.0,
        "Symmetric in floats.",
        _heavy_middle,
    ),
    Case(
        "c1-mixed",
        "a cluster with a tracer and an immovable disk",
        "Masses 0 and inf make the equations of a cluster singular.",
        "Invariance under relabelling; the immovable disk keeps its velocity.",
        0.0,
        "Rational numbers, rounded once.",
        _mixed,
    ),
    Case(
        "c2-lattice",
        "a lattice of 400 touching disks contracts onto its centre",
        "760 contacts at one instant, 361 of them redundant: impulses are not unique, velocities are.",
        "By Moreau's law every gap opens as fast as it closed: all velocities turn round.  For every order of labels.",
        0.0,
        "Half-integers, rounded once.",
        _lattice,
    ),
)

"""Scales: far away, late, tiny, huge, and mass or radius ratios that leave no digits to a naive formula."""

from __future__ import annotations

import math

import numpy as np

from eventsim.errors import SceneError
from eventsim.replay.past import PastRun
from eventsim.scene import Box, Disks, Scene
from eventsim.scene.gallery import gallery
from eventsim.validation.stress.case import Bench, Case, off
from eventsim.validation.stress.catalogue.scenes import exact_delay, lattice_gas, on_plane, with_disks

ULP = 2.0**-52
EXPONENTS = (-200, -60, 60, 200)


def _rounding_overlap(bench: Bench) -> float:
    scene = on_plane([[1e6, 0.0], [1e6 + 1.0 - 1e-9, 0.0]], [[1.0, 0.0], [0.0, 0.0]])
    run = bench.run(scene, until=5.0)
    return off(run.state.velocity, [[0.0, 0.0], [1.0, 0.0]])


def _speeds(bench: Bench) -> float:
    scene = lattice_gas(12, 0.3, seed=3)
    base = bench.run(scene, until=2.0)
    worst = 0.0
    for k in EXPONENTS:
        disks = scene.disks
        faster = Disks(disks.position, np.ldexp(disks.velocity, k), disks.radius, disks.mass)
        run = bench.run(with_disks(scene, faster), until=math.ldexp(2.0, -k))
        worst = max(worst, abs(run.counters.events - base.counters.events), _apart(run, base, k))
    return worst


def _apart(run: PastRun, base: PastRun, exponent: int) -> float:
    velocity = np.ldexp(run.state.velocity, -exponent)
    return max(off(velocity, base.state.velocity), off(run.state.position, base.state.position))


def _shift(bench: Bench) -> float:
    base = lattice_gas(12, 0.3, quantum=0.125, seed=4)
    assert base.domain.size is not None
    first = bench.run(base, until=4.0)
    shift = 2.0**20
    disks = base.disks
    moved = Disks(disks.position + shift, disks.velocity, disks.radius, disks.mass)
    run = bench.run(with_disks(base, moved, domain=Box(base.domain.size, (shift, shift))), until=4.0)
    return off(run.state.velocity, first.state.velocity)


def _late(bench: Bench) -> float:
    base = lattice_gas(12, 0.3, quantum=0.125, seed=4)
    first = bench.run(base, until=4.0)
    worst = 0.0
    for start in (2.0**20, 2.0**30):
        run = bench.run(with_disks(base, base.disks, start_time=start), until=start + 4.0)
        worst = max(worst, off(run.state.velocity, first.state.velocity), off(run.state.position, first.state.position))
    return worst


def _galperin(bench: Bench) -> float:
    return abs(bench.run(gallery("galperin", mass_ratio=1e6)).counters.events - 3141)


def _extreme_masses(bench: Bench) -> float:
    worst = 0.0
    for masses, after in (
        ((1e200, 1e200), (0.0, 1.0)),
        ((1e16, 1.0), (1.0 - 2e-16, 2.0)),
        ((math.inf, 1.0), (1.0, 2.0)),
        ((0.0, 1.0), (-1.0, 0.0)),
        ((1e-300, 1e300), (-1.0, 0.0)),
    ):
        run = bench.run(on_plane([[-3.0, 0.0], [0.0, 0.0]], [[1.0, 0.0], [0.0, 0.0]], mass=masses), until=10.0)
        worst = max(worst, off(run.state.velocity[:, 0], after))
    return worst


def _extreme_radii(bench: Bench) -> float:
    """The error of the contact's time, speed 1, relative to the gap of 1."""
    scene = on_plane([[0.0, 0.0], [1e8 + 2.0, 0.25]], [[0.0, 0.0], [-1.0, 0.0]], radius=[1e8, 1.0])
    run = bench.run(scene, until=5.0, log=True)
    return off(run.log.time, [exact_delay(-1e8 - 2.0, -0.25, 1.0, 0.0, 1e8 + 1.0)])


def _one_large(bench: Bench) -> float:
    """One disk of radius 30 among 300 of radius 1/2: energy, and overlaps in reaches."""
    rng = np.random.default_rng(8)
    sites = [(i + 0.5, j + 0.5) for i in range(-44, 44, 4) for j in range(-44, 44, 4)]
    small = np.array([site for site in sites if math.hypot(*site) > 32.0])
    position = np.vstack([[[0.0, 0.0]], small])
    velocity = np.vstack([[[0.0, 0.0]], rng.normal(size=small.shape)])
    radius = np.array([30.0, *[0.5] * len(small)])
    scene = Scene(Disks(position, velocity, radius, radius**2), Box((100.0, 100.0), (-50.0, -50.0)))
    run = bench.run(scene, events=500)
    return max(run.residuals.max_overlap, abs(run.residuals.energy or 0.0))


def _subnormal(bench: Bench) -> float:
    """0 where the scene is refused with a message, or the velocities are exchanged."""
    tiny = 1e-310
    try:
        scene = on_plane([[0.0, 0.0], [3.0 * tiny, 0.0]], [[tiny, 0.0], [0.0, 0.0]], tiny)
    except SceneError:
        return 0.0
    run = bench.run(scene, until=3.0)
    return off(run.state.velocity / tiny, [[0.0, 0.0], [1.0, 0.0]])


CASES = (
    Case(
        "f10-rounding-overlap",
        "an overlap by rounding, 10^6 from the origin",
        "The gap is negative: the contact is in the past, and lost or at a negative delay.",
        "Contact now: the velocities are exchanged.",
        ULP,
        "An exchange of velocities along x, rounded once.",
        _rounding_overlap,
    ),
    Case(
        "f13-speeds",
        "speeds of 10^-60 to 10^60",
        "Squares of speeds under- or overflow; absolute tolerances lose their meaning.",
        "Invariance: times scale by an exact power of two, everything else keeps its bits.",
        0.0,
        "A power of two changes no digit.",
        _speeds,
    ),
    Case(
        "f14-shift",
        "a box shifted by 2^20",
        "Absolute coordinates lose twenty bits.",
        "Invariance: the same velocities.",
        0.0,
        "Positions relative to the corner are the same.",
        _shift,
    ),
    Case(
        "f15-late",
        "a clock that starts at 2^20, 2^30",
        "An absolute clock loses twenty or thirty bits of every contact time.",
        "Invariance: the same positions and velocities.",
        0.0,
        "The clock counts from the start.",
        _late,
    ),
    Case(
        "f17-galperin",
        "two disks and a wall, mass ratio 10^6",
        "Contacts follow each other ever faster; steps miss most of them.",
        "ceil(pi/theta) - 1 = 3141 contacts (Galperin 2003, doi:10.1070/RD2003v008n04ABEH000252).",
        0.0,
        "A count.",
        _galperin,
    ),
    Case(
        "f17-masses",
        "masses 0, 10^-300, 1, 10^200, inf",
        "m1 m2 overflows; inf / inf is not a number.",
        "The pair update in mass fractions.",
        4 * ULP,
        "A few rounded operations.",
        _extreme_masses,
    ),
    Case(
        "f18-radii",
        "a radius ratio of 10^8, gap 1",
        "d^2 - reach^2 is the difference of two numbers of 10^16.",
        "60 decimal digits.",
        4 * ULP,
        "A few rounded operations on a time of about 1.",
        _extreme_radii,
    ),
    Case(
        "f18-one-large",
        "one disk of radius 30 among 300 of radius 1/2",
        "A cell grid as wide as the largest disk holds all others in one cell.",
        "Energy is conserved, nothing overlaps.",
        500 * 60 * ULP,
        "An ulp of the coordinates (50) and of the energy for each of 500 contacts, relative.",
        _one_large,
    ),
    Case(
        "f21-subnormal",
        "lengths and speeds of 10^-310",
        "Products vanish: the disks fly through each other without a word.",
        "Exact to the spacing of subnormal numbers, or a clear message.",
        1e-12,
        "The spacing 5e-324 relative to 1e-310, a few operations.",
        _subnormal,
        ("digits",),
    ),
)

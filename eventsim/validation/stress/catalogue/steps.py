"""What only steps get wrong: tunnelling, sticking, energy from springs, lost order, contacts that are missing."""

from __future__ import annotations

import math

import numpy as np

from eventsim.engines import ENGINES
from eventsim.engines.base import Stop
from eventsim.runner.loop import run_scene
from eventsim.scene import Box, Disks, Scene, Segment
from eventsim.validation.stress.case import Bench, Case, off
from eventsim.validation.stress.catalogue.scenes import lattice_gas, on_plane, with_disks

ULP = 2.0**-52

FAST = 57.0
"""A speed at which a disk flies 1.9 of its radii in the sixtieth of a second that a frame takes."""


def _tunnel(bench: Bench) -> float:
    """One disk at speed 1000 among slow ones, so that a usual step is far too long for it."""
    slow = [[20.0 + 2.0 * k, 5.0] for k in range(30)]
    position = [[-1.0, 0.0], [0.0, 0.0], *slow]
    velocity = [[1000.0, 0.0], [0.0, 0.0], *[[0.0, 1.0]] * len(slow)]
    run = bench.run(on_plane(position, velocity, 0.1), until=1 / 60)
    return off(run.state.velocity[:2] / 1000.0, [[0.0, 0.0], [1.0, 0.0]])


def _sticking(bench: Bench) -> float:
    """The deepest that a disk is inside a wall at two hundred moments, in radii."""
    scene = lattice_gas(25, 0.5, seed=21)
    assert scene.domain.size is not None
    side, until = scene.domain.size[0], 5.0
    run = bench.run(scene, until=until, log=True)
    worst = 0.0
    for time in np.linspace(0.0, until, 200).tolist():
        place = run.state_at(time).position
        worst = max(worst, float((0.5 - place).max()), float((place + 0.5 - side).max()))
    return worst / 0.5


def _springs(bench: Bench) -> float:
    """The change of energy, relative, after ten time units of a gas."""
    scene = lattice_gas(36, 0.4, seed=22)
    run = bench.run(scene, until=10.0)
    return abs(float((run.state.velocity**2).sum() / (scene.disks.velocity**2).sum()) - 1.0)


def _one_contact(bench: Bench) -> float:
    """3-4-5: contact at t = 3 with normal (.8, .6); positions at t = 10."""
    scene = on_plane([[-3.0, 0.0], [4.0, 3.0]], [[1.0, 0.0], [0.0, 0.0]], 2.5)
    run = bench.run(scene, until=10.0)
    return off(run.state.position, [[7 * 0.36, -7 * 0.48], [4.0 + 7 * 0.64, 3.0 + 7 * 0.48]])


def _missing(bench: Bench) -> float:
    """The share of contacts that is missing, or found twice, in a gas of a hundred disks."""
    gas = lattice_gas(100, 0.3, seed=23)
    fast = Disks(gas.disks.position, FAST * gas.disks.velocity, 0.5)
    scene, until = with_disks(gas, fast), 10.0 / FAST
    expected = run_scene(ENGINES["reference"], scene, Stop(until)).counters.pair_contacts
    return abs(bench.run(scene, until=until).counters.pair_contacts / expected - 1.0)


def _wedge(bench: Bench) -> float:
    """How far the speed of a disk that was in an acute corner is from what it was, relative."""
    walls = [Segment((0.0, 0.0), (4.0, 1.0)), Segment((0.0, 0.0), (4.0, -1.0))]
    scene = Scene(Disks([[3.5, 0.125]], [[-1.0, 0.03125]], 0.0625), Box((10.0, 10.0), (-5.0, -5.0)), walls=walls)
    run = bench.run(scene, until=5.0)
    inside = np.abs(run.state.position).max() < 5.0
    return abs(math.hypot(*run.state.velocity[0]) / math.hypot(1.0, 0.03125) - 1.0) if inside else math.inf


CASES = (
    Case(
        "t1-tunnelling",
        "a small disk at speed 1000",
        "Between two steps it is before and behind its target.",
        "Head on: the velocities are exchanged.",
        4 * ULP,
        "The relative velocity is rounded.",
        _tunnel,
    ),
    Case(
        "t2-sticking",
        "disks at walls in a dense box",
        "A disk that is already inside a wall is turned round every frame, and sticks.",
        "Never inside a wall; asked for at 200 moments.",
        64 * ULP,
        "A few ulp of the coordinates, below 8, in radii of 1/2.",
        _sticking,
    ),
    Case(
        "t3-springs",
        "the energy of a gas",
        "Springs, and overlaps that are corrected, gain or lose energy.",
        "Conserved.",
        1e-12,
        "About 1000 contacts, an ulp each.",
        _springs,
    ),
    Case(
        "t4-order",
        "one oblique contact",
        "A contact found after the step has another normal: error of first order, whatever the integrator.",
        "Rational: the 3-4-5 triangle.",
        32 * ULP,
        "A few operations on coordinates below 8.",
        _one_contact,
    ),
    Case(
        "t5-missing",
        "contacts in a gas while energy looks perfect",
        "Contacts that are missed cost no energy: a chart of energy shows nothing.",
        "The number of contacts in 10 time units of 100 disks; chaos makes two right runs differ by chance.",
        0.09,
        "About 1900 contacts: three standard errors of the difference of two runs, sqrt(2 / 1900) each.",
        _missing,
    ),
    Case(
        "t6-wedge",
        "a disk in an acute corner of walls",
        "Two overlapping walls push a disk in turn; it leaves through one of them.",
        "It comes out again at the speed at which it went in.",
        64 * ULP,
        "An ulp for each of at most twenty contacts.",
        _wedge,
    ),
)

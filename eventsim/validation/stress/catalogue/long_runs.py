"""Long runs: overlaps, drift, phase, time reversal, dense crystals."""

from __future__ import annotations

import math

import numpy as np

from eventsim.scene import Disks, Periodic, Scene
from eventsim.validation.stress.case import Bench, Case, off
from eventsim.validation.stress.catalogue.scenes import in_box, lattice_gas, with_disks

ULP = 2.0**-52


def crystal(columns: int, spacing: float, seed: int = 11) -> Scene:
    """A triangular lattice of disks of diameter 1 on a torus, normal velocities of zero sum."""
    rows = columns
    place = [
        ((i + 0.5 * (j % 2)) * spacing, j * spacing * math.sqrt(0.75)) for j in range(rows) for i in range(columns)
    ]
    velocity = np.random.default_rng(seed).normal(size=(len(place), 2))
    velocity -= velocity.mean(axis=0)
    size = columns * spacing, rows * spacing * math.sqrt(0.75)
    return Scene(Disks(place, velocity, 0.5), Periodic(size))


def _dense(bench: Bench) -> float:
    return bench.run(crystal(8, 1.1), events=2000).residuals.max_overlap


def _period(bench: Bench) -> float:
    run = bench.run(in_box(10.0, [[5.0, 5.0]], [[1.0, 0.0]]), until=18.0 * 1000)
    return max(off(run.state.position, [[5.0, 5.0]]), off(run.state.velocity, [[1.0, 0.0]]))


def _jammed(bench: Bench) -> float:
    """Z alpha from the virial of 4000 contacts, relative."""
    spacing, n = 1.0 + 1e-8, 16
    scene = crystal(4, spacing)
    start = bench.run(scene, events=1000)
    begun = with_disks(scene, Disks(start.state.position, start.state.velocity, 0.5))
    run = bench.run(begun, events=4000, log=True)
    kinetic = 0.5 * float((run.state.velocity**2).sum())
    impulses = float(np.nansum(run.log.impulse))
    z = 1.0 + impulses / (2.0 * n * (kinetic / (n - 1)) * run.time)
    alpha = (spacing - 1.0) * (spacing + 1.0)
    return abs(z * alpha / (2.0 * (n - 1) / n) - 1.0)


def _reversal(bench: Bench) -> float:
    """Sixteen disks for about a hundred contacts, then back: the error of the return, in diameters."""
    scene = lattice_gas(16, 0.3, seed=12)
    until = 3.0
    there = bench.run(scene, until=until)
    turned = Disks(there.state.position, -there.state.velocity, 0.5)
    back = bench.run(with_disks(scene, turned), until=until)
    return off(back.state.position, scene.disks.position)


def _energy(bench: Bench) -> float:
    run = bench.run(lattice_gas(64, 0.3, Periodic, seed=13), events=4000)
    return abs(run.residuals.energy or 0.0)


CASES = (
    Case(
        "f11-dense",
        "a dense crystal for 2000 contacts",
        "Overlaps of rounding pile up until a contact is lost.",
        "The deepest overlap at a contact, in reaches.",
        1e-14,
        "A few ulp of the coordinates, 8 to 9, against a reach of 1.",
        _dense,
    ),
    Case(
        "f16-period",
        "a thousand periods between two walls",
        "Phase errors of each reflection add up.",
        "Back at the start, bit for bit.",
        0.0,
        "All numbers are dyadic.",
        _period,
    ),
    Case(
        "f19-jammed",
        "a crystal of gap 10^-8",
        "Gaps of 10^-8 leave eight digits; steps would have to be 10^-9.",
        "Z alpha -> 2 (N - 1)/N of the cell theory.",
        0.1,
        "4000 contacts of 16 disks: a standard error of about 2 %, five of them.",
        _jammed,
    ),
    Case(
        "f33-reversal",
        "time reversal after about a hundred contacts",
        "Chaos doubles an error every few contacts.",
        "Back at the start within 2^(-53 + .133 n).",
        1e-8,
        "2^(-53 + 13) = 1e-12 at n = 100; chance of the scene, 2^13.",
        _reversal,
    ),
    Case(
        "f34-energy",
        "energy after 4000 contacts",
        "Drift, if each contact loses in the same direction.",
        "Conserved.",
        4000 * ULP / 2,
        "Half an ulp for each contact.",
        _energy,
    ),
)

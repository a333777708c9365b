"""The statistics of gases at walls that heat and shake: each number with its own bar, and the theory it is held against."""

from __future__ import annotations

import numpy as np
import pytest

import eventsim as es
from tests.engines.scenes import lattice_gas

pytest.importorskip("numba")
pytestmark = pytest.mark.slow

BLOCKS = 40
"""Parts of a run whose means tell the bar of its mean."""


def mean_and_bar(values):
    """(mean, bar) of a series, from the means of its blocks."""
    blocks = np.array(values)[: len(values) // BLOCKS * BLOCKS].reshape(BLOCKS, -1).mean(axis=1)
    return float(blocks.mean()), float(blocks.std(ddof=1)) / np.sqrt(BLOCKS)


def samples(scene, begin, step, count):
    """Velocities (count, N, 2) of a run at even times."""
    simulation = es.Simulation(scene, engine="fast")
    found = []
    for k in range(count):
        simulation.advance_to(begin + k * step)
        found.append(simulation.state.velocity.copy())
    return np.array(found)


def test_a_gas_takes_the_temperature_of_its_walls_and_maxwells_velocities():
    gas = lattice_gas(100, 0.1)
    walls = {side: {"temperature": 2.0} for side in ("left", "right", "bottom", "top")}
    scene = es.Scene(gas.disks, es.Box(gas.domain.size, walls=walls), seed=3)
    velocity = samples(scene, 100.0, 10.0, 4000)
    mean, bar = mean_and_bar(0.5 * (velocity**2).sum(axis=2).mean(axis=1))
    print(f"kT {mean} +- {bar}, walls 2")
    assert bar < 0.005 * 2.0
    assert abs(mean - 2.0) < 3.0 * bar
    energy = 0.5 * (velocity[::10] ** 2).sum(axis=2).ravel() / 2.0  # a tenth of the samples, as good as independent
    edges = -np.log1p(-np.arange(20) / 20.0)
    counts = np.histogram(energy, np.append(edges, np.inf))[0]
    expected = len(energy) / 20.0
    chi_square = float(((counts - expected) ** 2 / expected).sum())
    print(f"chi-square of the energies {chi_square}, 19 degrees of freedom")
    assert chi_square < 19.0 + 4.0 * np.sqrt(2.0 * 19.0)


def test_a_dilute_granular_gas_has_the_temperature_at_which_shaking_gives_what_contacts_take():
    """Per elastic contact with a wall of speed V: 2 m V^2 + 2 m V |v|; per contact of a pair: (1 - e^2) kT.

    At kT a disk meets walls at the rate n L <|v_x|> / 2, <|v_x|> = sqrt(2 kT / pi m), and |v| at contact is sqrt(pi kT / 2 m) in
    the mean of a flux; the rates are those that the run counts.
    """
    e, shaking, count = 0.95, 0.05, 100
    gas = lattice_gas(count, 0.05)
    walls = {side: {"shaking": shaking} for side in ("left", "right", "bottom", "top")}
    scene = es.Scene(gas.disks, es.Box(gas.domain.size, walls=walls), restitution={"pair": e, "wall": 1.0}, contact_duration=1e-9)
    simulation = es.Simulation(scene, engine="fast")
    simulation.advance_to(20000.0)
    before = simulation.counters.pair_contacts, simulation.counters.wall_contacts
    temperature = []
    for k in range(2000):
        simulation.advance_to(20000.0 + 20.0 * k)
        temperature.append(0.5 * (simulation.state.velocity**2).sum(axis=1).mean())
    after = simulation.counters.pair_contacts, simulation.counters.wall_contacts
    pairs, hits = (now - then for now, then in zip(after, before, strict=True))
    mean, bar = mean_and_bar(temperature)
    # (1 - e^2) T pairs = (2 V^2 + 2 V sqrt(pi T / 2)) hits, a quadratic equation for the root of T
    a, b, c = (1.0 - e * e) * pairs, -2.0 * shaking * np.sqrt(0.5 * np.pi) * hits, -2.0 * shaking**2 * hits
    root = (-b + np.sqrt(b * b - 4.0 * a * c)) / (2.0 * a)
    print(f"kT {mean} +- {bar}, from the balance {root**2}")
    assert 3.0 * bar < 0.03 * mean
    assert mean == pytest.approx(root**2, rel=0.03)

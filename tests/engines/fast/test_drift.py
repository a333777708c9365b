"""What rounding does to a gas in ten million contacts."""

from __future__ import annotations

import pytest

import eventsim as es
from tests.benchmarks.rates import lattice_gas

pytest.importorskip("numba")


@pytest.mark.slow
def test_ten_million_contacts_keep_the_energy_and_no_disks_overlap() -> None:
    run = es.simulate(lattice_gas(10_000, 0.5), events=10_000_000, engine="fast", log=False)
    assert run.counters.events >= 10_000_000
    assert abs(run.residuals.energy) < 1e-12, run.residuals
    assert run.residuals.max_overlap < 1e-12, run.residuals

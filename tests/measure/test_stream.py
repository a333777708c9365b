"""A log file is measured block by block: the same numbers, and never all of its rows in memory."""

from __future__ import annotations

import subprocess
import sys

import pytest

import eventsim as es
from eventsim.errors import LogWarning
from eventsim.measure import measure, measure_file
from eventsim.suffixes import LOGS
from tests import long_log
from tests.engines.scenes import lattice_gas


@pytest.fixture(scope="module")
def log():
    return es.simulate(lattice_gas(36, 0.3), events=4000, engine="reference", log=True).log


@pytest.mark.parametrize("compact", [False, True])
@pytest.mark.parametrize("suffix", LOGS)
def test_a_file_is_measured_as_its_log_is(tmp_path, log, suffix, compact):
    path = tmp_path / f"log{suffix}"
    log.save(path, compact=compact)
    measures, provenance = measure_file(path)
    assert measures.to_dict() == measure(log).to_dict()
    assert provenance.scene == log.scene


def test_changed_rows_are_told_after_the_last_one(tmp_path, log):
    path = tmp_path / "log.csv"
    log.save(path)
    lines = path.read_text().splitlines(keepends=True)
    cells = lines[50].split(",")
    cells[6] = repr(float(cells[6]) * 1.5)
    path.write_text("".join([*lines[:50], ",".join(cells), *lines[51:]]))
    with pytest.warns(LogWarning, match=r"log\.csv is not what its run wrote"):
        measure_file(path)


@pytest.mark.slow
@pytest.mark.parametrize("suffix", [".npz", ".parquet"])
def test_three_million_rows_are_measured_within_400_megabytes(tmp_path, suffix):
    """All of them would be 384 MB, and as much again while they are read."""
    long_log.write(tmp_path / f"log{suffix}", millions=3)
    assert long_log.megabytes("measure", str(tmp_path / f"log{suffix}")) < 400


COOLING = """
import resource, time, numpy as np, eventsim as es
from eventsim.measure import Meter
scene = es.gallery("cooling", n=1000)
meter, spent = Meter(scene), [(0, 0.0)]

def write(rows):
    begun = time.thread_time()
    meter.write(rows)
    spent.append((int(rows["event"][-1]) + 1, spent[-1][1] + time.thread_time() - begun))

run = es.simulate(scene, events=1_000_000, engine="fast", on_event=write)
measures = meter.finish(run.time)
events, seconds = np.array(spent).T
parts = np.diff(np.interp(np.arange(0, run.counters.events + 1, 100_000), events, seconds))
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, measures.series.energy[0] / measures.series.energy[-1], *parts)
"""


@pytest.mark.slow
@pytest.mark.timeout(1200)
def test_a_gas_that_cools_by_many_decades_is_measured_at_one_pace_in_constant_memory():
    """A million contacts: below 300 MB with the engine, and each 1e5 cost the meter what the first did, times 1.5."""
    pytest.importorskip("numba")
    for _ in range(2):  # the first one compiles, in the time of its first part
        done = subprocess.run([sys.executable, "-c", COOLING], check=True, capture_output=True, text=True)
    kilobytes, fall, first, *parts = map(float, done.stdout.split())
    assert kilobytes < 300_000
    assert fall > 1e12
    assert len(parts) == 9
    assert max(parts) < 1.5 * first

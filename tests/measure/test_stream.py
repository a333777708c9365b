"""A log file is measured block by block: the same numbers, and never all of its rows in memory."""

from __future__ import annotations

import subprocess
import sys

import pytest

import eventsim as es
from eventsim.errors import LogWarning
from eventsim.measure import measure, measure_file
from eventsim.suffixes import LOGS
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


MEASURING = """
import resource, sys, numpy as np, eventsim as es
from eventsim.record.files import open_sink
from eventsim.record.provenance import Ending
from eventsim.measure import measure_file
from tests.engines.scenes import lattice_gas
path, millions = sys.argv[1], 3
if sys.argv[2] == "write":
    log = es.simulate(lattice_gas(36, 0.3), events=20_000, engine="reference", log=True).log
    rows, last = log.rows.copy(), int(log.epoch[-1]) + 1
    sink = open_sink(path, log.provenance)
    for _ in range(millions * 50):
        sink.copy(rows, ())
        rows["event"] += len(rows)
        rows["epoch"] += last
    sink.close(Ending(int(rows["epoch"][-1]), 0.0, "until"))
else:
    measure_file(path)
    print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""


@pytest.mark.slow
@pytest.mark.parametrize("suffix", [".npz", ".parquet"])
def test_three_million_rows_are_measured_within_400_megabytes(tmp_path, suffix):
    """All of them would be 384 MB, and as much again while they are read."""
    words = [sys.executable, "-c", MEASURING, str(tmp_path / f"log{suffix}")]
    subprocess.run([*words, "write"], check=True)
    done = subprocess.run([*words, "read"], check=True, capture_output=True, text=True)
    assert int(done.stdout) < 400_000

"""Runs: columns are read back row by row, from any row on, also where the file was cut."""

import numpy as np
import pytest

from eventsim.record.events import ROW
from eventsim.record.files.runs import RUN, STEADY, columns_of_runs, cut_runs, rows_in_runs, runs_of

COUNT = 60


def columns(seed):
    rng = np.random.default_rng(seed)
    return {name: np.repeat(rng.integers(0, 3, 12), 5).astype(ROW[name]) for name in STEADY}


def write(path, wanted, begin, end):
    with path.open("ab") as file:
        file.write(runs_of({name: column[begin:end] for name, column in wanted.items()}, begin).tobytes())


@pytest.mark.parametrize("cut", range(COUNT + 1))
def test_rows_are_the_same_after_the_file_was_cut_and_continued(tmp_path, cut):
    path, wanted, other = tmp_path / "runs", columns(1), columns(2)
    for begin in range(0, COUNT, 7):
        mixed = {name: np.append(wanted[name][:cut], other[name][cut:]) for name in STEADY}
        write(path, mixed, begin, min(begin + 7, COUNT))
    cut_runs(path, cut)
    assert rows_in_runs(path) == cut
    write(path, wanted, cut, COUNT)
    assert rows_in_runs(path) == COUNT
    for first, count in ((0, COUNT), (cut, COUNT - cut), (cut // 2, 1), (13, 20)):
        if count:
            found = columns_of_runs(path, first, count)
            assert all(np.array_equal(found[name], wanted[name][first : first + count]) for name in STEADY)


def test_a_run_that_is_not_whole_does_not_count(tmp_path):
    path = tmp_path / "runs"
    write(path, columns(1), 0, COUNT)
    ends = np.fromfile(path, RUN)["end"]
    with path.open("r+b") as file:
        file.truncate(len(ends) * RUN.itemsize - 1)
    assert rows_in_runs(path) == ends[-2]


def test_no_rows_make_no_runs():
    assert len(runs_of({name: np.empty(0, ROW[name]) for name in STEADY}, 5)) == 0

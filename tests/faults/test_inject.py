"""A full disk, a broken one, an interrupted call: the old file or the whole new one, a sentence, and the run goes on."""

import pytest

from tests.faults.inject import run_with_faults


def faults(tmp_path, every, only=()):
    found = run_with_faults(every, list(only), tmp_path)
    if found is None:
        pytest.skip("no C compiler, or no Linux")
    return found


def test_a_call_that_fails_leaves_the_old_file_or_the_whole_new_one(tmp_path):
    """Some of the call sites.  The journal of a log that failed while it came into being stayed there as NAME.part~."""
    found = faults(tmp_path, 61, ["full .csv", "compact .npz", "state", "sweep"])
    assert found["findings"] == []
    assert sum(found["tried"].values()) > 20


@pytest.mark.slow
def test_no_call_site_fails_otherwise(tmp_path):
    assert faults(tmp_path, 1)["findings"] == []

"""No memory for an array: the run ends, its files are whole or as they were, and the next run is right."""

import pytest

from tests.faults.allocations import ENGINES, fail


def test_an_allocation_that_fails_leaves_files_whole():
    tried, findings = fail("reference", every=70)
    assert findings == []
    assert tried.total() >= 3


@pytest.mark.slow
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("engine", ENGINES)
def test_no_allocation_of_an_engine_fails_otherwise(engine):
    assert fail(engine, every=1)[1] == []

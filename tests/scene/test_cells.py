"""The search for overlaps through cells finds what a look at all pairs finds."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eventsim.scene import Disks, Open, Periodic, Scene
from eventsim.scene.cells import Cells

PERIODS = [(math.inf, math.inf), (1.0, math.inf), (1.0, 1.0)]


def all_pairs(position, radius, mass, period):
    """Overlapping pairs (i, j), i < j, by looking at each pair and image."""
    shifts = [[0.0] if math.isinf(length) else [-length, 0.0, length] for length in period]
    found = set()
    for i in range(len(radius)):
        for j in range(i + 1, len(radius)):
            if mass[i] == mass[j] and mass[i] in (0.0, math.inf):
                continue
            apart = position[i] - position[j]
            nearest = min(np.hypot(apart[0] + x, apart[1] + y) for x in shifts[0] for y in shifts[1])
            if nearest < radius[i] + radius[j]:
                found.add((i, j))
    return found


@given(
    st.integers(0, 2**32 - 1),
    st.integers(1, 30),
    st.sampled_from(PERIODS),
    st.sampled_from([0.5, 4.0, 9.0]),
)
@settings(max_examples=60, deadline=None)
def test_cells_find_the_overlaps_that_all_pairs_have(seed, count, period, octaves):
    rng = np.random.default_rng(seed)
    position = rng.random((count, 2))
    radius = 0.4 * 2.0 ** -rng.uniform(0, octaves, count) * rng.integers(0, 2, count)
    mass = rng.choice([0.0, 1.0, math.inf], count)
    found = [
        (min(pair), max(pair))
        for chunk in Cells(position, radius, mass, period).pairs()
        for pair in zip(chunk.first.tolist(), chunk.second.tolist(), strict=True)
    ]
    assert set(found) == all_pairs(position, radius, mass, period)


def test_other_disks_larger_than_those_in_the_cells_are_found():
    position = np.array([[0.0, 0.0], [0.9, 0.0], [0.5, 0.5]])
    cells = Cells(position, np.full(3, 1e-3), np.ones(3), (1.0, 1.0))
    chunks = list(cells.overlaps(np.array([[0.05, 0.0]]), 0.2, 1.0))
    assert sorted(np.concatenate([chunk.second for chunk in chunks])) == [0, 1]


def test_one_large_disk_among_many_small_ones_is_no_burden():
    side = 140
    x, y = np.meshgrid(np.arange(side), np.arange(side))
    small = np.stack([x.ravel() * 2.5 + 1, y.ravel() * 2.5 + 1], axis=1)
    small = small[np.hypot(*(small - 175).T) > 101]
    disks = Disks([*small, [175, 175]], radius=[*np.ones(len(small)), 100])
    # All pairs would take 2e8 looks; cells take about 30 a disk.
    Scene(disks, Periodic((350, 350)))


@pytest.mark.parametrize("scale", [1e-149, 1.0, 1e149])
def test_the_search_knows_no_unit_of_length(scale):
    Scene(Disks(np.array([[0, 0], [1, 0], [3, 5]]) * scale, radius=0.5 * scale), Open())
    chunks = Cells(np.array([[0, 0], [0.99, 0], [3, 5]]) * scale, np.full(3, 0.5 * scale), np.ones(3), PERIODS[0])
    assert sum(len(chunk.first) for chunk in chunks.pairs()) == 1

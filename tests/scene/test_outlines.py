"""Distances of disks from walls, in any unit of length."""

import math

import numpy as np
import pytest

import eventsim as es


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("unit", [1e-90, 1e100])
def test_the_side_of_a_chord_needs_no_square_of_an_area(unit):
    arc = es.Arc((unit, 0.0), (0.0, unit), (-unit, 0.0))
    above, below = arc.depth(unit * np.array([[0.0, 0.5], [0.0, -1.0]]), 0.0)
    assert above == pytest.approx(-0.5 * unit, rel=1e-14)
    assert below == pytest.approx(-math.sqrt(2.0) * unit, rel=1e-14)

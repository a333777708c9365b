"""Runs in another unit of time have the same measures, in that unit."""

from fractions import Fraction

import numpy as np
import pytest

import eventsim as es
from eventsim.measure import measure
from tests.engines.scenes import lattice_gas
from tests.engines.test_speeds import faster

SCENES = {
    "torus": lambda: lattice_gas(30, 0.3, es.Periodic),
    "mixture": lambda: lattice_gas(30, 0.3, masses=(1.0, 3.0)),
    "cooling": lambda: lattice_gas(40, 0.3, restitution=0.9),
}


RATES = {
    "1": 0,
    "length": 0,
    "1 / contact of a disk": 0,
    "time": -1,
    "1 / time": 1,
    "length / time": 1,
    "length^2 / time": 1,
    "mass length / time^2": 2,
    "energy": 2,
    "energy / length^2": 2,
}
"""Unit -> the power of 1 / time in it."""


def numbers(quantity, power):
    """What a quantity tells, as exact numbers, times 2**power."""
    told = quantity.value, quantity.error, quantity.theory, quantity.accuracy
    return [None if x is None or np.isnan(x) else Fraction(x) * Fraction(2) ** power for x in told]


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("k", [-200, 200])
def test_measures_scale_exactly_with_the_speeds(name, k):
    scene = SCENES[name]()
    one = es.simulate(scene, events=1500, engine="reference", measure=True).measures
    run = es.simulate(faster(scene, k), events=1500, engine="reference", log=True)
    other = measure(run.log)
    assert [quantity.name for quantity in one.quantities] == [quantity.name for quantity in other.quantities]
    assert {"temperature", "collision_rate", "mean_free_path"} <= set(one.by_name)
    for here, there in zip(one.quantities, other.quantities, strict=True):
        assert here.unit == there.unit
        expected, found = numbers(here, RATES[here.unit] * k), numbers(there, 0)
        if here.name == "cooling_exponent":  # logarithms do not scale
            assert [float(x) for x in found if x is not None] == pytest.approx([float(x) for x in expected if x is not None])
        else:
            assert found == expected, here.name
        assert here.deviation == there.deviation
    assert one.doubts == other.doubts
    assert np.ldexp(one.duration, -k) == other.duration
    assert np.array_equal(np.ldexp(one.speeds[0].edges, k), other.speeds[0].edges)
    assert np.array_equal(one.correlations.msd, other.correlations.msd)
    assert one.speeds[0].misfit == other.speeds[0].misfit

"""Runs so fast or so slow that their energies are no floats are measured like any other."""

from fractions import Fraction

import numpy as np
import pytest

import eventsim as es
from eventsim.measure import measure
from eventsim.measure.pace import RATES
from eventsim.scene.pace import in_words
from tests.engines.scenes import lattice_gas
from tests.engines.test_speeds import faster

SCENES = {
    "torus": lambda: lattice_gas(30, 0.3, es.Periodic),
    "mixture": lambda: lattice_gas(30, 0.3, masses=(1.0, 3.0)),
    "cooling": lambda: lattice_gas(40, 0.3, restitution=0.9),
}


def told(quantity):
    """(value, error, theory, unit) of a quantity as exact numbers of the unit that the factor leaves."""
    factor, _, unit = (
        quantity.unit.rpartition("2^")[2].partition(" ") if "2^" in quantity.unit else ("0", "", quantity.unit)
    )
    numbers = quantity.value, quantity.error, quantity.theory, quantity.accuracy
    scale = Fraction(2) ** int(factor)
    return [None if x is None or np.isnan(x) else Fraction(x) * scale for x in numbers], unit


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("k", [-900, -300, 480, 900])
def test_measures_scale_exactly_with_the_speeds(name, k):
    scene = SCENES[name]()
    one = es.simulate(scene, events=1500, engine="reference", measure=True).measures
    run = es.simulate(faster(scene, k), events=1500, engine="reference", log=True)
    other = measure(run.log)
    assert [quantity.name for quantity in one.quantities] == [quantity.name for quantity in other.quantities]
    assert {"temperature", "collision_rate", "mean_free_path"} <= set(one.by_name)
    for here, there in zip(one.quantities, other.quantities, strict=True):
        factor = Fraction(2) ** (RATES[here.unit] * k)
        numbers, unit = told(there)
        assert unit == here.unit
        expected = [None if x is None else x * factor for x in told(here)[0]]
        if here.name == "cooling_exponent":  # logarithms do not scale
            assert [float(x) for x in numbers if x is not None] == pytest.approx(
                [float(x) for x in expected if x is not None]
            )
        else:
            assert numbers == expected, here.name
        assert here.deviation == there.deviation
    assert one.doubts == other.doubts
    assert np.ldexp(one.duration, -k) == other.duration
    assert np.array_equal(np.ldexp(one.speeds[0].edges, k), other.speeds[0].edges)
    assert np.array_equal(one.correlations.msd, other.correlations.msd)
    assert one.speeds[0].misfit == other.speeds[0].misfit


def test_a_kick_sets_the_pace_of_a_scene_at_rest():
    sim = es.Simulation(es.Scene(es.Disks([(1.0, 1.0), (3.0, 1.5)], radius=0.5), es.Box((4.0, 4.0))))
    sim.set_velocity(0, (1e200, 0.0))
    sim.advance_to(1e-198)
    measures = measure(sim.log)
    assert measures["energy_end"].unit.startswith("2^")
    assert 1e199 < measures["mean_speed"].value < 1e200


def test_what_has_a_time_to_leave_out_leaves_it_out_at_any_pace():
    scene = faster(SCENES["torus"](), 900)
    length = es.simulate(scene, events=1500, engine="reference", measure=0.0).measures.duration
    half = es.simulate(scene, events=1500, engine="reference", measure=0.5 * length).measures
    assert half.discarded == 0.5 * length
    with pytest.raises(es.EventsimError, match=r"discard = 1e-200: the run lasts \d.*e-27\d only"):
        es.simulate(scene, events=1500, engine="reference", measure=1e-200)


def test_numbers_beyond_floats_have_words():
    assert in_words(0.5, 0) == "0.5"
    assert in_words(0.747667, 1800) == "5.342e+541"
    assert in_words(0.5, -1999) == "8.710e-603"

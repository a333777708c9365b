"""Runs in which nothing moves or comes back, and scenes of very large, very small and very unequal numbers."""

import math

import numpy as np
import pytest

import eventsim as es
from eventsim.cli.measure import measures_text
from eventsim.measure import measure

pytestmark = pytest.mark.filterwarnings("error")


def two_disks(domain, unit=1.0, velocity=((1.0, 0.3), (-1.0, 0.2)), mass=1.0):
    """Two disks of radius .1 in a domain of size 1, lengths in multiples of a unit."""
    position = unit * np.array([[0.25, 0.3], [0.75, 0.7]])
    return es.Scene(es.Disks(position, velocity, 0.1 * unit, mass), domain((unit, unit)))


@pytest.mark.parametrize("mass", [1.0, 4.0])
def test_disks_at_rest_have_no_temperature_and_no_steady_state(mass):
    scene = two_disks(es.Box, velocity=np.zeros((2, 2)), mass=mass)
    measures = es.simulate(scene, until=3.0, measure=True).measures
    assert math.isnan(measures["temperature"].value)
    assert math.isnan(measures["Z"].value)
    assert measures.doubts == ("nothing moves",)
    assert "nan" not in measures_text("rest", measures)


@pytest.mark.parametrize("domain", [es.Box, es.Periodic])
@pytest.mark.parametrize("power", [-300, -100, 300, 480])
def test_measures_scale_exactly_with_the_unit_of_length(domain, power):
    unit = 2.0**power
    one = es.simulate(two_disks(domain), until=60.0, log=True).log
    other = es.simulate(two_disks(domain, unit), until=60.0 * unit, log=True).log
    here, there = measure(one), measure(other)
    assert there["mean_free_path"].value == here["mean_free_path"].value * unit
    assert there["collision_rate"].error == here["collision_rate"].error / unit
    assert there["Z"].theory == here["Z"].theory
    assert np.array_equal(there.correlations.msd_error, here.correlations.msd_error * unit * unit)


def test_a_disk_too_heavy_to_be_moved_leaves_no_temperature():
    scene = two_disks(es.Periodic, velocity=[[1.0, 0.0], [-1.0, 0.2]], mass=[1e-300, 1e300])
    measures = es.simulate(scene, until=30.0, measure=True).measures
    told = {quantity.name for quantity in measures.quantities if math.isfinite(quantity.value)}
    assert all(measures[name].doubt for name in set(measures.keys()) - told)
    assert not {"temperature", "pressure", "temperature_0", "temperature_1"} & told
    assert measures["mean_speed_1"].value == pytest.approx(math.hypot(1.0, 0.2), rel=1e-12)
    assert "common motion" in measures.doubts[0]


def test_the_speeds_of_a_very_light_disk_have_bins():
    scene = two_disks(es.Box, velocity=[[1.0, 0.0], [-1.0, 0.2]], mass=[1e-300, 1e300])
    light, heavy = es.simulate(scene, until=30.0, measure=True).measures.speeds
    assert light.edges[-1] > 1e299
    assert heavy.edges[-1] == pytest.approx(8.0 * math.hypot(1.0, 0.2) / 2.0, rel=1e-12)  # kT = E / 2
    assert light.density[0] * light.edges[1] == pytest.approx(1.0, rel=1e-12)


def test_the_open_plane_has_no_steady_state():
    scene = es.Scene(es.Disks([[0.0, 0.0], [100.0, 0.0]], [[1.0, 0.0], [0.0, 0.0]], 0.5), es.Open())
    measures = es.simulate(scene, until=1000.0, measure=True).measures
    assert not measures.steady
    assert measures.doubts == ("on the open plane disks fly apart",)
    assert "no steady state: on the open plane" in measures_text("far", measures)
    held = es.Scene(scene.disks, es.Open(), walls=(es.Circle((50.0, 0.0), 60.0),))
    assert es.simulate(held, until=1000.0, measure=True).measures.steady


@pytest.mark.parametrize("domain", [es.Box, es.Periodic])
def test_a_run_without_contacts_has_no_line_of_what_was_not_seen(domain):
    measures = es.simulate(two_disks(domain), until=1e-3, measure=True).measures
    assert all(math.isfinite(quantity.value) or quantity.doubt for quantity in measures.quantities)
    assert "nan" not in measures_text("short", measures)

"""Neighbours of known faults: gases that drift, tracers that are pushed, points, gases apart, engines of steps, cold gases."""

import math
from dataclasses import replace

import numpy as np
import pytest

import eventsim as es
from eventsim.measure import measure
from eventsim.measure.ensemble import ensemble_of
from eventsim.measure.profile import _average
from eventsim.measure.quantities.cooling import flowing
from eventsim.measure.theory import cooling_exponent
from eventsim.scene.files import scene_from_dict, scene_to_dict
from eventsim.scene.restitution import Restitution
from tests.engines.scenes import lattice_gas


def drifting(velocity, seed=3, domain=es.Periodic):
    """A gas of 25 disks, all of it with a common velocity."""
    gas = lattice_gas(25, 0.2, domain, seed=seed)
    disks = gas.disks
    thermal = disks.velocity - disks.velocity.mean(axis=0)
    return es.Scene(es.Disks(disks.position, thermal + np.array(velocity), disks.radius, disks.mass), gas.domain)


def measured(scene, **stop):
    return es.simulate(scene, engine="reference", measure=True, **stop).measures


def test_the_common_motion_of_a_gas_is_no_diffusion():
    fast, still = measured(drifting((3.0, -1.0)), events=4000), measured(drifting((0.0, 0.0)), events=4000)
    assert fast["temperature"].value == pytest.approx(still["temperature"].value, rel=1e-12)
    # two runs of a chaotic gas: each is good to its bar, and a drift would show as 10 t
    spread = math.hypot(fast["diffusion"].error, still["diffusion"].error)
    assert abs(fast["diffusion"].value - still["diffusion"].value) < 4.0 * spread < 0.1 * fast["diffusion"].value * 10
    assert fast.correlations.vacf[0] == pytest.approx(still.correlations.vacf[0], rel=0.1)
    assert "drift (3, -1) included" in fast["mean_free_path"].doubt
    assert still["mean_free_path"].doubt is None


def test_tracers_that_disks_push_have_no_steady_state_of_their_own():
    gas = lattice_gas(16, 0.2, es.Periodic, seed=2)
    disks, side = gas.disks, gas.domain.size[0]
    place = np.concatenate([disks.position, [[0.0, 0.0], [0.5 * side, 0.0]]])
    velocity = np.concatenate([disks.velocity, [[1.0, 0.3], [-0.2, 1.0]]])
    scene = es.Scene(es.Disks(place, velocity, [*disks.radius, 0.0, 0.0], [*disks.mass, 0.0, 0.0]), gas.domain)
    measures = measured(scene, events=2000)
    for name in ("tracer_collision_rate", "tracer_mean_free_time", "tracer_mean_speed"):
        assert math.isnan(measures[name].error)
        assert "without end" in measures[name].doubt
    assert measures["collision_rate"].error > 0.0


def test_points_in_a_box_have_no_temperature_however_often_they_meet_its_walls():
    rng = np.random.default_rng(1)
    scene = es.Scene(es.Disks(rng.uniform(0.1, 0.9, (20, 2)), rng.normal(size=(20, 2)), 0.0), es.Box((1.0, 1.0)))
    measures = measured(scene, events=600)
    assert "never meet" in measures["temperature"].doubt
    assert not measures.equilibrated
    assert all(quantity.theory is None for quantity in measures.quantities)


def test_walls_alone_do_not_bring_a_gas_into_equilibrium():
    """Small disks meet walls often and each other hardly ever: nothing has mixed."""
    rng = np.random.default_rng(2)
    scene = es.Scene(es.Disks(rng.uniform(0.1, 0.9, (20, 2)), rng.normal(size=(20, 2)), 1e-4), es.Box((1.0, 1.0)))
    measures = measured(scene, events=1200)
    assert measures["wall_contact_rate"].value * measures.duration > 10 * 20
    assert not measures.equilibrated
    assert all(quantity.theory is None for quantity in measures.quantities)


def test_gases_on_both_sides_of_a_wall_have_no_common_temperature():
    left, right = lattice_gas(16, 0.3, es.Box, seed=1), lattice_gas(16, 0.3, es.Box, seed=2)
    side = left.domain.size[0]
    place = np.concatenate([left.disks.position, right.disks.position + np.array([side, 0.0])])
    velocity = np.concatenate([left.disks.velocity, 3.0 * right.disks.velocity])
    wall = es.Segment((side, 0.0), (side, side), name="middle")
    scene = es.Scene(es.Disks(place, velocity, left.disks.radius[0]), es.Box((2.0 * side, side)), walls=[wall])
    measures = measured(scene, events=6000)
    assert "2 groups that never meet" in measures["temperature"].doubt
    assert measures["force_middle_right"].value > 5.0 * measures["force_middle_left"].value


def test_the_pressure_is_the_mean_force_on_a_length_of_wall():
    gas = lattice_gas(16, 0.2, es.Box, seed=5)
    measures = measured(gas, events=4000)
    sides = [measures[f"pressure_{name}"].value for name in ("left", "right", "bottom", "top")]
    assert measures["pressure"].value == pytest.approx(float(np.mean(sides)), rel=1e-12)
    # what disks press on each other, and with their own radius on the walls, adds up to the same but for the ends of the run
    assert float(measures.series.pressure.mean()) == pytest.approx(measures["pressure"].value, rel=0.02)


@pytest.mark.parametrize("engine", ["frames", "stepped", "penalty"])
def test_walls_know_their_side_though_steps_find_contacts_late(engine):
    gas = lattice_gas(9, 0.1, es.Box, seed=4)
    run = es.simulate(gas, until=30.0, engine=engine, dt=0.01, log=True)
    measures, rows = measure(run.log, discard=0.0), run.log.rows
    for k, name in enumerate(("left", "right", "bottom", "top")):
        given = float(rows["impulse"][rows["wall"] == k].sum())
        assert measures[f"pressure_{name}"].value == pytest.approx(given / 30.0 / gas.domain.size[0], rel=1e-9)
    assert engine in measures.doubts[-1]
    assert not measures.equilibrated


def test_both_sides_and_the_ends_of_an_arc_are_told_apart():
    """Three disks: one flies at an arc from inside, one from outside, one at its tip."""
    arc = es.Arc((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), name="bow")
    places, velocity = [[0.0, 0.2], [0.0, 3.0], [1.0, -2.0]], [[0.0, 1.0], [0.0, -2.0], [0.0, 4.0]]
    scene = es.Scene(es.Disks(places, velocity, 0.1), es.Box((12.0, 12.0), origin=(-6.0, -6.0)), walls=[arc])
    measures = measured(scene, until=1.2)
    inner, outer = measures["force_bow_inside"].value, measures["force_bow_outside"].value
    assert (1.2 * inner, 1.2 * outer) == pytest.approx((2.0, 4.0), rel=1e-9)
    assert 1.2 * measures["force_bow"].value == pytest.approx(2.0 + 4.0 + 8.0, rel=1e-9)


def test_a_gas_that_has_cooled_below_the_digits_of_its_momentum_has_no_temperature():
    disks = drifting((0.0, 0.0)).disks
    gas = es.Scene(es.Disks(disks.position, disks.velocity, disks.radius), es.Periodic((9.0, 9.0)), restitution=0.9)
    ensemble = ensemble_of(gas)
    start = ensemble.start_energy
    assert ensemble.temperature(1e-27 * start) == pytest.approx(1e-27 * start / 24.0, rel=1e-3)
    assert math.isnan(ensemble.temperature(1e-29 * start))
    moving = es.Scene(es.Disks(disks.position, disks.velocity + np.array([3.0, 1.0]), disks.radius), gas.domain, restitution=0.9)
    left = ensemble_of(moving).drift_energy
    assert ensemble_of(moving).temperature(left + 1e-3) == pytest.approx(1e-3 / 24.0, rel=1e-9)
    assert math.isnan(ensemble_of(moving).temperature(left * (1.0 + 1e-13)))


def test_haffs_law_stands_only_beside_a_gas_that_is_homogeneous():
    small = ensemble_of(lattice_gas(64, 0.1, es.Periodic, seed=7, restitution=0.98))
    large = ensemble_of(es.gallery("cooling", n=5000))
    assert flowing(small, 100.0, 0.5 * cooling_exponent(0.98)) == 0.0  # no wave that fits in grows
    shares = [flowing(large, contacts, 0.5 * cooling_exponent(0.9)) for contacts in (5.0, 20.0, 50.0)]
    assert shares == sorted(shares)
    assert shares[0] < 0.02 < shares[2]


def test_kicks_leave_no_temperature_where_momentum_would_be_kept():
    sim = es.Simulation(drifting((0.0, 0.0)), engine="reference")
    sim.advance_to(0.5)
    sim.set_velocity(3, (5.0, 1.0))
    sim.advance_to(2.0)
    assert np.isnan(measure(sim.log).series.temperature).all()


def test_the_series_of_a_gas_that_turns_is_that_of_its_temperature():
    rng = np.random.default_rng(4)
    place = np.array([[x, y] for x in range(-3, 4) for y in range(-3, 4) if x * x + y * y < 10]) * 0.2
    velocity = rng.normal(size=place.shape) * 0.6 + 2.0 * np.column_stack([-place[:, 1], place[:, 0]])
    scene = es.Scene(es.Disks(place, velocity, 0.05), es.Open(), walls=[es.Circle((0.0, 0.0), 0.9)])
    measures = measured(scene, events=800)
    assert float(measures.series.temperature.mean()) == pytest.approx(measures["temperature"].value, rel=0.02)


def test_d_is_told_against_the_lag():
    found = measured(lattice_gas(36, 0.3, es.Periodic, seed=3), events=6000).correlations
    k = len(found.lag) - 1
    half = int(np.flatnonzero(found.lag == 0.5 * found.lag[k])[0])
    assert found.diffusion[k] == pytest.approx((found.msd[k] - found.msd[half]) / (2.0 * found.lag[k]), rel=1e-12)
    assert np.isnan(found.diffusion[0])
    assert found.to_dict()["diffusion"][0] is None


def test_the_histogram_of_speeds_grows_with_the_speeds():
    """A gas that begins slow and falls from a height, and one that is kicked: all of the time is in the bins."""
    gas = lattice_gas(16, 0.1, es.Box, seed=3)
    side, disks = gas.domain.size[0], es.Disks(gas.disks.position, 0.01 * gas.disks.velocity, gas.disks.radius)
    run = es.simulate(es.Scene(disks, es.Box((side, side)), gravity=(0.0, -5.0)), events=600, engine="reference", log=True)
    (one,) = measure(run.log, discard=0.0).speeds
    assert (one.density * np.diff(one.edges)).sum() == pytest.approx(1.0, rel=1e-9)
    fastest = max(float(np.hypot(run.log.vxa, run.log.vya).max()), 0.0)
    assert one.edges[-1] > fastest
    seen = np.flatnonzero(one.density)[-1]
    assert one.edges[seen + 1] > 0.8 * fastest
    sim = es.Simulation(gas, engine="reference")
    sim.advance_to(0.5)
    sim.set_velocity(3, (50.0, 1.0))
    sim.advance_to(1.0)
    (one,) = measure(sim.log, discard=0.0).speeds
    assert (one.density * np.diff(one.edges)).sum() == pytest.approx(1.0, rel=1e-9)
    assert one.edges[-1] > 50.0


def test_species_that_began_apart_are_not_called_equilibrated_before_they_mix():
    measures = measured(es.gallery("mixture"), events=3000)
    assert any("began apart" in doubt for doubt in measures.doubts)
    mixed = lattice_gas(36, 0.2, es.Periodic, seed=3, masses=(1.0, 3.0))
    assert not any("began apart" in doubt for doubt in measured(mixed, events=600).doubts)


def test_the_width_of_a_region_is_that_between_its_walls():
    """Below a share of it diffusion is read: in a triangle, beside a wall through the box, in a circle."""
    disk = es.Disks([[1.0, 1.0]], [[1.0, 0.0]], 0.1)
    triangle = es.Scene(disk, es.Open(), walls=[es.Polygon([(0.0, 0.0), (4.0, 0.0), (0.0, 3.0)])])
    halved = es.Scene(disk, es.Box((10.0, 10.0)), walls=[es.Segment((5.0, 0.0), (5.0, 10.0))])
    round_one = es.Scene(disk, es.Open(), walls=[es.Circle((1.0, 1.0), 2.0)])
    expected = ((triangle, 1.0), (halved, 100.0 / 30.0), (round_one, 2.0), (es.Scene(disk, es.Box((10.0, 8.0))), 8.0))
    for scene, width in expected:
        assert ensemble_of(scene).width == pytest.approx(width, rel=1e-9)
    assert ensemble_of(es.Scene(disk, es.Periodic((3.0, 3.0)))).width == math.inf


def test_a_gas_in_a_polygon_has_no_diffusion_once_it_has_felt_the_walls():
    """Its displacements end there: the slope at long lags is that of nothing."""
    gas = lattice_gas(25, 0.1, es.Box, seed=3)
    side = gas.domain.size[0]
    corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)]
    measures = measured(es.Scene(gas.disks, es.Open(), walls=[es.Polygon(corners)]), events=1500)
    assert "before walls are felt" in measures["diffusion"].doubt


def test_where_walls_take_energy_no_exponent_is_told_by_contacts():
    """How often disks come to walls depends on the box, and Haff's variable does not know of it."""
    gas = lattice_gas(25, 0.3, es.Box, seed=3)
    for shares in ((0.9, 0.9), (1.0, 0.8)):
        scene = es.Scene(gas.disks, gas.domain, restitution=Restitution(*shares))
        assert "walls take energy" in measured(scene, events=300)["cooling_exponent"].doubt
    pairs_only = measured(es.Scene(gas.disks, gas.domain, restitution=Restitution(0.9, 1.0)), events=300)
    assert pairs_only["cooling_exponent"].value > 0.0


@pytest.mark.parametrize("grip", [1.0, 0.5])
def test_rough_disks_have_no_temperature_that_motion_alone_tells(grip):
    """Spins have a share of the energy, and no theory of smooth disks speaks of such a gas."""
    gas = lattice_gas(25, 0.2, es.Periodic, seed=3)
    measures = measured(replace(gas, tangential_restitution=grip), events=300)
    for name in ("temperature", "Z", "diffusion"):
        assert "spins" in measures[name].doubt
    assert all(measures[name].theory is None for name in ("mean_speed", "collision_rate", "mean_free_path"))
    assert measures["energy_end"].value < measures["energy_start"].value
    smooth = measured(replace(gas, tangential_restitution=-1.0), events=300)
    assert smooth["temperature"].value == measured(gas, events=300)["temperature"].value


def test_one_rough_disk_is_no_billiard():
    """Its way depends on its spin: pi A / P is the mean free path of what flies by its place and direction alone."""
    disk = es.Disks([[1.0, 1.2]], [[0.7, 0.4]], 0.1)
    measures = measured(es.Scene(disk, es.Box((3.0, 2.0)), tangential_restitution=1.0), events=100)
    assert "mean_free_path" not in list(measures)
    assert "spins" in measures["temperature"].doubt


def test_walls_that_heat_shake_or_slide_are_named():
    gas = lattice_gas(25, 0.1, es.Box, seed=3)
    for manner in ({"shaking": 0.5}, {"temperature": 2.0}):
        scene = scene_from_dict(scene_to_dict(gas) | {"domain": {"kind": "box", "size": list(gas.domain.size),
                                "walls": {"bottom": manner}}, "seed": 1})  # fmt: skip
        measures = measured(scene, events=200)
        assert "walls heat, shake or slide" in measures["temperature"].doubt
        assert "cooling_exponent" not in list(measures)
        assert all(quantity.theory is None for quantity in measures.quantities)


def test_a_driven_gas_has_a_steady_state_where_something_takes_energy():
    gas = lattice_gas(25, 0.1, es.Box, seed=3)
    whole = scene_to_dict(gas) | {"seed": 1}
    for manner, pair, driven in (
        ({"shaking": 0.5}, 1.0, False),
        ({"shaking": 0.5}, 0.8, True),
        ({"temperature": 1.0}, 1.0, True),
    ):
        domain = {"kind": "box", "size": list(gas.domain.size), "walls": {"bottom": manner}}
        measures = measured(scene_from_dict(whole | {"domain": domain, "restitution": pair}), events=1500)
        assert measures.steady is measures.driven is driven
        assert math.isfinite(measures["mean_speed"].error) is driven
        assert math.isnan(measures["temperature"].value)


def test_energy_that_walls_still_bring_is_told():
    gas = lattice_gas(36, 0.1, es.Box, seed=3)
    walls = {side: {"temperature": 100.0} for side in ("bottom", "top")}
    scene = scene_from_dict(
        scene_to_dict(gas) | {"domain": {"kind": "box", "size": list(gas.domain.size), "walls": walls}, "seed": 1}
    )
    assert any("drift" in doubt or "still" in doubt for doubt in measured(scene, events=600).doubts)


def test_species_with_names_are_called_by_them():
    disks = es.Disks([[1, 1], [3, 1], [1, 3], [3, 3]], [[1, 0.3], [0, 1], [1, 1], [-1, 0]], [0.4, 0.4, 0.3, 0.3],
                     species=["big", "big", "small", "small"])  # fmt: skip
    names = list(measured(es.Scene(disks, es.Periodic((4.0, 4.0))), events=40))
    assert {"temperature_big", "mean_speed_small", "collision_rate_big_small"} <= set(names)


def test_a_slice_that_few_passages_saw_has_no_bar():
    count = np.zeros(64)
    count[[3, 40]] = 1.0
    above = np.random.default_rng(1).normal(size=64)
    assert math.isnan(_average(above * count, count).error)
    assert _average(above, np.ones(64)).error > 0.0

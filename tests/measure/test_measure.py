"""Measures of runs, against closed forms, theory, and a plain recount of the log."""

import math

import numpy as np
import pytest

import eventsim as es
from eventsim.measure import Meter, measure
from eventsim.measure.equilibration import strangers
from tests.engines.scenes import lattice_gas


def two_on_a_torus():
    """Two disks of diameter 1 at a packing fraction of 0.3, total momentum zero, E = kT = 1."""
    side = 2.288228082
    velocity = np.array([[0.8, 0.6], [-0.8, -0.6]])
    return es.Scene(es.Disks([[0.5, 0.5], [1.7, 1.6]], velocity, 0.5), es.Periodic((side, side)))


@pytest.fixture(scope="module")
def gas_log():
    scene = es.gallery("periodic-fluid", n=36, packing_fraction=0.3, seed=3)
    return es.simulate(scene, events=20_000, engine="reference", log=True).log


def test_sums_are_those_of_the_log(gas_log):
    measures = measure(gas_log, discard=0.0)
    scene, rows = gas_log.scene, gas_log.rows
    n, duration = len(scene.disks), measures.duration
    energy = 0.5 * float((scene.disks.velocity**2).sum())
    drift = 0.5 * float((scene.disks.velocity.mean(axis=0) ** 2).sum()) * n
    kt = (energy - drift) / (n - 1)
    assert measures["temperature"].value == pytest.approx(kt, rel=1e-12)
    z = 1.0 + 2.0 * scene.disks.radius[0] * float(rows["impulse"].sum()) / (2.0 * n * kt * duration)
    assert measures["Z"].value == pytest.approx(z, rel=1e-12)
    assert measures["collision_rate"].value == pytest.approx(2.0 * len(rows) / (n * duration), rel=1e-12)


def test_measures_do_not_depend_on_how_rows_are_cut(gas_log):
    scene, whole = gas_log.scene, measure(gas_log)
    meter = Meter(scene)
    for block in np.array_split(gas_log.rows, 37):
        meter.write(block)
    ending = gas_log.provenance.ending
    pieces = meter.finish(ending.epoch * gas_log.provenance.epoch_length + ending.remainder)
    assert pieces.to_dict() == whole.to_dict()


def test_a_run_measured_without_a_log_is_the_log_measured(gas_log):
    run = es.simulate(gas_log.scene, events=20_000, engine="reference", measure=True)
    assert not run.has_log
    # the log's ending and the run's time are one clock; the rounding of a sum is between them
    for name in ("Z", "collision_rate", "mean_free_path", "diffusion"):
        assert run.measures[name].value == pytest.approx(measure(gas_log)[name].value, rel=1e-9)


def test_free_paths_and_speeds_are_those_of_the_flights(gas_log):
    measures = measure(gas_log, discard=0.0)
    from eventsim.replay.flight_table import flight_table
    from eventsim.replay.replay import Replay

    table = flight_table(Replay(gas_log))
    speed = float(np.average(np.hypot(*table.velocity.T), weights=table.duration))
    assert measures["mean_speed"].value == pytest.approx(speed, rel=1e-12)
    path = measures["mean_speed"].value * measures["mean_free_time"].value
    assert measures["mean_free_path"].value == pytest.approx(path, rel=1e-12)


def test_displacements_are_those_of_the_flights(gas_log):
    from eventsim.replay.flight_table import flight_table
    from eventsim.replay.replay import Replay
    from tests.measure.ways import displacements

    correlations = measure(gas_log, discard=0.0).correlations
    interval = correlations.lag[0]
    times = np.arange(0.0, gas_log.time[-1], interval)
    table = flight_table(Replay(gas_log))
    way = np.stack([displacements(table, disk, times) for disk in range(36)], axis=1)
    for k in (1, 2, 8):
        place = int(np.argmin(abs(correlations.lag - k * interval)))
        expected = ((way[k:] - way[:-k]) ** 2).sum(axis=2).mean()
        assert correlations.msd[place] == pytest.approx(expected, rel=1e-9)


def test_a_gas_agrees_with_theory(gas_log):
    measures = measure(gas_log)
    assert measures.equilibrated
    for name in ("Z", "pressure", "collision_rate", "mean_speed", "mean_free_path"):
        assert abs(measures[name].deviation) < 4.0, name  # 1 in 16 000 by chance, for each of five
    assert measures.speeds[0].misfit < 2.0


def test_a_box_obeys_the_virial_theorem():
    run = es.simulate(lattice_gas(16, 0.2, es.Box, seed=5), events=20_000, engine="reference", measure=True)
    # walls and pairs are two ways to the same number: what differs are the ends of the run, about 1 / contacts of a disk
    assert run.measures["Z_walls"].value == pytest.approx(run.measures["Z"].value, rel=2e-3)


def test_equipartition_between_species():
    scene = lattice_gas(16, 0.2, es.Box, seed=6, masses=(1.0, 5.0), radii=(0.3, 0.5))
    measures = es.simulate(scene, events=20_000, engine="reference", measure=True).measures
    for kind in (0, 1):
        assert abs(measures[f"temperature_{kind}"].deviation) < 4.0
    count = measures["collision_rate_0_1"].value * 8, measures["collision_rate_1_0"].value * 8
    assert count[0] == pytest.approx(count[1], rel=1e-12)


def test_two_disks_have_their_closed_forms():
    measures = es.simulate(two_on_a_torus(), events=12_000, engine="reference", measure=True).measures
    assert measures["Z"].theory == pytest.approx(1.75, rel=1e-8)
    assert measures["collision_rate"].theory == pytest.approx(1.909859317, rel=1e-8)
    assert abs(measures["Z"].deviation) < 4.0
    assert measures["mean_speed"].deviation == 0.0


def test_haffs_law_while_the_gas_is_homogeneous():
    scene = lattice_gas(64, 0.1, es.Periodic, seed=7, restitution=0.95)
    measures = es.simulate(scene, events=64 * 25, engine="reference", measure=True).measures
    fall = measures["cooling_exponent"]
    assert not measures.steady
    assert fall.theory == pytest.approx(0.5 * (1.0 - 0.95**2), rel=1e-14)
    assert abs(fall.deviation) < 4.0


def test_energy_under_gravity_includes_the_flights():
    # one disk that falls 1 and rises again, for ever: mean kinetic energy = g h / 3
    scene = es.Scene(es.Disks([[1.0, 1.5]], radius=0.5), es.Box((2.0, 4.0)), gravity=(0.0, -2.0))
    measures = es.simulate(scene, until=400.0, engine="reference", measure=True).measures
    assert measures["kinetic_energy"].value == pytest.approx(2.0 / 3.0, rel=1e-2)  # a flight at each end, of 200


def test_the_beginning_is_left_out_when_asked_or_when_the_scene_says(gas_log):
    assert measure(gas_log, discard=1.5).discarded == 1.5
    scene = gas_log.scene
    told = es.Scene(scene.disks, scene.domain, equilibration=2.0)
    assert es.simulate(told, events=2000, engine="reference", measure=True).measures.discarded == 2.0


def test_a_crystal_that_does_not_melt_is_not_called_equilibrated():
    scene = es.gallery("periodic-fluid", n=64, packing_fraction=0.71)
    measures = es.simulate(scene, events=10_000, engine="reference", measure=True).measures
    assert not measures.equilibrated
    assert any("diameters" in doubt or "melting" in doubt for doubt in measures.doubts)


@pytest.mark.parametrize("discard", [-1.0, math.inf, 1e9])
def test_what_cannot_be_left_out_is_refused(gas_log, discard):
    with pytest.raises(es.EventsimError, match="discard"):
        measure(gas_log, discard=discard)


def test_posts_alone_are_nothing_to_measure():
    scene = es.Scene(es.Disks([[1.0, 1.0]], radius=0.5, mass=math.inf), es.Box((2.0, 2.0)))
    with pytest.raises(es.EventsimError, match="nothing to measure"):
        Meter(scene)


def test_the_quantity_that_is_furthest_off_is_named():
    off = [
        ("Z", 7.5, "a closed form"),
        ("force", -math.inf, "equipartition"),
        ("rate", None, None),
        ("speed", 4.9, "Maxwell"),
    ]
    assert strangers(off[2:]) == []
    (clause,) = strangers(off[:1])
    assert clause == "Z is 7.5 standard errors from equilibrium (a closed form): the disks do not mix, or have not yet"
    assert strangers(off)[0].startswith(
        "force is further than any error bar from equilibrium (equipartition), and 1 more"
    )

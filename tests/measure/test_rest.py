"""Measures where disks rest on walls: what they do between their row of rest and the next is no fall."""

import math

import numpy as np
import pytest

import eventsim as es
from eventsim.engines.auto import has_compiler
from eventsim.measure import Meter, measure, sums
from eventsim.record.events import Kind

ENGINES = ("reference", "fast") if has_compiler() else ("reference",)


def slopes():
    """Disks that fall, bounce, slide and lie: on the floor, down a slope, one pushed by another."""
    disks = es.Disks([[2.0, 0.25], [0.3, 0.4], [1.0, 1.3]], [[0.0, 0.0], [1.5, 0.0], [0.0, 0.0]], 0.1, [1.0, 3.0, 2.0])
    slope = es.Segment((0.5, 1.2), (3.5, 0.9), name="slope")
    return es.Scene(disks, es.Box((4.0, 2.0)), [slope], gravity=(0.0, -8.0), restitution=0.5)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_disk_that_stands_on_the_floor_presses_on_it_with_its_weight(engine):
    scene = es.Scene(es.Disks([[2.0, 0.5]], radius=0.1), es.Box((4.0, 2.0)), gravity=(0.0, -9.81), restitution=0.5)
    measures = es.simulate(scene, until=100.0, engine=engine, measure=20.0).measures
    assert measures["force_bottom"].value == pytest.approx(9.81, rel=1e-12)
    assert measures["kinetic_energy"].value == 0.0
    assert measures["mean_speed"].value == 0.0
    # from the start on it is the same but for the momentum at either end: none
    whole = es.simulate(scene, until=100.0, engine=engine, measure=True).measures
    assert whole["force_bottom"].value == pytest.approx(9.81, rel=2e-3)
    assert 0.0 < whole["kinetic_energy"].value < 9.81 * 0.4 / 50.0


def test_the_force_of_a_slope_is_the_part_of_the_weight_across_it():
    angle = math.radians(30.0)
    along, normal = np.array([math.cos(angle), -math.sin(angle)]), np.array([math.sin(angle), math.cos(angle)])
    disk = es.Disks([along + 0.5 * normal], radius=0.5, mass=2.0)
    wall = es.Segment((0.0, 0.0), tuple(100.0 * along), name="slope")
    scene = es.Scene(disk, es.Open(), [wall], gravity=(0.0, -2.0), restitution=0.5)
    measures = es.simulate(scene, until=8.0, measure=0.0).measures
    assert measures["force_slope"].value == pytest.approx(4.0 * math.cos(angle), rel=1e-9)
    assert measures["mean_speed"].value == pytest.approx(8.0 * 2.0 * math.sin(angle) / 2.0, rel=0.01)


def test_measures_are_those_of_the_states_that_the_log_tells():
    run = es.simulate(slopes(), until=6.0, engine="reference", log=True)
    assert (run.log.kind == Kind.REST).sum() >= 3
    measures = measure(run.log, discard=0.0)
    times = (np.arange(2000) + 0.5) * 3e-3
    velocity = np.array([run.state_at(t).velocity for t in times])
    speed = np.hypot(velocity[..., 0], velocity[..., 1])
    energy = 0.5 * (slopes().disks.mass * speed**2).sum(axis=1).mean()
    assert measures["kinetic_energy"].value == pytest.approx(energy, rel=0.01)
    assert measures["mean_speed"].value == pytest.approx(speed.mean(), rel=0.02)


def test_displacements_are_those_of_the_states_however_rows_are_cut():
    run = es.simulate(slopes(), until=6.0, engine="reference", log=True)
    for size in (7, len(run.log)):
        meter = Meter(slopes(), 0.0)
        for first in range(0, len(run.log), size):
            meter.write(run.log.rows[first : first + size])
        meter.finish(6.0)
        way = run.state.position - slopes().disks.position
        assert meter._sums.disks[:, sums.WX : sums.WY + 1] == pytest.approx(way, abs=1e-9)

"""Along a run each line tells its own part: what the states of the run give, averaged over just that part."""

import math

import numpy as np
import pytest

import eventsim as es
from eventsim.measure import measure
from eventsim.measure.ensemble import ensemble_of
from eventsim.measure.profile import Profiler
from eventsim.record.events import Kind
from tests.engines.scenes import lattice_gas

BALL = es.Disks(position=[(0.5, 2.0)], velocity=[(0.0, 0.0)], radius=0.05)


def falling(**keys):
    return es.Scene(BALL, es.Box((1.0, 2.5)), gravity=(0.0, -9.81), **keys)


def sliding():
    """A disk that comes to rest on a slope and slides down along it."""
    ramp = es.Segment(start=(0.0, 1.0), end=(4.0, 0.0))
    disk = es.Disks(position=[(0.6, 1.2)], velocity=[(0.0, 0.0)], radius=0.05)
    return es.Scene(disk, es.Box((4.0, 2.0)), [ramp], gravity=(0.0, -1.0), restitution=0.1)


def means(run, ends):
    """Kinetic energy on average over each part: two points of Gauss in each flight, exact for a quadratic of time."""
    cuts = np.unique(np.concatenate([ends, run.log.time[(run.log.time > ends[0]) & (run.log.time < ends[-1])]]))
    half = 0.5 * np.diff(cuts)
    mass = run.scene.disks.mass
    moving = np.isfinite(mass)

    def energy(time):
        velocity = np.asarray(run.state_at(float(time)).velocity)[moving]
        return 0.5 * float((mass[moving, None] * velocity**2).sum())

    points = [[energy(m + sign * h / math.sqrt(3.0)) for sign in (-1, 1)] for m, h in zip(cuts[:-1] + half, half, strict=True)]
    gained = np.concatenate([[0.0], np.cumsum(np.sum(points, axis=1) * half)])
    return np.diff(gained[np.searchsorted(cuts, ends)]) / np.diff(ends)


@pytest.mark.parametrize(
    ("scene", "until", "discard"),
    [
        (falling(), 5.0, None),
        (falling(restitution=0.8), 2.5, None),
        (falling(restitution=0.8), 2.5, 0.3),
        (sliding(), 3.0, None),
        (es.gallery("jar", n=8), 3.0, 0.5),
        (lattice_gas(9, 0.2), 8.0, 1.0),
    ],
    ids=["falls", "bounces", "bounces, the first flight cut", "slides", "many fall", "no gravity"],
)
def test_each_part_has_the_energy_of_its_own_time(scene, until, discard):
    run = es.simulate(scene, until=until, engine="reference", log=True)
    series = measure(run.log, discard=discard).series
    ends = np.concatenate([[discard or 0.0], series.time])
    expected = means(run, ends)
    # rounding of places in time, relative to a part
    scale = 1e-10 * expected.max()
    assert series.energy == pytest.approx(expected, rel=1e-10, abs=scale)


def test_a_sample_of_a_profile_counts_for_the_time_to_the_next():
    """Two units of time in the first of 32 slices, at speed 3, then eight in the last one, at speed 1, in one sample."""
    scene = es.Scene(es.Disks([(0.5, 0.5)], [(1.0, 0.0)], 0.1), es.Box((32.0, 1.0)))
    profiler = Profiler(scene, ensemble_of(scene), "x")
    profiler.add(np.array([0.0, 1.0]), 1.0, np.zeros((2, 1, 2)), np.full((2, 1, 2), [3.0, 0.0]))
    profiler.add(np.array([2.0]), 8.0, np.full((1, 1, 2), [31.0, 0.0]), np.array([[[1.0, 0.0]]]))
    (one,) = profiler.result().species
    assert one.density[[0, 1, 31]] == pytest.approx([0.2, 0.0, 0.8], rel=1e-15)
    assert one.velocity[[0, 31], 0].tolist() == [3.0, 1.0]


def test_a_disk_that_slides_down_was_tried():
    assert Kind.REST in es.simulate(sliding(), until=3.0, engine="reference", log=True).log.kind


def test_the_pressure_of_a_gas_that_cools_fast_is_that_of_the_energy_on_average():
    """n kT / A of the mean energy, and half of reach x impulse by time, with all contacts of the part."""
    scene = es.gallery("cooling", n=64, restitution=0.6)
    run = es.simulate(scene, events=3000, engine="reference", log=True)
    series = measure(run.log).series
    ends = np.concatenate([[0.0], series.time])
    assert series.energy[1] < 0.7 * series.energy[0]
    area = float(np.prod(scene.domain.size))
    n = len(scene.disks.mass)
    reach = scene.disks.radius[run.log.a] + scene.disks.radius[run.log.b]
    force = reach * run.log.impulse
    parts = zip(ends[:-1], series.time, strict=True)
    virial = [force[(run.log.time > a) & (run.log.time <= b)].sum() for a, b in parts]
    expected = (means(run, ends) * n / (n - 1) + 0.5 * np.array(virial) / np.diff(ends)) / area
    assert series.pressure == pytest.approx(expected, rel=1e-9)

"""Two disks against their closed forms to a ten-thousandth: rates and pressures of very long runs, summed batch by batch.

Source: the phase space of two disks, see eventsim/README.md; kT = 1 in both scenes.
"""

import math

import numpy as np
import pytest

import eventsim as es
from eventsim.measure.blocking import ratio_average

pytestmark = [pytest.mark.slow, pytest.mark.timeout(3600)]

PAIRS, PAIR_IMPULSE, WALLS, WALL_IMPULSE = range(4)


class BatchSums:
    """Takes the batches of runs, one after the other: (batches, 4) numbers and summed impulses of pairs and of walls."""

    def __init__(self):
        self.time, self.durations, self.sums = 0.0, [], []

    def __call__(self, rows):
        pair = rows["b"] >= 0
        impulse = np.where(pair, rows["impulse"], 0.0).sum()
        pairs = int(np.count_nonzero(pair))
        before, self.time = self.time, float(rows["time"][-1])
        self.durations.append(self.time - before)
        self.sums.append((pairs, impulse, len(rows) - pairs, rows["impulse"].sum() - impulse))

    def take(self, scene, events):
        """Simulate a scene."""
        pytest.importorskip("numba")
        self.time = 0.0
        run = es.simulate(scene, events=events, engine="fast", on_event=self)
        assert run.stopped == "events"

    def per_time(self, channel):
        return ratio_average(np.array(self.sums)[:, channel], np.array(self.durations))


def holds(bar, expected):
    return bar.error < 1e-4 * expected and abs(bar.mean - expected) < 3.0 * bar.error


def test_two_disks_on_a_torus():
    """Rate 2 d |v_rel| / (V - pi d^2) and Z = 1 + pi d^2 / (2 (V - pi d^2)), at eta = .3 and d = 1.

    Between the images there are straight corridors, so that free paths longer than l are as rare as 1 / l^2 only: their
    variance grows without end, and one flight of ten thousand free paths shows in the bar of the rate.
    """
    side = 2.288228082
    free = side * side - math.pi
    place = [[0.5, 0.5], [0.5 + 0.5 * side, 0.5 + 0.48 * side]]
    velocity = [[0.8, 0.6], [-0.8, -0.6]]  # kT = E / (N - 1) = 1, |v_rel| = 2
    sums = BatchSums()
    sums.take(es.Scene(es.Disks(place, velocity, 0.5), es.Periodic((side, side))), 400_000_000)
    assert holds(sums.per_time(PAIRS), 4.0 / free)
    virial = sums.per_time(PAIR_IMPULSE)  # d |dp| / (2 N kT) per contact
    assert holds(virial._replace(mean=1.0 + virial.mean / 4.0, error=virial.error / 4.0), 1.0 + math.pi / (2.0 * free))


def hard_box(seed):
    """Two disks in the unit box, kT = sum m v^2 / (2 N) = 1."""
    velocity = np.random.default_rng(seed).normal(size=(2, 2))
    velocity *= 2.0 / math.sqrt(float((velocity**2).sum()))
    return es.Scene(es.Disks([[0.25, 0.3], [0.7, 0.72]], velocity, 0.2), es.Box((1.0, 1.0)))


def test_two_disks_in_a_hard_box():
    """Unit box, r = .2: pair rate 4.15547414, hits on the four walls 9.57666101, force on each wall 5.64111898."""
    sums = BatchSums()
    for seed in range(4):
        sums.take(hard_box(seed), 200_000_000)
    assert holds(sums.per_time(PAIRS), 4.15547414)
    assert holds(sums.per_time(WALLS), 9.57666101)
    assert holds(sums.per_time(WALL_IMPULSE), 4.0 * 5.64111898)

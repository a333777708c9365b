"""Two disks, closed form: collision rates in a periodic and in a hard box within three standard errors.

The error of a rate comes from independent runs with different starts.  Source: the phase space of two disks, see
eventsim/README.md.
"""

import math

import numpy as np
import pytest

import eventsim as es


def start(rng, domain, low, high, distance, momentum_free):
    """Two disks at random places of the domain, not overlapping, with random directions and sum v^2 = 4."""
    while True:
        place = rng.uniform(low, high, (2, 2))
        apart = place[0] - place[1]
        if momentum_free:
            apart -= np.array(domain.size) * np.round(apart / np.array(domain.size))
        if math.hypot(*apart) >= distance:
            break
    velocity = rng.normal(size=(2, 2))
    if momentum_free:
        velocity -= velocity.mean(axis=0)
    velocity *= 2.0 / math.sqrt(float(np.sum(velocity**2)))
    return es.Scene(es.Disks(place, velocity, distance / 2.0), domain)


def mean_and_error(values):
    return float(np.mean(values)), float(np.std(values, ddof=1) / math.sqrt(len(values)))


def test_the_rate_of_two_disks_on_a_torus():
    """Rate 2 d |v_rel| / (V - pi d^2), at eta = .3 and d = 1."""
    side = 2.288228082
    rng = np.random.default_rng(1)
    rates, duration = [], 150.0
    for _ in range(40):
        scene = start(rng, es.Periodic((side, side)), 0.0, side, 1.0, True)
        relative = math.hypot(*(scene.disks.velocity[0] - scene.disks.velocity[1]))
        run = es.simulate(scene, until=duration)
        expected = 2.0 * relative / (side * side - math.pi)
        rates.append(run.counters.pair_contacts / duration / expected)
    mean, error = mean_and_error(rates)
    assert error < 0.01
    assert abs(mean - 1.0) < 3.0 * error


def test_the_rates_of_two_disks_in_a_hard_box():
    """Unit box, r = .2, kT = sum m v^2 / 4 = 1: pair rate 4.15547414, hits on the four walls 9.57666101."""
    rng = np.random.default_rng(2)
    pairs, walls, duration = [], [], 60.0
    for _ in range(60):
        scene = start(rng, es.Box((1.0, 1.0)), 0.2, 0.8, 0.4, False)
        run = es.simulate(scene, until=duration)
        pairs.append(run.counters.pair_contacts / duration)
        walls.append(run.counters.wall_contacts / duration)
    for values, expected in ((pairs, 4.15547414), (walls, 9.57666101)):
        mean, error = mean_and_error(values)
        assert error < 0.01 * expected
        assert abs(mean - expected) < 3.0 * error, (mean, error)


@pytest.mark.slow
def test_the_rates_of_two_disks_in_a_hard_box_to_a_thousandth():
    rng = np.random.default_rng(3)
    pairs = []
    for _ in range(200):
        scene = start(rng, es.Box((1.0, 1.0)), 0.2, 0.8, 0.4, False)
        pairs.append(es.simulate(scene, until=600.0).counters.pair_contacts / 600.0)
    mean, error = mean_and_error(pairs)
    assert error < 2e-3 * mean
    assert abs(mean - 4.15547414) < 3.0 * error

"""Contacts at one instant: corners, clusters, two images; the catalogue's scenes, looked at row by row."""

import math
from itertools import permutations

import numpy as np
import pytest

import eventsim as es
from eventsim.validation.stress.catalogue.boundaries import two_images
from eventsim.validation.stress.catalogue.clusters import AFTER_BREAK, PERIOD, diagonal, symmetric_break
from eventsim.validation.stress.catalogue.scenes import on_plane, relabelled
from tests.engines.scenes import rows_of, run_of

ULP = 2.0**-52


def test_a_corner_is_met_in_joint_rows():
    rows = rows_of(diagonal(), until=PERIOD)
    assert rows["time"].tolist() == [4.5, 4.5, 13.5, 13.5]
    assert rows["joint"].tolist() == [0, 0, 2, 2]
    assert (rows[1]["vxa"], rows[1]["vya"]) == (-1.0, -1.0)


def test_an_immovable_disk_in_a_corner_leaves_the_momentum_of_the_others_booked():
    obstacle = es.Disks([(5.0, 5.0), (2.0, 5.0)], [(1.0, 1.0), (0.0, 1.0)], 0.5, (math.inf, 1.0))
    run = es.simulate(es.Scene(obstacle, es.Box((10.0, 10.0))), until=6.0)
    assert (run.counters.clusters, run.counters.outer_momentum) == (1, [0.0, -2.0])
    assert run.residuals.momentum == 0.0


def test_many_periods_are_bit_exact():
    run = es.simulate(diagonal(), until=PERIOD * 2000)
    assert run.counters.events == 8000
    assert run.state.position.tolist() == [[5.0, 5.0]]
    assert run.state.velocity.tolist() == [[1.0, 1.0]]


@pytest.mark.slow
@pytest.mark.timeout(1200)  # two million joint contacts in exact arithmetic
def test_a_million_periods_are_bit_exact():
    run = es.simulate(diagonal(), until=PERIOD * 10**6, engine="reference")
    assert run.counters.events == 4 * 10**6
    assert run.state.position.tolist() == [[5.0, 5.0]]
    assert run.state.velocity.tolist() == [[1.0, 1.0]]


@pytest.mark.parametrize("order", list(permutations(range(3))))
def test_a_symmetric_break_is_one_cluster_and_the_rational_outcome_to_the_last_bit(order):
    session, _ = run_of(relabelled(symmetric_break(), list(order)), until=3.5)
    motion = session.motion()
    assert np.column_stack([motion.vx, motion.vy]).tolist() == AFTER_BREAK[list(order)].tolist()
    assert session.counters.clusters == 1


@pytest.mark.parametrize("order", list(permutations(range(4)))[::3])
def test_three_disks_at_120_degrees_onto_one_do_not_depend_on_labels(order):
    angles = 2.0 * math.pi * np.arange(3) / 3.0
    ring = np.column_stack([np.cos(angles), np.sin(angles)])
    ring[2] = ring[1] * [1.0, -1.0]  # symmetric in floats too
    position, velocity = np.vstack([[[0.0, 0.0]], 3.0 * ring]), np.vstack([[[0.0, 0.0]], -ring])
    position -= position.min(axis=0)  # what is rounded there is an exact tie
    base, _ = run_of(on_plane(position, velocity), until=4.0)
    other, _ = run_of(on_plane(position[list(order)], velocity[list(order)]), until=4.0)
    assert other.counters.events == base.counters.events
    for i, k in enumerate(order):
        assert other.motion().vx[i] == base.motion().vx[k]
        assert other.motion().vy[i] == base.motion().vy[k]
    assert math.hypot(base.motion().vx[0], base.motion().vy[0]) < 8 * ULP


def test_two_images_are_met_at_once():
    rows = rows_of(two_images(), events=2)
    assert len(rows) == 2
    assert rows["joint"].tolist() == [0, 0]
    assert rows[0]["time"] == pytest.approx(3.0 - math.sqrt(5.0), abs=4 * ULP)
    # the two normals are (2, +-sqrt 5)/3: by symmetry B's momentum is exchanged along y
    assert rows[1]["vxb"] == 0.0
    assert rows[1]["vyb"] + rows[1]["vya"] == pytest.approx(-1.0, abs=4 * ULP)
    assert rows[1]["vya"] ** 2 + rows[1]["vyb"] ** 2 == pytest.approx(1.0, abs=8 * ULP)


def test_a_disk_squeezed_between_immovable_ones_stops_the_run_with_a_reason():
    scene = on_plane(
        [[-2.0, 0.0], [0.0, 0.0], [2.0, 0.0]], [[1.0, 0.0], [0.0, 0.0], [-1.0, 0.0]], mass=[math.inf, 1.0, math.inf]
    )
    session, stopped = run_of(scene, until=5.0)
    assert stopped == "collapse"
    assert "disks 0, 1, 2" in session.reason

"""Walls hold: on a torus, in a channel, under gravity, round or straight, no disk passes one and none meets what is not there."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import eventsim as es
from tests.engines.scenes import run_of

SEGMENT = es.Segment((6.0, 1.0), (6.0, 3.0))


@pytest.mark.parametrize("domain", [es.Periodic, es.Channel])
def test_a_disk_that_wraps_meets_the_same_wall_again(domain):
    scene = es.Scene(es.Disks([[4.0, 2.0]], [[1.0, 0.0]], 0.2), domain((8.0, 4.0)), walls=[SEGMENT])
    run = es.simulate(scene, until=50.0, log=True)
    # from face to face through the boundary it is 8 - 2 (0.2) = 7.6
    assert run.log.time == pytest.approx([1.8 + 7.6 * k for k in range(7)], abs=1e-12)


def least_gap(run, start, end, radius, width):
    """The least distance between the disk's rim and a segment and its periodic images, over many times of the run."""
    (x0, y0), (x1, y1) = start, end
    ex, ey = x1 - x0, y1 - y0
    least = math.inf
    for t in np.linspace(run.start_time, run.time, 800):
        x, y = run.state_at(float(t)).position[0]
        for shift in (-width, 0.0, width):
            dx, dy = x + shift - x0, y - y0
            along = min(max((dx * ex + dy * ey) / (ex * ex + ey * ey), 0.0), 1.0)
            least = min(least, math.hypot(dx - along * ex, dy - along * ey) - radius)
    return least


@settings(max_examples=8, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from([es.Periodic, es.Channel]), st.sampled_from([None, (0.1, -0.7)]))
def test_a_segment_holds_on_a_torus_and_in_a_channel(seed, domain, gravity):
    rng = np.random.default_rng(seed)
    start, angle = rng.uniform((1.0, 1.2), (7.0, 2.8)), rng.uniform(0.0, math.pi)
    end = start + rng.uniform(0.5, 1.5) * np.array([math.cos(angle), math.sin(angle)])
    radius = 0.2
    for _ in range(100):
        place = rng.uniform((0.0, 0.3), (8.0, 3.7))
        middle = (start + end) / 2
        if math.hypot(*(place - middle)) > 1.1 and math.hypot(*(place - middle - [8.0, 0.0])) > 1.1:
            break
    try:
        scene = es.Scene(
            es.Disks([place], [rng.normal(size=2)], radius),
            domain((8.0, 4.0)),
            walls=[es.Segment(tuple(start), tuple(end))],
            gravity=gravity if domain is es.Channel else None,
        )
    except es.SceneError:
        return
    run = es.simulate(scene, until=30.0, log=True)
    assert run.stopped in ("until", "quiet")
    assert least_gap(run, start, end, radius, 8.0) > -1e-9


def test_an_arc_on_a_torus_is_met_where_it_is():
    arc = es.Arc((3.0, 1.0), (4.0, 2.0), (5.0, 1.0))
    for seed in range(10):
        velocity = np.random.default_rng(seed).normal(size=(2, 2))
        scene = es.Scene(es.Disks([[1.0, 3.0], [6.5, 3.0]], velocity, 0.2), es.Periodic((8.0, 4.0)), walls=[arc])
        run = es.simulate(scene, until=30.0, log=True)
        assert run.stopped == "until"
        walls = run.log.kinds == "wall"
        x, y = run.log.xa[walls] % 8.0, run.log.ya[walls] % 4.0
        away = np.min(
            [np.abs(np.hypot(x - 4.0 - dx, y - 1.0 - dy) - 1.0) for dx in (-8, 0, 8) for dy in (-4, 0, 4)], axis=0
        )
        ends = np.min(
            [np.hypot(x - ex - dx, y - 1.0 - dy) for ex in (3.0, 5.0) for dx in (-8, 0, 8) for dy in (-4, 0, 4)], axis=0
        )
        assert np.all((np.abs(away - 0.2) < 1e-9) | (np.abs(ends - 0.2) < 1e-9))


def test_a_turning_point_inside_an_arc_is_no_contact():
    scene = es.Scene(
        es.Disks([[0.1, 0.1]], [[0.0, 0.2]], 0.05),
        es.Open(),
        walls=[es.Arc((1.0, 0.0), (0.0, 0.6), (-1.0, 0.0))],
        gravity=(0.0, -1.0),
    )
    session, stopped = run_of(scene, until=1.0)
    assert (stopped, session.counters.events) == ("quiet", 0)


def test_a_galton_board_of_posts_and_a_shelf_runs_under_gravity():
    scene = es.Scene(
        es.Disks([[0.5, 3.0], [2.4, 2.0]], radius=0.1, mass=[1.0, math.inf]),
        es.Box((4.0, 4.0)),
        walls=[es.Segment((1.0, 1.0), (2.0, 1.0)), es.Circle((2.0, 2.0), 5.0)],
        gravity=(0.0, -1.0),
    )
    session, stopped = run_of(scene, until=10.0, check=True)
    assert stopped == "until"
    assert session.counters.events > 0


@pytest.mark.slow
def test_a_disk_crushed_between_a_wall_and_an_obstacle_ends_with_a_reason():
    scene = es.Scene(
        es.Disks([[1.5, 2.0], [6.0, 2.0]], [[0.3, 0.0], [-1.0, 0.0]], 0.5, [1.0, math.inf]), es.Box((8.0, 4.0))
    )
    session, stopped = run_of(scene, until=10.0)
    assert stopped == "digits"
    assert session.reason

"""Where nothing but posts can be met, these alone are looked for; the log is the same, bit for bit."""

from __future__ import annotations

import math

import numpy as np
import pytest

import eventsim as es
from eventsim.compiler import is_interpreted
from eventsim.engines.base import Stop
from eventsim.engines.fast.plan import in_memory, posts_of
from eventsim.engines.fast.session import FastSession
from eventsim.engines.reference.loop import ReferenceSession
from eventsim.record.digest import digest_of
from eventsim.scene.gallery import gallery
from eventsim.scene.stage import stage_of
from tests.engines.fast.test_same_log import assert_same, rows_of

pytestmark = pytest.mark.kernels

EVENTS = 100 if is_interpreted() else 2000
SIZE = (8.0, 6.0)


def among_posts(
    columns: int,
    rows: int,
    movers: int,
    domain: type = es.Periodic,
    post: float = 0.3,
    radius: float = 0.0,
    mass: float = 0.0,
    corner: float = 0.5,
) -> es.Scene:
    """A lattice of posts in a domain of SIZE, the first at `corner` spacings, and disks that meet only these, in between."""
    rng = np.random.default_rng(columns * rows + movers)
    spacing = np.array([SIZE[0] / columns, SIZE[1] / rows])
    row, column = np.divmod(np.arange(columns * rows), columns)
    posts = (np.stack([column, row], axis=1) + corner) * spacing
    near = posts[rng.integers(0, len(posts), movers)] + 0.5 * spacing
    between = (near + rng.uniform(-0.05, 0.05, near.shape)) % SIZE
    disks = es.Disks(
        np.concatenate([between, posts]),
        np.concatenate([rng.normal(size=(movers, 2)), np.zeros_like(posts)]),
        np.repeat([radius, post], [movers, len(posts)]),
        np.repeat([mass, math.inf], [movers, len(posts)]),
    )
    return es.Scene(disks, es.Open() if domain is es.Open else domain(SIZE))


@pytest.mark.parametrize(
    "scene",
    [
        pytest.param(among_posts(1, 1, 40), id="one post"),
        pytest.param(among_posts(3, 3, 40, es.Box, corner=0.4, radius=0.05), id="a few in a box"),
        pytest.param(among_posts(2, 2, 40, corner=0.0), id="across the border"),
        pytest.param(among_posts(2, 2, 40, post=1.5, corner=0.5), id="next to the border"),
        pytest.param(among_posts(8, 6, 60), id="cells of posts"),
        pytest.param(among_posts(8, 6, 60, es.Channel, corner=0.35, radius=0.08, post=0.2), id="cells in a channel"),
        pytest.param(among_posts(8, 6, 60, es.Open), id="cells on the open plane"),
        pytest.param(among_posts(8, 6, 60, corner=0.0), id="cells across the border"),
        pytest.param(among_posts(3, 2, 40, mass=1.0), id="points of mass 1"),
        pytest.param(among_posts(3, 2, 1, mass=2.0, radius=0.2), id="a single disk"),
    ],
)
def test_what_meets_only_posts_has_one_log(scene: es.Scene) -> None:
    stage = stage_of(scene)
    assert posts_of(stage) is not None
    assert_same(stage, Stop(until=1000.0, events=EVENTS))


def test_posts_come_first_in_memory() -> None:
    stage = stage_of(among_posts(20, 15, 40, post=0.1))
    assert np.array_equal(np.sort(in_memory(stage)[:300]), np.flatnonzero(np.isinf(stage.mass)))


@pytest.mark.parametrize("name", ["gas", "brownian", "jar", "bounce"])
def test_where_disks_meet_or_fall_none_is_told_to_meet_only_posts(name: str) -> None:
    assert posts_of(stage_of(gallery(name))) is None


def test_posts_that_reach_half_a_period_are_looked_for_as_others_are() -> None:
    assert posts_of(stage_of(among_posts(1, 1, 3, post=2.9, corner=0.6))) is not None
    assert posts_of(stage_of(among_posts(1, 1, 3, post=2.9, radius=0.1, corner=0.6))) is None


def test_a_post_that_is_kicked_is_no_post_any_more() -> None:
    stage = stage_of(among_posts(3, 3, 30, es.Box))
    digests = []
    for session in (ReferenceSession(stage), FastSession(stage)):
        rows = [rows_of(session, Stop(events=EVENTS // 4))[0]]
        session.kick(32, 0.25, -0.125)
        rows.append(rows_of(session, Stop(events=EVENTS // 2))[0])
        session.restore(session.snapshot())
        session.kick(32, 0.0, 0.0)
        rows.append(rows_of(session, Stop(events=EVENTS))[0])
        digests.append(digest_of(np.concatenate(rows)))
    assert digests[0] == digests[1]

"""Where there are many walls, a disk looks for those near its cell; the log is the same, bit for bit."""

from __future__ import annotations

import numpy as np
import pytest

import eventsim as es
from eventsim.compiler import is_interpreted
from eventsim.engines.auto import _at_start
from eventsim.engines.base import Stop
from eventsim.engines.fast.plan import Grids
from eventsim.engines.fast.wall_cells import MANY_SHAPES
from eventsim.scene.stage import Stage, stage_of
from tests.engines.fast.test_same_log import assert_same

pytestmark = pytest.mark.kernels

EVENTS = 60 if is_interpreted() else 2000
SIZE = (9.0, 8.0)


def among_walls(disks: int, domain: type, arcs: bool = False, **scene: object) -> es.Scene:
    """Disks between the short walls, of all directions, of a lattice of 6 by 5."""
    rng = np.random.default_rng(disks)
    row, column = np.divmod(np.arange(30), 6)
    middle = (np.stack([column, row], axis=1) + 0.5) * (SIZE[0] / 6, SIZE[1] / 5)
    half = rng.uniform(-0.25, 0.25, (30, 2))
    across = half[:, ::-1] * (0.5, -0.5)
    walls = [
        es.Arc(m - h, m + a, m + h) if arcs and k % 2 else es.Segment(m - h, m + h)
        for k, (m, h, a) in enumerate(zip(middle, half, across, strict=True))
    ]
    cell = rng.permutation(30)[:disks]
    position = np.stack([cell % 6 + 0.95, cell // 6 + 0.5], axis=1) * (SIZE[0] / 6, SIZE[1] / 5)
    made = es.Open() if domain is es.Open else domain(SIZE)
    return es.Scene(es.Disks(position, rng.normal(size=(disks, 2)), 0.05), made, walls=walls, **scene)


def round_table(disks: int, edges: int = 80) -> es.Scene:
    """Disks in a polygon of many edges, on the open plane."""
    angle = 2.0 * np.pi * np.arange(edges) / edges
    rng = np.random.default_rng(3)
    position = np.stack([np.arange(disks) % 6 - 2.5, np.arange(disks) // 6 - 2.5], axis=1) * 0.25
    polygon = es.Polygon(np.stack([np.cos(angle), np.sin(angle)], axis=1) * 2.0)
    return es.Scene(es.Disks(position, rng.normal(size=(disks, 2)), 0.1), es.Open(), walls=[polygon])


def listed(stage: Stage) -> np.ndarray | None:
    grids = Grids(stage, "auto")
    grids.choose(_at_start(stage))
    return grids.near_walls()


@pytest.mark.parametrize(
    "scene",
    [
        pytest.param(among_walls(30, es.Box), id="box"),
        pytest.param(among_walls(28, es.Periodic, arcs=True), id="periodic"),
        pytest.param(among_walls(2, es.Channel, arcs=True), id="two disks"),
        pytest.param(among_walls(30, es.Open, arcs=True), id="open"),
        pytest.param(among_walls(30, es.Box, gravity=(0.25, -0.5)), id="falling"),
        pytest.param(among_walls(12, es.Box, gravity=(0.0, -0.5), restitution=0.8), id="coming to rest"),
        pytest.param(round_table(1), id="one disk in a polygon"),
        pytest.param(round_table(36), id="disks in a polygon"),
    ],
)
def test_many_walls_have_one_log(scene: es.Scene) -> None:
    stage = stage_of(scene)
    table = listed(stage)
    assert table is not None
    assert len(table) < len(stage.features) * (int(table[0]) - 1)
    assert_same(stage, Stop(until=1000.0, events=EVENTS))


def test_with_few_walls_all_are_looked_at() -> None:
    scene = among_walls(30, es.Box)
    stage = stage_of(es.Scene(scene.disks, scene.domain, walls=scene.walls[:3]))
    assert len(stage.features) < MANY_SHAPES
    assert listed(stage) is None


def test_no_place_is_nearer_to_a_wall_than_is_told() -> None:
    from eventsim.engines.fast.wall_cells import _bounds, _distances

    walls = [es.Segment((1.0, 1.0), (3.0, 2.0)), es.Arc((1.0, 0.0), (2.0, 1.0), (3.0, 0.0)), es.Ellipse((2.0, 1.0), (1.0, 0.5))]
    points = np.random.default_rng(3).uniform(-1.0, 5.0, (50, 2))
    for wall in walls:
        for shape, _ in wall.pieces(lambda point: point):
            told = _distances(shape, points[:, 0], points[:, 1])
            true = np.array([shape.nearest(x, y)[2] for x, y in points.tolist()])
            assert np.all(told <= np.where(np.isfinite(true), true, np.inf) + 1e-12)
            (low_x, low_y), (high_x, high_y) = _bounds(shape)
            assert low_x <= high_x
            assert low_y <= high_y

"""Grids of several levels change no bit of the log, whatever the radii."""

from __future__ import annotations

import numpy as np
import pytest

import eventsim as es
from eventsim.compiler import is_interpreted
from eventsim.engines.base import Stop
from eventsim.engines.fast import FastOptions
from eventsim.engines.fast.plan import FIVE, Grids, Sizes, along_a_curve, classes_of, levels_of
from eventsim.engines.fast.session import FastSession
from eventsim.engines.reference.loop import ReferenceSession
from eventsim.record.digest import digest_of
from eventsim.scene.stage import Stage, stage_of
from tests.engines.fast.test_same_log import assert_same, rows_of
from tests.engines.scenes import lattice_gas, wide_mixture

pytestmark = pytest.mark.kernels

STOP, SEEDS = (Stop(until=100.0, events=60), 1) if is_interpreted() else (Stop(until=100.0, events=3000), 4)
slow = pytest.mark.slow


@pytest.mark.parametrize(
    ("domain", "gravity"),
    [
        (es.Periodic, None),
        pytest.param(es.Box, None, marks=slow),
        pytest.param(es.Channel, None, marks=slow),
        pytest.param(es.Open, None, marks=slow),
        pytest.param(es.Box, (0.5, -1.0), marks=slow),
        pytest.param(es.Channel, (0.5, 0.0), marks=slow),
    ],
)
def test_a_wide_mixture_has_one_log(domain: type, gravity: tuple[float, float] | None) -> None:
    for seed in range(SEEDS):
        stage = stage_of(wide_mixture(250, seed, domain, gravity=gravity))
        assert len(classes_of(stage)) > 1
        assert_same(stage, STOP)


def test_cells_into_which_a_fifth_disk_fits_have_room_for_it_from_the_beginning() -> None:
    """More slots in the middle of a run are another kind of kernel, and compile for seconds."""
    depths = []
    for name in ("gas", "mixture"):
        stage = stage_of(es.gallery(name))
        grids = Grids(stage, "auto")
        grids.choose(ReferenceSession(stage).motion())
        assert grids.sizes is not None
        depths.append(grids.sizes[0].depth)
        for more in (FIVE, 2 * FIVE)[depths[-1] == FIVE :]:
            grids.deepen(0)
            assert grids.sizes[0].depth == more
    assert depths == [4, FIVE]


def square(count: int, depth: int, radius: float) -> Sizes:
    return Sizes((0.0, 0.0), count, count, (8.0 / count, 8.0 / count), depth, radius)


def test_grids_of_any_width_and_the_scalar_kernel_give_one_log() -> None:
    stage = stage_of(wide_mixture(250, 1, es.Periodic))
    choices: list[dict[str, object]] = [
        {},
        {"lanes": False},
        {"sizes": None},
        {"sizes": (square(18, 8, 0.2), square(3, 16, 1.2))},
        {"sizes": (square(40, 4, 0.05), square(16, 4, 0.2), square(1, 8, 1.2))},
    ]
    digests = {digest_of(rows_of(FastSession(stage, options=FastOptions(**options)), STOP)[0]) for options in choices}
    assert len(digests) == 1


def stage_with(radius: np.ndarray) -> Stage:
    scene = lattice_gas(len(radius), 0.1, es.Periodic)
    disks = es.Disks(1000.0 * scene.disks.position, scene.disks.velocity, radius)
    return stage_of(es.Scene(disks, es.Periodic(tuple(1000.0 * length for length in scene.domain.size))))


def test_disks_of_alike_radii_share_one_grid() -> None:
    assert classes_of(stage_with(np.linspace(300.0, 900.0, 100))) == (900.0,)


def test_each_class_ends_with_a_radius_that_exists() -> None:
    stage = stage_with(np.concatenate([np.full(2000, 0.5), [1.0, 3.0, 100.0], np.full(1000, 0.0)]))
    classes = classes_of(stage)
    assert set(classes) <= {0.0, 0.5, 1.0, 3.0, 100.0}
    level = levels_of(stage, classes)
    assert level.tolist() == [next(k for k, bound in enumerate(classes) if r <= bound) for r in stage.radius]
    assert level[2002] == len(classes) - 1


@pytest.mark.parametrize("gravity", [None, pytest.param((0.5, -1.0), marks=slow)])
@pytest.mark.parametrize("wide", [False, True])
@pytest.mark.parametrize("shift", [0.0, pytest.param(3.5, marks=slow)])
def test_disks_in_a_small_part_of_a_box_have_cells_there(
    shift: float, wide: bool, gravity: tuple[float, float] | None
) -> None:
    """Chosen anew as the gas spreads, until they cover the box."""
    gas = wide_mixture(60, 1, es.Box) if wide else lattice_gas(64, 0.3, seed=3)
    (width, height), disks = gas.domain.size, gas.disks
    place = disks.position + np.array([shift * width, shift * height])
    moved = es.Disks(place, disks.velocity, disks.radius, disks.mass)
    stage = stage_of(es.Scene(moved, es.Box((8.0 * width, 8.0 * height)), gravity=gravity))
    assert_same(stage, Stop(events=300))
    session = FastSession(stage)
    grounds = []
    for events in (1, 300):
        rows_of(session, Stop(events=events))
        grid = session._machine.grid
        grounds.append(grid.columns * grid.side_x * grid.rows * grid.side_y / (64.0 * width * height))
    assert grounds[0] < 0.1
    assert gravity is not None or grounds[1] > 0.1


@pytest.mark.parametrize("gravity", [None, pytest.param((0.5, -1.0), marks=slow)])
@pytest.mark.parametrize("wide", [False, pytest.param(True, marks=slow)])
def test_disks_that_fly_apart_on_the_open_plane_come_to_an_end(wide: bool, gravity: tuple[float, float] | None) -> None:
    scene = (
        wide_mixture(60, 1, es.Open, gravity=gravity)
        if wide
        else lattice_gas(64, 0.3, es.Open, seed=3, gravity=gravity)
    )
    stage = stage_of(scene)
    logs = []
    for session in (ReferenceSession(stage), FastSession(stage)):
        rows, stopped = rows_of(session, Stop())
        assert stopped == "quiet"
        logs.append(digest_of(rows))
    assert logs[0] == logs[1]


def test_disks_too_large_for_levels_on_a_torus_have_no_cells() -> None:
    """Two of their images would be equally near before they are looked at again."""
    places = [(0.4 * (k % 20 + 0.5), 0.4 * (k // 20 + 0.5)) for k in range(400)]
    far = [(x, y) for x, y in places if min(np.hypot(x - 2.0, y - 2.0), np.hypot(x - 6.0, y - 6.0)) > 1.7]
    radius = [1.6] * 2 + [0.05] * len(far)
    disks = es.Disks([(2.0, 2.0), (6.0, 6.0), *far], np.random.default_rng(2).normal(size=(len(radius), 2)), radius)
    stage = stage_of(es.Scene(disks, es.Periodic((8.0, 8.0))))
    assert len(classes_of(stage)) == 2
    grids = Grids(stage, "auto")
    grids.choose(ReferenceSession(stage).motion())
    assert grids.sizes is None


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("largest", [0.0, 0.1, 0.5])
def test_points_in_a_row_on_the_plane_have_one_grid(largest: float, axis: int) -> None:
    """Nothing tells how far apart they are on the average: the row has no area."""
    place, velocity = np.zeros((31, 2)), np.zeros((31, 2))
    place[:, axis], velocity[:, axis] = np.arange(31.0), [1.0] * 15 + [-1.0] * 16
    stage = stage_of(es.Scene(es.Disks(place, velocity, [0.0] * 30 + [largest]), es.Open()))
    assert classes_of(stage) == (largest,)
    assert_same(stage, Stop(until=100.0))


def test_disks_in_a_row_on_the_plane_meet() -> None:
    place = [(float(k), 0.0) for k in range(30)]
    stage = stage_of(es.Scene(es.Disks(place, [(1.0, 0.0)] + [(0.0, 0.0)] * 29, 0.25), es.Open()))
    assert_same(stage, Stop(until=100.0))
    assert len(rows_of(ReferenceSession(stage), Stop(until=100.0))[0]) == 29


def test_disks_in_a_column_are_in_its_order_in_memory() -> None:
    y = np.random.default_rng(1).permutation(300).astype(float)
    along = y[along_a_curve(np.full(300, 2.5), y)]
    assert (np.diff(along) > 0.0).all() or (np.diff(along) < 0.0).all()


def test_a_tie_among_disks_of_several_classes_has_one_log() -> None:
    tiny = [(0.5 + 0.5 * (k % 20), 9.0 + 0.5 * (k // 20)) for k in range(60)]
    position, radius = [(3.0, 4.0), (6.0, 4.0), (9.0, 4.0), *tiny], [1.0, 1.0, 1.0] + [0.01] * 60
    velocity = [(1.0, 0.0), (0.0, 0.0), (-1.0, 0.0)] + [(0.0, 0.0)] * 60
    scene = es.Scene(es.Disks(position, velocity, radius), es.Box((12.0, 12.0)))
    sizes = [FastSession(stage_of(scene)), ReferenceSession(stage_of(scene))]
    rows = []
    for session in sizes:
        session.advance(Stop(events=6), 10**6)
        rows.append(session.take_rows())
    assert rows[0].tobytes() == rows[1].tobytes()
    assert rows[0]["joint"].tolist()[:2] == [0, 0]

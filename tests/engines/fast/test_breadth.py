"""Whatever a scene has, and however the fast engine works: one log, the reference engine's, bit for bit."""

from __future__ import annotations

import json

import numpy as np
import pytest

import eventsim as es
from eventsim.engines.base import Stop
from eventsim.engines.fast import FastOptions
from eventsim.engines.fast.compiled import lanes_work
from eventsim.engines.fast.plan import cell_sizes, classes_of
from eventsim.engines.fast.session import FastSession
from eventsim.engines.reference.loop import ReferenceSession
from eventsim.record.digest import digest_of
from eventsim.record.events import Rows
from eventsim.scene.stage import Stage, stage_of
from tests.engines.fast.crowds import crowd
from tests.engines.fast.test_same_log import assert_same, rows_of
from tests.gallery.test_gallery_digests import DIGESTS, stored

pytestmark = pytest.mark.kernels

FEW, MANY = (3, 5), range(200)
EVENTS, MOST_EVENTS = 1000, 100_000


def wider(stage: Stage) -> dict[str, object]:
    """Cells half as many along each axis and twice as deep; none where there were none."""
    sizes = cell_sizes(stage, stage.x, stage.y, classes_of(stage), {})
    if sizes is None or stage.size is None:
        return {"sizes": None}
    made = []
    for size in sizes:
        columns, rows = (
            max(count // 2, 1 if length is None else min(5, count))
            for count, length in zip((size.columns, size.rows), stage.period, strict=True)
        )
        side = stage.size[0] / columns, stage.size[1] / rows
        made.append(size._replace(columns=columns, rows=rows, side=side, depth=2 * size.depth))
    return {"sizes": tuple(made)}


def split(stage: Stage, stop: Stop, seed: int) -> Rows:
    """The rows of a run that is cut into pieces, each of a new session of one of the two engines."""
    rng = np.random.default_rng(seed)
    session: ReferenceSession | FastSession = ReferenceSession(stage)
    assert stop.events is not None
    cuts = sorted(rng.integers(0, stop.events, 3).tolist())
    blocks = []
    for k, cut in enumerate([*cuts, stop.events]):
        rows, stopped = rows_of(session, Stop(stop.until, cut))
        blocks.append(rows)
        if stopped != "events":
            break
        before, session = session, ReferenceSession(stage) if k % 2 else FastSession(stage)
        session.restore(before.snapshot())
        session.counters.copy_from(before.counters)
    return np.concatenate(blocks)


def relabelled(scene: es.Scene, order: np.ndarray) -> es.Scene:
    d = scene.disks
    disks = es.Disks(d.position[order], d.velocity[order], d.radius[order], d.mass[order])
    return es.Scene(
        disks,
        scene.domain,
        walls=scene.walls,
        gravity=scene.gravity,
        restitution=scene.restitution,
        contact_duration=scene.contact_duration,
    )


def agree(seed: int, events: int) -> None:
    """One scene, and for each seed another way to simulate it besides the usual one."""
    scene = crowd(seed)
    stage, stop = stage_of(scene), Stop(until=200.0, events=events)
    assert_same(stage, stop)
    way = seed // 4 % 4
    if way == 0:
        assert_same(stage, stop, lanes=False)
    elif way == 1:
        assert_same(stage, stop, **wider(stage))
    elif way == 2:
        whole, _ = rows_of(ReferenceSession(stage), stop)
        assert digest_of(split(stage, stop, seed)) == digest_of(whole)
    else:
        assert_same(stage_of(relabelled(scene, np.random.default_rng(seed).permutation(stage.n))), stop)


@pytest.mark.parametrize("seed", FEW)
def test_a_crowd_has_one_log(seed: int) -> None:
    agree(seed, EVENTS)


@pytest.mark.slow
@pytest.mark.parametrize("seed", MANY)
def test_many_crowds_have_one_log_each(seed: int) -> None:
    agree(seed, int(EVENTS * (MOST_EVENTS / EVENTS) ** np.random.default_rng(seed).random()))


KNOWN = json.loads(DIGESTS.read_text())
QUICK = ("break", "newton-cradle", "corner")


@pytest.mark.parametrize("lanes", [True, False], ids=["lanes", "scalar"])
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=() if name in QUICK else pytest.mark.slow) for name in KNOWN]
)
def test_golden_digests_hold_with_lanes_and_without(name: str, lanes: bool) -> None:
    if lanes and not lanes_work():
        pytest.skip("this processor has no such registers")
    scene = stored(name)
    rows, stopped = rows_of(FastSession(stage_of(scene), options=FastOptions(lanes=lanes)), Stop(scene.until, scene.events))
    assert {"events": len(rows), "stopped": stopped, "digest": digest_of(rows)} == KNOWN[name]

"""The fast engine writes the reference engine's log, bit for bit."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

import eventsim as es
from eventsim.compiler import is_interpreted
from eventsim.engines.base import Session, Stop
from eventsim.engines.fast import FastOptions, machine, plan
from eventsim.engines.fast.plan import Sizes
from eventsim.engines.fast.session import FastSession
from eventsim.engines.reference.loop import ReferenceSession
from eventsim.record.digest import digest_of
from eventsim.record.events import ROW, Rows
from eventsim.scene.gallery import gallery, names
from eventsim.scene.stage import Stage, stage_of

pytest.importorskip("numba")
pytestmark = pytest.mark.kernels

BUDGET = 3000
COUNTERS = (
    "events",
    "pair_contacts",
    "wall_contacts",
    "clusters",
    "wraps",
    "turnovers",
    "deepest_overlap",
    "outer_momentum",
)


def rows_of(session: Session, stop: Stop) -> tuple[Rows, str]:
    blocks, stopped = [], None
    while stopped is None:
        stopped = session.advance(stop, BUDGET)
        blocks.append(session.take_rows())
    return np.concatenate(blocks), stopped


def assert_same(stage: Stage, stop: Stop, **options: object) -> None:
    reference, fast = ReferenceSession(stage), FastSession(stage, options=FastOptions(**options))
    expected, why = rows_of(reference, stop)
    rows, stopped = rows_of(fast, stop)
    differ = next(
        (k for k in range(min(len(rows), len(expected))) if rows[k].tolist()[:10] != expected[k].tolist()[:10]), None
    )
    assert (len(rows), differ) == (len(expected), None)
    for name in ROW.names:
        assert np.array_equal(rows[name], expected[name], equal_nan=ROW[name].kind == "f"), name
    assert stopped == why or (stage.size is None and {stopped, why} == {"until", "quiet"})
    assert digest_of(rows) == digest_of(expected)
    for name in COUNTERS:
        assert getattr(fast.counters, name) == getattr(reference.counters, name), name
    assert fast.clock == reference.clock
    for one, other in zip(fast.motion(), reference.motion(), strict=True):
        assert np.array_equal(one, other)


MOST = 120 if is_interpreted() else None
"""Events of a run that is to be quick."""


@pytest.mark.parametrize("name", names())
def test_a_gallery_scene_has_one_log(name: str) -> None:
    scene = gallery(name)
    assert_same(stage_of(scene), Stop(scene.until, MOST or scene.events))


def lattice_gas(
    columns: int, rows: int, spacing: float, rng: np.random.Generator, domain: str, quantised: bool, spread: float
) -> es.Scene:
    """Disks of radius up to 1/2 on a square lattice, with velocities that may be small multiples of 1/4."""
    n = columns * rows
    size = (columns * spacing, rows * spacing)
    place = np.stack([(np.arange(n) % columns + 0.5) * spacing, (np.arange(n) // columns + 0.5) * spacing], axis=1)
    velocity = rng.integers(-2, 3, (n, 2)) / 4.0 if quantised else rng.normal(size=(n, 2))
    radius = 0.5 * (1.0 - spread * rng.random(n))
    domains = {"periodic": es.Periodic, "channel": es.Channel, "box": es.Box}
    made = es.Open() if domain == "open" else domains[domain](size)
    return es.Scene(disks=es.Disks(place, velocity, radius), domain=made)


random_gases = given(
    seed=st.integers(0, 2**32 - 1),
    columns=st.integers(1, 12),
    rows=st.integers(1, 9),
    spacing=st.sampled_from([1.0, 1.03125, 1.25, 1.5, 2.7]),
    quantised=st.booleans(),
    spread=st.sampled_from([0.0, 0.6]),
)
few = settings(max_examples=5 if is_interpreted() else 25, deadline=None, suppress_health_check=list(HealthCheck))


@pytest.mark.parametrize("domain", ["periodic", "box", pytest.param("channel", marks=pytest.mark.slow)])
@few
@random_gases
def test_a_random_gas_has_one_log(
    domain: str, seed: int, columns: int, rows: int, spacing: float, quantised: bool, spread: float
) -> None:
    assume(spacing > 1.0 or min(columns, rows) > 1)  # a disk that fills its box is refused
    scene = lattice_gas(columns, rows, spacing, np.random.default_rng(seed), domain, quantised, spread)
    assert_same(stage_of(scene), Stop(until=30.0, events=MOST or 1000))


@pytest.mark.slow  # four kernels are compiled
@pytest.mark.compiled
def test_scalar_kernel_and_lanes_and_two_cell_sizes_agree() -> None:
    stage = stage_of(lattice_gas(12, 12, 1.25, np.random.default_rng(5), "periodic", False, 0.0))
    stop = Stop(events=3000)
    digests = {
        digest_of(rows_of(FastSession(stage, options=FastOptions(**options)), stop)[0])
        for options in (
            {"lanes": False},
            {"lanes": None},
            {"sizes": Sizes((0.0, 0.0), 6, 6, (2.5, 2.5), 16)},
            {"sizes": None},
        )
    }
    assert len(digests) == 1


@pytest.mark.parametrize("domain", ["box", "periodic"])
def test_disks_that_fall_alike_meet_in_lanes_as_one_by_one(domain: str) -> None:
    gas = lattice_gas(9, 9, 1.25, np.random.default_rng(8), domain, True, 0.6)
    stage = stage_of(es.Scene(gas.disks, gas.domain, gravity=(0.25, -0.5)))
    stop = Stop(events=MOST or 3000)
    assert_same(stage, stop, lanes=None)
    assert_same(stage, stop, lanes=False)


@pytest.mark.compiled
@pytest.mark.parametrize(("domain", "quantised"), [("periodic", False), pytest.param("box", True, marks=pytest.mark.slow)])
def test_what_is_done_for_many_disks_changes_no_bit(
    domain: str, quantised: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(plan, "MANY_DISKS", 0)  # prefetches, the calendar's waiting room
    gas = lattice_gas(20, 20, 1.25, np.random.default_rng(6), domain, quantised, 0.0)
    assert_same(stage_of(gas), Stop(events=12_000))


@pytest.mark.parametrize("domain", ["periodic", "box"])
def test_the_waiting_room_of_many_disks_changes_no_bit(domain: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan, "MANY_DISKS", 0)
    assert_same(stage_of(lattice_gas(9, 9, 1.25, np.random.default_rng(6), domain, True, 0.0)), Stop(events=MOST or 3000))


def uneven() -> es.Scene:
    """A gas with many ties, some disks of which are 2**20 times as heavy as the others, in a box with a slanted wall."""
    gas = lattice_gas(8, 8, 1.25, np.random.default_rng(9), "box", True, 0.0)
    mass = np.resize([2.0**20, 1.0, 1.0, 3.0], len(gas.disks))
    disks = es.Disks(gas.disks.position, gas.disks.velocity, 0.375, mass)
    return es.Scene(disks, gas.domain, walls=[es.Segment((1.25, 0.3), (1.3, 0.9))])


def test_uneven_masses_have_one_log() -> None:
    assert_same(stage_of(uneven()), Stop(until=30.0, events=3000))


@pytest.mark.parametrize("scene", ["equal", "uneven"])
def test_a_run_handed_over_at_any_time_has_one_log(scene: str) -> None:
    equal = lattice_gas(8, 8, 1.25, np.random.default_rng(9), "periodic", True, 0.0)
    stage = stage_of(equal if scene == "equal" else uneven())
    whole, _ = rows_of(ReferenceSession(stage), Stop(events=2500))
    first = ReferenceSession(stage)
    begun, _ = rows_of(first, Stop(events=700))
    middle = FastSession(stage, saved=first.snapshot())
    middle.counters.copy_from(first.counters)
    between, _ = rows_of(middle, Stop(events=1600))
    last = ReferenceSession(stage)
    last.restore(middle.snapshot())
    last.counters.copy_from(middle.counters)
    ended, _ = rows_of(last, Stop(events=2500))
    assert digest_of(np.concatenate([begun, between, ended])) == digest_of(whole)


def test_looking_and_stopping_changes_no_bit() -> None:
    stage = stage_of(lattice_gas(9, 9, 1.1, np.random.default_rng(2), "box", False, 0.0))
    step = 0.125 if is_interpreted() else 0.5
    whole, _ = rows_of(FastSession(stage), Stop(until=40.0 * step))
    session = FastSession(stage)
    parts = []
    for k in range(1, 41):
        parts.append(rows_of(session, Stop(until=step * k))[0])
        session.motion()
    assert digest_of(np.concatenate(parts)) == digest_of(whole)


def test_a_kick_right_after_a_restore_goes_on_from_what_was_saved() -> None:
    told = []
    for engine in ("reference", "fast"):
        sim = es.Simulation(lattice_gas(6, 6, 1.5, np.random.default_rng(4), "box", False, 0.0), engine=engine)
        sim.advance_to(2.0)
        saved = sim.snapshot()
        sim.advance_to(4.0)
        sim.restore(saved)
        sim.set_velocity(7, (3.0, -1.0))
        sim.advance_to(6.0)
        counters = sim.counters
        assert sim.log.event.tolist() == list(range(counters.events))
        assert counters.pair_contacts + counters.wall_contacts + counters.kicks == counters.events
        told.append((sim.log.digest(), sim.log.joint.tolist(), counters.wall_contacts, counters.outer_momentum))
    assert told[0] == told[1]


def test_a_kick_is_logged_alike() -> None:
    stage = stage_of(lattice_gas(6, 6, 1.5, np.random.default_rng(4), "box", False, 0.0))
    logs = []
    for session in (ReferenceSession(stage), FastSession(stage)):
        before, _ = rows_of(session, Stop(until=2.0))
        session.kick(7, 3.0, -1.0)
        after, _ = rows_of(session, Stop(until=6.0))
        logs.append(digest_of(np.concatenate([before, after])))
    assert logs[0] == logs[1]


@pytest.mark.compiled
def test_golden_digests_hold() -> None:
    golden = Path(__file__).parents[2] / "gallery" / "golden"
    known = json.loads((golden / "digests.json").read_text())
    for name in ("break", "newton-cradle", "corner"):
        run = es.simulate(gallery(name), engine="fast", log=True)
        assert run.log.digest() == known[name]["digest"]


@pytest.mark.compiled
def test_auto_hands_over_without_a_seam(monkeypatch: pytest.MonkeyPatch) -> None:
    from eventsim.engines import auto

    for name in ("PATIENCE", "SAMPLE", "WARM"):
        monkeypatch.setattr(auto, name, 0.0)
    monkeypatch.setattr(auto, "SURE", math.inf)
    monkeypatch.setattr(auto, "_is_warm", lambda *asked: True)
    scene = lattice_gas(9, 9, 1.1, np.random.default_rng(2), "box", False, 0.0)
    mixed = es.simulate(scene, until=20.0, log=True)
    pure = es.simulate(scene, until=20.0, log=True, engine="reference")
    assert mixed.log.digest() == pure.log.digest()
    assert (mixed.begun_by, mixed.engine) == ("reference", "fast")
    assert math.isclose(mixed.time, 20.0)


@pytest.mark.parametrize("seed", [2, 3, 7, 11])
def test_disks_that_slide_into_ends_of_walls_meet_them(seed: int) -> None:
    """Where a disk rests on a slope its path is no parabola of gravity: the screen of circles must know."""
    rng = np.random.default_rng(seed)
    start, end = np.array([0.0, 5.0]), np.array([8.0, 5.0 - 8.0 * rng.uniform(0.05, 0.55)])
    along = (end - start) / np.linalg.norm(end - start)
    across = np.array([-along[1], along[0]])
    post = start + rng.uniform(3.0, 6.0) * along + rng.uniform(0.1, 0.45) * across
    walls = [es.Segment(tuple(start), tuple(end)), es.Segment(tuple(post), tuple(post + 2.0 * across))]
    disks = es.Disks([start + 0.6 * along + 0.25 * across], [rng.uniform(0.0, 1.0) * along], 0.25)
    box = es.Box((10.0, 12.0))
    assert_same(stage_of(es.Scene(disks, box, walls, gravity=(0.0, -1.0), restitution=0.5)), Stop(30.0, 80))


def test_a_full_buffer_of_rows_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(machine, "ROOM", 8)
    assert_same(stage_of(lattice_gas(5, 4, 1.2, np.random.default_rng(4), "box", False, 0.0)), Stop(None, 100))

"""The log is one object: no grid, label, pause, look or queue changes a bit of it."""

import copy
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import eventsim as es
from eventsim.engines import ENGINES
from eventsim.engines.base import Stop
from eventsim.engines.reference.cells import plan
from eventsim.scene.stage import stage_of
from tests.engines.scenes import lattice_gas, rows_of, session_of

DOMAINS = [es.Box, es.Periodic, es.Channel, es.Open]

SCENES = {
    "box": lambda: lattice_gas(40, 0.3),
    "ties": lambda: lattice_gas(36, 0.3, quantum=0.5),
    "torus": lambda: lattice_gas(40, 0.4, es.Periodic),
    "torus of ties": lambda: lattice_gas(36, 0.2, es.Periodic, quantum=0.5),
    "channel": lambda: lattice_gas(40, 0.3, es.Channel),
    "plane": lambda: lattice_gas(40, 0.5, es.Open),
    "mixture": lambda: lattice_gas(40, 0.3, es.Periodic, radii=(0.5, 0.25), masses=(1.0, 3.0)),
    "giant": lambda: lattice_gas(49, 0.05, es.Box, radii=(0.1,) * 48 + (1.0,)),
    "cooling": lambda: lattice_gas(40, 0.3, es.Box, restitution=0.9, contact_duration=1e-4),
    "gravity": lambda: lattice_gas(40, 0.2, es.Box, gravity=(0.1, -1.0)),
    "posts and gravity": lambda: lattice_gas(30, 0.1, es.Box, gravity=(0.0, -1.0), masses=(1.0, 2.0, math.inf)),
    "walls": lambda: lattice_gas(
        36, 0.1, es.Box, walls=[es.Segment((0.05, 0.05), (1.0, 0.3)), es.Arc((2.9, 0.2), (3.1, 0.15), (3.3, 0.2))]
    ),
    "uneven": lambda: lattice_gas(
        36, 0.1, es.Box, masses=(1.0, 2.0, 2.0**20), walls=[es.Segment((0.05, 0.05), (1.0, 0.3))]
    ),
    "uneven ties": lambda: lattice_gas(36, 0.2, es.Periodic, quantum=0.5, masses=(1.0, 2.0**20, 2.0**20)),
    "tracers": lambda: lattice_gas(40, 0.2, es.Periodic, radii=(0.5, 0.0, 0.4), masses=(1.0, 0.0, 2.0)),
}


@pytest.mark.parametrize("name", SCENES)
def test_every_invariant_holds_after_every_event(name):
    session = session_of(SCENES[name](), check=True)
    stopped = session.advance(Stop(None, 90), 10**6)
    assert session.counters.events >= 90 or stopped == "quiet"


@pytest.mark.parametrize("name", SCENES)
def test_cells_and_all_pairs_give_the_same_log(name):
    scene = SCENES[name]()
    stage = stage_of(scene)
    expected = rows_of(scene, events=1000, grid=None)
    assert len(expected) > 20
    grids = [plan(stage), plan(stage, 1.05), plan(stage, 1.7), plan(stage, 2.3)]
    assert any(grids)
    for grid in grids:
        if grid is not None:
            assert rows_of(scene, events=1000, grid=grid).tobytes() == expected.tobytes()


@pytest.mark.parametrize("name", SCENES)
def test_stopping_and_going_on_changes_no_bit(name):
    scene = SCENES[name]()
    whole = rows_of(scene, until=3.0)
    session = session_of(scene)
    parts = []
    for until in np.sort(np.random.default_rng(3).uniform(0.0, 3.0, 40)):
        session.advance(Stop(float(until), None), 10**6)
        session.motion()
        parts.append(session.take_rows())
    session.advance(Stop(3.0, None), 10**6)
    parts.append(session.take_rows())
    assert np.concatenate(parts).tobytes() == whole.tobytes()


@pytest.mark.parametrize("name", SCENES)
def test_a_snapshot_restored_into_a_new_session_changes_no_bit(name):
    scene = SCENES[name]()
    whole = rows_of(scene, events=1200)
    session = session_of(scene)
    parts = []
    for events in range(100, 1300, 100):
        session.advance(Stop(None, min(events, 1200)), 10**6)
        rows = session.take_rows()
        parts.append(rows)
        saved, counters = session.snapshot(), session.counters
        session = session_of(scene)
        session.restore(saved)
        session.counters.copy_from(counters)
    joined = np.concatenate(parts)
    assert joined[: len(whole)].tobytes() == whole.tobytes()


def relabelled(rows, order):
    """The rows with disk order[i] called i, a the smaller of a pair, rows of equal time sorted."""
    place = np.argsort(order)
    rows = rows.copy()
    pair = rows["b"] >= 0
    rows["a"], rows["b"] = place[rows["a"]], np.where(pair, place[rows["b"]], -1)
    swap = pair & (rows["a"] > rows["b"])
    for name in ("", "x", "y", "vx", "vy"):
        one, other = name + "a", name + "b"
        rows[one], rows[other] = np.where(swap, rows[other], rows[one]), np.where(swap, rows[one], rows[other])
    return in_order(rows)


def in_order(rows):
    """The rows in the order of time, a, b, wall; without what depends on the order (event number, joint)."""
    names = [name for name in rows.dtype.names if name not in ("event", "joint", "impulse")]
    order = np.lexsort((rows["wall"], rows["b"], rows["a"], rows["remainder"], rows["epoch"]))
    return [tuple(0.0 if value == 0.0 else value for value in rows[name][order].tolist()) for name in names]


@settings(deadline=None, max_examples=25)
@given(st.sampled_from(sorted(SCENES)), st.integers(0, 10**6))
def test_relabelling_the_disks_relabels_the_log(name, seed):
    scene = SCENES[name]()
    disks = scene.disks
    order = np.random.default_rng(seed).permutation(len(disks))
    shuffled = es.Scene(
        es.Disks(disks.position[order], disks.velocity[order], disks.radius[order], disks.mass[order]),
        scene.domain,
        scene.walls,
        scene.gravity,
        scene.restitution,
        scene.contact_duration,
    )
    expected = relabelled(rows_of(scene, until=1.5), order)
    got = in_order(rows_of(shuffled, until=1.5))
    assert repr(got) == repr(expected)


def rows_by(engine, scene, events):
    """The rows of a run of any engine."""
    session = ENGINES[engine].open(stage_of(scene))
    while session.advance(Stop(None, events), 10**9) is None:
        pass
    return session.take_rows()


# kernels of the other domains take seconds to compile
BOTH = [("reference", domain) for domain in DOMAINS] + [("fast", es.Box), ("fast", es.Periodic)]
BOTH += [pytest.param("fast", domain, marks=pytest.mark.slow) for domain in (es.Channel, es.Open)]


@pytest.mark.parametrize(("engine", "domain"), BOTH)
@pytest.mark.parametrize(
    ("offset", "start"), [((2.0**20, -(2.0**19)), 2.0**20), ((-3.0, 2.0**30), 2.0**30), ((0.0, 0.0), 2.0**40)]
)
def test_a_shifted_or_late_scene_has_the_same_log(engine, domain, offset, start):
    """By an exactly representable offset, the starts on a grid fine enough to be representable too.

    On the open plane both lie far out, and the offset is a multiple of the unit of their corner, 16.
    """
    if engine == "fast":
        pytest.importorskip("numba")
    scene = lattice_gas(30, 0.3, domain)
    position = np.round(scene.disks.position * 2.0**16) / 2.0**16
    if domain is es.Open:
        position, offset = position + 2.0**10, tuple(16.0 * along for along in offset)
    size = () if domain is es.Open else (scene.domain.size,)
    there = () if domain is es.Open else (scene.domain.size, offset)
    here = es.Scene(es.Disks(position, scene.disks.velocity, 0.5), domain(*size))
    far = es.Scene(es.Disks(position + offset, scene.disks.velocity, 0.5), domain(*there), start_time=start)
    one, other = rows_by(engine, here, 600), rows_by(engine, far, 600)
    assert len(one) >= (20 if domain is es.Open else 600)
    for name in set(one.dtype.names) - {"time"}:
        assert one[name].tobytes() == other[name].tobytes(), name
    # what the clock shows is the rounded sum: less than a bit of it away from the exact time
    assert np.all(np.abs((other["time"] - start) - one["time"]) <= np.spacing(other["time"]))


def test_looking_at_the_state_in_between_changes_no_bit():
    scene = lattice_gas(30, 0.3, es.Periodic)
    run = es.simulate(scene, events=500, log=True)
    sim = es.Simulation(scene)
    while len(sim.log) < 500:
        sim.step()
        assert np.isfinite(sim.state.position).all()
    assert sim.log.rows.tobytes() == run.log.rows.tobytes()


def test_a_simulation_goes_back_to_a_snapshot():
    sim = es.Simulation(lattice_gas(20, 0.3))
    sim.advance_to(1.0)
    saved = sim.snapshot()
    sim.advance_to(2.0)
    once = sim.log.rows
    sim.restore(saved)
    assert sim.time == 1.0
    sim.advance_to(2.0)
    assert sim.log.rows.tobytes() == once.tobytes()


def test_a_kick_is_logged_and_changes_the_future():
    sim = es.Simulation(lattice_gas(20, 0.3))
    sim.advance_to(0.5)
    sim.set_velocity(3, (2.0, -1.0))
    assert sim.log.kinds[-1] == "kick"
    assert sim.state.velocity[3].tolist() == [2.0, -1.0]
    sim.advance_to(1.0)
    assert sim.log.provenance.kicks == ((int(np.flatnonzero(sim.log.kinds == "kick")[0]), 2.0, -1.0),)
    with pytest.raises(es.EventsimError, match="disk 99"):
        sim.set_velocity(99, (0.0, 0.0))


@pytest.mark.parametrize("engine", ["reference", "fast"])
@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy])
def test_a_copy_of_a_simulation_goes_on_by_itself(engine, copied):
    sim = es.Simulation(SCENES["walls"](), engine=engine)
    sim.advance_to(1.0)
    before = sim.log.rows.tobytes()
    other = copied(sim)
    other.set_velocity(0, (0.5, -0.25))
    other.advance_to(2.0)
    assert (sim.time, sim.log.rows.tobytes()) == (1.0, before)
    assert other.log.rows.tobytes().startswith(before)
    sim.set_velocity(0, (0.5, -0.25))
    sim.advance_to(2.0)
    assert sim.log.rows.tobytes() == other.log.rows.tobytes()
    assert sim.counters.events == other.counters.events

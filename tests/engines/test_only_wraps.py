"""Disks that only wrap, or part on the plane: when it is known that nothing is ahead, and where a run then ends."""

import math

import numpy as np
import pytest

import eventsim as es
from eventsim.compiler import is_interpreted
from eventsim.engines.only_wraps import only_wraps
from eventsim.engines.reference.loop import ReferenceSession
from eventsim.scene.stage import stage_of

MANY = 80 if is_interpreted() else 300
BOX = es.Periodic((4.0, 3.0))
POST = es.Segment((0.5, 2.0), (0.6, 2.0))

NEVER = {
    "one disk": ([[1.0, 1.0]], [[1.0, 0.3]], BOX, ()),
    "one disk under a wall": ([[1.0, 1.0]], [[1.0, 0.0]], BOX, (POST,)),
    "one disk along a channel": ([[1.0, 1.0]], [[1.0, 0.0]], es.Channel((4.0, 3.0)), ()),
    "lanes": ([[1.0, 1.0], [1.0, 2.0]], [[1.0, 0.0], [-0.5, 0.0]], BOX, ()),
    "lanes that rise together": ([[1.0, 1.0], [1.0, 2.0]], [[1.0, 0.25], [-0.5, 0.25]], BOX, ()),
    "lanes upwards": ([[1.0, 1.0], [2.0, 1.0], [3.0, 2.0]], [[0.0, 1.0], [0.0, -0.5], [0.0, 0.0]], BOX, (POST,)),
    "one disk and a wall beside its way": ([[1.0, 1.0]], [[4.0, 3.0]], BOX, (es.Segment((0.5, 2.0), (0.6, 2.1)),)),
    "a way that closes after rounds": ([[1.0, 1.0], [3.0, 1.0]], [[3.0, 1.5], [-1.0, -1.5]], BOX, ()),
}
SOME_TIME = {
    "one disk and a wall ahead": ([[1.0, 1.0]], [[1.0, 0.003]], BOX, (es.Segment((0.5, 1.5), (0.6, 1.5)),)),
    "one lane": ([[1.0, 1.0], [3.0, 1.1]], [[1.0, 0.0], [0.999, 0.0]], BOX, ()),
    "a way that closes late": ([[1.0, 1.0], [3.0, 1.0]], [[4.0, 3.1], [0.0, 0.0]], BOX, ()),
    "a slow one meets a wall": ([[1.0, 1.0], [1.0, 2.0]], [[1.0, 0.0], [-0.0001, 0.0]], BOX, (POST,)),
}
ENGINES = ["reference", "certified", pytest.param("fast", marks=pytest.mark.slow)]


def run(engine, position, velocity, domain, walls):
    if engine != "reference":
        pytest.importorskip({"certified": "flint", "fast": "numba"}[engine])
    return es.simulate(es.Scene(es.Disks(position, velocity, 0.2), domain, walls), events=1, engine=engine)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", NEVER)
def test_disks_that_never_meet_anything_are_quiet(engine, name):
    ended = run(engine, *NEVER[name])
    assert (ended.stopped, ended.counters.events) == ("quiet", 0)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", SOME_TIME)
def test_disks_that_meet_something_after_many_rounds_are_waited_for(engine, name):
    ended = run(engine, *SOME_TIME[name])
    assert (ended.stopped, ended.counters.events) == ("events", 1)
    assert ended.counters.wraps > 16


@pytest.mark.parametrize("engine", ENGINES[::2])
def test_a_disk_that_falls_around_a_torus_is_quiet(engine):
    if engine == "fast":
        pytest.importorskip("numba")
    sim = es.Simulation(es.Scene(es.Disks([[1.0, 1.0]], [[1.0, 0.3]], 0.2), BOX, gravity=(0.0, -1.0)), engine=engine)
    assert len(sim.step()) == 0
    assert sim.time > 0.0


@pytest.mark.parametrize("engine", ENGINES[::2])
def test_a_step_ends_where_nobody_knows_whether_an_event_is_ahead(engine, monkeypatch):
    """Points of no size: nothing tells that they will never meet."""
    if engine == "fast":
        pytest.importorskip("numba")
    monkeypatch.setattr("eventsim.simulation.MOST_WRAPS", 10_000)
    points = es.Disks([[1.0, 1.0], [3.0, 1.0]], [[1.0, 0.7], [-0.9, 0.6]], 0.0)
    sim = es.Simulation(es.Scene(points, BOX), engine=engine)
    with pytest.raises(es.EventsimError, match=r"no event in 10000 wraps .* advance_to"):
        sim.step()
    sim.advance_to(sim.time + 1.0)
    assert len(sim.log) == 0


def apart(n):
    """A gas that flies apart on the open plane: n disks in rows, 29 contacts of 20 and about 1500 of 300, 200 of 80."""
    side = math.isqrt(n - 1) + 1
    place = 1.5 * np.array([divmod(i, side) for i in range(n)])
    return es.Scene(es.Disks(place, np.random.default_rng(1).normal(size=(n, 2)), 0.5), es.Open())


@pytest.mark.parametrize("n", [3, 20, MANY])
@pytest.mark.kernels
def test_what_flies_apart_ends_at_its_last_contact_in_every_engine(n):
    pytest.importorskip("numba")
    slow, fast = (es.simulate(apart(n), events=10**6, engine=engine, log=True) for engine in ("reference", "fast"))
    assert slow.stopped == fast.stopped == "quiet"
    assert slow.time == fast.time == (slow.log.time[-1] if len(slow.log) else 0.0)
    assert slow.state.position.tobytes() == fast.state.position.tobytes()
    assert slow.log.provenance.ending == fast.log.provenance.ending
    if n < MANY:
        pytest.importorskip("flint")
        assert es.simulate(apart(n), events=10**6, engine="certified").time == pytest.approx(slow.time, rel=1e-11)
    assert slow.state.position.tobytes() == es.simulate(apart(n), events=len(slow.log), engine="fast").state.position.tobytes()


@pytest.mark.kernels
def test_what_flies_together_over_the_plane_ends_where_it_began():
    pytest.importorskip("numba")
    together = es.Disks(apart(MANY).disks.position, np.full((MANY, 2), 0.3), 0.5)
    for engine in ("reference", "fast"):
        ended = es.simulate(es.Scene(together, es.Open()), events=1, engine=engine)
        assert (ended.stopped, ended.time) == ("quiet", 0.0)


@pytest.mark.parametrize("name", NEVER)
@pytest.mark.kernels
def test_what_drifts_ends_at_one_time_in_every_engine(name):
    slow, proven = (run(engine, *NEVER[name]) for engine in ("reference", "certified"))
    fast = run("fast", *NEVER[name])
    assert slow.time == proven.time == fast.time > 0.0
    assert slow.state.position.tobytes() == fast.state.position.tobytes()


@pytest.mark.kernels
def test_time_does_not_go_back_where_nothing_is_ahead():
    pytest.importorskip("numba")
    digests = []
    for engine in ("reference", "fast"):
        sim, other = (es.Simulation(apart(MANY), engine=engine) for _ in range(2))
        while len(sim.step()):
            pass
        assert sim.time == sim.log.time[-1] < 1000.0
        assert len(sim.step()) == 0
        assert sim.time == sim.log.time[-1]
        sim.advance_to(1000.0)
        assert len(sim.step()) == 0
        assert sim.time == 1000.0
        other.advance_to(1000.0)
        assert sim.state.position.tobytes() == other.state.position.tobytes()
        assert sim.log.digest() == other.log.digest()
        for each in (sim, other):  # towards another disk: cells must be those of the present
            place, speed = each.state.position, each.state.velocity
            each.set_velocity(7, tuple(speed[8] + 0.1 * (place[8] - place[7])))
            each.step()
        assert sim.log.kinds[-2:].tolist() == ["kick", "pair"]
        assert sim.log.digest() == other.log.digest()
        digests.append(sim.log.digest())
    assert digests[0] == digests[1]


HIGH = es.Periodic((4.0, 12.0))
LANES = [[1.0, 0.6 * k] for k in range(20)], [[0.1 * k, 0.0] for k in range(20)]
UPWARDS = [[v, 0.25] for v, _ in LANES[1]]


@pytest.mark.parametrize(
    ("velocity", "domain", "rules", "idle", "expected"),
    [
        (LANES[1], HIGH, {}, 81.0, True),
        (LANES[1], HIGH, {}, 79.0, False),
        (UPWARDS, HIGH, {}, 81.0, True),
        (UPWARDS, HIGH, {"walls": [es.Segment((0.0, 0.3), (0.5, 0.3))]}, 1e9, False),
        ([*UPWARDS[1:], [0.0, 1.0]], HIGH, {}, 1e9, False),
        ([[1.0, 0.0]] * 20, HIGH, {"walls": [es.Segment((0.0, 0.3), (0.5, 0.3))]}, 9.0, True),
        ([[1.0, 0.0]] * 20, HIGH, {"walls": [es.Segment((0.0, 0.3), (0.5, 0.3))]}, 7.0, False),
        ([[1.0, 0.0]], HIGH, {"walls": [es.Segment((0.0, 0.3), (0.5, 0.3))], "gravity": (0.0, -1.0)}, 1e9, False),
        ([[1.0, 0.0]], HIGH, {"gravity": (0.0, -1.0)}, 1.0, True),
        ([[1.0, 1e-9]], es.Channel((4.0, 12.0)), {}, 1e9, False),
        ([[1.0, 0.0]], es.Channel((4.0, 12.0)), {}, 9.0, True),
    ],
)
def test_only_wraps_are_ahead_once_all_have_been_around_twice(velocity, domain, rules, idle, expected):
    """The slowest of the lanes are 0.1 apart, and 4 around: twice in 80."""
    place = np.add(LANES[0][: len(velocity)], [0.0, 0.25 if isinstance(domain, es.Channel) else 0.0])
    stage = stage_of(es.Scene(es.Disks(place, velocity, 0.2), domain, **rules))
    assert only_wraps(stage, ReferenceSession(stage).state.anchors(), idle) == expected

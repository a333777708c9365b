"""Coming to rest under gravity: one disk on one straight wall, in closed form; what lies on two things is refused."""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import eventsim as es
from eventsim.compiler import has_compiler
from eventsim.record.events import Kind
from eventsim.replay.replay import Replay
from eventsim.scene.stage import stage_of
from tests.engines.falling import ENGINES, dropped

FLOOR = es.Segment((-10.0, 0.0), (10.0, 0.0), name="floor")


def ramp(angle, length=80.0, **changes):
    """A disk that starts a little above a ramp that falls to the right, its normal and its direction downwards."""
    along = np.array([math.cos(angle), -math.sin(angle)])
    normal = np.array([math.sin(angle), math.cos(angle)])
    end = length * along
    disk = es.Disks([0.5 * normal + 0.25 * normal + along], radius=0.5)
    scene = es.Scene(
        disk, es.Open(), [es.Segment((0.0, 0.0), tuple(end), name="ramp")],
        **{"gravity": (0.0, -2.0), "restitution": 0.5, **changes},
    )  # fmt: skip
    return scene, along, normal


def kinds(run):
    return [Kind(kind).label for kind in run.log.kind.tolist()]


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("walls", [(), (es.Segment((0.0, 0.0), (10.0, 0.0)),)], ids=["box", "segment"])
def test_f23_a_bounce_ends_at_its_zeno_time(engine, walls):
    """Impacts at 3 - 2^(2-n), all numbers dyadic; then rest at 3, exactly."""
    domain = es.Open() if walls else None
    run = es.simulate(dropped(walls, domain), until=10.0, engine=engine, log=True)
    impacts, last = run.log.time[:-1], run.log.time[-1]
    assert len(impacts) >= (20 if walls else 40)  # the place on a segment is rounded
    assert impacts.tolist() == [3.0 - 2.0 ** (2 - n) for n in range(1, len(impacts) + 1)]
    assert kinds(run)[-1] == "rest"
    assert last == 3.0
    assert run.stopped == "quiet"
    assert run.state.position.tolist() == [[5.0, 0.5]]
    assert run.state.velocity.tolist() == [[0.0, 0.0]]
    assert run.residuals.momentum < 1e-15


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("restitution", "duration"), [(None, None), (0.5, None), (0.5, 1e-3)])
def test_f24_a_disk_that_lies_on_the_floor_slides_to_the_wall_and_back(engine, restitution, duration):
    disks = es.Disks([[8.5, 0.5]], [[1.0, 0.0]], 0.5)
    scene = es.Scene(
        disks, es.Box((10.0, 10.0)), gravity=(0.0, -1.0), restitution=restitution, contact_duration=duration
    )
    run = es.simulate(scene, until=3.0, engine=engine, log=True)
    assert kinds(run) == ["rest", "wall", "rest"]
    assert run.log.time.tolist() == [0.0, 1.0, 1.0]
    back = 1.0 if restitution is None else restitution
    assert run.state.position.tolist() == [[9.5 - 2.0 * back, 0.5]]
    assert {run.state_at(t).position[0, 1] for t in (0.0, 0.3, 1.0, 2.9)} == {0.5}


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("restitution", [None, 0.5])
def test_so_does_a_point_although_its_place_does_not_tell_its_side(engine, restitution):
    disks = es.Disks([[9.0, 0.0]], [[1.0, 0.0]], 0.0)
    scene = es.Scene(disks, es.Box((10.0, 10.0)), gravity=(0.0, -1.0), restitution=restitution)
    run = es.simulate(scene, until=3.0, engine=engine, log=True)
    assert kinds(run) == ["rest", "wall", "rest"]
    assert run.state.position.tolist() == [[10.0 - 2.0 * (restitution or 1.0), 0.0]]


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("degrees", [10.0, 37.0, 80.0])
def test_a_disk_slides_down_a_ramp_at_g_sin_alpha(engine, degrees):
    angle = math.radians(degrees)
    scene, along, normal = ramp(angle)
    run = es.simulate(scene, until=6.0, engine=engine, log=True)
    assert kinds(run)[-1] == "rest"
    # without friction the way along the ramp is that of a free fall along it, bounces or not
    way = 1.0 + 0.5 * (2.0 * math.sin(angle)) * 6.0**2
    position = run.state.position[0]
    assert position @ normal == pytest.approx(0.5, abs=1e-14)
    assert position @ along == pytest.approx(way, rel=1e-13)
    assert run.state.velocity[0] @ normal == pytest.approx(0.0, abs=1e-14)


@pytest.mark.parametrize("engine", ENGINES)
def test_the_energy_at_rest_is_the_potential_one(engine):
    run = es.simulate(dropped((FLOOR,), es.Open(), restitution=0.7), until=50.0, engine=engine, log=True)
    assert kinds(run)[-1] == "rest"
    assert run.state.velocity.tolist() == [[0.0, 0.0]]
    assert run.state.position[0, 1] == 0.5
    assert run.counters.rests == 1


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("restitution", [0.0, 0.3, 0.9, 0.99])
def test_a_bounce_has_as_many_events_as_its_series_needs(engine, restitution):
    run = es.simulate(dropped(restitution=restitution), until=1e4, engine=engine, log=True)
    assert kinds(run)[-1] == "rest"
    assert run.log.time[-1] == pytest.approx((1.0 + restitution) / (1.0 - restitution), rel=1e-12)
    halvings = 53.0 * math.log(2.0)
    needed = 1 if restitution == 0.0 else 2.0 + halvings / -math.log(restitution)
    assert run.counters.events <= needed + 2


@pytest.mark.parametrize("engine", ENGINES)
def test_a_disk_leaves_the_end_of_its_wall(engine):
    """Fast enough, v^2 > r g, it flies on from there like a stone."""
    scene = es.Scene(
        es.Disks([[0.0, 0.5]], [[2.0, 0.0]], 0.5), es.Open(), [es.Segment((-1.0, 0.0), (4.0, 0.0))],
        gravity=(0.0, -2.0), restitution=0.5,
    )  # fmt: skip
    run = es.simulate(scene, until=3.0, engine=engine, log=True)
    assert kinds(run)[0] == "rest"
    assert run.log.time[1] == 2.0
    assert run.log.impulse[1] == 0.0
    assert run.state.position[0] == pytest.approx([6.0, 0.5 - 1.0], abs=1e-14)


@pytest.mark.parametrize("engine", ENGINES)
def test_walls_in_line_are_one_support(engine):
    chain = es.Polyline([(-1.0, 0.0), (1.0, 0.0), (2.0, 0.0), (30.0, 0.0)])
    scene = es.Scene(
        es.Disks([[0.0, 0.5]], [[1.0, 0.0]], 0.5), es.Open(), [chain], gravity=(0.0, -2.0), restitution=0.5
    )
    run = es.simulate(scene, until=20.0, engine=engine, log=True)
    assert kinds(run) == ["rest"]
    assert run.state.position.tolist() == [[20.0, 0.5]]


@pytest.mark.parametrize("engine", ENGINES)
def test_an_impulse_frees_a_disk_at_rest(engine):
    disks = es.Disks([[2.0, 0.5], [6.0, 0.5]], [[0.0, 0.0], [-1.0, 0.0]], 0.5)
    scene = es.Scene(disks, es.Box((10.0, 10.0)), gravity=(0.0, -1.0), restitution=0.5)
    run = es.simulate(scene, until=20.0, engine=engine, log=True)
    first = int(np.flatnonzero(run.log.kind == Kind.PAIR)[0])
    assert np.any((run.log.kind == Kind.REST)[:first])
    assert run.log.vxa[first] < 0.0
    assert np.any((run.log.kind == Kind.REST)[first:] & (run.log.a == 0)[first:])
    assert run.state.position[:, 1].tolist() == [0.5, 0.5]
    assert run.residuals.momentum < 1e-12


def test_scenes_without_gravity_or_restitution_have_no_supports():
    assert stage_of(dropped(gravity=None)).supports is None
    assert stage_of(dropped(restitution=None)).supports is None
    assert stage_of(dropped(contact_duration=1e-6)).supports is None  # nothing ends there
    assert stage_of(dropped()).supports is not None


def test_kicked_up_it_bounces_and_rests_again():
    sim = es.Simulation(dropped(), engine="reference")
    sim.advance_to(4.0)
    sim.set_velocity(0, (0.5, 1.0))
    sim.advance_to(10.0)
    assert [Kind(kind).label for kind in sim.log.kind.tolist()].count("rest") == 2
    assert sim.state.position[0, 1] == 0.5
    assert sim.state.velocity.tolist() == [[0.5, 0.0]]


def random_pit(seed):
    """A few disks that fall onto ramps and floors whose corners are on a grid, or near one."""
    rng = np.random.default_rng(seed)
    side = 4.0
    domain = (es.Box((side, side)), es.Channel((side, side)))[rng.integers(2)]
    walls = []
    for _ in range(rng.integers(0, 3)):
        points = rng.integers(1, 15, size=(2, 2)) / 4.0 + (rng.normal(size=(2, 2)) * 0.1 if rng.random() < 0.5 else 0.0)
        if rng.random() < 0.4:
            points[1, 1] = points[0, 1]
        if np.ptp(points, axis=0).max() > 0.1:
            walls.append(es.Segment(*points))
    gravity = (0.0, -1.0) if rng.random() < 0.6 else tuple(rng.normal(size=2))
    restitution = es.Restitution(pair=float(rng.choice([0.5, 1.0])), wall=float(rng.choice([0.0, 0.25, 0.5, 0.9])))
    scene, found = None, []
    for _ in range(20):
        new = (rng.integers(1, 16, size=2) / 4.0, rng.integers(-4, 5, size=2) / 4.0, rng.choice([0.25, 0.5]))
        place, velocity, radius = zip(*found, new, strict=True)
        try:
            scene = es.Scene(es.Disks(place, velocity, radius), domain, walls, gravity=gravity, restitution=restitution)
        except es.SceneError:
            continue
        found.append(new)
        if len(found) == 3:
            break
    return scene


@settings(max_examples=25, deadline=None)
@example(4502)  # where a disk that slides into a gap as wide as itself takes impulses of 1.6e8
@given(st.integers(0, 10_000))
def test_random_pits_end_in_order_and_replay_to_the_same_bits(seed):
    """No hang, no sinking; replay, and a run that is stopped and goes on, agree bit for bit."""
    scene = random_pit(seed)
    if scene is None:
        return
    run = es.simulate(scene, until=20.0, events=2000, engine="reference", log=True)
    assert run.residuals.momentum < 1e-11 + 2.0**-50 * max(run.log.impulse, default=0.0)
    assert run.residuals.max_overlap < 1e-12
    final = Replay(run.log).final()
    assert final.position.tobytes() == run.state.position.tobytes()
    assert final.velocity.tobytes() == run.state.velocity.tobytes()
    again = es.Simulation(scene, engine="reference")
    try:
        again.advance_to(run.time / 3.0)
        saved = again.snapshot()
        again.advance_to(run.time / 2.0)
        again.restore(saved)
        again.advance_to(run.time, 2000)
    except es.CollapseError:
        return
    rows = again.log.rows[
        : len(run.log)
    ]  # of contacts at the time where the first run had enough events, it may have more
    assert rows.tobytes() == run.log.rows[: len(rows)].tobytes()


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("rise", [0.03 * 29 - 1.2, 0.03 * 35 - 1.2, 0.21])
def test_an_elastic_disk_that_touches_a_slope_and_moves_along_it_slides_also_where_its_gap_is_rounded_to_nothing(engine, rise):
    """Then no speed across the slope is that of a fall from the gap; but this one is the rounding of the velocity."""
    length, radius = math.hypot(1.0, rise), 0.07
    disk = es.Disks([(0.4 - radius * rise / length, 0.4 * rise + radius / length)], [(1.3 / length, 1.3 * rise / length)], radius)
    slope = es.Segment((0.0, 0.0), (1.0, rise))
    run = es.simulate(es.Scene(disk, es.Open(), [slope], gravity=(0.0, -1.0)), until=0.05, engine=engine, log=True)
    assert kinds(run) == ["rest"]
    assert run.log.time[0] == 0.0
    speed = 1.3 - 0.05 * rise / length
    assert run.state.velocity[0] == pytest.approx((speed / length, speed * rise / length), rel=1e-13)


@pytest.mark.skipif(not has_compiler(), reason="needs numba")
@pytest.mark.kernels
def test_engines_agree_on_what_comes_to_rest():
    """Six pits of one kind, so that kernels are compiled once."""
    pits = [scene for seed in range(60) if (scene := random_pit(seed)) is not None]
    alike = [scene for scene in pits if isinstance(scene.domain, es.Box) and scene.walls and len(scene.disks) > 1][:6]
    rested = 0
    for scene in alike:
        run, other = (
            es.simulate(scene, until=20.0, events=2000, engine=engine, log=True) for engine in ("reference", "fast")
        )
        assert (other.digest, other.stopped, other.reason) == (run.digest, run.stopped, run.reason)
        rested += run.counters.rests
    assert rested > 6


@pytest.mark.parametrize("suffix", [".csv", ".npz", ".jsonl"])
@pytest.mark.parametrize("compact", [False, True])
def test_files_of_rests_and_slides_replay(tmp_path, suffix, compact):
    scene = ramp(0.5, 4.0)[0]
    path = tmp_path / f"slide{suffix}"
    run = es.simulate(scene, until=4.0, engine="reference", log=path, compact=compact)
    log = es.load_log(path).expand()
    assert log.digest() == run.digest
    assert (log.kind == Kind.REST).any()
    assert (log.impulse == 0.0).any()  # it left the end of the ramp
    assert Replay(log).final().position.tobytes() == run.state.position.tobytes()

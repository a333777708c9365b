"""The clock forgets idle time: what comes late has the digits of what comes early, and is the same live and by replay."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

import eventsim as es
from eventsim.engines import engine_named
from eventsim.engines.base import Stop
from eventsim.record.provenance import Ending
from eventsim.replay.clock_windows import DoublingWindows
from eventsim.replay.replay import Replay
from eventsim.scene.stage import stage_of
from tests.engines.scenes import lattice_gas

ENGINES = ["reference", "fast"]
LATE = [1.0, 1e6, 1e9, 1e12, 1e15]


def at_rest() -> es.Scene:
    return es.Scene(es.Disks([(2.0, 5.0), (7.0, 5.25)], [(0.0, 0.0), (0.0, 0.0)], 0.5), es.Box((10.0, 10.0)))


def skip_without(engine: str) -> None:
    if engine == "fast":
        pytest.importorskip("numba")


def bits(state: es.State) -> tuple[bytes, bytes]:
    return state.position.tobytes(), state.velocity.tobytes()


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("late", LATE)
def test_a_kick_after_a_long_time_is_followed_as_exactly_as_an_early_one(engine: str, late: float) -> None:
    """The true place is that of 200 digits; the 13 contacts of these 64 time units multiply the rounding of the first."""
    skip_without(engine)
    sim = es.Simulation(at_rest(), engine=engine)
    sim.advance_to(late)
    sim.set_velocity(0, (1.0, 0.0))
    sim.advance_to(late + 64.0)
    assert sim.state.position[0].tolist() == pytest.approx([9.220230471767364, 8.483998910860148], abs=2e-13)
    replay = Replay(sim.log)
    assert bits(replay.state_at(late + 64.0)) == bits(sim.state)
    assert replay.state_at(math.nextafter(late, 0.0)).velocity.tolist() == [[0.0, 0.0], [0.0, 0.0]]
    assert sim.log.digest() == es.EventLog(*_compact(sim.log)).expand().digest()


def _compact(log: es.EventLog) -> tuple:
    rows = log.rows.copy()
    for name in ("xa", "ya", "vxa", "vya", "xb", "yb", "vxb", "vyb", "impulse"):
        rows[name] = np.nan
    kicks = tuple(zip(*(log.rows[log.rows["kind"] == 3][name].tolist() for name in ("event", "vxa", "vya")), strict=True))
    return replace(log.provenance, compact=True, kicks=kicks), rows


def slow_mover(gap: float, speed: float) -> es.Scene:
    """A heavy disk that reaches one at rest after gap / speed; that one then runs to and fro between it and the wall."""
    disks = es.Disks([(1.0, 5.0), (2.0 + gap, 5.0)], [(speed, 0.0), (0.0, 0.0)], 0.5, [math.inf, 1.0])
    return es.Scene(disks, es.Box((4.0 + gap, 10.0)))


@pytest.mark.parametrize("engine", ENGINES)
def test_a_first_contact_after_a_long_time_is_as_if_time_had_begun_shortly_before(engine: str) -> None:
    """The same dyadic scene, with a way to the first contact of 2^20 and of 4: later times relative to the first are equal.

    But for what places keep in so wide a box.
    """
    skip_without(engine)
    rows, wide = [], 2.0**20
    for gap in (4.0, wide):
        run = es.simulate(slow_mover(gap, 0.5), events=12, engine=engine, log=True)
        assert run.stopped == "events"
        epochs = (run.log.epoch - run.log.epoch[0]).astype(float) * run.log.provenance.epoch_length
        rows.append(epochs + (run.log.remainder - run.log.remainder[0]))
    assert rows[1].tolist() == pytest.approx(rows[0].tolist(), abs=2.0 * math.ulp(wide))


def idle_scenes() -> dict[str, tuple[es.Scene, list[tuple[float, int, tuple[float, float]]], float]]:
    """Scenes, kicks (time, disk, velocity), an end."""
    rest = (0.0, 0.0)
    lanes = es.Disks([(0.25, 0.3), (0.25, 0.6)], [(0.7, 0.3e-2), (0.7, 0.0)], 0.05)
    tall = es.Disks([(2.0, 5.0), (7.0, 0.5)], [(0.0, 100.0), rest], 0.5)
    return {
        "kicks": (
            at_rest(),
            [(1e6, 0, (1.0, 0.0)), (1e6 + 30, 0, rest), (1e6 + 30, 1, rest), (1e12, 0, (-1.0, 0.2))],
            1e12 + 99,
        ),
        "wraps": (
            es.Scene(es.Disks([(0.25, 0.3)], [(0.7, 0.3)], 0.01), es.Periodic((1.3, 0.7))),
            [(90.0, 0, (0.01, 0.003)), (900.0, 0, rest), (1e6, 0, (0.5, 0.5))],
            1e6 + 60,
        ),
        "lanes": (es.Scene(lanes, es.Periodic((1.3, 0.7))), [(90.0, 0, (0.7, 0.1))], 130.0),
        "channel": (
            es.Scene(es.Disks([(2.0, 5.0), (7.0, 5.25)], [(0.01, 0.0), rest], 0.5), es.Channel((10.0, 10.0))),
            [(5e3, 1, (0.0, 0.05))],
            9e3,
        ),
        "a long fall": (
            es.Scene(tall, es.Box((10.0, 1e5)), gravity=(0.0, -0.01), restitution=0.5),
            [(1e4, 1, (0.3, 4.0))],
            3e4,
        ),
        "a way over the plane": (
            es.Scene(es.Disks([(0.0, 0.0), (1e7, 0.25), (1e7 + 5, 0.0)], [(1.0, 0.0), rest, rest], 0.5), es.Open()),
            [],
            1e8,
        ),
    }


@pytest.mark.parametrize("engine", ["reference", pytest.param("fast", marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", idle_scenes())
def test_a_state_in_an_idle_spell_has_the_same_bits_however_one_comes_there(name: str, engine: str) -> None:
    """Live in one go and by many stops, by replay, after going on from snapshots; at 100 times, some just before a kick."""
    skip_without(engine)
    scene, kicks, end = idle_scenes()[name]
    marks = [0.0, *(time for time, *_ in kicks), end]
    random = np.random.default_rng(1)
    times = {*random.uniform(0.0, end, 100 - 10 * len(marks)).tolist(), end}
    times |= {b * (1.0 - 10.0 ** -random.uniform(1, 16)) for b in marks[1:] for _ in range(10)}

    def lived(stops: list[float], breaks: bool) -> tuple[es.Simulation, dict[float, tuple[bytes, bytes]]]:
        sim, states = es.Simulation(scene, engine=engine), {}
        plan = [(time, 0, (i, v)) for time, i, v in kicks] + [(time, 1, None) for time in {*stops, end}]
        plan.sort(key=lambda item: item[:2])
        for time, _, kick in plan:
            sim.advance_to(time)
            if kick is not None:
                sim.set_velocity(*kick)
            else:
                states[time] = bits(sim.state)
            if breaks:
                saved = sim.snapshot()
                sim.restore(saved)
        return sim, states

    (once, _), (stops, states), (resumed, again) = lived([], False), lived(sorted(times), False), lived(sorted(times), True)
    assert once.log.digest() == stops.log.digest() == resumed.log.digest()
    assert once.log.provenance.ending == stops.log.provenance.ending
    assert states == again
    replay = Replay(once.log)
    assert {time: bits(replay.state_at(time)) for time in states} == states
    assert es.EventLog(*_compact(once.log)).expand().digest() == once.log.digest()
    if engine == "fast":
        other = es.Simulation(scene, engine="reference")
        for time, i, v in kicks:
            other.advance_to(time)
            other.set_velocity(i, v)
        other.advance_to(end)
        assert other.log.digest() == once.log.digest()


@pytest.mark.parametrize(
    ("engine", "until", "most"),
    [
        ("reference", 3e4, 2e-10),
        ("fast", 3e4, 2e-10),
        pytest.param("fast", 1e6, 5e-9, marks=pytest.mark.slow),
        pytest.param("reference", 1e6, 5e-9, marks=pytest.mark.slow),
    ],
)
def test_who_only_wraps_keeps_its_digits(engine: str, until: float, most: float) -> None:
    """28,000 wraps, each rounded to the last bit of its time; to 1e6 (slow) one last bit of the velocity alone makes 1e-10."""
    size, speed, start = (1.3, 0.7), (0.7, 0.3), (0.25, 0.3)
    skip_without(engine)
    session = engine_named(engine).open(stage_of(es.Scene(es.Disks([start], [speed], 0.01), es.Periodic(size))))
    while session.advance(Stop(until), 1 << 20) is None:
        pass
    motion = session.motion()
    for x, length, v, x0 in zip((motion.x[0], motion.y[0]), size, speed, start, strict=True):
        off = (Fraction(x) - Fraction(x0) - Fraction(v) * Fraction(until)) % Fraction(length)
        assert min(off, Fraction(length) - off) < most
    assert session.counters.turnovers < 0.01 * session.counters.wraps


@pytest.mark.parametrize("engine", ENGINES)
def test_a_disk_far_smaller_than_its_table_has_a_clock(engine: str) -> None:
    skip_without(engine)
    for radius in (1e-9, 1e-18):
        for domain, walls in ((es.Open(), [es.Circle((0.0, 0.0), 1.0)]), (es.Box((2.0, 2.0), origin=(-1.0, -1.0)), [])):
            scene = es.Scene(es.Disks([(0.25, 0.0)], [(1000.0, 0.0)], radius), domain, walls)
            run = es.simulate(scene, until=1e7, events=200, engine=engine)
            assert (run.stopped, run.counters.events) == ("events", 200)
            assert run.time == pytest.approx((0.75 + 199 * 2.0) / 1000.0, rel=1e-6)
            assert run.counters.turnovers < 100


def few(radius: float) -> es.Scene:
    disks = es.Disks([(0.25, 0.3), (0.7, 0.6), (1.1, 0.2)], [(0.7, 0.3), (-0.4, 0.2), (0.1, -0.6)], radius)
    return es.Scene(disks, es.Periodic((1.3, 0.7)))


@pytest.mark.parametrize(
    ("scene", "until", "events"),
    [
        (few(0.1), None, 1500),
        (few(0.01), 600.0, None),
        (few(1e-4), 900.0, None),
        (es.gallery("cooling", n=2), None, 500),
        (es.gallery("cooling", n=3), None, 800),
        (es.gallery("cooling", n=10), None, 2000),
        (es.gallery("cooling", n=60), None, 6000),
        (lattice_gas(2, 0.3, es.Box, restitution=es.Restitution(0.9, 1.0)), None, 1500),
        (lattice_gas(2, 0.3, es.Box), None, 1000),
        (lattice_gas(5, 0.3, es.Channel), None, 600),
    ],
)
def test_turnovers_are_few(scene: es.Scene, until: float | None, events: int | None) -> None:
    """Where contacts are rare, and where a gas cools to a hundred thousandth of its speed: windows follow its pace."""
    run = es.simulate(scene, until=until, events=events, engine="reference")
    assert run.stopped in ("until", "events")
    assert run.counters.turnovers < 0.05 * (run.counters.events + run.counters.wraps)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_gas_cools_until_its_speeds_are_below_the_digits(engine: str) -> None:
    """The clock goes on; what ends the run is that all that is left of the motion is what rounding made of the momentum."""
    skip_without(engine)
    run = es.simulate(es.gallery("cooling", n=5), events=10_000, engine=engine, log=True)
    velocity = run.state.velocity - run.state.velocity.mean(axis=0)
    assert (run.stopped, run.counters.events) == ("digits", 1783)
    assert "drift" in str(run.reason)
    assert float(np.abs(velocity).max()) < 2.0**-50
    earlier = es.simulate(run.scene, events=1500, engine=engine)
    assert (earlier.stopped, len(run.log)) == ("events", 1783)


@pytest.mark.slow
def test_a_cooled_gas_costs_no_more_an_event() -> None:
    """The work of kernels and of turnovers between 50,000 and 95,000 events, beside that of the first 50,000."""
    pytest.importorskip("numba")
    work = []
    for events in (50_000, 95_000):
        c = es.simulate(es.gallery("cooling"), events=events, engine="fast").counters
        assert c.events == events
        work.append(c.events + c.wraps + c.crossings + c.stale + 200 * c.turnovers)
    assert work[1] < 2.0 * work[0]


def test_windows_beyond_2_to_the_13_epochs_are_found_by_replay() -> None:
    """There the length of a window depends on how fast the disks are."""
    run = es.simulate(es.gallery("cooling", n=12), events=2000, engine="reference", log=True)
    assert float(np.abs(run.state.velocity).max()) < 2.0**-13
    replay = Replay(run.log)
    assert max(replay.windows.end) > 2**14 * run.log.provenance.epoch_length
    assert bits(replay.final()) == bits(run.state)
    assert es.EventLog(*_compact(run.log)).expand().digest() == run.digest


def test_a_log_of_the_clock_before_is_still_read() -> None:
    """Version 0.1 doubled its windows where there were no rows."""
    sim = es.Simulation(at_rest(), engine="reference")
    sim.advance_to(100.0)
    sim.set_velocity(0, (1.0, 0.0))
    sim.advance_to(164.0)
    rows, length = sim.log.rows.copy(), sim.log.provenance.epoch_length
    time = rows["epoch"] * length + rows["remainder"]
    rows["epoch"], rows["remainder"] = 0, time
    old = es.EventLog(replace(sim.log.provenance, ending=Ending(0, 164.0, "until")), rows)
    replay = Replay(old)
    assert isinstance(replay.windows, DoublingWindows) or replay.windows.start == [0]
    assert replay.state_at(164.0).position[0].tolist() == pytest.approx([9.220230471767364, 8.483998910860148], abs=1e-9)


@pytest.mark.parametrize("radius", [0.0, 1e-18])
def test_the_clock_of_a_disk_as_small_as_a_point_rounds_no_place_on_its_way_to_a_corner(radius):
    """It comes to one wall 2.8e-16 beside the corner; a turnover on the way would take it to the other one."""
    corners = [
        (6.5483320433773455, 4.7077614707094675),
        (5.609843816554238, 6.819058061324656),
        (2.038444567568254, 5.107307737315054),
        (0.563178924871413, 2.0642322019386796),
        (2.3423207757602, 1.1895309554024958),
        (4.145650456228476, 2.4994128109686127),
    ]
    disk = es.Disks([(3.3717947481987895, 2.5547652782780563)], [(1.1099247014273221, 2.1148079195151834)], radius)
    run = es.simulate(es.Scene(disk, es.Open(), [es.Polygon(corners)]), events=1, engine="reference", log=True)
    assert [run.log.vxa[0], run.log.vya[0]] == pytest.approx([-2.31358126664162, 0.59303212554435], rel=1e-14)


def test_a_disk_that_comes_from_afar_on_the_open_plane_is_met_with_all_digits():
    """The clock is that of the disks, not of the way: an epoch is no longer than it takes to fly some thousand diameters."""
    far = 2.0**40
    scene = es.Scene(es.Disks([(0.0, 0.0), (far, 0.25)], [(0.0, 0.0), (-1.0, 0.0)], 0.5), es.Open())
    run = es.simulate(scene, until=2.0 * far, engine="reference", log=True)
    across, along = 0.25, math.sqrt(1.0 - 0.25**2)
    assert len(run.log) == 1
    assert run.log.time[0] == far - along
    assert [run.log.vxa[0], run.log.vya[0]] == pytest.approx([-(along**2), -across * along], abs=1e-11)
    assert stage_of(scene).epoch_length <= 2.0**12


def small_polygon(seed: int) -> es.Scene:
    """A tiny disk in a triangle: it idles for many epochs between contacts, and meets two walls within few near a vertex."""
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.uniform(0.0, 2.0 * math.pi, 3)).tolist()
    triangle = es.Polygon([(4.3 * math.cos(angle), 4.3 * math.sin(angle)) for angle in angles])
    centre = np.mean(triangle.points, axis=0)
    return es.Scene(es.Disks([centre], [rng.normal(size=2)], 10.0 ** -rng.integers(3, 13)), es.Open(), (triangle,))


@pytest.mark.kernels
@pytest.mark.parametrize("seed", range(8))
def test_a_window_goes_on_behind_the_contact_that_the_clock_has_jumped_to(seed: int) -> None:
    """The engines have the same rows, and none is passed over."""
    skip_without("fast")
    reference, fast = (es.simulate(small_polygon(seed), events=20, engine=engine, log=True) for engine in ("reference", "fast"))
    assert fast.log.digest() == reference.log.digest()
    assert len(fast.log) == 20

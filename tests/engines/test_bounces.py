"""Series of bounces end: at rest on what is straight, with a reason on what is round, at the time of the geometric series."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from mpmath import mp, mpf

import eventsim as es
from eventsim.record.events import Kind
from eventsim.replay.replay import Replay
from tests.engines.falling import ENGINES, dropped

mp.dps = 40

RARE = [name if name == "reference" else pytest.param(name, marks=pytest.mark.slow) for name in ENGINES]
"""The engines, for scenes that no other test has kernels compiled for."""


def zeno_time(gap, rate, pull, restitution):
    """When infinitely many bounces are over, from exact numbers: gap, rate of the gap, pull across the wall."""
    e = mpf(restitution)
    speed = mp.sqrt(mpf(rate) ** 2 + 2 * pull * gap)
    return (rate + speed) / pull + 2 * e * speed / (pull * (1 - e))


def drop_onto_a_side(rng, restitution):
    radius, height, pull = rng.choice([0.0, 0.1, 0.5]), 10.0 ** rng.uniform(-1.5, 0.5), 10.0 ** rng.uniform(0.0, 3.0)
    y, u = radius + height, rng.choice([0.0, 1e-3])
    scene = es.Scene(
        es.Disks([[5.0, y]], [[u, 0.0]], radius), es.Box((40.0, 10.0)), gravity=(0.0, -pull), restitution=restitution
    )
    return scene, zeno_time(mpf(y) - mpf(radius), mpf(0), mpf(pull), restitution)


def drop_onto_a_segment(rng, restitution):
    radius, height, pull = rng.choice([0.0, 0.1, 0.5]), 10.0 ** rng.uniform(-1.5, 0.5), 10.0 ** rng.uniform(0.0, 3.0)
    floor = rng.uniform(-3.0, 3.0)
    y = floor + radius + height
    wall = es.Segment((0.0, floor), (10.0, floor))
    scene = es.Scene(es.Disks([[5.0, y]], radius=radius), es.Open(), [wall], gravity=(0.0, -pull), restitution=restitution)
    return scene, zeno_time(mpf(y) - mpf(floor) - mpf(radius), mpf(0), mpf(pull), restitution)


def drop_onto_a_slope(rng, restitution):
    """As long as the way along it; the components along the normal decide."""
    radius, height, pull = rng.choice([0.0, 0.1, 0.5]), 10.0 ** rng.uniform(-1.5, 0.5), 10.0 ** rng.uniform(0.0, 3.0)
    angle = rng.uniform(-0.3, 0.3) if restitution < 0.99 else rng.uniform(-0.01, 0.01)
    spell = math.sqrt(2.0 * height / pull) * 2.0 / (1.0 - restitution)
    far = 0.55 * pull * abs(math.sin(angle)) * spell**2 + 10.0
    x1, y1 = far * math.cos(angle), far * math.sin(angle)
    y = (radius + height) / math.cos(angle)
    wall = es.Segment((-x1, -y1), (x1, y1))
    scene = es.Scene(es.Disks([[0.0, y]], radius=radius), es.Open(), [wall], gravity=(0.0, -pull), restitution=restitution)
    ex, ey = 2 * mpf(x1), 2 * mpf(y1)
    length = mp.sqrt(ex * ex + ey * ey)
    gap = (-ey * mpf(x1) + ex * (mpf(y) + mpf(y1))) / length - mpf(radius)
    return scene, zeno_time(gap, mpf(0), mpf(pull) * ex / length, restitution)


DROPS = {"side": (drop_onto_a_side, 1e-9), "segment": (drop_onto_a_segment, 1e-8), "slope": (drop_onto_a_slope, 1e-8)}


def rests_in_time(kind, seed, restitution, engine):
    """Whether a drop is at rest at the true time."""
    drop, tolerance = DROPS[kind]
    scene, true = drop(np.random.default_rng(seed), restitution)
    run = es.simulate(scene, until=1.01 * float(true), events=80_000, engine=engine, log=True)
    assert (run.log.kind == Kind.REST).tolist() == [False] * (len(run.log) - 1) + [True]
    assert abs((mpf(float(run.log.time[-1])) - true) / true) < tolerance
    return run


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("restitution", [0.9, 0.95, 0.97])
@pytest.mark.parametrize("kind", DROPS)
def test_a_drop_is_at_rest_at_its_zeno_time(kind, restitution, engine):
    for seed in range(2):
        run = rests_in_time(kind, seed, restitution, engine)
        assert run.counters.events < 40.0 / (1.0 - restitution)
        assert run.residuals.momentum < 1e-13


@pytest.mark.parametrize("engine", ENGINES)
def test_a_series_on_one_of_several_links_in_line_is_no_arrival_on_the_others(engine):
    """Links that were not struck took the last bounces for slow arrivals, and let the disk rest at once."""
    for angle in np.linspace(-1.1, 1.2, 12):
        ex, ey = math.cos(angle), math.sin(angle)
        chain = es.Polyline([(m * ex, m * ey) for m in (0.0, 1.0, 1.5, 3.0)])
        x, y = 0.5 * ex - 0.1001 * ey, 0.5 * ey + 0.1001 * ex
        scene = es.Scene(es.Disks([[x, y]], radius=0.1), es.Open(), [chain], gravity=(0.0, -1.0), restitution=0.5)
        run = es.simulate(scene, until=0.5, engine=engine, log=True)
        length = mp.hypot(mpf(ex), mpf(ey))
        gap = (mpf(ex) * mpf(y) - mpf(ey) * mpf(x)) / length - mpf(0.1)
        true = zeno_time(gap, mpf(0), mpf(ex) / length, 0.5)
        rests = run.log.time[run.log.kind == Kind.REST]
        assert abs((mpf(float(rests[0])) - true) / true) < 1e-8


@pytest.mark.slow
@pytest.mark.timeout(1800)
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("kind", DROPS)
def test_five_hundred_drops_are_all_at_rest_in_time(kind, engine):
    rng = np.random.default_rng(5)
    for seed, loss in enumerate(10.0 ** rng.uniform(-3.0, -1.0, 167)):
        rests_in_time(kind, seed, 1.0 - float(loss), engine)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_bounce_that_rounding_would_keep_up_ends(engine):
    """A late clock, whose last bits are coarse, and many bounces: flights of a hundred last bits came back for ever."""
    disk = es.Disks([[0.5, 1.1]], radius=0.1)
    scene = es.Scene(disk, es.Box((40.0, 5.0)), gravity=(0.0, -1.0), restitution=0.99)
    run = es.simulate(scene, until=300.0, events=10_000, engine=engine, log=True)
    assert run.stopped == "quiet"
    assert run.log.time[-1] == pytest.approx(math.sqrt(2.0) * 1.99 / 0.01, rel=1e-13)
    assert len(run.log) < 3500
    assert run.state.position.tolist() == [[0.5, 0.1]]


@pytest.mark.parametrize("height", [0.0, 0.25])
@pytest.mark.parametrize("engine", ENGINES)
def test_what_has_met_another_disk_low_above_the_floor_falls_on_and_bounces(engine, height):
    """Its gap is known to a few last bits, to those of its height alone above a side of the domain."""
    radius, drop, low = 2.0**-10, 2.0**-47, 2.0**-49
    begun = math.sqrt(2.0 * (drop - low))
    y = height + radius + drop
    disks = es.Disks([(1.0, y), (1.0 + 2.0 * radius + begun, y)], [(0.0, 0.0), (-1.0, 0.0)], radius)
    walls = (es.Segment((0.0, height), (4.0, height)),) if height else ()
    run = es.simulate(es.Scene(disks, es.Box((4.0, 1.0)), walls, (0.0, -1.0), 0.5), until=1e-5, engine=engine, log=True)
    assert run.log.kind[:2].tolist() == [Kind.PAIR, Kind.WALL]
    assert run.log.time[run.log.kind == Kind.REST] == pytest.approx([3.0 * math.sqrt(2.0 * drop)] * 2, rel=1e-8)


@pytest.mark.parametrize("engine", RARE)
def test_a_disk_that_comes_to_rest_does_not_hold_up_the_others(engine):
    disks = es.Disks([[2.0, 1.1], [8.0, 8.0]], [[0.0, 0.0], [3.0, 0.0]], 0.5)
    scene = es.Scene(disks, es.Box((40.0, 10.0)), gravity=(0.0, -1.0), restitution=0.97)
    run = es.simulate(scene, until=1000.0, events=60_000, engine=engine, log=True)
    first = int(np.flatnonzero(run.log.kind == Kind.REST)[0])
    assert run.stopped in ("until", "quiet")
    assert run.log.a[first:].max() == 1
    assert run.state.position[:, 1].tolist() == [0.5, 0.5]


@pytest.mark.parametrize("engine", RARE)
def test_the_digits_of_a_far_place_do_not_keep_up_a_bounce(engine):
    """At 1e6 the last bit of a place is 1e-10: a fall from there would keep up flights of 5e-4."""
    wall, disk = es.Segment((-10.0, 1e6), (10.0, 1e6)), es.Disks([[5.0, 1e6 + 1.5]], radius=0.5)
    scene = es.Scene(disk, es.Box((20.0, 2e6), (-10.0, 0.0)), [wall], gravity=(0.0, -2.0), restitution=0.95)
    run = es.simulate(scene, until=1e3, events=10_000, engine=engine, log=True)
    assert run.log.kind[-1] == Kind.REST
    assert run.log.time[-1] == pytest.approx(39.0, rel=1e-13)
    assert run.state.position.tolist() == [[5.0, 1e6 + 0.5]]


@pytest.mark.parametrize("engine", RARE)
def test_a_bounce_along_a_period_ends_as_any_other(engine):
    disk = es.Disks([[5.0, 1.5]], [[100.0, 0.0]], 0.5)
    scene = es.Scene(disk, es.Channel((10.0, 10.0)), gravity=(0.0, -2.0), restitution=0.95)
    run = es.simulate(scene, until=60.0, events=10_000, engine=engine, log=True)
    assert run.log.kind[-1] == Kind.REST
    assert run.log.time[-1] == pytest.approx(39.0, rel=1e-13)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("restitution", [0.0, 1e-300, 1e-17])
def test_a_disk_that_does_not_bounce_rests_where_it_falls(engine, restitution):
    run = es.simulate(dropped(restitution=restitution), until=10.0, engine=engine, log=True)
    assert (run.log.kind.tolist(), run.log.time.tolist()) == ([Kind.WALL, Kind.REST], [1.0, 1.0])
    assert run.state.position.tolist() == [[5.0, 0.5]]


@pytest.mark.parametrize("engine", ENGINES)
def test_an_almost_elastic_bounce_is_not_cut(engine):
    run = es.simulate(dropped(restitution=1.0 - 1e-12), until=1000.0, engine=engine, log=True)
    assert run.stopped == "until"
    assert run.log.time == pytest.approx(np.arange(500) * 2.0 + 1.0, rel=1e-9)


@pytest.mark.parametrize("engine", ENGINES)
def test_nothing_rests_beyond_the_end_of_its_wall(engine):
    """At speed 1 it passes the end 1e-6 before its series is over: it flies on from there, hardly lower than it came."""
    scene = dropped([es.Segment((0.0, 0.0), (8.0 - 1e-6, 0.0))], es.Open())
    scene = replace(scene, disks=es.Disks([[5.0, 1.5]], [[1.0, 0.0]], 0.5))
    run = es.simulate(scene, until=4.0, engine=engine, log=True)
    assert not (run.log.kind == Kind.REST).any()
    assert run.state.position[0] == pytest.approx([9.0, 0.5 - 1.0], abs=1e-5)


ROUND = {
    "vertex": ([es.Polygon([(5.0, 2.0), (4.0, 1.0), (6.0, 1.0)])], [5.0, 3.5]),
    "end": ([es.Segment((5.0, 2.0), (5.5, 0.0))], [5.0, 3.5]),
    "arc": ([es.Arc((4.0, 1.0), (5.0, 2.0), (6.0, 1.0))], [5.0, 3.5]),
    "container": ([es.Circle((5.0, 5.0), 4.0)], [5.0, 2.5]),
}
"""Walls, and where a disk of radius 1/2 is one above their top or bottom, in the middle."""


def onto_what_is_round(name, restitution, beside=0.0):
    walls, (x, y) = ROUND[name]
    disk = es.Disks([[x + beside, y]], radius=0.5)
    return es.Scene(disk, es.Open(), walls, gravity=(0.0, -2.0), restitution=restitution)


ROUND_AND_ENGINE = [
    pytest.param(name, engine, marks=pytest.mark.slow)
    if engine == "fast" and name in ("arc", "container")
    else (name, engine)
    for name in ROUND
    for engine in ENGINES
]


@pytest.mark.parametrize("restitution", [0.9, pytest.param(0.99, marks=pytest.mark.slow)])
@pytest.mark.parametrize(("name", "engine"), ROUND_AND_ENGINE)
def test_a_central_drop_onto_what_is_round_stops_at_its_zeno_time(name, restitution, engine):
    scene = onto_what_is_round(name, restitution)
    run = es.simulate(scene, until=1000.0, events=10_000, engine=engine, log=True)
    assert run.stopped == "collapse"
    assert run.time == pytest.approx((1.0 + restitution) / (1.0 - restitution), rel=1e-11)
    assert float(re.search(r"each ([\d.]+) times as long", run.reason)[1]) == restitution
    assert np.ptp(run.log.xa) == 0.0


@pytest.mark.parametrize("engine", RARE)
@pytest.mark.parametrize("restitution", [0.5, 0.9, pytest.param(0.99, marks=pytest.mark.slow)])
def test_so_does_a_drop_onto_an_immovable_disk_and_the_ratio_of_rounds_is_the_restitution(restitution, engine):
    disks = es.Disks([[5.0, 2.5], [5.0, 0.5]], radius=0.5, mass=[1.0, math.inf])
    scene = es.Scene(disks, es.Box((10.0, 10.0)), gravity=(0.0, -2.0), restitution=restitution)
    run = es.simulate(scene, until=1000.0, events=10_000, engine=engine)
    assert run.stopped == "collapse"
    assert run.time == pytest.approx((1.0 + restitution) / (1.0 - restitution), rel=1e-11)
    assert float(re.search(r"each ([\d.]+) times as long", run.reason)[1]) == restitution


@pytest.mark.parametrize("engine", ENGINES)
def test_a_drop_beside_the_middle_of_a_vertex_falls_past_it(engine):
    scene = onto_what_is_round("vertex", 0.99, beside=1e-9)
    run = es.simulate(scene, until=100.0, events=1000, engine=engine)
    assert run.stopped == "quiet"
    assert run.state.position[0, 1] < -10.0


@pytest.mark.parametrize("engine", RARE)
def test_a_wall_that_goes_round_the_domain_supports_nobody_but_lets_bounces_end(engine):
    disk = es.Disks([[3.0, 2.5]], radius=0.5)
    wall = es.Segment((0.0, 1.0), (10.0, 1.0))
    scene = es.Scene(disk, es.Periodic((10.0, 10.0)), [wall], gravity=(0.0, -2.0), restitution=0.9)
    run = es.simulate(scene, until=1000.0, events=10_000, engine=engine)
    assert run.stopped == "collapse"
    assert run.time == pytest.approx(19.0, rel=1e-11)


@pytest.mark.parametrize("engine", ENGINES)
def test_between_two_slopes_a_series_stops_with_a_reason(engine):
    walls = [es.Segment((-9.0, 9.0), (0.0, 0.0), name="l"), es.Segment((0.0, 0.0), (9.0, 9.0), name="r")]
    scene = es.Scene(es.Disks([[0.3, 5.0]], radius=0.5), es.Open(), walls, gravity=(0.0, -1.0), restitution=0.9)
    run = es.simulate(scene, until=1000.0, events=10_000, engine=engine)
    assert run.stopped in ("collapse", "digits")
    assert "contact_duration" in run.reason
    assert run.state.position[0] == pytest.approx([0.0, 0.5 * math.sqrt(2.0)], abs=1e-6)


def test_a_kick_begins_another_series():
    sim = es.Simulation(dropped(restitution=0.9), engine="reference")
    sim.advance_to(18.999)
    sim.set_velocity(0, (0.1, 1.0))
    began, state = sim.time, sim.state
    sim.advance_to(40.0)
    assert sim.log.kind[-1] == Kind.REST
    true = zeno_time(mpf(float(state.position[0, 1])) - mpf(0.5), mpf(1), mpf(2), 0.9)
    assert sim.log.time[-1] == pytest.approx(began + float(true), rel=1e-13)
    assert sim.state.velocity.tolist() == [[0.1, 0.0]]


@pytest.mark.parametrize("kind", DROPS)
def test_in_the_middle_of_a_series_a_run_goes_on_and_replays_alike(kind, tmp_path):
    scene, true = DROPS[kind][0](np.random.default_rng(3), 0.9)
    whole = es.simulate(scene, until=1.1 * float(true), engine="reference", log=True)
    sim = es.Simulation(scene, engine="reference")
    for share in (0.5, 0.999999, 1.0 - 1e-12):
        sim.advance_to(share * float(true))
        saved = sim.snapshot()
        sim.advance_to(1.01 * float(true))
        sim.restore(saved)
        seen = Replay(whole.log).state_at(share * float(true))
        assert seen.position.tobytes() == sim.state.position.tobytes()
    sim.advance_to(1.1 * float(true))
    assert sim.log.rows.tobytes() == whole.log.rows.tobytes()
    path = tmp_path / "drop.npz"
    es.simulate(scene, until=1.1 * float(true), engine="reference", log=path, compact=True)
    assert es.load_log(path).expand().digest() == whole.digest


@pytest.mark.parametrize("kind", [*DROPS, *ROUND])
@pytest.mark.kernels
def test_engines_agree_on_every_kind_of_bounce(kind):
    pytest.importorskip("numba")
    if kind in DROPS:
        scene, _ = DROPS[kind][0](np.random.default_rng(7), 0.97)
    else:
        scene = onto_what_is_round(kind, 0.97)
    runs = [es.simulate(scene, until=200.0, events=3000, engine=engine, log=True) for engine in ENGINES]
    assert len({(run.digest, run.stopped, run.reason) for run in runs}) == 1


def burst(seed):
    """Two hundred disks on the open plane, which part."""
    rng = np.random.default_rng(seed)
    places = np.stack(np.divmod(np.arange(200), 15), axis=1) * 1.5
    return es.Scene(es.Disks(places, rng.normal(size=(200, 2)), 0.5), es.Open())


@pytest.mark.parametrize("engine", ENGINES)
def test_a_stop_is_quiet_where_nothing_is_ahead_and_that_alone(engine):
    """Whatever the cells of an engine make it look for."""
    run = es.simulate(burst(1), until=1e4, engine=engine, log=True)
    last = float(run.log.time[-1])
    words = [es.simulate(burst(1), until=until, engine=engine, log=True).stopped for until in (0.9 * last, 1.01 * last, 1e6)]
    assert (run.stopped, words) == ("quiet", ["until", "quiet", "quiet"])


@pytest.mark.parametrize("engine", RARE)
def test_a_wall_far_below_is_ahead(engine):
    scene = burst(2)
    below = replace(scene, walls=(es.Segment((-1e4, -1e5), (1e4, -1e5)),), gravity=(0.0, -1.0))
    assert es.simulate(below, until=300.0, engine=engine).stopped == "until"

"""A log alone gives the engine's own states, bit for bit, whether full or compact."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from eventsim.errors import LogError
from eventsim.record import State
from eventsim.replay.expand import expand_blocks
from eventsim.replay.log import EventLog, stream_log
from eventsim.replay.replay import Replay
from eventsim.run import Run, load_log
from eventsim.scene import Arc, Box, Channel, Circle, Disks, Domain, Open, Periodic, Polygon, Polyline, Scene, Segment
from eventsim.simulation import Simulation, simulate
from eventsim.suffixes import LOGS

UNEVEN = np.where(np.arange(16) % 3 == 0, 2.0**20, np.where(np.arange(16) % 7 == 1, np.inf, 1.0))
POSTS = np.where(np.arange(16) % 5 == 0, np.inf, 1.0 + np.arange(16) % 3)


def lattice(domain: Domain, mass: object = 1.0, **rules: object) -> Scene:
    """Sixteen disks on a square lattice, moving at random; the immovable ones rest."""
    rng = np.random.default_rng(5)
    width, height = domain.size or (4.0, 4.0)
    place = [((i + 0.5) * width / 4, (j + 0.5) * height / 4) for i in range(4) for j in range(4)]
    masses = np.broadcast_to(np.asarray(mass), 16)
    velocity = np.where(np.isinf(masses)[:, None], 0.0, rng.standard_normal((16, 2)))
    return Scene(Disks(np.array(place) + domain.origin, velocity, 0.2, masses), domain, **rules)  # type: ignore[arg-type]


def rack(domain: Domain, places: list[tuple[float, float]], cue: tuple[float, float]) -> Scene:
    """Touching disks of radius 1/2 at rest; the last one runs into them with the velocity `cue`."""
    return Scene(Disks(places, [(0.0, 0.0)] * (len(places) - 1) + [cue], 0.5), domain)


INNER = (
    Segment((2.0, 0.1), (2.0625, 1.2)),
    Polygon(((3.8, 3.8), (3.95, 3.95), (3.95, 3.8))),
    Arc((0.05, 0.1), (0.08, 0.2), (0.2, 0.25)),
)

SCENES = {
    "box": (lattice(Box((4.0, 3.0), (1e3, 0.1))), 4.0),
    "periodic": (lattice(Periodic((4.0, 3.0), (0.3, -7.0))), 60.0),
    "late": (lattice(Periodic((4.0, 3.0)), start_time=1e6 + 0.1), 1e6 + 10.0),
    "channel": (lattice(Channel((4.0, 3.0)), POSTS), 20.0),
    "gravity": (lattice(Box((4.0, 4.0)), POSTS, gravity=(0.3, -1.0)), 3.0),
    "falling for ever": (lattice(Periodic((4.0, 4.0)), gravity=(0.3, -1.0)), 4.0),
    "cooling": (lattice(Box((4.0, 3.0)), restitution={"pair": 0.8, "wall": 0.9}, contact_duration=0.1), 20.0),
    "walls": (lattice(Box((4.0, 4.0)), walls=INNER), 10.0),
    "walls of a torus": (lattice(Periodic((4.0, 4.0)), walls=INNER), 10.0),
    "uneven": (lattice(Channel((4.0, 3.0)), UNEVEN, walls=INNER[:1]), 4.0),
    "uneven on a torus": (lattice(Periodic((4.0, 3.0)), UNEVEN), 20.0),
    "container": (
        Scene(
            Disks([(1, 1), (1.5, 2.5), (2.5, 1.2)], [(1, 0.3), (-0.7, 1), (0.2, 0.9)], [0.1, 0.2, 0.05]),
            Open(),
            walls=(Circle((2, 2), 2.1), Polyline(((2, 1), (2.2, 1.6), (2.0, 2.2)))),
            gravity=(0.0, -1.0),
        ),
        8.0,
    ),
    "two onto one": (
        Scene(Disks([(0, 0), (-4, 3), (4, 3)], [(0, 0), (0.5, 0), (-0.5, 0)], [2.5, 1.25, 1.25]), Open()),
        30.0,
    ),
    "rack in a box": (rack(Box((4, 4)), [(0.5, 0.5), (1.5, 0.5), (2.5, 0.5), (3, 3)], (0.25, -1)), 10.0),
    "rack on a torus": (rack(Periodic((4, 4)), [(0.5, 0.5), (1.5, 0.5), (2.5, 0.5), (1, 3)], (0, -1)), 10.0),
    "a pair that meets twice at once": (
        Scene(Disks([(0.5, 0.5), (1.5, 2)], [(0.125, 1), (0.125, -1)], 0.5625), Periodic((2, 4))),
        9.0,
    ),
}


def assert_same(one: State, other: State) -> None:
    assert one.position.tobytes() == other.position.tobytes()
    assert one.velocity.tobytes() == other.velocity.tobytes()


@cache
def run_of(name: str) -> Run:
    """The run of a scene, with its log."""
    scene, until = SCENES[name]
    return simulate(scene, until=until, log=True)


@pytest.mark.parametrize("name", SCENES)
def test_the_state_at_any_time_is_the_engine_s_own(name: str) -> None:
    scene, until = SCENES[name]
    run = run_of(name)
    replay = Replay(run.log)
    assert_same(replay.final(), run.state)
    sim = Simulation(scene)
    for time in np.linspace(scene.start_time, until, 12).tolist():
        sim.advance_to(time)
        assert_same(replay.state_at(time), sim.state)


@pytest.mark.parametrize("name", SCENES)
def test_a_compact_log_expands_to_the_full_one(tmp_path: Path, name: str) -> None:
    log = run_of(name).log
    log.save(tmp_path / "log.jsonl", compact=True)
    compact = load_log(tmp_path / "log.jsonl")
    assert compact.expand().rows.tobytes() == log.rows.tobytes()
    assert compact.digest() == log.digest()


KERNELS = [
    pytest.param(name, marks=() if name in ("periodic", "rack on a torus") else pytest.mark.slow) for name in SCENES
]
"""Most scenes need kernels of their own, which take seconds to compile."""


@pytest.mark.parametrize("name", KERNELS)
@pytest.mark.kernels
def test_kernels_expand_a_compact_log_to_the_same_bits(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("numba")
    log = run_of(name).log
    monkeypatch.setattr("eventsim.replay.expand.first_engine", lambda *_: "fast")
    compact = EventLog(replace(log.provenance, compact=True), log.rows)
    assert compact.expand().rows.tobytes() == log.rows.tobytes()


@pytest.mark.slow
@pytest.mark.parametrize("uneven", [False, True], ids=["equal", "uneven"])
@pytest.mark.kernels
def test_kernels_expand_a_log_with_kicks(uneven: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("numba")
    log = kicked(uneven).log
    monkeypatch.setattr("eventsim.replay.expand.first_engine", lambda *_: "fast")
    compact = EventLog(replace(log.provenance, compact=True), log.rows)
    assert compact.expand().rows.tobytes() == log.rows.tobytes()


@pytest.mark.kernels
def test_kernels_refuse_rows_that_do_not_follow(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("numba")
    log = run_of("periodic").log
    rows = log.rows.copy()
    rows["remainder"][7] *= 1.0 + 1e-12
    monkeypatch.setattr("eventsim.replay.expand.first_engine", lambda *_: "fast")
    with pytest.raises(LogError, match="does not fit its scene at event 7"):
        EventLog(replace(log.provenance, compact=True), rows).expand()


def test_the_racks_are_tests_of_clusters() -> None:
    for name in ("two onto one", "rack in a box", "rack on a torus", "a pair that meets twice at once"):
        log = run_of(name).log
        assert (log.joint >= 0).any(), name


@cache
def kicked(uneven: bool) -> Simulation:
    simulation = Simulation(lattice(Periodic((4.0, 3.0)), UNEVEN if uneven else 1.0))
    for i, time in enumerate((0.7, 3.1, 3.1, 20.0)):
        simulation.advance_to(time)
        simulation.set_velocity(3 * i, (1.0 - i, 0.5))
    simulation.advance_to(25.0)
    return simulation


@pytest.mark.parametrize(
    ("suffix", "compact", "uneven"),
    [*((suffix, compact, False) for suffix in LOGS for compact in (False, True)), (".npz", True, True)],
)
def test_a_file_with_kicks_replays_to_the_final_state(tmp_path: Path, suffix: str, compact: bool, uneven: bool) -> None:
    simulation = kicked(uneven)
    path = tmp_path / f"log{suffix}"
    simulation.log.save(path, compact=compact)
    log = load_log(path)
    assert log.digest() == simulation.log.digest()
    assert_same(Replay(log).final(), simulation.state)
    assert_same(Replay(log).state_at(25.0), simulation.state)


def test_a_streamed_log_is_the_one_in_memory(tmp_path: Path) -> None:
    scene, until = SCENES["periodic"]
    kept = run_of("periodic").log
    assert kept is not None
    for suffix in LOGS:
        run = simulate(scene, until=until, log=tmp_path / f"log{suffix}")
        streamed = load_log(tmp_path / f"log{suffix}")
        assert isinstance(streamed, EventLog)
        assert streamed.rows.tobytes() == kept.rows.tobytes()
        assert streamed.provenance == kept.provenance
        assert run.digest == kept.digest()


@pytest.mark.parametrize("suffix", [".csv", ".npz"])
def test_a_compact_log_is_made_full_up_to_a_time(tmp_path: Path, suffix: str) -> None:
    simulation = kicked(False)
    simulation.log.save(tmp_path / f"log{suffix}", compact=True)
    compact, full = load_log(tmp_path / f"log{suffix}"), Replay(simulation.log)
    for time in (0.0, 0.7, 2.5, 3.1, 19.9, 20.0, 25.0):
        part = compact.expand(time)
        assert part.rows.tobytes() == simulation.log.rows[: len(part)].tobytes()
        assert (part.time <= time).all()
        assert_same(Replay(part).state_at(time), full.state_at(time))
    assert len(compact.expand(2.5)) < len(compact.expand(20.0)) < len(compact)


def test_a_log_that_was_cut_inside_a_generation_ends_where_its_rows_end() -> None:
    log = run_of("rack in a box").log
    cut = int(np.flatnonzero(log.joint >= 0)[1])
    assert log.joint[cut] < cut
    provenance = replace(log.provenance, compact=True, ending=None, rows=None)
    assert EventLog(provenance, log.rows[:cut]).expand().rows.tobytes() == log.rows[:cut].tobytes()


def test_a_log_is_streamed_as_full_rows(tmp_path: Path) -> None:
    simulation = kicked(False)
    simulation.log.save(tmp_path / "log.npz", compact=True)
    whole = simulation.log.rows
    provenance, blocks = stream_log(tmp_path / "log.npz")
    assert not provenance.compact
    assert np.concatenate(list(blocks)).tobytes() == whole.tobytes()
    pieces = [whole[first : first + 7] for first in range(0, len(whole), 7)]
    assert np.concatenate(list(expand_blocks(simulation.log.provenance, pieces))).tobytes() == whole.tobytes()


def test_what_differs_is_told_with_what_to_do() -> None:
    log = run_of("periodic").log
    heavier = replace(log.scene, disks=replace(log.scene.disks, mass=np.where(np.arange(16) == 3, 2.0, 1.0)))
    here = replace(log.provenance, compact=True, scene=heavier)
    with pytest.raises(LogError, match=r"at event \d+: it has pair of disks .*, where the engine finds pair of .* changed"):
        EventLog(here, log.rows).expand()
    with pytest.raises(LogError, match=r"made by version 0\.0\.9 under other rules \(bits 1, here 2\), or changed since: read"):
        EventLog(replace(here, version="0.0.9", bits=1), log.rows).expand()
    with pytest.raises(LogError, match="the log of the engine stepped has to be a full one"):
        EventLog(replace(here, engine="stepped"), log.rows).expand()
    with pytest.raises(LogError, match="the log of the engine certified has to be a full one"):
        EventLog(replace(log.provenance, engine="certified"), log.rows).save("never.npz", compact=True)

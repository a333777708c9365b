"""Under every law of contacts both engines write one log: begun anew, kicked, resumed, relabelled, from its compact form."""

from __future__ import annotations

from contextlib import suppress

import numpy as np
import pytest

import eventsim as es
from eventsim.compiler import is_interpreted
from eventsim.engines.base import Stop
from eventsim.engines.fast.rules import pairs_of, rules_of, shares_of
from eventsim.engines.fast.session import FastSession
from eventsim.engines.reference.loop import ReferenceSession
from eventsim.record.events import row_of
from eventsim.replay import expand
from eventsim.scene.stage import stage_of
from tests.engines.law_scenes import LAWS, by_chance, own, random_scene, relabelled, told
from tests.engines.scenes import lattice_gas

pytest.importorskip("numba")

EVENTS = 20 if is_interpreted() else 60
KINDS = None if is_interpreted() else 3
"""Of how many kinds scenes of a law are, each of which is compiled."""

SEEDS = 3 if is_interpreted() else 200


def followed(session, seed, other=None, order=None):
    """The rows of a run that is kicked on its way; then it goes on in another session, if one is given.

    order: disk k of the session is disk order[k] of the scene that the kick is meant for.
    """
    rng = np.random.default_rng(seed)
    blocks, stopped = [], None
    for part in (1, 2, 3):
        stop = Stop(events=session.counters.events + EVENTS)
        while stopped is None:
            stopped = session.advance(stop, 1000)
        blocks.append(session.take_rows())
        if stopped != "events":
            break
        stopped = None
        if part == 1:
            kicked = int(rng.integers(session.stage.n))
            kicked = kicked if order is None else order.tolist().index(kicked)
            session.kick(kicked, *rng.normal(size=2).tolist())
            blocks.append(session.take_rows())
        elif part == 2 and other is not None:
            other.restore(session.snapshot())
            session = other
    return np.concatenate(blocks), stopped, session.reason


def assert_one_log(seed, law):
    scene = random_scene(seed, law, KINDS)
    stage = stage_of(scene)
    rows, *why = followed(ReferenceSession(stage), seed)
    for other in (None, ReferenceSession(stage)) if seed % 2 else (None, FastSession(stage)):
        found, *stopped = followed(FastSession(stage), seed, other)
        assert stopped == why
        assert len(found) == len(rows)
        behind = [np.where(log["joint"] < 0, -1, log["event"] - log["joint"]) for log in (found, rows)]
        assert np.array_equal(*behind)
        anew = ("event", "joint") if other is not None else ()  # a session that takes over counts anew
        for name in (name for name in rows.dtype.names if name not in anew):
            assert np.array_equal(found[name], rows[name], equal_nan=rows.dtype[name].kind == "f"), name
    if not by_chance(law) and (not is_interpreted() or seed == 0):
        order = np.random.default_rng(seed).permutation(stage.n)
        found, stopped, _ = followed(FastSession(stage_of(relabelled(scene, order))), seed, order=order)
        assert stopped == why[0]
        assert told(found, order) == told(rows, range(stage.n))
    return len(rows)


def of_laws(scene):
    """What kernels are told of laws, the usual restitutions left out; None is compiled away."""
    stage = stage_of(scene)
    rules, state = rules_of(stage), FastSession(stage).state
    names = ("law", "by_speed", "own", "driven", "seed", "pair_roughness", "wall_roughness")
    told = {name: getattr(rules, name) for name in names} | {"shares": shares_of(stage), "pairs": pairs_of(stage)}
    return told | {"spin": state.spin, "contacts": state.contacts, "columns": row_of(stage.spin is not None).names}


@pytest.mark.kernels
def test_a_scene_without_laws_has_nothing_of_them():
    for bare in (lattice_gas(12, 0.1), lattice_gas(12, 0.1, restitution=0.9)):
        told = of_laws(bare)
        columns = told.pop("columns")
        assert set(told.values()) == {None}
        assert not [name for name in columns if "spin" in name]


@pytest.mark.kernels
@pytest.mark.parametrize("law", [law for law in LAWS if law != "restitution"])
def test_a_scene_with_a_law_has_something_of_it(law):
    assert any(value is not None for name, value in of_laws(random_scene(0, law)).items() if name != "columns")


@pytest.mark.kernels
@pytest.mark.parametrize("law", LAWS)
def test_a_law_has_one_log(law):
    found = [assert_one_log(seed, law) for seed in range(SEEDS)]
    assert sum(found) > 2 * EVENTS * len(found)


def log_of(scene, engine, path):
    """The log file of a run that is kicked on its way; it may squeeze a disk, which then has contacts without end."""
    simulation = es.Simulation(scene, engine=engine, log=path)
    with suppress(es.CollapseError):
        simulation.advance_to(1.0, events=10 * EVENTS)
        simulation.set_velocity(0, (1.0, -0.5))
        simulation.advance_to(2.0, events=10 * EVENTS)
    return simulation.log


def assert_compact(full, path):
    full.save(path, compact=True)
    assert es.load_log(path, law=own if full.scene.law else None).digest() == full.digest()


@pytest.mark.parametrize("law", LAWS)
def test_a_compact_log_gives_the_rows_of_its_law(law, tmp_path):
    for seed in range(4):
        assert_compact(log_of(random_scene(seed, law), "reference", tmp_path / f"{seed}.npz"), tmp_path / f"compact{seed}.npz")


@pytest.mark.slow
@pytest.mark.kernels
@pytest.mark.parametrize("law", LAWS)
def test_one_engine_expands_the_compact_log_of_the_other(law, tmp_path, monkeypatch):
    for seed in range(SEEDS):
        written, read = ("fast", "reference") if seed % 2 else ("reference", "fast")
        monkeypatch.setattr(expand, "first_engine", lambda *_, read=read: read)
        assert_compact(log_of(random_scene(seed, law, KINDS), written, tmp_path / "log.npz"), tmp_path / "compact.npz")

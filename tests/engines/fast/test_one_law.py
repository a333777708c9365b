"""Under every law of contacts both engines write one log: begun anew, kicked, resumed, and from its compact form."""

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
from eventsim.scene.stage import stage_of
from tests.engines.law_scenes import LAWS, own, random_scene
from tests.engines.scenes import lattice_gas

pytest.importorskip("numba")

EVENTS = 20 if is_interpreted() else 60


def followed(session, seed, other=None):
    """The rows of a run that is kicked on its way; then it goes on in another session, if one is given."""
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
            session.kick(int(rng.integers(session.stage.n)), *rng.normal(size=2).tolist())
            blocks.append(session.take_rows())
        elif part == 2 and other is not None:
            other.restore(session.snapshot())
            session = other
    return np.concatenate(blocks), stopped, session.reason


def assert_one_log(seed, law):
    stage = stage_of(random_scene(seed, law, None if is_interpreted() else 3))
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
    found = [assert_one_log(seed, law) for seed in range(5 if is_interpreted() else 200)]
    assert sum(found) > 2 * EVENTS * len(found)


@pytest.mark.parametrize("law", LAWS)
def test_a_compact_log_gives_the_rows_of_its_law(law, tmp_path):
    for seed in range(4):
        simulation = es.Simulation(random_scene(seed, law), engine="reference", log=tmp_path / f"{seed}.npz")
        with suppress(es.CollapseError):
            simulation.advance_to(1.0)
            simulation.set_velocity(0, (1.0, -0.5))
            simulation.advance_to(2.0)
        full = simulation.log
        full.save(tmp_path / f"compact{seed}.npz", compact=True)
        again = es.load_log(tmp_path / f"compact{seed}.npz", law=own if full.scene.law else None)
        assert again.digest() == full.digest()

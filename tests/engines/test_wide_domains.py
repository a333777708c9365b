"""Very wide domains: places keep the digits that their coordinates lose, the same ones in both engines and in replay."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import eventsim as es
from eventsim.engines.base import Stop
from eventsim.record.digest import digest_of
from eventsim.replay import expand
from eventsim.replay.expand import expand_rows
from eventsim.replay.replay import Replay
from eventsim.scene.stage import WIDE, stage_of
from tests.engines.scenes import in_far_corner, lattice_gas, rows_of, session_of

SIZE = 2.0**20


def across_the_border(domain, n=30, **options):
    """A gas around the corner of a periodic domain, held by walls: half of its pairs see each other across a border."""
    gas = lattice_gas(n, 0.3, **options)
    half, middle = 0.5 * gas.domain.size[0], SIZE if domain is es.Periodic else 0.5 * SIZE
    place = gas.disks.position - half + (SIZE, middle)
    walls = [es.Polygon([(SIZE + x * half, middle + y * half) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))])]
    disks = replace(gas.disks, position=np.mod(place, SIZE))
    return replace(gas, disks=disks, domain=domain((SIZE, SIZE)), walls=walls)


def among_round_walls():
    """Disks in a container far from the corner, with an arc, a post and tracers."""
    gas = lattice_gas(25, 0.2, masses=(1.0, 3.0, 0.0, 1.0, math.inf))
    far = (SIZE - 30.0, SIZE - 40.0)
    middle = tuple(np.add(far, 0.5 * gas.domain.size[0]))
    still = np.isinf(gas.disks.mass)[:, None]
    disks = replace(
        gas.disks, position=gas.disks.position + far, velocity=np.where(still, 0.0, gas.disks.velocity), radius=0.4
    )
    walls = [
        es.Circle(middle, gas.domain.size[0]),
        es.Arc(*(tuple(np.add(middle, p)) for p in ((-6.0, 3.0), (-6.5, 0.3), (-6.0, -3.0)))),
    ]
    return es.Scene(disks, es.Box((SIZE, SIZE)), walls=walls)


SCENES = {
    "corner": lambda: in_far_corner(lattice_gas(16, 0.3), SIZE),
    "ties": lambda: in_far_corner(lattice_gas(16, 0.3, quantum=0.5), SIZE),
    "uneven": lambda: in_far_corner(lattice_gas(16, 0.3, masses=(1.0, 2.0**20)), SIZE),
    "torus": lambda: across_the_border(es.Periodic),
    "channel": lambda: across_the_border(es.Channel),
    "torus of ties": lambda: across_the_border(es.Periodic, quantum=0.5),
    "cooling": lambda: in_far_corner(lattice_gas(16, 0.3, restitution=0.9, contact_duration=1e-4), SIZE),
    "round walls": among_round_walls,
}
NAME = pytest.mark.parametrize("name", SCENES)
EVENTS = 300


def test_only_very_wide_domains_in_which_nothing_falls_pay_for_it():
    disks = es.Disks([(1.0, 1.0), (3.0, 3.0)], [(1.0, 0.0), (0.0, 0.0)], (0.5, 0.25))
    assert not stage_of(es.Scene(disks, es.Box((WIDE, WIDE)))).low_places
    assert stage_of(es.Scene(disks, es.Box((2.0 * WIDE, 8.0)))).low_places
    assert stage_of(es.Scene(disks, es.Channel((8.0, 2.0 * WIDE)))).low_places
    assert not stage_of(es.Scene(disks, es.Box((2.0 * WIDE, 8.0)), gravity=(0.0, -1.0))).low_places
    assert not stage_of(es.Scene(disks, es.Open())).low_places
    points = es.Disks([(1.0, 1.0), (3.0, 3.0)], [(1.0, 0.0), (0.0, 0.0)], 0.0)
    assert not stage_of(es.Scene(points, es.Box((2.0 * WIDE, 8.0)))).low_places


def test_disks_touch_in_the_far_corner_as_well_as_in_the_near_one():
    run = es.simulate(SCENES["corner"](), events=2000, engine="reference")
    assert run.residuals.max_overlap < 1e-14  # of 2e-11, a last bit of the coordinates, without low parts


@NAME
def test_invariants_hold_after_every_event(name):
    session = session_of(SCENES[name](), check=True)
    session.advance(Stop(None, 100), 10**6)
    assert session.counters.events >= 100


@NAME
def test_stopping_going_on_and_snapshots_change_no_bit(name):
    scene = SCENES[name]()
    whole = rows_of(scene, events=EVENTS)
    session, parts = session_of(scene), []
    for events in range(50, EVENTS + 1, 50):
        session.advance(Stop(None, events), 10**6)
        session.motion()
        parts.append(session.take_rows())
        saved, counters = session.snapshot(), session.counters
        session = session_of(scene)
        session.restore(saved)
        session.counters.copy_from(counters)
    assert np.concatenate(parts)[: len(whole)].tobytes() == whole.tobytes()


@NAME
def test_cells_and_all_pairs_give_the_same_log(name):
    scene = SCENES[name]()
    assert rows_of(scene, events=EVENTS, grid=None).tobytes() == rows_of(scene, events=EVENTS).tobytes()


@NAME
def test_relabelling_changes_no_bit(name):
    scene = SCENES[name]()
    d, order = scene.disks, np.random.default_rng(4).permutation(len(scene.disks))
    other = replace(scene, disks=es.Disks(d.position[order], d.velocity[order], d.radius[order], d.mass[order]))
    one, two = (session_of(each) for each in (scene, other))
    for session in (one, two):
        session.advance(Stop(3.0, None), 10**6)
    assert one.counters.events == two.counters.events > 10
    for mine, theirs in zip(one.motion(), two.motion(), strict=True):
        assert (np.asarray(mine)[order] == np.asarray(theirs)).all()


@NAME
def test_replay_has_the_bits_of_the_engine(name, tmp_path):
    scene = SCENES[name]()
    run = es.simulate(scene, events=EVENTS, engine="reference", log=tmp_path / "full.npz")
    final = Replay(run.log).final()
    assert final.position.tobytes() == run.state.position.tobytes()
    assert final.velocity.tobytes() == run.state.velocity.tobytes()
    compact = es.simulate(scene, events=EVENTS, engine="reference", log=tmp_path / "compact.npz", compact=True).log
    rows = expand_rows(compact.provenance, compact.rows)
    for field in rows.dtype.names:
        assert np.array_equal(rows[field], run.log.rows[field], equal_nan=rows[field].dtype.kind == "f"), field


def test_a_kick_settles_the_place_and_can_be_replayed(tmp_path):
    sim = es.Simulation(SCENES["corner"](), engine="reference")
    sim.advance_to(0.5)
    sim.set_velocity(3, (2.0, -1.0))
    sim.advance_to(1.0)
    final = Replay(sim.log).final()
    assert final.position.tobytes() == sim.state.position.tobytes()


QUICK = ("corner",)
"""The others need kernels of their own, which take seconds to compile."""


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=() if name in QUICK else pytest.mark.slow) for name in SCENES]
)
def test_both_engines_have_one_log_and_kernels_expand_it(name, monkeypatch):
    pytest.importorskip("numba")
    from eventsim.engines.fast.session import FastSession
    from tests.engines.fast.test_same_log import assert_same

    scene = SCENES[name]()
    stage = stage_of(scene)
    assert_same(stage, Stop(None, 1000))
    reference = session_of(scene)
    reference.advance(Stop(None, EVENTS), 10**6)
    fast = FastSession(stage, saved=reference.snapshot())
    fast.counters.copy_from(reference.counters)
    reference.take_rows()
    for session in (reference, fast):
        while session.advance(Stop(None, 2 * EVENTS), 10**6) is None:
            pass
    assert digest_of(fast.take_rows()) == digest_of(reference.take_rows())
    monkeypatch.setattr(expand, "first_engine", lambda *_: "fast")
    log = es.simulate(scene, events=EVENTS, engine="reference", log=True).log
    assert digest_of(expand_rows(log.provenance, log.rows)) == log.digest()

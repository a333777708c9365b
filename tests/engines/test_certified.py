"""Proofs: how many events a bit buys, what is done while they go on, and how long float64 has the order right."""

import math
from dataclasses import replace

import numpy as np
import pytest

import eventsim as es
from eventsim.engines import ENGINES
from eventsim.engines.base import Stop
from eventsim.engines.certified import CertifiedOptions
from eventsim.engines.certified.session import CertifiedSession
from eventsim.errors import EventsimError
from eventsim.record.compare import agreement, deviations
from eventsim.runner.loop import run_session
from eventsim.runner.options import Interrupt, RunOptions
from eventsim.scene.gallery import gallery
from eventsim.scene.stage import stage_of
from eventsim.validation.proof import prove
from tests.engines.proofs import certified
from tests.engines.scenes import in_far_corner, lattice_gas, rows_of


@pytest.mark.parametrize(("n", "least"), [(8, 1000), (16, 1500), (32, 2500)])
def test_1024_bits_prove_as_many_events_as_balls_can(n, least):
    session, stopped = certified(lattice_gas(n, 0.3, seed=3), events=10_000, most_bits=1024)
    assert stopped == "undecided tie"
    assert session.proven >= least


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_ten_thousand_events_are_proven():
    session, stopped = certified(lattice_gas(16, 0.3, seed=1), events=10_000, keep_rows=False)
    assert (stopped, session.proven >= 10_000) == ("events", True)


def test_twice_the_bits_lie_inside_the_balls():
    scene = lattice_gas(8, 0.3, seed=5)
    rough, _ = certified(scene, until=3.0, bits=256, most_bits=256)
    fine, _ = certified(scene, until=3.0, bits=1024)
    assert rough.bits == 256
    motion, true, distances = rough.motion(), fine.motion(), rough.distances()
    allowed = distances + fine.distances()
    for k, name in enumerate(("x", "y", "vx", "vy")):
        assert np.all(np.abs(getattr(motion, name) - getattr(true, name)) <= allowed[:, k])


def test_precision_rises_until_the_digits_are_there():
    session, stopped = certified(lattice_gas(8, 0.3, seed=2), events=300, bits=128)
    assert stopped == "events"
    assert session.bits > 128
    assert [attempt.bits for attempt in session.attempts][:2] == [128, 256]
    proven = [attempt.events for attempt in session.attempts]
    assert proven == sorted(proven)
    assert session.radii().max() < 1e-17
    rows = session.take_rows()
    assert rows["event"].tolist() == list(range(len(rows)))


def test_a_proof_that_is_broken_off_is_that_of_the_attempt_that_came_farthest():
    session = CertifiedSession(stage_of(lattice_gas(8, 0.3, seed=2)), options=CertifiedOptions(bits=128))
    rows = []
    while len(session.attempts) < 2 or session.counters.events > 100:
        assert session.advance(Stop(None, 10_000), 200) is None
        rows.append(session.take_rows())
    farthest, present = session.attempts[-1], session.counters.events
    assert present < farthest.events
    session.break_off()
    rows.append(session.take_rows())
    assert (session.bits, session.proven, session.counters.events) == (farthest.bits, farthest.events, farthest.events)
    assert np.concatenate(rows)["event"].tolist() == list(range(farthest.events))
    assert session.attempts[-1] == (2 * farthest.bits, False, present)
    assert farthest not in session.attempts
    assert np.isfinite(session.distances()).all()


def test_an_interrupted_run_takes_the_rows_that_were_held_back():
    scene = lattice_gas(8, 0.3, seed=2)
    session = CertifiedSession(stage_of(scene), options=CertifiedOptions(bits=128))

    def ask(share, events, time):
        if session.attempts and not interrupted:
            interrupted.append(session.attempts[0].events)
            interrupt.ask()

    interrupted, interrupt = [], Interrupt()
    wanted = RunOptions(log=True, progress=ask, interrupt=interrupt)
    run = run_session(session, ENGINES["certified"], scene, Stop(None, 10_000), wanted)
    assert run.stopped == "interrupted"
    assert len(run.recorded.rows) == run.counters.events >= interrupted[0]


def first_difference(scene, events=600):
    """(event at which float64 leaves the true order, deviations up to there)."""
    session, stopped = certified(scene, events=events)
    assert stopped == "events"
    true = session.take_rows()
    plain = rows_of(scene, events=events + 64)
    common = agreement(true, plain)
    assert common.difference is not None
    return common.difference, deviations(true, plain, common.pairs)


def on_a_grid(scene, shift, **changes):
    """The scene on the grid that floats have around a shift, in a box there: what its positions lose is lost at the start."""
    position = (scene.disks.position + shift) - shift
    box = es.Box(scene.domain.size, origin=(shift, shift))
    return replace(scene, disks=replace(scene.disks, position=position + shift), domain=box, **changes)


WIDE = 1e6  # diameters
PLACES = {
    "box at 0": lambda scene: scene,
    "box at 2^20, clock at 2^30": lambda scene: on_a_grid(scene, 2.0**20, start_time=2.0**30),
    **{
        f"corner {corner} of a wide box": lambda scene, corner=corner: in_far_corner(scene, WIDE, corner)
        for corner in ((0, 0), (0, 1), (1, 0), (1, 1))
    },
}


QUICK = "box at 0", "box at 2^20, clock at 2^30", "corner (1, 1) of a wide box"


@pytest.mark.parametrize(
    ("place", "seeds"),
    [(place, range(2 if "corner" in place else 4)) for place in QUICK]
    + [pytest.param(place, range(24), marks=pytest.mark.slow) for place in PLACES],
)
def test_float64_follows_the_true_order_for_330_events_and_for_200_at_a_million_diameters(place, seeds):
    found = [first_difference(PLACES[place](lattice_gas(16, 0.3, seed=seed))) for seed in seeds]
    events = np.array([event for event, _ in found])
    error = events.std(ddof=1) / math.sqrt(len(events))
    print(f"{place}: first difference at event {events.mean():.0f} +- {error:.0f}, {len(events)} seeds")
    # coordinates of 2^20 diameters lack 20 bits of a gap, at 0.133 bits an event
    far = place.startswith("corner") and place != "corner (0, 0) of a wide box"
    assert events.mean() - error >= (200 if far else 330)
    if place != "box at 0":
        return  # coordinates in a row are rounded to the last bit of a million
    for event, deviation in found:
        # 0.133 bits an event (REFERENCES: time reversal), from 2**-50; a few bits for the luck of single seeds
        bound = 2.0 ** (-50 + 0.133 * np.arange(len(deviation)) + 14)
        assert np.all(deviation <= np.maximum(bound, 2.0**-40)), event


def test_what_cannot_be_proven_is_refused():
    session = CertifiedSession(stage_of(gallery("two-disks")))
    with pytest.raises(EventsimError, match="kicks"):
        session.kick(0, 1.0, 0.0)
    with pytest.raises(EventsimError, match="snapshots"):
        session.snapshot()


def test_the_engine_is_one_of_all_engines():
    scene = gallery("two-disks")
    run = es.simulate(scene, engine="certified", log=True)
    plain = es.simulate(scene, engine="reference", log=True)
    assert run.engine == "certified"
    assert run.digest == plain.digest


def test_a_compact_log_of_it_is_refused(tmp_path):
    with pytest.raises(EventsimError, match="full"):
        es.simulate(gallery("two-disks"), engine="certified", log=tmp_path / "log.npz", compact=True)
    assert not list(tmp_path.iterdir())


def test_a_proof_says_where_float64_leaves_it():
    proof = prove(lattice_gas(8, 0.3, seed=1), Stop(None, 350))
    assert proof.proven >= 350
    assert proof.float64.difference == proof.float64.agreed
    assert 100 < proof.float64.difference < 350
    assert (proof.float64.stopped, proof.float64.reason) == (None, None)
    assert proof.enclosures.max() < 1e-14

"""Proofs on balls: how many events a bit buys, ties, and what float64 has right."""

import math
import signal
from dataclasses import replace
from fractions import Fraction
from time import process_time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import eventsim as es
from eventsim.engines.base import Stop
from eventsim.engines.certified import CertifiedSession
from eventsim.engines.certified.ball import Undecided, ball, traced
from eventsim.engines.certified.proof import prove
from eventsim.engines.drive import Wishes, drive
from eventsim.errors import EventsimError
from eventsim.record.compare import agreement, deviations
from eventsim.scene.gallery import gallery
from eventsim.scene.stage import stage_of
from tests.engines.scenes import in_far_corner, lattice_gas, rows_of

NUMBERS = st.fractions(-100, 100, max_denominator=1000)


def certified(scene, events=None, until=None, **options):
    """(session, reason to stop) of a certified run."""
    session = CertifiedSession(stage_of(scene), **options)
    stopped = None
    while stopped is None:
        stopped = session.advance(Stop(until, events), 1 << 62)
    return session, stopped


def line(x, v, **scene):
    """Disks of diameter 1 on a line, at x plus one diameter each."""
    n = len(x)
    return es.Scene(
        disks=es.Disks(np.column_stack([np.add(x, range(n)), np.zeros(n)]), [(u, 0.0) for u in v], 0.5),
        domain=es.Open(),
        **scene,
    )


@settings(max_examples=60, deadline=None)
@given(NUMBERS, NUMBERS, st.sampled_from(["+", "-", "*", "/"]))
def test_traced_numbers_are_the_rational_numbers_that_they_stand_for(a, b, operation):
    one, other = traced(float(a)), traced(float(b))
    a, b = Fraction(float(a)), Fraction(float(b))
    if operation == "/" and b == 0:
        return
    number = {"+": lambda: one + other, "-": lambda: one - other, "*": lambda: one * other, "/": lambda: one / other}
    true = {"+": lambda: a + b, "-": lambda: a - b, "*": lambda: a * b, "/": lambda: a / b}
    result, exact = number[operation](), true[operation]()
    assert result.rational == exact
    assert (result < 1.0) == (exact < 1)
    assert (result == other) == (exact == b)


def test_equal_expressions_are_equal_and_others_undecided():
    root2, root3 = traced(2.0).sqrt(), traced(3.0).sqrt()
    assert root2 * root3 == root3 * root2
    assert root2 - root3 == -(root3 - root2)
    assert (root2 + 1.0) - root3 == 1.0 + root2 - root3
    assert root2 - root2 == 0.0
    assert not root2 < root2
    with pytest.raises(Undecided):
        bool(root2 * root3 == traced(6.0).sqrt())


def test_balls_answer_or_raise():
    third = ball(1.0) / 3.0
    assert third < 0.5
    assert third > 0.25
    assert third <= third
    with pytest.raises(Undecided):
        bool(third * 3.0 < 1.0)
    with pytest.raises(TypeError):
        hash(third)


@pytest.mark.parametrize(("n", "least", "cost"), [(8, 1000, 0.2), (16, 1500, 0.2), (32, 2500, 0.4)])
def test_1024_bits_prove_as_many_events_as_balls_can(n, least, cost):
    began = process_time()
    session, stopped = certified(lattice_gas(n, 0.3, seed=3), events=10_000, most_bits=1024)
    each = (process_time() - began) / session.proven * 1e3
    assert stopped == "undecided tie"
    assert session.proven >= least
    assert each < 4.0 * cost  # milliseconds; idle it is below cost, other work on the machine may share the caches


@pytest.mark.slow
def test_ten_thousand_events_are_proven_in_two_minutes():
    began = process_time()
    session, stopped = certified(lattice_gas(16, 0.3, seed=1), events=10_000, keep_rows=False)
    assert (stopped, session.proven >= 10_000) == ("events", True)
    assert process_time() - began < 120.0


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
    session = CertifiedSession(stage_of(lattice_gas(8, 0.3, seed=2)), bits=128)
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
    session = CertifiedSession(stage_of(scene), bits=128)

    def interrupt(share, events, time):
        if session.attempts and not interrupted:
            interrupted.append(session.attempts[0].events)
            signal.raise_signal(signal.SIGINT)

    interrupted = []
    run = drive(session, "certified", scene, Stop(None, 10_000), Wishes(log=True, progress=interrupt))
    assert run.stopped == "interrupted"
    assert len(run.log) == run.counters.events >= interrupted[0]


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


@pytest.mark.parametrize("seeds", [range(4), pytest.param(range(24), marks=pytest.mark.slow)])
@pytest.mark.parametrize("place", PLACES)
def test_float64_follows_the_true_order_for_330_events(place, seeds):
    found = [first_difference(PLACES[place](lattice_gas(16, 0.3, seed=seed))) for seed in seeds]
    events = np.array([event for event, _ in found])
    error = events.std(ddof=1) / math.sqrt(len(events))
    print(f"{place}: first difference at event {events.mean():.0f} +- {error:.0f}, {len(events)} seeds")
    assert events.mean() - error >= 330
    if place != "box at 0":
        return  # coordinates in a row are rounded to the last bit of a million
    for event, deviation in found:
        # 0.133 bits an event (REFERENCES: time reversal), from 2**-50; a few bits for the luck of single seeds
        bound = 2.0 ** (-50 + 0.133 * np.arange(len(deviation)) + 14)
        assert np.all(deviation <= np.maximum(bound, 2.0**-40)), event


@pytest.mark.parametrize("k", [20, 40, 52])
@pytest.mark.parametrize("sign", [1, -1])
def test_the_sign_of_the_smallest_gap_decides(k, sign):
    eps = sign * 2.0**-k
    scene = es.Scene(
        disks=es.Disks(
            [(0.0, 0.0), (0.5, 0.0), (1.0 + eps, 0.0)], [(1.0, 0.0), (0.0, 0.0), (-1.0, 0.0)], 0.125, (1.0, 3.0, 1.0)
        ),
        domain=es.Open(),
    )
    session, stopped = certified(scene, until=10.0)
    expected = (-0.5, -0.25, 1.25) if sign > 0 else (-1.25, 0.25, 0.5)
    assert stopped in ("until", "quiet")
    assert session.motion().vx.tolist() == list(expected)


@pytest.mark.parametrize(("e", "events"), [(0.08, 11), (0.0719, 89), (0.0718, 504)])
def test_a_chain_that_just_does_not_collapse_is_counted(e, events):
    session, stopped = certified(
        line((-1.0, 0.0, 2.0), (1.0, 0.0, -1.0), restitution=es.Restitution(e, 1.0)), until=100.0
    )
    assert (stopped, session.proven) == ("quiet", events)


@pytest.mark.parametrize(("e", "time"), [(0.05, 12.0 / 7.0), (0.0717, 1.78303658286)])
def test_a_collapse_is_told(e, time):
    """The times from 900 decimal digits; the second restitution is just below the limit 7 - 4 sqrt 3 of a collapse."""
    scene = line((-1.0, 0.0, 2.0), (1.0, 0.0, -1.0), restitution=es.Restitution(e, 1.0))
    session, stopped = certified(scene, until=100.0)
    assert stopped == "collapse"
    assert "collapse" in session.reason
    epoch, remainder = session.clock
    assert epoch * session.stage.epoch_length + remainder == pytest.approx(time, abs=1e-11)


@pytest.mark.parametrize("name", ["corner", "newton-cradle", "tie", "two-disks"])
def test_ties_of_rational_flights_are_decided(name):
    scene = gallery(name)
    session, stopped = certified(scene, until=scene.until)
    assert stopped in ("until", "quiet")
    found = rows_of(scene, until=scene.until)
    assert len(agreement(session.take_rows(), found).pairs) == len(found)


def test_ties_of_equal_expressions_are_decided():
    position = [(0.0, 0.0), (4.0, 0.25), (0.0, 8.0), (4.0, 7.75)]
    scene = es.Scene(disks=es.Disks(position, [(1.0, 0.0), (-1.0, 0.0)] * 2, 0.5), domain=es.Open())
    session, stopped = certified(scene, until=10.0)
    assert (stopped, session.traced) == ("quiet", True)
    rows = session.take_rows()
    assert rows["a"].tolist()[:2] == [0, 2]
    assert rows["remainder"][0] == rows["remainder"][1]
    assert rows["vya"][0] == -rows["vya"][1]


def test_a_tie_that_nothing_decides_is_said_to_be_one():
    """Two pairs meet after the same time, which their own formulas write differently: by sqrt(3)/2, and by sqrt(12)/4."""
    scene = es.Scene(
        disks=es.Disks(
            [(0.0, 0.0), (4.0, 0.5), (0.0, 9.0), (8.0, 10.0)],
            [(1.0, 0.0), (0.0, 0.0), (2.0, 0.0), (0.0, 0.0)],
            (0.5, 0.5, 1.0, 1.0),
        ),
        domain=es.Open(),
    )
    session, stopped = certified(scene, until=10.0)
    assert (stopped, session.proven) == ("undecided tie", 0)
    assert session.bits <= 4096
    assert "more bits do not help" in session.reason


def test_what_cannot_be_proven_is_refused():
    with pytest.raises(EventsimError, match="quartic"):
        CertifiedSession(stage_of(gallery("funnel")))
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
    assert proof.difference == proof.agreed
    assert 100 < proof.difference < 350
    assert proof.enclosures.max() < 1e-14

"""What only a proof can say: which gap is the smallest, how many contacts there are, which ties are ones."""

import warnings
from dataclasses import replace

import numpy as np
import pytest

import eventsim as es
from eventsim.record.compare import agreement
from eventsim.scene.gallery import gallery
from tests.engines.proofs import certified, line
from tests.engines.scenes import lattice_gas, rows_of


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


@pytest.mark.parametrize("k", [-245, -120, 120, 245])
def test_the_proof_is_the_same_at_the_ends_of_the_range_of_speeds(k):
    """The proof at any speed is that at speeds of about 1, and nobody warns."""
    scene = lattice_gas(8, 0.3, seed=1)
    fast = replace(scene, disks=replace(scene.disks, velocity=np.ldexp(scene.disks.velocity, k)))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rows, found = (certified(each, events=60)[0].take_rows() for each in (scene, fast))
    for name in ("kind", "a", "b", "xa", "ya"):
        assert found[name].tolist() == rows[name].tolist()
    assert found["vxa"].tolist() == np.ldexp(rows["vxa"], k).tolist()


@pytest.mark.parametrize(("treatment", "speed"), [({"shaking": 0.5}, 2.0), ({"velocity": 3.0}, 1.0)])
def test_what_walls_that_shake_and_slide_give_is_exact(treatment, speed):
    """A wall that comes at .5 gives twice that; a smooth one that slides gives nothing."""
    scene = es.Scene(
        es.Disks([(2.0, 2.0)], [(-1.0, 0.25)], 0.5), es.Box((4.0, 8.0), walls={"left": treatment})
    )
    session, stopped = certified(scene, until=2.0)
    motion = session.motion()
    assert (stopped, motion.vx.tolist(), motion.vy.tolist()) == ("until", [speed], [0.25])


@pytest.mark.parametrize("name", ["heat-flow", "sheared", pytest.param("vibrated", marks=pytest.mark.slow)])
def test_gases_that_walls_drive_are_proven(name):
    """In the order of the reference engine, which takes the same formulas through floats."""
    session, stopped = certified(gallery(name), events=60)
    assert stopped == "events"
    assert len(agreement(session.take_rows(), rows_of(gallery(name), events=60)).pairs) == 60

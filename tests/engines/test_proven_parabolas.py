"""Proofs under gravity: parabolas against round things, rest, and disks that fall onto others that rest."""

import math

import numpy as np
import pytest

import eventsim as es
from eventsim.engines.base import Stop
from eventsim.errors import EventsimError
from eventsim.record.compare import agreement
from eventsim.scene.gallery import gallery
from eventsim.validation.proof import prove
from tests.engines.proofs import certified
from tests.engines.scenes import rows_of


@pytest.mark.parametrize("side", [1, -1])
def test_a_fall_onto_a_round_wall_comes_when_it_must(side):
    """Straight down on a post of radius 1, a way of 3, or to the bottom of a container of radius 5."""
    if side > 0:
        scene = es.Scene(
            es.Disks([(0.0, 5.0), (0.0, 0.0)], [(0.0, 0.0)] * 2, [1.0, 1.0], [1.0, math.inf]),
            es.Open(),
            gravity=(0.0, -1.0),
        )
    else:
        jar = es.Circle((0.0, 1.0), 5.0)
        scene = es.Scene(es.Disks([(0.0, 0.0)], [(0.0, 0.0)], 1.0), es.Open(), walls=[jar], gravity=(0.0, -1.0))
    session, stopped = certified(scene, events=3)
    assert stopped == "events"
    rows = session.take_rows()
    times = rows["epoch"] * session.stage.epoch_length + rows["remainder"]
    assert times == pytest.approx(math.sqrt(6.0) * np.array([1.0, 3.0, 5.0]), rel=1e-15)
    assert session.distances().max() < 1e-14


@pytest.mark.parametrize("name", ["jar", "funnel", pytest.param("sculpture", marks=pytest.mark.slow)])
@pytest.mark.parametrize("events", [40, pytest.param(1000, marks=pytest.mark.slow)])
def test_scenes_of_round_things_and_gravity_are_proven(name, events):
    proof = prove(gallery(name), Stop(None, events))
    assert (proof.run.stopped, proof.proven) == ("events", events)
    assert proof.float64.difference is None or proof.float64.difference > 300
    assert proof.float64.deviation < 1e-3 or events > 300


def test_a_disk_that_falls_straight_down_leaves_a_slope_of_45_degrees_along_an_axis():
    """Its speed across that axis is 0, and known to be."""
    slope = es.Segment((0.0, 4.0), (4.0, 0.0))
    scene = es.Scene(
        es.Disks([(2.0, 6.0)], [(0.0, 0.0)], 0.25), es.Box((20.0, 20.0)), walls=[slope], gravity=(0.0, -1.0)
    )
    session, stopped = certified(scene, events=2)
    assert (stopped, session.traced) == ("events", True)
    assert session.take_rows()["vya"][0] == 0.0


def test_rest_and_a_fall_onto_what_rests_are_proven():
    """A disk has come to rest at its Zeno time, 3 v / a from e = 1/2, when another one falls past the end of a shelf onto it."""
    shelf = es.Segment((0.0, 4.0), (3.0, 4.0))
    scene = es.Scene(
        es.Disks([(4.0, 1.0), (2.0, 4.5)], [(0.0, 0.0), (0.125, 0.0)], 0.5),
        es.Box((8.0, 8.0)),
        walls=[shelf],
        gravity=(0.0, -1.0),
        restitution=0.5,
    )
    session, stopped = certified(scene, until=20.0)
    rows = session.take_rows()
    plain = rows_of(scene, until=20.0)
    assert stopped in ("until", "collapse", "digits")
    assert (rows["kind"] == 2).any()
    assert len(agreement(rows, plain).pairs) >= min(len(rows), len(plain)) - 2


def test_points_that_fall_onto_walls_are_refused():
    walls = [es.Segment((0.0, 4.0), (2.0, 2.0)), es.Segment((2.0, 2.0), (4.0, 4.0))]
    scene = es.Scene(es.Disks([(0.5, 5.0)], radius=0.0), es.Box((5.0, 8.0)), walls=walls, gravity=(0.0, -1.0))
    with pytest.raises(EventsimError, match="give the disks a radius"):
        certified(scene, events=3)

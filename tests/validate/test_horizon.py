"""The horizon of float64, against the first event at which float64 leaves the proven order."""

import math

import pytest

import eventsim as es
from eventsim.engines.base import Stop
from eventsim.engines.certified.session import CertifiedSession
from eventsim.record.compare import agreement
from eventsim.scene.gallery import gallery
from eventsim.scene.stage import stage_of
from eventsim.validation.proof import prove
from eventsim.validation.shadows import horizon
from tests.engines.scenes import in_far_corner, lattice_gas, rows_of

SHAPES = ((8, 0.2), (16, 0.3), (24, 0.4), (16, 0.5), (12, 0.1))


def true_difference(scene, events):
    session = CertifiedSession(stage_of(scene))
    while session.advance(Stop(None, events), 1 << 62) is None:
        pass
    return agreement(session.take_rows(), rows_of(scene, events=events + 100)).difference


@pytest.mark.parametrize("seeds", [range(1), pytest.param(range(10), marks=pytest.mark.slow)])
@pytest.mark.parametrize(("n", "eta"), SHAPES)
def test_the_horizon_is_neither_late_nor_half(n, eta, seeds):
    for seed in seeds:
        scene = lattice_gas(n, eta, seed=seed)
        true, told = true_difference(scene, 60 * n), horizon(scene, Stop(None, 100 * n))
        assert true is not None
        assert told.event is not None
        print(f"n = {n}, eta = {eta}, seed {seed}: true {true}, told {told.event}")
        assert 0.5 * true <= told.event <= 1.1 * true


@pytest.mark.parametrize("seeds", [range(1), pytest.param(range(10), marks=pytest.mark.slow)])
def test_in_a_wide_box_it_is_neither(seeds):
    for seed in seeds:
        scene = in_far_corner(lattice_gas(16, 0.3, seed=seed), 1e6)
        true, told = true_difference(scene, 600), horizon(scene, Stop(None, 1600))
        print(f"far corner, seed {seed}: true {true}, told {told.event}")
        assert 0.5 * true <= told.event <= 1.1 * true


def test_the_horizon_has_the_time_of_its_event():
    scene = lattice_gas(16, 0.3, seed=1)
    told = horizon(scene, Stop(None, 1000))
    assert told.time == rows_of(scene, events=1000)["time"][told.event]


def test_the_horizon_tells_how_far_apart_the_times_of_matched_contacts_are():
    """Last bits of places of about 1, which every contact of a disk amplifies until the order of contacts is another one."""
    scene = lattice_gas(16, 0.3, seed=1)
    few, more, all_of_them = (horizon(scene, Stop(None, events)) for events in (2, 150, 1000))
    assert 0.0 < few.apart < 1e-14
    assert few.apart < 1e-3 * more.apart
    assert more.apart < 1e-3 * all_of_them.apart
    assert all_of_them.apart < all_of_them.time


def test_what_falls_from_rest_has_a_horizon():
    """Nothing moves at the start, so shadows are told apart by the last bits of contacts alone."""
    scene = gallery("sculpture")
    told = horizon(scene, Stop(scene.until, 400))
    assert told.event is not None
    assert told.event > 100


def test_a_run_that_ends_before_has_no_horizon():
    told = horizon(lattice_gas(16, 0.3, seed=1), Stop(None, 100))
    assert (told.event, told.time) == (None, None)
    assert told.events >= 100
    scene = gallery("two-disks")
    assert horizon(scene, Stop(scene.until, None)).event is None


def test_the_horizon_is_the_same_twice():
    scene = lattice_gas(8, 0.3, seed=4)
    assert horizon(scene, Stop(None, 500)) == horizon(scene, Stop(None, 500))


def test_near_ties_up_to_the_horizon_are_counted():
    """A disk between two others that come from both sides, a last bit apart: the shadows part there."""
    disks = es.Disks([(-3.0, 0.0), (0.0, 0.0), (math.nextafter(3.0, 4.0), 0.0)], [(1.0, 0.0), (0.0, 0.0), (-1.0, 0.0)], 0.5)
    scene = es.Scene(disks, es.Open(), until=10.0)
    assert horizon(scene, Stop(10.0, None)).near_ties == 1
    assert prove(scene, Stop(10.0, None)).float64.near_ties == 1
    assert horizon(lattice_gas(16, 0.3, seed=1), Stop(None, 100)).near_ties == 0

"""Near ties: found where rounding parts two contacts that share a disk, and nowhere else."""

import math
from dataclasses import replace

import pytest

import eventsim as es
from eventsim.scene.gallery import gallery, names
from eventsim.validation import near_ties as module
from eventsim.validation.near_ties import near_ties
from tests.engines.scenes import lattice_gas

LAST_BIT = math.ulp(3.0)
"""Of a coordinate below."""


def one_between_two(shift):
    """A disk that rests between two others, which reach it from both sides at about time 2."""
    disks = es.Disks([(-3.0, 0.0), (0.0, 0.0), (3.0 + shift, 0.0)], [(1.0, 0.0), (0.0, 0.0), (-1.0, 0.0)], 0.5)
    return es.Scene(disks, es.Open(), until=10.0)


@pytest.mark.parametrize("ulps", [2, 4])
def test_contacts_a_few_last_bits_apart_are_found(ulps):
    (tie,) = near_ties(one_between_two(ulps * LAST_BIT))
    assert (tie.first, tie.second, tie.time) == ((0, 1), (1, 2), 2.0)
    assert tie.apart == ulps * LAST_BIT


@pytest.mark.parametrize("ulps", [0, 64, 2**40])
def test_exact_ties_and_contacts_apart_are_not(ulps):
    assert near_ties(one_between_two(ulps * LAST_BIT)) == ()


def test_times_are_on_the_clock_of_the_scene():
    scene = replace(one_between_two(LAST_BIT), start_time=100.0, until=110.0)
    (tie,) = near_ties(scene)
    assert tie.time == 102.0


def test_a_tie_behind_the_first_contact_is_found():
    """A cue reaches disk 1, which then runs between two others, whose places differ by a last bit."""
    up = math.nextafter(4.0, 5.0)
    disks = es.Disks([(-3.0, 0.0), (0.0, 0.0), (4.0, 0.75), (up, -0.75)], [(1.0, 0.0)] + [(0.0, 0.0)] * 3, 0.5)
    ties = near_ties(es.Scene(disks, es.Open(), until=20.0))
    assert (ties[0].first, ties[0].second) == ((1, 2), (1, 3))


def test_a_wall_takes_part_and_is_named():
    """Disk 1 comes down on disk 0 at time 2, an ulp before this one reaches a plate."""
    x = math.nextafter(2.5, 3.0)
    plate = es.Segment((x, -1.0), (x, 0.25), name="plate")
    disks = es.Disks([(0.0, 0.0), (2.0, 3.0)], [(1.0, 0.0), (0.0, -1.0)], 0.5)
    (tie,) = near_ties(es.Scene(disks, es.Open(), walls=[plate], until=9.0))
    assert (tie.first, tie.second) == ((0, 1), (0, "plate"))


def test_the_walls_of_a_corner_may_be_met_in_any_order():
    disks = es.Disks([(2.0, math.nextafter(2.0, 3.0))], [(-1.0, -1.0)], 0.5)
    assert near_ties(es.Scene(disks, es.Box((8.0, 8.0)), until=9.0)) == ()


def test_no_scene_of_the_gallery_hangs_on_a_last_bit():
    assert [name for name in names() if near_ties(gallery(name))] == []


def test_chance_makes_no_ties():
    assert near_ties(lattice_gas(100, 0.3, seed=1)) == ()


def test_large_scenes_are_not_looked_at(monkeypatch):
    monkeypatch.setattr(module, "MOST_DISKS", 2)
    assert near_ties(one_between_two(LAST_BIT)) is None


def test_walls_inside_the_domain_are_told_by_their_names():
    """A disk comes down between two walls, and meets the second one a last bit later."""
    walls = [es.Segment((0.0, 0.7), (3.0, 0.0), name="left-hand"), es.Segment((3.0, 0.0), (6.0, 0.7), name="right-hand")]
    disks = es.Disks([(3.0 - 2.0**-51, 0.5636958593624257)], [(0.0, -1.0)], 0.5)
    (tie,) = near_ties(es.Scene(disks, es.Box((6.0, 8.0)), walls, until=0.1))
    assert {tie.first[1], tie.second[1]} == {"left-hand", "right-hand"}

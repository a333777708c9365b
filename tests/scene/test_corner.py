"""Where places are counted from on the open plane."""

from __future__ import annotations

import numpy as np
import pytest

import eventsim as es
from eventsim.scene.corner import FAR, corner_of
from eventsim.scene.stage import stage_of
from eventsim.scene.walls import parts_of


def corner(places: list[tuple[float, float]], radius: float = 0.5, walls: tuple[es.Segment | es.Circle, ...] = ()) -> tuple:
    scene = es.Scene(es.Disks(places, radius=radius), es.Open(), walls=walls)
    assert stage_of(scene).corner == corner_of(scene.disks, scene.domain, parts_of(walls))
    return stage_of(scene).corner


@pytest.mark.parametrize(
    ("places", "expected"),
    [
        ([(0.0, 0.0)], (0.0, 0.0)),
        ([(8.0, 0.0)], (0.0, 0.0)),
        ([(-8.25, 3.0)], (-8.0, 0.0)),
        ([(8.5, 0.0)], (9.0, 0.0)),
        ([(-8.5, 0.0)], (-9.0, 0.0)),
        ([(1000.0, 2000.0), (1003.0, 2000.5)], (1000.0, 2000.0)),
        ([(1000.0, 3.0), (1003.0, 3.0)], (1000.0, 0.0)),
    ],
)
def test_ordinary_scenes_have_their_own_coordinates(places, expected) -> None:
    """The unit is 1 for a lone disk of radius 1/2, and 4 for two of them 3 apart; ties go away from 0."""
    assert corner(places) == expected


def test_points_of_walls_count_and_circles_with_their_radius() -> None:
    assert corner([(20.0, 0.0)], 0.5, (es.Segment((-20.0, 5.0), (20.5, 5.0)),)) == (0.0, 0.0)
    assert corner([(20.0, 0.0)], 0.5, (es.Circle((20.0, 0.0), 2.0),)) == (0.0, 0.0)
    assert corner([(40.0, 0.0)], 0.5, (es.Circle((40.0, 0.0), 2.0),)) == (40.0, 0.0)


def test_a_lone_point_has_the_unit_1() -> None:
    assert corner([(0.5, 9.5)], 0.0) == (0.0, 10.0)


@pytest.mark.parametrize("steps", [(9, -12), (1000, 2**20), (-(2**30), 17)])
def test_a_far_scene_moves_with_its_corner(steps: tuple[int, int]) -> None:
    """By multiples of the unit, without rounding, beyond FAR of them before and after: the same stage, and the same log."""
    rng, unit = np.random.default_rng(3), 8.0
    places = np.round(rng.uniform(0.0, 5.0, (6, 2)) * 2**12) / 2**12 + np.array([20.0, 30.0]) * unit
    inward = np.round((places.mean(axis=0) - places) * 2**8) / 2**8
    spread = es.Disks(places, inward, 0.125)
    moved = es.Disks(places + np.array(steps) * unit * 64, spread.velocity, 0.125)
    runs = [es.simulate(es.Scene(disks, es.Open()), until=40.0, engine="reference", log=True) for disks in (spread, moved)]
    assert FAR * unit < np.abs(np.array(stage_of(runs[0].scene).corner)).min()
    assert runs[0].log.digest() == runs[1].log.digest()
    assert len(runs[0].log) > 0


def test_a_domain_has_its_origin() -> None:
    scene = es.Scene(es.Disks([(105.0, 205.0)], radius=0.5), es.Box((10.0, 10.0), origin=(100.0, 200.0)))
    assert stage_of(scene).corner == (100.0, 200.0)

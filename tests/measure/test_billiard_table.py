"""Area and perimeter of what a centre sees, against closed forms and against darts."""

import math

import numpy as np
import pytest

import eventsim as es
from eventsim.measure.billiard_table import _Reach, table_of


def scene_with(walls, domain=None, radius=0.0, place=(0.5, 0.3), posts=()):
    disks = es.Disks(
        [place, *(p for p, _ in posts)], radius=[radius, *(r for _, r in posts)], mass=[1.0, *(math.inf for _ in posts)]
    )
    return es.Scene(disks, domain or es.Open(), walls=walls)


def table(scene):
    return table_of(scene, float(scene.disks.radius[0]), scene.disks.position[:1])


TRIANGLE = es.Polygon(((0.0, 0.0), (1.0, 0.0), (0.5, 0.8)))
ARC = es.Arc((0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))


def test_a_triangle_shrinks_along_its_bisectors():
    area, perimeter = 0.4, 1.0 + 2.0 * math.hypot(0.5, 0.8)
    assert table(scene_with([TRIANGLE])) == pytest.approx((area, perimeter), rel=1e-12)
    inner = 1.0 - 0.05 * perimeter / (2.0 * area)  # similar: the distance to all sides is the share of the incircle's radius
    assert table(scene_with([TRIANGLE], radius=0.05)) == pytest.approx((area * inner**2, perimeter * inner), rel=1e-9)


def test_outside_of_a_triangle_corners_are_round():
    box = es.Box((4.0, 4.0), origin=(-2.0, -2.0))
    seen = table(scene_with([TRIANGLE], box, radius=0.05, place=(0.5, -0.5)))
    perimeter = 1.0 + 2.0 * math.hypot(0.5, 0.8)
    kept = 0.4 + 0.05 * perimeter + math.pi * 0.05**2
    assert seen == pytest.approx((3.9**2 - kept, 4 * 3.9 + perimeter + 2.0 * math.pi * 0.05), rel=1e-9)


def test_a_segment_has_two_sides_and_two_ends():
    wall = es.Segment((0.3, 0.6), (0.7, 0.6))
    assert table(scene_with([wall], es.Box((1.0, 1.0)))) == pytest.approx((1.0, 4.8), rel=1e-12)
    seen = table(scene_with([wall], es.Box((1.0, 1.0)), radius=0.1))
    assert seen == pytest.approx((0.64 - 0.08 - 0.01 * math.pi, 3.2 + 0.8 + 0.2 * math.pi), rel=1e-8)


def test_a_wall_across_leaves_the_half_that_one_is_in():
    wall = es.Segment((1.0, 0.0), (1.0, 1.0))
    assert table(scene_with([wall], es.Box((2.0, 1.0)), radius=0.1)) == pytest.approx((0.64, 3.2), rel=1e-9)


def test_posts_that_overlap_their_images_and_each_other():
    posts = [((0.02, 0.5), 0.2), ((0.3, 0.5), 0.15), ((0.98, 0.98), 0.1)]
    scene = scene_with([], es.Periodic((1.0, 1.0)), radius=0.01, posts=posts)
    seen, reach = table(scene), _Reach(scene, 0.01)
    darts = np.random.default_rng(1).random((20_000, 2))
    share = np.mean([reach.free(x, y) for x, y in darts.tolist()])
    assert seen.area == pytest.approx(share, abs=4.0 * math.sqrt(share * (1.0 - share) / len(darts)))


def test_half_circles_of_either_sense_are_one_table():
    other = es.Arc((1.0, -1.0), (2.0, 0.0), (1.0, 1.0))
    sides = [es.Segment((0.0, -1.0), (1.0, -1.0)), es.Segment((1.0, 1.0), (0.0, 1.0))]
    for arc in (ARC, es.Arc(ARC.end, ARC.through, ARC.start)):
        assert table(scene_with([arc, other, *sides])) == pytest.approx((math.pi + 2.0, 2.0 * math.pi + 2.0), rel=1e-12)


@pytest.mark.parametrize("walls", [[], [ARC], [es.Polyline(((0.0, 0.0), (1.0, 0.0), (0.5, 0.8), (0.0, 0.1)))]])
def test_the_open_plane_is_no_table(walls):
    assert table(scene_with(walls)) is None


def test_a_gap_narrower_than_the_disk_closes_the_table():
    walls = [es.Polyline(((0.0, 0.0), (1.0, 0.0), (0.5, 0.8), (0.0, 0.1)))]
    assert table(scene_with(walls, radius=0.06)) is not None

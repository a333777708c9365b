"""Lines of walls and domains, and images across periodic boundaries."""

import math

import numpy as np
import pytest

import eventsim as es
from eventsim.show.images import disks_with_images, lines_with_images
from eventsim.show.outlines import boundary_lines, wall_lines

HALF = math.sqrt(0.5)


def scene(domain, *walls, position=((5.0, 5.0),)):
    return es.Scene(es.Disks(position, radius=0.5), domain, walls)


@pytest.mark.parametrize(
    ("through", "inside"),
    [((1.0, 1.0), lambda p: p[:, 1] >= -1e-15), ((1.0, -1.0), lambda p: p[:, 1] <= 1e-15)],
)
def test_an_arc_passes_through_its_middle_point(through, inside):
    (line,) = wall_lines(scene(es.Open(), es.Arc((0.0, 0.0), through, (2.0, 0.0))))
    assert np.allclose(np.hypot(line[:, 0] - 1.0, line[:, 1]), 1.0, rtol=0, atol=1e-15)
    assert inside(line).all()
    assert np.allclose(line[[0, -1]], [(0.0, 0.0), (2.0, 0.0)], atol=1e-15)


def test_an_arc_of_more_than_half_a_turn_goes_the_long_way():
    (line,) = wall_lines(scene(es.Open(), es.Arc((HALF, HALF), (-1.0, 0.0), (HALF, -HALF))))
    assert line[:, 0].min() == pytest.approx(-1.0, abs=1e-4)
    assert line[:, 0].max() == pytest.approx(HALF)


def test_a_polygon_has_a_line_for_each_edge_and_a_circle_closes():
    lines = wall_lines(scene(es.Open(), es.Polygon(((0, 0), (1, 0), (0, 1))), es.Circle((5, 5), 2.0)))
    assert len(lines) == 4
    assert np.allclose(lines[3][0], lines[3][-1])


def test_a_channel_is_hard_below_and_above_and_open_at_its_sides():
    hard, open_ = boundary_lines(scene(es.Channel((10.0, 10.0), origin=(0.0, 0.0))))
    assert [line[:, 1].tolist() for line in hard] == [[0.0, 0.0], [10.0, 10.0]]
    assert [line[:, 0].tolist() for line in open_] == [[0.0, 0.0], [10.0, 10.0]]


def test_a_disk_in_the_corner_of_a_torus_is_seen_four_times():
    torus = scene(es.Periodic((10.0, 10.0)), position=((0.25, 9.75), (5.0, 5.0)))
    place, disk = disks_with_images(torus.disks.position, torus.disks.radius, torus)
    assert disk.tolist() == [0, 1, 0, 0, 0]
    assert {tuple(p) for p in place[disk == 0].tolist()} == {
        (0.25, 9.75),
        (10.25, 9.75),
        (0.25, -0.25),
        (10.25, -0.25),
    }


def test_a_wall_across_a_periodic_boundary_is_seen_on_both_sides():
    channel = scene(es.Channel((10.0, 10.0)), es.Segment((8.0, 2.0), (12.0, 3.0)))
    lines = lines_with_images(wall_lines(channel), channel)
    assert sorted(line[0, 0] for line in lines) == [-2.0, 8.0]

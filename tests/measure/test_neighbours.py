"""Pairs and neighbours in periodic domains, against plain counts and freud's Voronoi cells."""

import numpy as np
import pytest

from eventsim.measure import neighbours
from eventsim.measure.neighbours import pairs_within, voronoi_neighbours, wrapped

freud = pytest.importorskip("freud")

SIZE = np.array([3.0, 2.0])


def places(count, seed, share=1.0):
    """Places (count, 2) in that share of the domain along both axes."""
    return np.random.default_rng(seed).uniform(0.0, share * SIZE, (count, 2))


@pytest.mark.parametrize("count", [4, 5, 30, 400])
@pytest.mark.parametrize("share", [1.0, 0.1])
def test_neighbours_are_those_of_freud(count, share):
    """Where nearly all of the domain is empty, cells reach far beyond the rim of images, and Euler counts them."""
    place = places(count, count, share)
    one, other, apart = voronoi_neighbours(place, SIZE)
    box = freud.box.Box(Lx=3.0, Ly=2.0, is2D=True)
    voronoi = freud.locality.Voronoi()
    voronoi.compute((box, np.column_stack([place - 0.5 * SIZE, np.zeros(count)])))
    told = np.asarray(voronoi.nlist.query_point_indices), np.asarray(voronoi.nlist.point_indices)
    if share == 1.0 and count >= 30:  # of few, freud tells one image of a neighbour only
        assert sorted(zip(one.tolist(), other.tolist(), strict=True)) == sorted(zip(*(t.tolist() for t in told), strict=True))
    assert len(one) == 6 * count  # Euler, on a torus
    moved = apart - (place[other] - place[one])
    assert np.abs(moved - SIZE * np.round(moved / SIZE)).max() < 1e-12


def test_neighbours_found_tile_by_tile_are_those_of_the_whole(monkeypatch):
    place = places(900, 3)
    edges = []
    for side in (1000.0, 7.0):
        monkeypatch.setattr(neighbours, "TILE", side)
        one, other, apart = voronoi_neighbours(place, SIZE)
        edges.append(sorted(zip(one.tolist(), other.tolist(), apart.round(9).tolist(), strict=True)))
    assert edges[0] == edges[1]


def test_pairs_are_those_of_a_plain_count():
    place = places(300, 1)
    apart = place[:, None] - place
    apart -= SIZE * np.round(apart / SIZE)
    near = np.argwhere(np.triu(np.hypot(*apart.T).T < 0.3, 1))
    found = pairs_within(place, SIZE, 0.3)
    assert sorted(map(tuple, found.tolist())) == sorted(map(tuple, near.tolist()))


def test_places_are_wrapped_below_the_size():
    place = np.array([[-1e-20, 2.0], [3.5, -0.5], [0.0, 1.0]])
    assert wrapped(place, SIZE).tolist() == [[0.0, 0.0], [0.5, 1.5], [0.0, 1.0]]

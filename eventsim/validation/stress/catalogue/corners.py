"""Walls that go on: points at vertices and joints, slides along chains, arcs that are nearly flat."""

from __future__ import annotations

import math

import numpy as np

from eventsim.scene import Arc, Box, Disks, Open, Polygon, Polyline, Scene
from eventsim.validation.stress.case import Bench, Case, off

ULP = 2.0**-52

VEE = ((0.0, 4.0), (2.0, 0.5), (5.0, 4.0))
"""Two walls that meet in a vertex below which nothing can get."""

CORNERS = (
    (7.9103366189665625, 4.272029695452981),
    (5.727970304547019, 7.9103366189665625),
    (2.0896633810334375, 5.727970304547019),
    (4.27202969545298, 2.0896633810334375),
)
"""Of a square that is turned, in the order of the angles."""


def _vertex(bench: Bench) -> float:
    """How far a point gets below two walls that meet, in units of the table."""
    deepest = 0.0
    for radius in (0.0, 0.01):
        scene = Scene(
            Disks([[0.5, 4.5]], radius=radius),
            Box((5.0, 8.0)),
            walls=[Polyline(VEE)],
            gravity=(0.0, -1.0),
            restitution=0.3,
        )
        for until in (1.0, 2.0, 3.0, 4.0):
            x, y = bench.run(scene, until=until, may_give_up=True).state.position[0].tolist()
            deepest = max(deepest, float(np.interp(x, *np.transpose(VEE))) - y)
    return deepest


def _aimed(bench: Bench) -> float:
    """How far points get out of a polygon whose corners they are aimed at."""
    farthest = 0.0
    for x, y in CORNERS:
        for start in ((4.681668668545604, 5.468556774337902), (5.0, 4.5)):
            for shift in (-(2.0**-51), 2.0**-51):
                u, w = (x - start[0]) * (1.0 + shift), y - start[1]
                scene = Scene(Disks([start], [(u, w)], 0.0), Open(), walls=[Polygon(CORNERS)])
                place = bench.run(scene, until=10.0).state.position[0]
                farthest = max(farthest, beyond(CORNERS, *place.tolist()))
    return farthest


def beyond(corners: tuple[tuple[float, float], ...], x: float, y: float) -> float:
    """How far a place is beyond the sides of a convex polygon; below 0 inside."""
    ways = []
    for (ax, ay), (bx, by) in zip(corners, [*corners[1:], corners[0]], strict=True):
        ways.append(((by - ay) * (x - ax) - (bx - ax) * (y - ay)) / math.hypot(bx - ax, by - ay))
    return max(ways)


def _chain(bench: Bench) -> float:
    """How far slides along links in line are from straight ones, with and without gravity."""
    worst = 0.0
    chain = Polyline(((0.0, 0.2), (0.4, 0.2), (0.8, 0.2), (3.0, 0.2)))
    for gravity in (None, (0.0, -1.0)):
        scene = Scene(
            Disks([[0.3, 0.3]], [[1.0, 0.0]], 0.1), Open(), walls=[chain], gravity=gravity, restitution=0.5
        )
        state = bench.run(scene, until=2.0).state
        worst = max(worst, off(state.position, [[2.3, 0.3]]) / 0.1, off(state.velocity, [[1.0, 0.0]]))
    return worst


def _flat(bench: Bench) -> float:
    """Errors of place and velocity after a contact, for ever flatter arcs.  It ends at the first one that is wrong."""
    worst, radius = 0.0, 0.25
    for wanted in (1e-3, 1e-6, 1e-9, 1e-12):
        top = 1.0 + wanted
        bulge = top - 1.0
        bow = 0.5 / bulge + 0.5 * bulge + radius
        height = math.sqrt(bow * bow - 0.25)
        fall = 1.0 - (bulge - 0.25 / (bow + height))
        nx, ny = -0.5 / bow, height / bow
        u, w = 2.0 * ny * nx, 2.0 * ny * ny - 1.0
        wall = Arc((1.0, 1.0), (2.0, top), (3.0, 1.0))
        scene = Scene(Disks([[1.5, 2.0 + radius]], [[0.0, -1.0]], radius), Open(), walls=[wall])
        state = bench.run(scene, until=1.5).state
        lag = 1.5 - fall
        place = [[1.5 + lag * u, 2.0 + radius - fall + lag * w]]
        worst = max(worst, off(state.velocity, [[u, w]]), off(state.position, place) / radius)
        if worst > FLAT:
            break
    return worst


FLAT = 1e-12
"""What is right on a nearly flat arc."""

CASES = (
    Case(
        "p1-vertex",
        "a point falls into a V of two walls",
        "A point has no width: its side of a wall is the sign of a rounded number, and it slips through the vertex.",
        "It stays above the V, as a small disk does.",
        64 * ULP,
        "Places on slanted walls are rounded, at most some last bits of 4.",
        _vertex,
    ),
    Case(
        "p1-aimed",
        "points aimed at the corners of a polygon, missed by a last bit",
        "An engine finds that both walls were met, or neither.",
        "They stay inside.",
        64 * ULP,
        "Places at walls are rounded, at most some last bits of 8.",
        _aimed,
        ("digits", "collapse"),
    ),
    Case(
        "p6-chain",
        "a disk slides along links that are in line",
        "The ends of the links are posts, which rounding lets the disk touch.",
        "Straight on.",
        16 * ULP,
        "A few rounded operations.",
        _chain,
    ),
    Case(
        "p7-flat",
        "arcs whose bulge is down to 1e-12 of their chord",
        "Centre and radius are huge, and their difference, which is the wall, has no digits left.",
        "The circle through three points, by the sum and not the difference of its lengths.",
        FLAT,
        "Some last bits of numbers about 2, in radii of 1/4.",
        _flat,
    ),
)

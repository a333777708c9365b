"""Families of scenes and what is judged of each: on which side the point is, and what it met first."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import NamedTuple

import numpy as np

import eventsim as es
from tests.points.judge import Point, first_hit, floor_height, is_inside, is_valley, margin, reflected
from tests.points.scenes import Generator, aimed, inner_point, kinked, point_scene, polygon

NEAR = 1e-9
"""A place nearer to a wall than this is on either side."""

VALLEY = 1e-11
"""A point that is spent between two walls is so near to the lowest place: some last bits of its energy, over a slope."""


class Verdict(NamedTuple):
    """wrong: a sentence, or nothing; refused: why the run stopped early, or nothing; exact: whether a hit was exact.

    held: the run ended where the point came to rest between two walls, which is no refusal.
    """

    wrong: str
    refused: str
    exact: bool
    held: bool = False


def path_of(run: es.Run, scene: es.Scene, until: float) -> list[tuple[float, Point]]:
    """(time, place) at the middle of each flight, and at the end."""
    times = [0.0, *np.unique(run.log.time).tolist(), until]
    middles = [0.5 * (a + b) for a, b in pairwise(times) if b - a > 1e-7]
    return [(t, tuple(run.state_at(t).position[0].tolist())) for t in [*middles, until]]


def simulate(scene: es.Scene, until: float, engine: str) -> es.Run:
    """A run with a log, of at most some thousand events."""
    return es.simulate(scene, until=until, events=3000, engine=engine, log=True)


def _refusal(run: es.Run) -> str:
    return "" if run.stopped in ("until", "events", "quiet") else str(run.stopped)


def in_polygon(rng: Generator, engine: str, make: Callable[[Generator], list[Point]] = polygon) -> Verdict:
    """A point inside a polygon, aimed at one of its corners."""
    corners = make(rng)
    start = inner_point(rng, corners, is_inside)
    velocity = aimed(rng, start, corners[int(rng.integers(len(corners)))])
    scene = point_scene(start, velocity, domain=es.Box((10.0, 10.0)), walls=(es.Polygon(tuple(corners), name="p"),))
    until = 12.0 / math.hypot(*velocity)
    run = simulate(scene, until, engine)
    edges = list(zip(corners, (*corners[1:], corners[0]), strict=True))
    return _judged(run, scene, until, edges, [f"p.{k}" for k in range(len(edges))], corners, True)


def kink_of_polygon(rng: Generator, engine: str) -> Verdict:
    """The same where corners are hardly bent."""
    return in_polygon(rng, engine, kinked)


def around_polygon(rng: Generator, engine: str) -> Verdict:
    """A point between a polygon and a box around it, aimed at a corner from outside."""
    corners = polygon(rng)
    while True:
        start = tuple(rng.uniform(0.1, 9.9, 2).tolist())
        if not is_inside(corners, *start) and margin(corners, *start) > 0.05:
            break
    velocity = aimed(rng, start, corners[int(rng.integers(len(corners)))])
    scene = point_scene(start, velocity, domain=es.Box((10.0, 10.0)), walls=(es.Polygon(tuple(corners), name="p"),))
    until = 20.0 / math.hypot(*velocity)
    run = simulate(scene, until, engine)
    edges = list(zip(corners, (*corners[1:], corners[0]), strict=True))
    box = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)]
    sides = list(zip(box, (*box[1:], box[0]), strict=True))
    names = [*(f"p.{k}" for k in range(len(edges))), "bottom", "right", "top", "left"]
    return _judged(run, scene, until, [*edges, *sides], names, corners, False)


def on_floor(rng: Generator, engine: str) -> Verdict:
    """A point above a chain from border to border, aimed at one of its points, those on the border among them."""
    points = random_floor(rng)
    while True:
        x, y = rng.uniform(0.1, 4.9), rng.uniform(2.0, 4.9)
        if y > floor_height(points, x) + 0.1:
            break
    velocity = aimed(rng, (x, y), points[int(rng.integers(len(points)))])
    scene = point_scene((x, y), velocity, domain=es.Box((5.0, 5.0)), walls=(es.Polyline(tuple(points), name="f"),))
    until = 15.0 / math.hypot(*velocity)
    run = simulate(scene, until, engine)
    region = [*points, (5.0, 5.0), (0.0, 5.0)]
    edges = list(pairwise(points))
    edges += [(points[-1], (5.0, 5.0)), ((5.0, 5.0), (0.0, 5.0)), ((0.0, 5.0), points[0])]
    names = [*(f"f.{k}" for k in range(len(points) - 1)), "right", "top", "left"]
    return _judged(run, scene, until, edges, names, region, True)


def random_floor(rng: Generator) -> list[Point]:
    """A chain from the left border of a box of 5 x 5 to the right one."""
    n = int(rng.integers(3, 9))
    xs = [0.0, *np.sort(rng.uniform(0.3, 4.7, n - 2)).tolist(), 5.0]
    return [(float(x), float(y)) for x, y in zip(xs, rng.uniform(0.2, 2.0, n), strict=True)]


def in_circle(rng: Generator, engine: str) -> Verdict:
    """A point in a container that a chord parts, aimed at where they meet."""
    radius, (cx, cy) = rng.uniform(1.0, 3.0), rng.uniform(3.0, 5.0, 2)
    a, b = rng.uniform(0.0, 2.0 * math.pi), rng.uniform(0.7, 5.5)
    ends = [(float(cx + radius * math.cos(t)), float(cy + radius * math.sin(t))) for t in (a, a + b)]
    while True:
        x, y = rng.uniform(-radius, radius, 2)
        if math.hypot(x, y) < 0.95 * radius and abs(_side(ends, x + cx, y + cy)) > 0.05:
            break
    start = float(cx + x), float(cy + y)
    velocity = aimed(rng, start, ends[int(rng.integers(2))])
    walls = es.Circle((float(cx), float(cy)), float(radius), name="c"), es.Segment(*ends, name="s")
    scene = point_scene(start, velocity, domain=es.Open(), walls=walls)
    until = 15.0 / math.hypot(*velocity)
    run = simulate(scene, until, engine)
    before = _side(ends, *start) > 0.0
    for t, (px, py) in path_of(run, scene, min(until, float(run.state.time))):
        far = abs(_side(ends, px, py)) > NEAR
        if (far and (_side(ends, px, py) > 0.0) != before) or math.hypot(px - cx, py - cy) > radius + NEAR:
            return Verdict(f"on the other side at t = {t}", "", False)
    return Verdict("", _refusal(run), False)


def in_arc(rng: Generator, engine: str) -> Verdict:
    """A point between an arc and its chord, or outside of both, aimed at where they meet."""
    radius, (cx, cy) = rng.uniform(1.0, 3.0), rng.uniform(3.0, 5.0, 2)
    a, b = rng.uniform(0.0, 2.0 * math.pi), rng.uniform(0.9, 5.0)
    first, middle, last = (
        (float(cx + radius * math.cos(t)), float(cy + radius * math.sin(t))) for t in (a, a + 0.5 * b, a + b)
    )
    ends = [first, last]
    bulge = _side(ends, *middle) > 0.0
    inside = rng.random() < 0.6

    def held(x: float, y: float) -> bool:
        return (_side(ends, x, y) > 0.0) == bulge and math.hypot(x - cx, y - cy) < radius

    while True:
        x, y = float(rng.uniform(cx - 1.5 * radius, cx + 1.5 * radius)), float(rng.uniform(cy - radius, cy + radius))
        clear = abs(_side(ends, x, y)) > 0.03 and abs(math.hypot(x - cx, y - cy) - radius) > 0.03
        if clear and held(x, y) == inside:
            break
    velocity = aimed(rng, (x, y), ends[int(rng.integers(2))])
    walls = es.Arc(first, middle, last, name="a"), es.Segment(first, last, name="s")
    scene = point_scene((x, y), velocity, domain=es.Open(), walls=walls)
    until = 12.0 / math.hypot(*velocity)
    run = simulate(scene, until, engine)
    for t, (px, py) in path_of(run, scene, min(until, float(run.state.time))):
        clear = abs(_side(ends, px, py)) > NEAR and abs(math.hypot(px - cx, py - cy) - radius) > NEAR
        if clear and held(px, py) != inside:
            return Verdict(f"on the other side at t = {t}", "", False)
    return Verdict("", _refusal(run), False)


def _side(ends: list[Point], x: float, y: float) -> float:
    (ax, ay), (bx, by) = ends
    return ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / math.hypot(bx - ax, by - ay)


def falling(rng: Generator, engine: str) -> Verdict:
    """A point that falls onto a corner of a floor: thrown so that it is there after a time, to some units in the last place."""
    points = random_floor(rng)
    x, y = rng.uniform(0.1, 4.9), rng.uniform(3.0, 4.9)
    target, t, g = points[int(rng.integers(len(points)))], rng.uniform(0.2, 0.8), float(rng.uniform(1.0, 10.0))
    u, w = (target[0] - x) / t, (target[1] - y) / t + 0.5 * g * t
    if rng.random() < 0.2:
        x, u, w = target[0], 0.0, 0.0
    off = rng.integers(-3, 4, 2)
    velocity = float(u + off[0] * np.spacing(u)) if u else 0.0, float(w + off[1] * np.spacing(w)) if w else 0.0
    if not 0.0 <= x <= 5.0:
        return Verdict("", "", False)
    scene = point_scene(
        (float(x), float(y)),
        velocity,
        domain=es.Box((5.0, 5.0)),
        walls=(es.Polyline(tuple(points), name="f"),),
        gravity=(0.0, -g),
        restitution=float(rng.choice([1.0, 0.8, 0.5])),
    )
    return above_floor(scene, points, 4.0, engine)


def dropped(rng: Generator, engine: str) -> Verdict:
    """A point that falls onto a random floor."""
    points = random_floor(rng)
    start = float(rng.uniform(0.1, 4.9)), float(rng.uniform(3.0, 4.9))
    velocity = tuple(rng.normal(size=2).tolist())
    scene = point_scene(
        start,
        velocity,
        domain=es.Box((5.0, 5.0)),
        walls=(es.Polyline(tuple(points), name="f"),),
        gravity=(0.0, -1.0),
        restitution=0.6,
    )
    return above_floor(scene, points, 20.0, engine)


def above_floor(scene: es.Scene, points: list[Point], until: float, engine: str) -> Verdict:
    """Whether a point stays above a floor all the time."""
    run = simulate(scene, until, engine)
    for t, (x, y) in path_of(run, scene, min(until, float(run.state.time))):
        if y < floor_height(points, min(max(x, 0.0), 5.0)) - NEAR:
            return Verdict(f"below the floor at t = {t}", "", False)
    if run.stopped == "collapse" and is_valley(points, *run.state.position[0].tolist(), VALLEY):
        return Verdict("", "", False, True)
    return Verdict("", "events" if run.stopped == "events" else _refusal(run), False)


def _judged(
    run: es.Run,
    scene: es.Scene,
    until: float,
    edges: list[tuple[Point, Point]],
    names: list[str],
    region: list[Point],
    inside: bool,
) -> Verdict:
    """Whether a point stays in its region, and meets first what the exact sign tells."""
    start, velocity = (tuple(array[0].tolist()) for array in (scene.disks.position, scene.disks.velocity))
    hit = first_hit(start, velocity, edges)
    if hit is not None and len(run.log) and not hit.exact:
        name = str(run.log.wall_name[0])
        if name != names[hit.walls[0]]:
            return Verdict(f"met {name}, not {names[hit.walls[0]]}", "", False)
        after = reflected(velocity, edges[hit.walls[0]], 1.0)
        got = float(run.log.vxa[0]), float(run.log.vya[0])
        if math.dist(after, got) > 1e-12 * math.hypot(*velocity):
            return Verdict(f"left {name} with {got}, not {after}", "", False)
    elif hit is not None and not len(run.log) and float(hit.time) < until:
        return Verdict("met nothing", "", False)
    for t, place in path_of(run, scene, min(until, float(run.state.time))):
        if margin(region, *place) > NEAR and is_inside(region, *place) != inside:
            return Verdict(f"on the other side at t = {t}", "", hit is not None and hit.exact)
    return Verdict("", _refusal(run), hit is not None and hit.exact)


AIMS = {
    "polygon": in_polygon,
    "kink": kink_of_polygon,
    "outside": around_polygon,
    "floor": on_floor,
    "circle": in_circle,
    "arc": in_arc,
    "falling": falling,
}

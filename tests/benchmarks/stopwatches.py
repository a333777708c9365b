"""What a time unit takes pymunk, by three stopwatches: `validate`, `chart`, and a loop of one's own.

    python -m tests.benchmarks.stopwatches [--least] [--csv FILE]

A row for each scene and step: CPU milliseconds per time unit of the scene by each of the three, and those of the first two over
the third.  The last line has the ratio that is furthest from 1.  `validate` and `chart` read the same stopwatch, `timing_of`;
the loop of one's own calls nothing of eventsim while it is timed, and repeats what is short until its time can be read.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from statistics import fmean, median
from time import thread_time
from typing import Any

import eventsim as es
from eventsim.scene.stage import stage_of
from eventsim.validation.compare import compare
from eventsim.validation.competitors import COMPETITORS
from eventsim.validation.precision import Task, curves
from tests.benchmarks.table import Table, arguments
from tests.validate.judge.stepper import box_of

COLUMNS = ("scene", "steps", "validate", "chart", "own", "validate/own", "chart/own")
ROUNDS, READ_S = 9, 5e-3
"""Of the loop of one's own: how often it is timed, and how long each time at least, CPU seconds."""

PATIENCE_S = 1.0


def scenes() -> Iterator[tuple[str, es.Scene, float]]:
    """(name, scene, until): few disks and many, with gravity and without, a hundred microseconds of steps and a second."""
    three = es.Disks([(0.5, 0.5), (1.5, 0.6), (2.5, 0.4)], [(1.0, 0.2), (-0.5, 0.0), (-1.0, 0.3)], 0.2)
    yield "three", es.Scene(three, es.Box((3.0, 1.0))), 1.0
    yield "six that fall", box_of(), 1.5
    yield "break", es.gallery("break"), 0.5
    yield "gas of 100", es.gallery("gas", n=100), 0.1
    yield "gas of 300", es.gallery("gas"), 0.1


def space_of(scene: es.Scene) -> Any:
    """A box of disks in pymunk, as one writes it by hand, with the settings that `validate` tells."""
    import pymunk

    law, radius = stage_of(scene).law, scene.disks.radius
    space = pymunk.Space()
    space.gravity = scene.gravity or (0.0, 0.0)
    space.collision_slop = 0.01 * float(radius.min())
    for i, (place, velocity) in enumerate(zip(scene.disks.position, scene.disks.velocity, strict=True)):
        body = pymunk.Body(float(scene.disks.mass[i]), math.inf)
        body.position, body.velocity = tuple(place.tolist()), tuple(velocity.tolist())
        circle = pymunk.Circle(body, float(radius[i]))
        circle.elasticity = math.sqrt(law.pair)
        space.add(body, circle)
    width, height = scene.domain.size
    corners = [(-1, -1), (width + 1, -1), (width + 1, height + 1), (-1, height + 1)]
    for ends in zip(corners, corners[1:] + corners[:1], strict=True):
        wall = pymunk.Segment(space.static_body, *ends, 1.0)
        wall.elasticity = math.sqrt(law.wall)
        space.add(wall)
    return space


def own_loop(scene: es.Scene, dt: float, steps: int) -> list[float]:
    """CPU seconds per time unit of a loop of so many steps from the start, ROUNDS times."""

    def once() -> float:
        space = space_of(scene)
        begun = thread_time()
        for _ in range(steps):
            space.step(dt)
        return thread_time() - begun

    once()
    often = max(math.ceil(READ_S / max(once(), 1e-6)), 1)
    return [fmean(once() for _ in range(often)) / (steps * dt) for _ in range(ROUNDS)]


def main() -> None:
    parser = arguments(__doc__)
    parser.add_argument("--least", action="store_true", help="the least of the repeats in place of their median")
    chosen = parser.parse_args()
    table, pymunk = Table(COLUMNS, 14), [COMPETITORS["pymunk"]]
    every = [(1.0, "")]
    for name, scene, until in scenes():
        charted = curves(Task(name, scene, "trajectory", until), pymunk, PATIENCE_S).of("pymunk")
        sizes = [point.value for point in charted]
        lines = {line.dt: line for line in compare(scene, pymunk, sizes, until, PATIENCE_S).lines}
        for point in charted:
            dt, line = point.value, lines.get(point.value)
            steps = int((until - scene.start_time) / dt + 1e-9)
            if line is None or not steps:
                continue
            loops = own_loop(scene, dt, steps)
            # what lies behind the last whole step is nobody's time
            share = (until - scene.start_time) / (steps * dt)
            if chosen.least:
                found = [line.timing.least * share, point.least * share, min(loops)]
            else:
                found = [line.timing.median * share, point.elapsed * share, median(loops)]
            told = [f"{1e3 * each:.4g}" for each in found]
            ratios = [each / found[2] for each in found[:2]]
            every += [(ratio, f"{name}, {steps} steps") for ratio in ratios]
            table.add(dict(zip(COLUMNS, (name, steps, *told, *(f"{ratio:.2f}" for ratio in ratios)), strict=True)))
    ratio, where = max(every, key=lambda one: abs(math.log(one[0])))
    print(f"furthest from 1: {ratio:.2f} ({where})")
    table.write(chosen.csv)


if __name__ == "__main__":
    main()

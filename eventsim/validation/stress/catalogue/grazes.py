"""Grazes, tangencies and touches: where one bit decides whether there is a contact at all."""

from __future__ import annotations

import math

from eventsim.scene import Disks, Open, Scene, Segment
from eventsim.validation.stress.case import Bench, Case, off
from eventsim.validation.stress.catalogue.scenes import exact_delay, in_box, on_plane

ULP = 2.0**-52


def passing(dy: float) -> Scene:
    """A disk flies past another one at rest; their centres pass at a distance dy, in diameters."""
    return on_plane([[-3.0, dy], [0.0, 0.0]], [[1.0, 0.0], [0.0, 0.0]])


def _graze(bench: Bench) -> float:
    dy = 1.0 - 2.0**-53
    run = bench.run(passing(dy), until=10.0)
    across = dy * math.sqrt((1.0 - dy) * (1.0 + dy))
    return off(run.state.velocity, [[dy * dy, across], [1.0 - dy * dy, -across]])


def _miss(bench: Bench) -> float:
    worst = 0.0
    for dy in (1.0, 1.0 + 2.0**-52):
        run = bench.run(passing(dy), until=10.0)
        worst = max(worst, run.counters.events, off(run.state.velocity, [[1.0, 0.0], [0.0, 0.0]]))
    return worst


def _along(bench: Bench) -> float:
    exact = bench.run(on_plane([[0.0, 0.0], [3.0, 4.0]], [[0.0, 0.0], [-4.0, 3.0]], 2.5), until=10.0)
    rounded = on_plane([[0.0, 0.0], [3.0, 4.0]], [[0.0, 0.0], [-0.8, 0.6]], 2.5)
    run = bench.run(rounded, until=10.0)
    return max(exact.counters.events, run.counters.events - 1, off(run.state.velocity, [[0.0, 0.0], [-0.8, 0.6]]))


def _touching(bench: Bench) -> float:
    worst = 0.0
    for speed, after in ((-1.0, [-1.0, 0.0]), (1.0, [0.0, 1.0]), (0.0, [0.0, 0.0])):
        run = bench.run(on_plane([[0.0, 0.0], [1.0, 0.0]], [[0.0, 0.0], [speed, 0.0]]), until=5.0)
        worst = max(worst, off(run.state.velocity[:, 0], after))
    return worst


def _apex(bench: Bench) -> float:
    worst = 0.0
    for height, hits in ((1.0, 0), (1.0 - 2.0**-50, 1)):
        ceiling = Segment((0.0, height + 1.5), (10.0, height + 1.5))
        disks = Disks([[5.0, 1.0]], [[0.0, 2.0]], 0.5)
        run = bench.run(Scene(disks, Open(), walls=[ceiling], gravity=(0.0, -2.0)), until=4.0)
        worst = max(worst, abs(run.counters.events - hits))
    return worst


def _low_flight(bench: Bench) -> float:
    """The error of the first impact's time, relative."""
    worst = 0.0
    y = 0.5 + 1e-12
    gap, g = y - 0.5, 9.81
    for v in (1.0, -1.0):
        root = math.sqrt(1.0 + 2.0 * g * gap)
        expected = (1.0 + root) / g if v > 0.0 else 2.0 * gap / (1.0 + root)
        run = bench.run(in_box(10.0, [[5.0, y]], [[0.0, v]], gravity=(0.0, -g)), events=1, log=True)
        worst = max(worst, off(run.log.time[:1], [expected]) / expected)
    return worst


def _far(bench: Bench) -> float:
    """The error of the contact's time, as a length: the speed is 1."""
    run = bench.run(on_plane([[-1e8, 0.3], [0.0, 0.0]], [[1.0, 0.0], [0.0, 0.0]]), until=1e8 + 2.0, log=True)
    return off(run.log.time, [exact_delay(-1e8, 0.3, 1.0, 0.0, 1.0)])


CASES = (
    Case(
        "f1-graze",
        "a graze by one bit",
        "The discriminant b^2 - a c cancels to its last bit; steps fly past.",
        "Closed form: A leaves with (dy^2, dy sqrt(1 - dy^2)).",
        8 * ULP,
        "The normal at contact is rounded to an ulp of the coordinates; 8 operations.",
        _graze,
    ),
    Case(
        "f2-miss",
        "a tangency, and a miss by one bit",
        "Rounding turns a miss by 2^-52 into a hit; a tolerance turns a tangency into one.",
        "No event; velocities unchanged.",
        0.0,
        "Nothing happens, so nothing may be rounded.",
        _miss,
    ),
    Case(
        "f3-along",
        "disks in contact that move along each other",
        "b is zero, or rounds below zero: a contact that changes nothing is found again and again.",
        "No event for exact numbers; at most one where decimals round to an approach of 2e-16.",
        4 * ULP,
        "The approach that the decimals round to.",
        _along,
    ),
    Case(
        "f9-touching",
        "disks that touch at the start",
        "A contact time of exactly zero is lost by engines that ask for t > 0.",
        "Approaching: they exchange velocities; receding or at rest: nothing.",
        0.0,
        "The exchange of velocities of equal disks along x is exact.",
        _touching,
    ),
    Case(
        "f12-far",
        "a contact after a flight of 10^8 diameters",
        "b^2 and a c agree in 16 digits: the naive root is wrong by a diameter.",
        "99999999.0460607985830543 for the decimal .3; here from 60 decimal digits.",
        2.0**-26,
        "The last bit of a time of 10^8.",
        _far,
    ),
    Case(
        "f25-apex",
        "a parabola whose apex touches the ceiling",
        "The two roots of the quadratic meet; one bit decides whether there is any.",
        "Height 1: no event; 1 - 2^-50: one.",
        0.0,
        "A count.",
        _apex,
    ),
    Case(
        "f26-low-flight",
        "a jump that begins 10^-12 above the floor",
        "The roots of the parabola differ by twelve orders of magnitude; one of them cancels.",
        "Closed form for the gap that the float coordinate leaves.",
        8 * ULP,
        "Relative; 8 operations.",
        _low_flight,
    ),
)

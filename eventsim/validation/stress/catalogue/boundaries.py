"""Periodic images, wraps, moments exactly at an event; scenes in which nothing happens, and scenes that are none."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from eventsim.errors import SceneError
from eventsim.scene import Box, Disks, Open, Periodic, Scene
from eventsim.validation.stress.case import Bench, Case, off
from eventsim.validation.stress.catalogue.scenes import in_box, on_plane

ULP = 2.0**-52


def _image(bench: Bench) -> float:
    scene = Scene(Disks([[0.0, 0.0], [1.9, 0.0]], [[0.0, 0.0], [1.0, 0.0]], 0.5), Periodic((4.0, 4.0)))
    run = bench.run(scene, until=2.0)
    return off(run.state.velocity, [[1.0, 0.0], [0.0, 0.0]])


def two_images() -> Scene:
    """d = 3 in a box of 4: between two images of a disk at rest another one is met from both sides."""
    return Scene(Disks([[0.0, 0.0], [2.0, 3.0]], [[0.0, 0.0], [0.0, -1.0]], 1.5), Periodic((4.0, 8.0)))


def _two_images(bench: Bench) -> float:
    try:
        Scene(Disks([[1.0, 1.0]], radius=2.1), Periodic((4.0, 4.0)))
    except SceneError:
        run = bench.run(two_images(), until=1.5)
        # normals (+-2, sqrt 5)/3, equal masses: by symmetry along y only; momentum and energy give an exchange
        return off(run.state.velocity, [[0.0, -1.0], [0.0, 0.0]])
    return math.inf


def _wrap(bench: Bench) -> float:
    """How far a coordinate is outside [0, 1)."""
    scene = Scene(Disks([[1e-17, 0.5]], [[-1.0, 0.25]], 0.1), Periodic((1.0, 1.0)))
    worst = 0.0
    for time in (0.0, 1e-18, 0.5, 1.0, 2.0, 5.0):
        place = bench.run(scene, until=time).state.position
        worst = max(worst, float(np.max(-place)), float(np.max(place - math.nextafter(1.0, 0.0))))
    return worst


def _nothing(bench: Bench) -> float:
    """Events in scenes in which nothing can happen."""
    worst = 0.0
    for domain in (Open(), Box((40.0, 40.0)), Periodic((40.0, 40.0))):
        run = bench.run(Scene(Disks([[5.0, 5.0], [9.0, 9.0]], radius=0.5), domain), until=10.0)
        worst = max(worst, run.counters.events)
    together = Scene(Disks([[5.0, 5.0], [9.0, 9.0]], [[1.0, 0.3]] * 2, 0.5), Periodic((40.0, 40.0)))
    return max(worst, bench.run(together, until=100.0).counters.events)


def _at_an_event(bench: Bench) -> float:
    run = bench.run(on_plane([[-3.0, 0.0], [0.0, 0.0]], [[1.0, 0.0], [0.0, 0.0]]), until=4.0, log=True)
    after, before = run.state_at(2.0).velocity, run.state_at(math.nextafter(2.0, 0.0)).velocity
    return max(off(after, [[0.0, 0.0], [1.0, 0.0]]), off(before, [[1.0, 0.0], [0.0, 0.0]]))


def _bad_input(bench: Bench) -> float:
    """Bad scenes that were accepted; the engine then runs a good one."""
    bad: tuple[Callable[[], Scene], ...] = (
        lambda: on_plane([[0.0, 0.0], [0.5, 0.0]], [[0.0, 0.0], [0.0, 0.0]]),
        lambda: in_box(10.0, [[0.2, 5.0]], [[0.0, 0.0]]),
        lambda: on_plane([[math.nan, 5.0]], [[0.0, 0.0]]),
        lambda: on_plane([[0.0, 5.0]], [[0.0, 0.0]], -1.0),
    )
    accepted = 0
    for make in bad:
        try:
            make()
        except SceneError:
            continue
        accepted += 1
    return accepted + bench.run(in_box(10.0, [[5.0, 5.0]], [[1.0, 0.0]]), until=1.0).counters.events


CASES = (
    Case(
        "f27-image",
        "a disk meets the image of another in a small periodic box",
        "The nearest image at the start is not the one that is met.",
        "Contact at 1.1: the velocities are exchanged.",
        4 * ULP,
        "The coordinate 1.9 is rounded, the normal is not.",
        _image,
    ),
    Case(
        "f28-two-images",
        "a disk is met by two images of another at once",
        "Only one image of a pair is looked at; disks of more than half the box are not foreseen.",
        "Symmetry and conservation; a disk larger than the box is refused.",
        16 * ULP,
        "The normals (2, sqrt 5)/3 at contact carry a few ulp.",
        _two_images,
    ),
    Case(
        "f29-wrap",
        "(-1e-17) % 1.0 is 1.0",
        "A wrapped coordinate lies on the wrong side of the boundary.",
        "0 <= x < L at every time.",
        0.0,
        "A rule.",
        _wrap,
    ),
    Case(
        "f20-nothing",
        "scenes in which nothing happens",
        "Engines that wait for the next event wait for ever.",
        "No events; the run returns at once.",
        0.0,
        "A count.",
        _nothing,
    ),
    Case(
        "f36-at-an-event",
        "a state asked for exactly at an event",
        "Before or after, as rounding will have it.",
        "The state after; one bit earlier the state before.",
        0.0,
        "An exchange of velocities along x is exact.",
        _at_an_event,
    ),
    Case(
        "f37-bad-input",
        "overlap, outside a wall, NaN, r < 0",
        "Accepted in silence, and wrong from the first contact on.",
        "Refused, disks named.",
        0.0,
        "A count.",
        _bad_input,
    ),
)

"""An engine that is a function: its steps are called one after the other, and its motion is judged like that of any other."""

from __future__ import annotations

import math
from collections.abc import Callable
from time import thread_time
from typing import Any, NamedTuple

import numpy as np

from eventsim.errors import EventsimError
from eventsim.readers.samples import Floats, Samples, checked
from eventsim.scene import Scene

MOST_SAMPLES = 20_000
"""Of a run with more steps every second, fourth, ... is kept."""

Step = Callable[[Any, Any, float], Any]
"""step(position, velocity, dt) -> (position, velocity), arrays (n, 2); or None where it changes them in place."""


class Stepped(NamedTuple):
    """What a function did: its motion, and the CPU seconds of a time unit, its first step apart."""

    samples: Samples
    elapsed: float


def stepped(scene: Scene, step: Step, dt: float, until: float | None = None) -> Stepped:
    """Call a function from the start of a scene to its end, or `until`.

    Raises:
        EventsimError: where nothing says when to stop, or the function returns what is no state of the disks.
    """
    if not callable(step):
        raise EventsimError(f"step = {step!r}: must be a function step(position, velocity, dt) that returns both after dt")
    end = scene.until if until is None else until
    if end is None:
        raise EventsimError("nothing says when to stop: give until, or a key until in the scene")
    if not 0.0 < dt < math.inf:
        raise EventsimError(f"dt = {dt!r}: a step must be a finite time above 0")
    count = round((end - scene.start_time) / dt)
    if count < 2:
        raise EventsimError(f"dt = {dt!r}: there must be at least two steps until {end:g}")
    every = 1 << max(math.ceil(math.log2(count / MOST_SAMPLES)), 0)
    position, velocity = scene.disks.position.copy(), scene.disks.velocity.copy()
    places, speeds, times = [position.copy()], [velocity.copy()], [scene.start_time]
    spent = first = 0.0
    for k in range(1, count + 1):
        begun = thread_time()
        given = step(position, velocity, dt)
        spent += thread_time() - begun
        first = first or spent
        position, velocity = (position, velocity) if given is None else _state(given, k, position.shape)
        if k == 1 and velocity.any() and np.array_equal(position, places[0]) and np.array_equal(velocity, speeds[0]):
            raise EventsimError(
                "step moves nothing: it must change the arrays position and velocity in place, or return both after dt"
            )
        if k % every == 0 or k == count:
            places.append(np.array(position, dtype=np.float64))
            speeds.append(np.array(velocity, dtype=np.float64))
            times.append(scene.start_time + k * dt)
    source = getattr(step, "__name__", "the function")
    samples = checked(Samples(source, np.array(times), np.array(places), np.array(speeds)))
    return Stepped(samples, (spent - first) / ((count - 1) * dt))


def _state(given: Any, number: int, shape: tuple[int, ...]) -> tuple[Floats, Floats]:
    """What a step returns, as arrays; EventsimError where it is no state of the disks."""
    try:
        position, velocity = given
    except (TypeError, ValueError):
        raise EventsimError(f"step {number} returns {type(given).__name__}: must be (position, velocity), or None") from None
    try:
        state = np.asarray(position, dtype=np.float64), np.asarray(velocity, dtype=np.float64)
    except (TypeError, ValueError):
        raise EventsimError(f"step {number} returns what are no numbers: must be (position, velocity), arrays {shape}") from None
    for name, values in zip(("position", "velocity"), state, strict=True):
        if values.shape != shape:
            raise EventsimError(f"step {number} returns a {name} of the shape {values.shape}: must be {shape}")
    return state

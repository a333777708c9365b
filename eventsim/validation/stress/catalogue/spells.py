"""Long spells: a kick after a long time without events, and series of bounces that last long."""

from __future__ import annotations

import math

from eventsim.scene import Box, Disks, Scene
from eventsim.validation.stress.case import Bench, Case, off
from eventsim.validation.stress.catalogue.scenes import in_box

AFTER = ((9.220230471767364, 8.48399891086015), (9.220230471767364, 1.7660010891398497))
"""Where the disks are 64 after a kick, in 60 digits."""

LATE, RESTS = 1e-11, 1e-9
"""What is right after a spell, and of a bounce."""


def _spell(bench: Bench) -> float:
    """Errors of places 64 after a kick, for ever later kicks.  It ends at the first one that is wrong."""
    worst = 0.0
    scene = Scene(Disks([[2.0, 5.0], [7.0, 5.25]], radius=0.5), Box((10.0, 10.0)))
    for wait in (8.0, 1e3, 1e6, 1e9, 1e12, 1e15):
        run = bench.run_kicked(scene, wait, 0, (1.0, 0.0), until=wait + 64.0)
        worst = max(worst, off(run.state.position, AFTER) / 0.5)
        if worst > LATE:
            break
    return worst


def bounce(restitution: float, height: float, gravity: float, time: float) -> tuple[float, float]:
    """(height, velocity) of a bounce from rest, by its geometric series; (0, 0) once it is over."""
    first = math.sqrt(2.0 * height / gravity)
    if time < first:
        return height - 0.5 * gravity * time * time, -gravity * time
    flight, lag = 2.0 * restitution * first, time - first
    count = math.floor(math.log1p(-lag * (1.0 - restitution) / flight) / math.log(restitution)) if restitution < 1.0 else 0
    begin = flight * (1.0 - restitution**count) / (1.0 - restitution)
    speed = 0.5 * gravity * flight * restitution**count
    lag -= begin
    return speed * lag - 0.5 * gravity * lag * lag, speed - gravity * lag


def _long_bounce(bench: Bench) -> float:
    """Errors of heights in the middle and at the end of a bounce, for ever livelier ones.  It ends at the first that is wrong."""
    worst, height = 0.0, 2.0
    for restitution in (0.9, 0.97):
        for gravity in (1.0, 9.0, 400.0):
            over = math.sqrt(2.0 * height / gravity) * (1.0 + restitution) / (1.0 - restitution)
            scene = in_box(20.0, [[5.0, 0.5 + height]], [[0.0, 0.0]], gravity=(0.0, -gravity), restitution=restitution)
            for share in (0.5, 1.1):
                state = bench.run(scene, until=share * over).state
                true = bounce(restitution, height, gravity, 0.5 * over)[0] if share < 1.0 else 0.0
                worst = max(worst, abs(float(state.position[0, 1]) - 0.5 - true) / 0.5)
                if worst > RESTS:
                    return worst
    return worst


CASES = (
    Case(
        "p3-spell",
        "a kick after 8 to 1e15 units of nothing",
        "A clock that counts on loses the digits of all that comes late.",
        "The same places for every wait, in 60 digits.",
        LATE,
        "Ten contacts, each of which may triple a last bit of 1e-15.",
        _spell,
    ),
    Case(
        "p5-bounce",
        "long series of bounces, and their end",
        "Rounding keeps the last bounces up, or a step is longer than they are.",
        "Heights by the geometric series; at rest after (1 + e)/(1 - e) times the first fall.",
        RESTS,
        "A thousand rounded contacts, and speeds of up to 40 diameters in a unit of time.",
        _long_bounce,
    ),
)

"""A disk that bounces lower and lower.

What happens
    A disk falls from a height above the floor and keeps the fraction e of its speed at each impact.
    With g = 2, height 1 and e = 1/2 the impacts come at 1, 2, 5/2, 11/4, ..., at 3 - 2^(2-n) for the
    n-th: infinitely many before t = 3. The run stops just before that.

Why
    Each flight lasts e times as long as the one before, so the times add up to t1 (1 + e) / (1 - e),
    the Zeno time, with t1 = sqrt(2 h / g). All numbers of the default scene are dyadic, so the log can
    be compared with the formula bit for bit.

Source
    E. Falcon, C. Laroche, S. Fauve, C. Coste, Behavior of one inelastic ball bouncing repeatedly off
    the ground, European Physical Journal B 3, 45 (1998), doi:10.1007/s100510050283.

A question
    Run it until = 4. What does the engine say about the time after 3, and what would a movie of a real
    disk show?
"""

import math

from eventsim.scene.disks import Disks
from eventsim.scene.domain import Box
from eventsim.scene.gallery._demand import demand
from eventsim.scene.scene import Scene

GRAVITY = 2.0
RADIUS = 0.5


def scene(*, restitution: float = 0.5, height: float = 1.0) -> Scene:
    """A disk dropped from `height` above a floor with `restitution`; the run stops before the Zeno time."""
    demand(height > 0, "height", height, "must be above 0")
    demand(0 <= restitution <= 1, "restitution", restitution, "must be from 0 to 1")
    fall = math.sqrt(2 * height / GRAVITY)
    zeno = fall * (1 + restitution) / (1 - restitution) if restitution < 1 else math.inf
    until = min(zeno * (1 - 2.0**-10), 21 * fall)
    disks = Disks(position=[[1.0, RADIUS + height]], velocity=[[1.0, 0.0]], radius=RADIUS)
    return Scene(
        disks=disks,
        domain=Box((2.0 + math.ceil(until), 2 * RADIUS + height + 0.5)),
        gravity=(0.0, -GRAVITY),
        restitution=restitution,
        until=until,
        name="bounce",
    )

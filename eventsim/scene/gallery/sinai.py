"""Sinai's billiard: neighbouring points part around a post.

What happens
    Points of mass 0 (tracers: they deflect nobody and do not meet each other) fly in a periodic box
    around an immovable disk. They start 1e-9 apart with the same velocity. After a few contacts with
    the post they are on different ways.

Why
    The post is convex: each contact multiplies the distance of neighbouring paths by about 2 * path /
    (radius * cosine of incidence). The growth is exponential in the number of contacts: this is why no
    computer follows such a path for long, whatever its method.

Source
    Ya. G. Sinai, Dynamical systems with elastic reflections, Russian Mathematical Surveys 25 (2), 137
    (1970), doi:10.1070/RM1970v025n02ABEH003794.

A question
    Plot the logarithm of the distance of the first two points against the number of contacts. What is
    its slope, and how does it depend on radius?
"""

import math

from eventsim.scene.disks import Disks
from eventsim.scene.domain import Periodic
from eventsim.scene.gallery._demand import demand
from eventsim.scene.scene import Scene


def scene(*, n: int = 2, separation: float = 1e-9, radius: float = 0.25) -> Scene:
    """`n` points `separation` apart, and a post of `radius` in the middle of a unit torus (disk 0)."""
    demand(n >= 1, "n", n, "must be at least 1")
    demand(0 < radius < 0.5, "radius", radius, "must be above 0 and below 0.5, half the torus")
    disks = Disks(
        position=[[0.0, 0.0]] + [[-0.5, -0.4 + separation * i] for i in range(n)],
        velocity=[[0.0, 0.0]] + [[0.8, 0.6]] * n,
        radius=[radius] + [0.0] * n,
        mass=[math.inf] + [0.0] * n,
    )
    return Scene(disks=disks, domain=Periodic((1.0, 1.0), origin=(-0.5, -0.5)), until=40.0, name="Sinai billiard")

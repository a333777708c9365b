"""A gas between two plates.

What happens
    Disks of one speed but random directions start between two hard plates; along the plates the world
    is periodic. After a few contacts per disk the speeds are spread as Maxwell found.

Why
    The plates reverse vy only: the momentum along x and the energy are conserved, the momentum across
    is not. The plates feel the pressure; just beside them disks are denser than in the middle.

Source
    The wall theorem: the contact density at a hard wall is P / kT; J. R. Henderson, in Fundamentals of
    Inhomogeneous Fluids (1992), chapter 2.

A question
    Sum the impulses of the rows with wall = "top" over a long run. Which pressure do they give, and
    what does kinetic theory say?
"""

from eventsim.scene.files import scene_from_dict
from eventsim.scene.scene import Scene


def scene(*, n: int = 160, speed: float = 1.0, seed: int = 1) -> Scene:
    """`n` disks of diameter 1 with one `speed` in a channel 32 by 16; directions drawn from `seed`."""
    return scene_from_dict(
        {
            "name": "channel",
            "until": 60.0,
            "domain": {"kind": "channel", "size": [32.0, 16.0]},
            "gas": [{"count": n, "radius": 0.5, "speed": speed, "arrangement": "random", "seed": seed}],
        },
        source="gallery scene channel",
    )

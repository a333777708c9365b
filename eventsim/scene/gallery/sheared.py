"""Rough disks between walls that slide turn with the flow: half as fast as it shears.

What happens
    The wall below slides to the left, the wall above to the right, and both grip: they drag disks along, and turn
    them. Contacts take what the walls put in, so that after some hundred contacts of each disk the gas is as warm
    as it stays: warmer, and thinner, at the walls. Disks in the middle spin clockwise, those at the walls ten times as fast.

Why
    A flow of shear rate g = du/dy is a stretching, and a rotation at -g/2. Where surfaces grip, contacts turn
    those disks that do not turn with the flow around them, until hardly a torque is left: at a mean spin of -g/2.
    In the inner half of the channel, over a long run, it is 0.998 +- 0.006 of that. Within some free paths of a
    wall it is the wall that turns them; the worse disks grip each other, the further that reaches.

Source
    C. K. K. Lun, Kinetic theory for granular flow of dense, slightly inelastic, slightly rough spheres, Journal
    of Fluid Mechanics 233, 539 (1991), doi:10.1017/S0022112091000599; N. Mitarai, H. Hayakawa, H. Nakanishi,
    Collisional granular flow as a micropolar fluid, Physical Review Letters 88, 174301 (2002),
    doi:10.1103/PhysRevLett.88.174301.

A question
    Is the spin in the inner half still -g/2 where `roughness` is -0.5, so that surfaces mostly slip? (A log of 400000
    events, then eventsim state LOG --frames 400, tells y, vx and spin of each disk.) It is 1.12 +- 0.01 of that.
"""

import math

from eventsim.scene.files import scene_from_dict
from eventsim.scene.scene import Scene


def scene(
    *,
    n: int = 300,
    restitution: float = 0.9,
    roughness: float = 0.5,
    speed: float = 10.0,
    height: float = 20.0,
    seed: int = 1,
) -> Scene:
    """`n` disks of diameter 1, `restitution` and `roughness`, a fifth of a channel of this `height`.

    Its walls slide at `speed`; the disks stand and fly at first as `seed` has it.
    """
    width = n * 0.25 * math.pi / (0.2 * height)
    return scene_from_dict(
        {
            "name": "sheared",
            "events": 4_000,
            "restitution": {"pair": restitution, "wall": 1.0},
            "tangential_restitution": {"pair": roughness, "wall": 1.0},
            "contact_duration": 1e-9,
            "domain": {
                "kind": "channel",
                "size": [width, height],
                "walls": {"bottom": {"velocity": -speed}, "top": {"velocity": speed}},
            },
            "gas": [{"count": n, "radius": 0.5, "temperature": 1.0, "seed": seed}],
        },
        source="gallery scene sheared",
    )

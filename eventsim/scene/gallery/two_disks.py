"""Two disks take turns.

What happens
    Disk 0 meets disk 1 head on at t = 2. With equal masses it stops dead and disk 1 goes on with its
    whole velocity, meets the right wall at 4.5, comes back at 7 and sends disk 0 to the left wall
    (10.5). At t = 12 everything is as in the beginning: four contacts a period, and every number in the
    log can be worked out by hand.

Why
    The smallest scene with everything in it: a pair contact, wall contacts, a period. All its numbers
    are exactly representable, so the period holds to the last bit for ever.

Source
    The elastic exchange of velocities: C. Huygens, De motu corporum ex percussione (1703), proposition
    I.

A question
    With which mass_ratio does disk 0 turn round instead of stopping? And when do both disks go on to
    the right?
"""

from eventsim.scene.disks import Disks
from eventsim.scene.domain import Box
from eventsim.scene.gallery._demand import demand
from eventsim.scene.scene import Scene


def scene(*, mass_ratio: float = 1.0) -> Scene:
    """`mass_ratio` is the mass of disk 1 over that of disk 0."""
    demand(mass_ratio > 0, "mass_ratio", mass_ratio, "must be above 0")
    disks = Disks(
        position=[[2.0, 2.0], [5.0, 2.0]],
        velocity=[[1.0, 0.0], [0.0, 0.0]],
        radius=0.5,
        mass=[1.0, mass_ratio],
    )
    return Scene(disks=disks, domain=Box((8.0, 4.0)), until=24.0, name="two disks")

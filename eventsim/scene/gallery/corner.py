"""One disk into the corner of a box.

What happens
    The disk runs along the diagonal and meets two walls at the same instant, t = 4.5, then the opposite
    two at 13.5. Period 18, for ever, with the same bits each time.

Why
    The two walls act on different components of the velocity, so they are resolved jointly and their
    order cannot matter: the velocity is reversed. Two rows at one time, with the same number in the
    column `joint`.

Source
    Unfolding the box into a lattice of its mirror images makes the path a straight line through lattice
    points; S. Tabachnikov, Geometry and Billiards (2005), chapter 2.

A question
    Change the velocity to (1, 2). Which points of the box does the disk visit now, and what is its
    period?
"""

from eventsim.scene.disks import Disks
from eventsim.scene.domain import Box
from eventsim.scene.scene import Scene


def scene(*, vx: float = 1.0, vy: float = 1.0) -> Scene:
    """One disk of diameter 1 in the middle of a box of side 10, with velocity (`vx`, `vy`)."""
    disks = Disks(position=[[5.0, 5.0]], velocity=[[vx, vy]], radius=0.5)
    return Scene(disks=disks, domain=Box((10.0, 10.0)), until=36.0, name="corner")

"""Bunimovich's stadium: chaos between walls that only focus.

What happens
    One small disk flies between two straight walls joined by two half circles. The direction of flight
    soon looks random, though no wall is convex towards it.

Why
    A half circle focuses neighbouring paths, but the table is long: beyond the focus they have time to
    part more than they were drawn together. A circle alone (half_length = 0) keeps its angle of
    incidence for ever.

Source
    L. A. Bunimovich, On the ergodic properties of nowhere dispersing billiards, Communications in
    Mathematical Physics 65, 295 (1979), doi:10.1007/BF01197884.

A question
    Compare the mean free path of a long run with pi A / P, where A and P are the area and the perimeter
    of the region that the disk's centre can reach.
"""

from eventsim.scene.disks import Disks
from eventsim.scene.domain import Open
from eventsim.scene.gallery._demand import demand
from eventsim.scene.scene import Scene
from eventsim.scene.walls import Arc, Segment, Wall


def scene(*, half_length: float = 1.0, radius: float = 0.125) -> Scene:
    """Straight walls from -`half_length` to `half_length`, half circles of radius 1; a disk of `radius`."""
    demand(half_length >= 0, "half_length", half_length, "must be at least 0")
    demand(0 <= radius < 1, "radius", radius, "must be at least 0 and below 1, the stadium's own")
    a = half_length
    walls: tuple[Wall, ...] = (
        Arc((a, -1.0), (a + 1.0, 0.0), (a, 1.0), name="east"),
        Arc((-a, 1.0), (-a - 1.0, 0.0), (-a, -1.0), name="west"),
    )
    if a > 0:
        walls += (
            Segment((-a, -1.0), (a, -1.0), name="south"),
            Segment((-a, 1.0), (a, 1.0), name="north"),
        )
    disks = Disks(position=[[0.0, 0.0]], velocity=[[0.8, 0.6]], radius=radius)
    return Scene(disks=disks, domain=Open(), walls=walls, until=200.0, name="stadium")

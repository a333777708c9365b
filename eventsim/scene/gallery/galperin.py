"""Counting contacts gives the digits of pi.

What happens
    A light disk rests between a wall and a heavy disk that comes in. They meet again and again, pairs
    and wall in turn, until both leave for good and the run ends, quiet. For mass ratios 1, 100, 10 000,
    1 000 000, ... the number of contacts is 3, 31, 314, 3141, ...

Why
    In coordinates scaled by the roots of the masses the pair is one point in a wedge of angle theta =
    arctan sqrt(m/M), and unfolding the wedge makes its path a straight line: it crosses ceil(pi/theta)
    - 1 of the images of the wedge's sides, the k-th at the time -tan(theta)/tan(k theta). The clock
    starts at -2, so that 0 is the middle of the story, when the line is closest to the corner.

Source
    G. Galperin, Playing pool with pi, Regular and Chaotic Dynamics 8, 375 (2003),
    doi:10.1070/RD2003v008n04ABEH000252. His floor(pi/theta) fails where pi/theta is a whole number
    (mass ratios 1/3, 1, 3).

A question
    After which contact is the heavy disk slowest, and where is it then? Compare the log with
    tan(theta).
"""

import math

from eventsim.scene.disks import Disks
from eventsim.scene.domain import Open
from eventsim.scene.gallery._demand import demand
from eventsim.scene.scene import Scene
from eventsim.scene.walls import Segment

SMALL = 0.5
LARGE = 1.0


def scene(*, mass_ratio: float = 100.0) -> Scene:
    """`mass_ratio` is that of the heavy disk (disk 1) to the light one (disk 0)."""
    demand(0 < mass_ratio < math.inf, "mass_ratio", mass_ratio, "must be finite and above 0")
    disks = Disks(
        position=[[SMALL + 1.0, 0.0], [2 * SMALL + LARGE + 2.0, 0.0]],
        velocity=[[0.0, 0.0], [-1.0, 0.0]],
        radius=[SMALL, LARGE],
        mass=[1.0, mass_ratio],
    )
    wall = Segment((0.0, -2.0), (0.0, 2.0), name="wall")
    return Scene(
        disks=disks,
        domain=Open(),
        walls=(wall,),
        start_time=-2.0,
        until=2.0 + 2.0 * last_contact(mass_ratio),
        name=f"Galperin, mass ratio {mass_ratio:g}",
    )


def last_contact(mass_ratio: float) -> float:
    """When the last contact comes, on the scene's clock: late where pi/theta is just above a whole number."""
    theta = math.atan(math.sqrt(1 / mass_ratio))
    beyond = math.fmod(math.pi, theta)
    # Where pi/theta is a whole number the line ends parallel to a side, and only rounding would leave an angle here.
    return math.tan(theta) / math.tan(beyond if beyond > 1e-9 * theta else theta)

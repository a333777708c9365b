"""An oblique contact between a moving disk and a resting one.

What happens
    Disk 0 comes in along x and strikes disk 1 off its centre line. The distance of that line from the
    centre of disk 1, divided by the sum of the radii, is b = offset / 5. Equal masses part at a right
    angle with velocities (b^2, b sqrt(1 - b^2)) and (1 - b^2, -b sqrt(1 - b^2)); here b = 3/5, so they
    are (0.36, 0.48) and (0.64, -0.48).

Why
    Only the component along the line of centres is exchanged. With the triangle 3, 4, 5 the moment of
    contact is exact: at t = 6 the centres are 4 apart in x and 3 in y.

Source
    L. D. Landau, E. M. Lifshitz, Mechanics, section 17; the circle of final velocities is that of
    Thales.

A question
    At offset = 5 the disks just touch in passing. What does the log hold for 5, and what for
    4.999999999999999?
"""

from eventsim.scene.disks import Disks
from eventsim.scene.domain import Open
from eventsim.scene.gallery._demand import demand
from eventsim.scene.scene import Scene


def scene(*, offset: float = 3.0, mass_ratio: float = 1.0) -> Scene:
    """`offset` is the height of disk 0's line over the centre of disk 1 (reach 5), `mass_ratio` m1 / m0."""
    demand(mass_ratio > 0, "mass_ratio", mass_ratio, "must be above 0")
    disks = Disks(
        position=[[0.0, offset], [10.0, 0.0]],
        velocity=[[1.0, 0.0], [0.0, 0.0]],
        radius=2.5,
        mass=[1.0, mass_ratio],
    )
    return Scene(disks=disks, domain=Open(), until=16.0, name="oblique contact")

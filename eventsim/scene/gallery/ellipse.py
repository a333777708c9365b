"""Points in an ellipse: foci and caustics.

What happens
    Three points of speed 1 fly in an ellipse with semi-axes 5 and 3, whose foci are at (-4, 0) and (4, 0). The first one starts
    in a focus, so it passes a focus every 10 time units, and its path comes closer and closer to the long axis. The second one
    crosses that axis between the foci, ever again: its path touches a hyperbola. The third one passes beyond the foci, and its
    path touches an ellipse.

Why
    A tangent makes equal angles with the lines to both foci. So the product of the angular momenta about the foci is
    the same after every contact. It is 0 for the first point, negative for the second one, positive for the third one. No path
    is chaotic; only that through the foci is unstable.

Source
    M. V. Berry, Regularity and chaos in classical mechanics, illustrated by three deformations of a circular billiard, Eur. J.
    Phys. 2, 91 (1981), doi:10.1088/0143-0807/2/2/006.

A question
    Where is the first point at t = 10, and where at t = 20? Try --set speed=2.
"""

from eventsim.scene.disks import Disks
from eventsim.scene.domain import Open
from eventsim.scene.gallery._demand import demand
from eventsim.scene.scene import Scene
from eventsim.scene.walls import Ellipse


def scene(*, speed: float = 1.0) -> Scene:
    """`speed` is that of all points."""
    demand(speed > 0.0, "speed", speed, "must be above 0")
    disks = Disks(
        position=[[-4.0, 0.0], [1.0, 0.0], [4.5, 0.0]],
        velocity=[[0.6 * speed, 0.8 * speed], [0.28 * speed, 0.96 * speed], [-0.28 * speed, 0.96 * speed]],
        radius=0.0,
        mass=0.0,
    )
    return Scene(disks, Open(), [Ellipse((0.0, 0.0), (5.0, 3.0), name="ellipse")], until=120.0, name="ellipse")

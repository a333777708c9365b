"""One disk meets two at the same instant.

What happens
    The cue disk runs symmetrically into two resting disks. Both contacts come at t = 3 exactly and are
    resolved jointly: the targets leave with speed 40/57 along (0.8, 0.6) and (0.8, -0.6), the cue goes
    back with 7/57.

Why
    Resolved one after the other, the outcome would depend on which disk has the lower number, and would
    not be symmetric. The joint law asks for impulses that leave no contact approaching, and keeps
    momentum, energy and the symmetry of the scene.

Source
    J. J. Moreau, Unilateral contact and dry friction in finite freedom dynamics, in Nonsmooth Mechanics
    and Applications (1988), doi:10.1007/978-3-7091-2624-0_1.

A question
    Set delay to 1e-3, then 1e-6, 1e-9: the contacts now come one after the other. Do the final
    velocities tend to those of the tie?
"""

from eventsim.scene.disks import Disks
from eventsim.scene.domain import Open
from eventsim.scene.gallery._demand import demand
from eventsim.scene.scene import Scene


def scene(*, delay: float = 0.0) -> Scene:
    """Disks of diameter 5, the cue at speed 1; `delay` moves disk 2 back along x by that length."""
    demand(delay >= 0, "delay", delay, "must be at least 0")
    disks = Disks(
        position=[[-3.0, 0.0], [4.0, 3.0], [4.0 + delay, -3.0]],
        velocity=[[1.0, 0.0], [0.0, 0.0], [0.0, 0.0]],
        radius=2.5,
    )
    return Scene(disks=disks, domain=Open(), until=10.0, name="tie")

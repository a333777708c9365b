"""Three inelastic disks on a line: eleven contacts, or infinitely many.

What happens
    Two disks close in on one between them and lose most of the speed of approach at each contact. With
    e = 0.08 there are eleven contacts, then the disks part. Below e = 7 - 4 sqrt 3 = 0.0718 the
    contacts never end: their times pile up at a finite instant.

Why
    The outer disks send the inner one to and fro. Each round multiplies the velocities of approach by a
    matrix whose eigenvalues depend on e only; where they are real, the disks come to rest relative to
    each other after infinitely many rounds, in finite time.

Source
    S. McNamara, W. R. Young, Inelastic collapse and clumping in a one-dimensional granular medium,
    Physics of Fluids A 4, 496 (1992), doi:10.1063/1.858323.

A question
    e = 0.0719 gives 89 contacts in exact arithmetic. How many does this engine find, and what does it
    say when its digits do not suffice?
"""

from eventsim.scene.disks import Disks
from eventsim.scene.domain import Open
from eventsim.scene.scene import Scene


def scene(*, restitution: float = 0.08) -> Scene:
    """Disks of diameter 1 with gaps 1 and 2, velocities 1, 0, -1, and `restitution`."""
    disks = Disks(
        position=[[-1.0, 0.0], [1.0, 0.0], [4.0, 0.0]],
        velocity=[[1.0, 0.0], [0.0, 0.0], [-1.0, 0.0]],
        radius=0.5,
    )
    return Scene(disks=disks, domain=Open(), restitution=restitution, until=10.0, name="collapse")

"""Newton's cradle, lying on a table between two walls.

What happens
    `moving` disks slide into a row of touching disks at rest; as many leave at the other end with the
    same speed, all others stop exactly. A wall sends them back, and the swing goes on with period 16.

Why
    The contact reaches only the first disk of the row. It passes its velocity on to its neighbour,
    which is touching, so the next contact is due at the same instant: equal masses exchange velocities
    one pair after the other. The law of simultaneous contacts (a joint solution for the whole row)
    would apply only to contacts that approach before any is resolved.

Source
    F. Herrmann, M. Seitz, How does the ball-chain work?, American Journal of Physics 50, 977 (1982),
    doi:10.1119/1.12936, for why real steel needs small gaps to behave like this.

A question
    Pull two disks: two leave. Momentum alone would also allow one disk at twice the speed. Which law
    forbids it?
"""

from eventsim.scene.disks import Disks
from eventsim.scene.domain import Box
from eventsim.scene.gallery._demand import demand
from eventsim.scene.scene import Scene


def scene(*, n: int = 5, moving: int = 1) -> Scene:
    """`n` disks of diameter 1, the first `moving` of them start at the left wall with speed 1."""
    demand(n >= 2, "n", n, "a cradle has at least 2 disks")
    demand(1 <= moving < n, "moving", moving, f"must be from 1 to n - 1 = {n - 1}")
    room = 4.0  # on either side of the row, once the movers have joined it
    disks = Disks(
        position=[[0.5 + i if i < moving else 0.5 + i + room, 1.0] for i in range(n)],
        velocity=[[1.0, 0.0] if i < moving else [0.0, 0.0] for i in range(n)],
        radius=0.5,
    )
    return Scene(disks=disks, domain=Box((n + 2 * room, 2.0)), until=32.0, name="Newton's cradle")

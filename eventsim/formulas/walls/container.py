"""A container: a circle from inside."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple

from eventsim.formulas.contact import leaving_delay
from eventsim.formulas.parabola import ANY_OVERLAP, circle_delays, on_circle
from eventsim.formulas.real import NEVER, Acceleration, Real, sqrt
from eventsim.formulas.roots import Line, Moment, Quartic, less_number, reaches
from eventsim.formulas.walls.face import Face


class Container(NamedTuple):
    """A circle around (x, y); disks live inside, which is the side -1."""

    x: float
    y: float
    radius: float

    @staticmethod
    def word() -> str:
        """What messages call one such shape."""
        return "container"

    def delay(
        self,
        x: Real,
        y: Real,
        vx: Real,
        vy: Real,
        gx: Acceleration,
        gy: Acceleration,
        radius: Real,
        met: int,
        touches: bool = False,
        beside: int | None = None,
    ) -> tuple[Real, int]:
        """(delay, -1) of the next contact with the container from inside."""
        if gx is None:
            return leaving_delay(x, y, vx, vy, radius, self.x, self.y, self.radius), -1
        if gx == 0.0 and gy == 0.0:  # an immovable disk, on which gravity does not act
            return leaving_delay(x, y, vx, vy, radius, self.x, self.y, self.radius), -1
        return circle_delays(x - self.x, y - self.y, vx, vy, gx, gy, self.radius - radius, -1.0, ANY_OVERLAP, touches)[0], -1

    def normal(self, side: int, x: Real, y: Real) -> tuple[Real, Real]:
        """The normal, of any length, that points to a disk at (x, y): from inside to the centre."""
        return side * (x - self.x), side * (y - self.y)

    def touching(self, side: int, x: Real, y: Real, radius: Real) -> tuple[Real, Real]:
        """The centre of a disk on contact, next to (x, y), but for the last bits."""
        return on_circle(self.x, self.y, self.radius + side * radius, x, y)

    def nearest(self, x: Real, y: Real) -> tuple[Real, Real, Real]:
        """(nx, ny, distance): the unit normal that points to a centre, and its distance; NEVER in the middle."""
        dx, dy = x - self.x, y - self.y
        distance = sqrt(dx * dx + dy * dy)
        if not distance > 0.0:
            return 0.0, 0.0, NEVER
        return -(dx / distance), -(dy / distance), self.radius - distance

    def moment(self, x: Line, y: Line, side: int, radius: float) -> Moment | Quartic | None:
        """The exact time of a contact; along a parabola the quartic whose root it is."""
        reach = Fraction(self.radius) + side * Fraction(radius)
        return reaches(less_number(x, self.x), less_number(y, self.y), reach, -side)

    def line(self) -> Face | None:
        """None: no disk rests on a round wall."""
        return None

    def lies_on(self, line: Face) -> bool:
        """False: a circle is on no line."""
        return False

    def in_numbers(self, number: Callable[[float], Real]) -> Container:
        """The same circle in other numbers than floats."""
        return Container(*map(number, self))


container_delay, container_nearest, container_touching = Container.delay, Container.nearest, Container.touching
"""The same for kernels; the normal is that of a post."""

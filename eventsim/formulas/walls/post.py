"""A post: a hard point, as at the ends of faces and arcs."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple

from eventsim.formulas.contact import circle_delay
from eventsim.formulas.parabola import ANY_OVERLAP, circle_delays, on_circle
from eventsim.formulas.real import NEVER, Acceleration, Real, sqrt
from eventsim.formulas.roots import Line, Moment, less_number, reaches
from eventsim.formulas.walls.face import Face, is_in_line


class Post(NamedTuple):
    """A hard point at (x, y)."""

    x: float
    y: float

    @staticmethod
    def word() -> str:
        """What messages call one such shape."""
        return "post"

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
    ) -> tuple[Real, int]:
        """(delay, 1) of the next contact with a post."""
        if gx is None:
            return _straight_to_post(self, x, y, vx, vy, radius, met)
        if gx == 0.0 and gy == 0.0:  # an immovable disk, on which gravity does not act
            return _straight_to_post(self, x, y, vx, vy, radius, met)
        return circle_delays(x - self.x, y - self.y, vx, vy, gx, gy, radius, 1.0, ANY_OVERLAP, touches)[0], 1

    def normal(self, side: int, x: Real, y: Real) -> tuple[Real, Real]:
        """The normal, of any length, that points to a disk at (x, y)."""
        return side * (x - self.x), side * (y - self.y)

    def touching(self, side: int, x: Real, y: Real, radius: Real) -> tuple[Real, Real]:
        """The centre of a disk on contact, next to (x, y), but for the last bits."""
        return on_circle(self.x, self.y, side * radius, x, y)

    def nearest(self, x: Real, y: Real) -> tuple[Real, Real, Real]:
        """(nx, ny, distance): the unit normal that points to a centre, and its distance; NEVER on the point itself."""
        dx, dy = x - self.x, y - self.y
        distance = sqrt(dx * dx + dy * dy)
        if not distance > 0.0:
            return 0.0, 0.0, NEVER
        return dx / distance, dy / distance, distance

    def moment(self, x: Line, y: Line, side: int, radius: float) -> Moment | None:
        """The exact time of a contact; None along a parabola."""
        return reaches(less_number(x, self.x), less_number(y, self.y), side * Fraction(radius), -side)

    def line(self) -> Face | None:
        """None: no disk rests on a post."""
        return None

    def lies_on(self, line: Face) -> bool:
        """Whether the point is on the line of a face."""
        return is_in_line(line, self.x, self.y)

    def at_origin(self) -> Post:
        """The post in the origin."""
        return Post(0.0, 0.0)

    def in_numbers(self, number: Callable[[float], Real]) -> Post:
        """The same post in other numbers than floats."""
        return Post(*map(number, self))


def _straight_to_post(shape: Post, x: Real, y: Real, vx: Real, vy: Real, radius: Real, met: int) -> tuple[Real, int]:
    if met != 0:
        return NEVER, 1
    return circle_delay(x, y, vx, vy, radius, shape.x, shape.y, 0.0), 1


post_delay, post_normal, post_nearest, post_touching = Post.delay, Post.normal, Post.nearest, Post.touching
"""The same for kernels."""

"""A post: a hard point, as at the ends of faces and arcs."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple

from eventsim.formulas.contact import circle_delay
from eventsim.formulas.doubt import SLACK
from eventsim.formulas.parabola import ANY_OVERLAP, circle_delays, on_circle
from eventsim.formulas.real import NEVER, Acceleration, Real, sqrt
from eventsim.formulas.roots import Line, Moment, Quartic, less_number, reaches
from eventsim.formulas.walls.face import Face, is_in_line
from eventsim.formulas.walls.point import CLOSE, is_near, is_point, post_delay_of_point


class Post(NamedTuple):
    """A hard point at (x, y), the end of walls.

    (ax, ay), (bx, by): from it along the two walls between which it sticks out (counter-clockwise from a to b); both the
    same at a free end, 0 where nothing ends.  size: of its coordinates.
    """

    x: float
    y: float
    ax: float = 0.0
    ay: float = 0.0
    bx: float = 0.0
    by: float = 0.0
    size: float = 0.0

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
        beside: int | None = None,
    ) -> tuple[Real, int]:
        """(delay, 1) of the next contact with a post: where a disk touches it and none of the walls that end there.

        A point meets a post only where it hits it exactly.
        """
        if gx is None and met != 0:
            return NEVER, 1
        delay = _delay_of_point(self, beside, x, y, vx, vy, gx, gy, radius)
        if delay == delay:
            return delay, 1
        if gx is None:
            return _straight_to_post(self, x, y, vx, vy, radius), 1
        if gx == 0.0 and gy == 0.0:  # an immovable disk, on which gravity does not act
            return (_straight_to_post(self, x, y, vx, vy, radius) if met == 0 else NEVER), 1
        for delay in circle_delays(x - self.x, y - self.y, vx, vy, gx, gy, radius, 1.0, ANY_OVERLAP, touches):
            if delay < NEVER:
                px, py = x + delay * (vx + (0.5 * gx) * delay), y + delay * (vy + (0.5 * gy) * delay)
                if _sticks_out(self, px, py, abs(x) + abs(y)):
                    return delay, 1
        return NEVER, 1

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

    def moment(self, x: Line, y: Line, side: int, radius: float) -> Moment | Quartic | None:
        """The exact time of a contact; along a parabola the quartic whose root it is."""
        return reaches(less_number(x, self.x), less_number(y, self.y), side * Fraction(radius), -side)

    def line(self) -> Face | None:
        """None: no disk rests on a post."""
        return None

    def lies_on(self, line: Face) -> bool:
        """Whether the point is on the line of a face."""
        return is_in_line(line, self.x, self.y)

    def in_numbers(self, number: Callable[[float], Real]) -> Post:
        """The same post in other numbers than floats."""
        return Post(*map(number, self))


post_delay, post_normal, post_nearest, post_touching = Post.delay, Post.normal, Post.nearest, Post.touching
"""The same for kernels."""


def is_post_to(shape: object, radius: float) -> bool:
    """Whether a shape is a post, and a disk of this radius a point to it."""
    return isinstance(shape, Post) and is_point(radius, shape.size)


def _straight_to_post(shape: Post, x: Real, y: Real, vx: Real, vy: Real, radius: Real) -> Real:
    delay = circle_delay(x, y, vx, vy, radius, shape.x, shape.y, 0.0)
    if delay < NEVER and _sticks_out(shape, x + vx * delay, y + vy * delay, abs(x) + abs(y)):
        return delay
    return NEVER


def _sticks_out(shape: Post, x: Real, y: Real, size: Real) -> bool:
    """Whether a disk at (x, y) that touches the post is beyond the ends of its walls; else it is theirs."""
    dx, dy = x - shape.x, y - shape.y
    slack = SLACK * (shape.size + size)
    if dx * shape.ax + dy * shape.ay > slack * (abs(shape.ax) + abs(shape.ay)):
        return False
    return not dx * shape.bx + dy * shape.by > slack * (abs(shape.bx) + abs(shape.by))


def _delay_of_point(
    shape: Post,
    beside: int | None,
    x: Real,
    y: Real,
    vx: Real,
    vy: Real,
    gx: Acceleration,
    gy: Acceleration,
    radius: Real,
) -> Real:
    """When a point hits the post; nan for what is no point."""
    if beside is None:
        return math.nan
    if not is_point(radius, shape.size):
        return math.nan
    return _exact_hit(shape, x, y, vx, vy, gx, gy)


def _exact_hit(shape: Post, x: float, y: float, vx: float, vy: float, gx: Acceleration, gy: Acceleration) -> float:
    """When a point hits the post exactly, coming from where it sticks out."""
    away = x != shape.x or y != shape.y
    if away and is_near(shape.x, shape.y, x, y, CLOSE * (shape.size + abs(x) + abs(y))):
        return NEVER  # it comes from there: the walls that end in the post decide
    delay = post_delay_of_point(x, y, vx, vy, gx, gy, shape.x, shape.y)
    if not delay < NEVER:
        return NEVER
    u, w = vx, vy
    if gx is not None:
        u, w = vx + gx * delay, vy + gy * delay
    after_b, before_a = u * shape.by - w * shape.bx, w * shape.ax - u * shape.ay
    return NEVER if after_b > 0.0 and before_a > 0.0 else delay

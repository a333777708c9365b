"""An ellipse, hard on both sides, for points that fly straight.

In its own frame, with lengths along its axes in semi-axes, it is the unit circle: contacts are those with that circle.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple

from eventsim.formulas.contact import circle_delay, leaving_delay
from eventsim.formulas.real import NEVER, Acceleration, Real, sqrt
from eventsim.formulas.roots import Line, Moment, Quartic, less_number, quadratic_root
from eventsim.formulas.walls.face import Face
from eventsim.formulas.walls.point import side_known

STEPS = 64
"""Halvings after which a foot on the ellipse is known to the last bits."""


class Ellipse(NamedTuple):
    """An ellipse around (x, y).  Outside is the side +1, inside -1.

    (ex, ey): along its first axis, as it was given; norm: the length of that.  a, b: the semi-axes.  size: of its coordinates.
    """

    x: float
    y: float
    ex: float
    ey: float
    norm: float
    a: float
    b: float
    size: float

    @property
    def semi_major(self) -> float:
        """The larger semi-axis."""
        return max(self.a, self.b)

    @staticmethod
    def word() -> str:
        """What messages call one such shape."""
        return "ellipse"

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
        """(delay, side) of the next contact of a point; who has met it from outside, and flies straight, leaves it."""
        side = side_known(met, beside)
        if side == 0:
            side = ellipse_side(self, x, y, vx, vy)
        u, w = along_axes(self, x - self.x, y - self.y)
        du, dw = along_axes(self, vx, vy)
        if side < 0:
            return leaving_delay(u, w, du, dw, 0.0, 0.0, 0.0, 1.0), -1
        if met != 0:
            return NEVER, 1
        return circle_delay(u, w, du, dw, 0.0, 0.0, 0.0, 1.0), 1

    def side(self, x: Real, y: Real, vx: Real, vy: Real) -> int:
        """+1 outside, -1 inside; a point exactly on it is on the side that it moves to."""
        u, w = along_axes(self, x - self.x, y - self.y)
        excess = (u * u - 1.0) + w * w
        if excess > 0.0:
            return 1
        if excess < 0.0:
            return -1
        du, dw = along_axes(self, vx, vy)
        return 1 if u * du + w * dw > 0.0 else -1

    def normal(self, side: int, x: Real, y: Real) -> tuple[Real, Real]:
        """The normal, of any length, that points to a disk at (x, y)."""
        u, w = along_axes(self, x - self.x, y - self.y)
        u, w = side * (u / self.a), side * (w / self.b)
        return u * self.ex - w * self.ey, u * self.ey + w * self.ex

    def touching(self, side: int, x: Real, y: Real, radius: Real) -> tuple[Real, Real]:
        """The place of a point on contact, next to (x, y), but for the last bits."""
        u, w = along_axes(self, x - self.x, y - self.y)
        length = sqrt(u * u + w * w)
        if not length > 0.0:
            return x, y
        u, w = self.a * (u / length) / self.norm, self.b * (w / length) / self.norm
        return self.x + (u * self.ex - w * self.ey), self.y + (u * self.ey + w * self.ex)

    def nearest(self, x: Real, y: Real) -> tuple[Real, Real, Real]:
        """(nx, ny, distance): the unit normal that points to a centre, and its distance; NEVER in the middle of it.

        Source: the foot (a^2 p / (t + a^2), b^2 q / (t + b^2)) of a place (p, q) is on the ellipse for one t > -b^2, a >= b > 0;
        D. Eberly, Distance from a point to an ellipse (2013).
        """
        u, w = along_axes(self, x - self.x, y - self.y)
        p, q = self.a * u, self.b * w
        if p == 0.0 and q == 0.0:
            return 0.0, 0.0, NEVER
        f, g = foot(self.a, self.b, p, q)
        side = 1.0 if (u * u - 1.0) + w * w >= 0.0 else -1.0
        nx, ny = side * (f / self.a) / self.a, side * (g / self.b) / self.b
        length = sqrt(nx * nx + ny * ny)
        nx, ny = nx / length, ny / length
        distance = nx * (p - f) + ny * (q - g)
        return (nx * self.ex - ny * self.ey) / self.norm, (nx * self.ey + ny * self.ex) / self.norm, distance

    def moment(self, x: Line, y: Line, side: int, radius: float) -> Moment | Quartic | None:
        """The exact time of a contact."""
        x, y = less_number(x, self.x), less_number(y, self.y)
        if x[2] or y[2]:
            return None
        ex, ey, a2, b2 = Fraction(self.ex), Fraction(self.ey), Fraction(self.a) ** 2, Fraction(self.b) ** 2
        (u, du), (w, dw) = ((ex * x[k] + ey * y[k] for k in (0, 1)), (ex * y[k] - ey * x[k] for k in (0, 1)))
        scale = ex * ex + ey * ey
        return quadratic_root(
            du * du / a2 + dw * dw / b2, u * du / a2 + w * dw / b2, u * u / a2 + w * w / b2 - scale, -side
        )

    def line(self) -> Face | None:
        """None: no disk rests on a round wall."""
        return None

    def lies_on(self, line: Face) -> bool:
        """False: an ellipse is on no line."""
        return False

    def in_numbers(self, number: Callable[[float], Real]) -> Ellipse:
        """The same ellipse in other numbers than floats, its direction of length 1 to their digits."""
        shape = Ellipse(*map(number, self))
        return shape._replace(norm=sqrt(shape.ex * shape.ex + shape.ey * shape.ey))


ellipse_delay, ellipse_side, ellipse_normal = Ellipse.delay, Ellipse.side, Ellipse.normal
ellipse_touching, ellipse_nearest = Ellipse.touching, Ellipse.nearest
"""The same for kernels."""


def along_axes(shape: Ellipse, dx: Real, dy: Real) -> tuple[Real, Real]:
    """A vector in the frame in which the ellipse is the unit circle."""
    return (shape.ex * dx + shape.ey * dy) / shape.norm / shape.a, (shape.ex * dy - shape.ey * dx) / shape.norm / shape.b


def foot(a: Real, b: Real, p: Real, q: Real) -> tuple[Real, Real]:
    """The place on an ellipse with semi-axes along x and y that is nearest to (p, q)."""
    if a < b:
        g, f = foot_of_flat(b, a, abs(q), abs(p))
    else:
        f, g = foot_of_flat(a, b, abs(p), abs(q))
    return (f if p >= 0.0 else -f), (g if q >= 0.0 else -g)


def foot_of_flat(a: Real, b: Real, p: Real, q: Real) -> tuple[Real, Real]:
    """The same for a >= b and p, q >= 0."""
    if q == 0.0 and (a - b) * (a + b) > a * p:
        f = a * (p * a) / ((a - b) * (a + b))
        return f, b * sqrt((1.0 - f / a) * (1.0 + f / a))
    low, high = b * q - b * b, sqrt(a * p * a * p + b * q * b * q) - b * b
    for _ in range(STEPS):
        t = 0.5 * (low + high)
        u, w = a * p / (t + a * a), _share(b * q, t + b * b)
        if u * u + w * w > 1.0:
            low = t
        else:
            high = t
    t = 0.5 * (low + high)
    u, w = a * p / (t + a * a), _share(b * q, t + b * b)
    length = sqrt(u * u + w * w)
    return a * (u / length), b * (w / length)


def _share(part: Real, whole: Real) -> Real:
    """part / whole, both at least 0; of nothing, which rounding may leave of the whole, it is all or none."""
    if whole > 0.0:
        return part / whole
    return 1.0 if part > 0.0 else 0.0

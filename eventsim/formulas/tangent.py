"""The tangent map of a contact: what becomes of a small deviation from a trajectory.

A deviation is (x, y, vx, vy) per disk, all at one time.  In free flight the places gain t times the velocities, and gravity drops
out.  At a contact the neighbouring trajectory meets a little earlier or later, and along another normal:

    shift = -(n d) / (n u)                    how much later it meets; d, u: relative deviation and velocity before
    turn  = curvature (t (d + u shift))       by how much its normal is turned; t: the tangent, n rotated by a right angle

Rough disks also have a deviation of the spin.  What the contact does along the surfaces is in proportion to the velocity g at
which they slide past each other (`formulas.rough`), so its deviation is that of g, and of the tangent.

Everything is linear in the deviation.  So deviations may be floats, or arrays of several ones.
Source: Gaspard, Chaos, Scattering and Statistical Mechanics (1998), section 1.4; Dellago, Posch, Hoover, Phys. Rev. E 53, 1485
(1996), doi:10.1103/PhysRevE.53.1485; of rough disks: van Meel, Posch, Phys. Rev. E 80, 016206 (2009),
doi:10.1103/PhysRevE.80.016206.
"""

from __future__ import annotations

from typing import Any, NamedTuple


class Meeting(NamedTuple):
    """How a neighbouring trajectory meets.

    shift: how much later.  turn: by which angle its normal is turned.  (push_x, push_y): the change of (n u) n, of which each
    body gets its part.
    """

    shift: Any
    turn: Any
    push_x: Any
    push_y: Any


def meeting(
    nx: float,
    ny: float,
    ux: float,
    uy: float,
    curvature: float,
    dx: Any,
    dy: Any,
    du: Any,
    dw: Any,
    gx: float = 0.0,
    gy: float = 0.0,
    away: float = 0.0,
) -> Meeting:
    """Return how a neighbour meets.

    Args:
        nx, ny: the unit normal, towards the first body.
        ux, uy: the velocity of the first body relative to the second one; (n u) below 0.
        curvature: 1 / distance from the centre of curvature, 1 / length; below 0 where the wall is met from inside.
        dx, dy, du, dw: the relative deviation of place and velocity.
        gx, gy: the relative acceleration.
        away: the speed along the normal at which a wall meets it that shakes, and stays where it is.
    """
    approach = nx * ux + ny * uy
    shift = -(nx * dx + ny * dy) / approach
    along = nx * (dy + uy * shift) - ny * (dx + ux * shift)
    turn = curvature * along
    sideways = nx * uy - ny * ux
    change = nx * (du + gx * shift) + ny * (dw + gy * shift) + turn * sideways
    met = approach - away
    return Meeting(shift, turn, change * nx - met * turn * ny, change * ny + met * turn * nx)


def after(
    part: float, approach: float, nx: float, ny: float, how: Meeting, x: Any, y: Any, u: Any, w: Any
) -> tuple[Any, Any, Any, Any]:
    """Return the deviation of one body behind the contact.

    Args:
        part: its velocity changes by -part (n u) n; 1 + e at a wall.
        approach: (n u), below 0; less `away` at a wall that shakes.
        nx, ny: as in `meeting`.
        how: what `meeting` gave.
        x, y, u, w: its deviation before.
    """
    moved = part * approach * how.shift
    return x + moved * nx, y + moved * ny, u - part * how.push_x, w - part * how.push_y


def sliding(
    nx: float, ny: float, ux: float, uy: float, how: Meeting, du: Any, dw: Any, spun: Any, gx: float = 0.0, gy: float = 0.0
) -> Any:
    """Return how much faster the surfaces of a neighbour slide past each other.

    Args:
        nx, ny, ux, uy, du, dw, gx, gy: as in `meeting`.
        how: what `meeting` gave.
        spun: the deviation of the velocity of the surfaces that is due to spin, the sum of radius times spin.
    """
    along = nx * (dw + gy * how.shift) - ny * (du + gx * how.shift)
    return along - how.turn * (nx * ux + ny * uy) - spun


def after_grip(
    got: float, change: Any, nx: float, ny: float, how: Meeting, x: Any, y: Any, u: Any, w: Any
) -> tuple[Any, Any, Any, Any]:
    """Return the deviation of one body behind a contact that also changes its velocity along the tangent.

    Args:
        got: by how much the contact changes that velocity.
        change: how much more it does so of the neighbour.
        nx, ny, how: as in `after`.
        x, y, u, w: what `after` gave.
    """
    moved = got * how.shift
    return (
        x + moved * ny,
        y - moved * nx,
        u - change * ny - got * how.turn * nx,
        w + change * nx - got * how.turn * ny,
    )

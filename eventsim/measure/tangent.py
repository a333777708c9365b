"""Deviations from a run, carried along its rows by the tangent map (`formulas.tangent`)."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from itertools import repeat
from typing import Any, NamedTuple, TypeAlias

from eventsim.formulas.impulse import mass_fractions
from eventsim.formulas.rough import SMOOTH, Roughness, pair_grip, wall_grip
from eventsim.formulas.tangent import Meeting, after, after_grip, meeting, sliding
from eventsim.formulas.walls.boundary import Boundary
from eventsim.formulas.walls.shape import Shape
from eventsim.measure.sums import nearest
from eventsim.record.events import SPINS, Kind, Rows, has_spins
from eventsim.scene.numbers import Point
from eventsim.scene.scene import Scene
from eventsim.scene.stage import Stage, stage_of
from eventsim.scene.walls import parts_of

UNSEEN = 1e-12
"""Share of a velocity below which its change tells no direction: rounding."""

NEAR = 2.0**-13
"""Share of a distance over which a normal is looked at again for its curvature, whose error is the square of this."""

Deviation: TypeAlias = tuple[Any, Any, Any, Any]
"""(x, y, vx, vy) of a disk: floats, or arrays of several deviations."""

Vector: TypeAlias = tuple[float, float]

Rounding: TypeAlias = Callable[[Deviation, float, float, float, float, float], Deviation]
"""A deviation with what rounding adds, from (deviation, x, y, vx, vy, time that is rounded)."""


class Passed(NamedTuple):
    """What a row did.

    Attributes:
        event, time: as in the log.
        disks: that took part.
        lags: time since the row before of each; inf where there was none.
        shift: how much later a neighbour meets; 0.0 where nothing approached.
        joint: whether it is one of several contacts at one instant.
        met: what each of the disks met: another disk, or -1 - wall.
    """

    event: int
    time: float
    disks: tuple[int, ...]
    lags: tuple[float, ...]
    shift: Any
    joint: bool
    met: tuple[int, ...]


class Tangent:
    """Deviations of all disks of a run, each at the time of the disk's last row.

    off: the deviations, by disk.  spun: those of the angular velocities; None where disks have no spin.  spin: angular
    velocities of the run; not used where disks have none.

    Laws are taken as the log shows them: what share of the approach velocity came back is no function of it.
    """

    def __init__(
        self, scene: Scene, off: list[Deviation], rounding: Rounding | None = None, corner: Point | None = None
    ) -> None:
        """Begin with deviations; rounding: what each row adds; corner: what places in rows are relative to, None: the stage's."""
        stage = stage_of(scene, corner)
        self.off = off
        self.spun: list[Any] | None = None if stage.spin is None else [0.0 * one[0] for one in off]
        self.spin: list[float] = scene.disks.spins().tolist()
        self._mass: list[float] = scene.disks.mass.tolist()
        self._moment: list[float] = scene.disks.moments().tolist()
        self._rough = stage.law.rough or Roughness(SMOOTH, SMOOTH)
        self._rounding = rounding
        self._stage = stage
        self._periods = tuple(length or 0.0 for length in stage.period)
        gravity = stage.gravity or (0.0, 0.0)
        self._fall = [(0.0, 0.0) if math.isinf(mass) else gravity for mass in scene.disks.mass.tolist()]
        self._pull: list[Vector] = list(self._fall)
        self._slopes = [(float(ax), float(ay)) for ax, ay in stage.slopes]
        self._radius: list[float] = scene.disks.radius.tolist()
        self._since: list[Vector | None] = [None] * stage.n
        self._velocity = list(zip(stage.vx.tolist(), stage.vy.tolist(), strict=True))
        self._pieces = _pieces_of(stage)
        first = len(stage.wall_names) - len(parts_of(scene.walls))
        self._scales = {
            first + k: part.curvature_radius() or part.length() for k, part in enumerate(parts_of(scene.walls))
        }

    def follow(self, rows: Rows) -> Iterator[Passed]:
        """Take the deviations through rows, one by one; what each did."""
        names = "event", "time", "kind", "a", "b", "wall", "joint", "epoch", "remainder"
        places = "xa", "ya", "vxa", "vya", "xb", "yb", "vxb", "vyb"
        columns = (rows[name].tolist() for name in names + places)
        spins = (rows[name].tolist() if has_spins(rows) else repeat(0.0, len(rows)) for name in SPINS)
        for event, time, kind, a, b, wall, joint, epoch, remainder, xa, ya, vxa, vya, xb, yb, vxb, vyb, spin_a, spin_b in zip(
            *columns, *spins, strict=True
        ):
            before, lag = self._arrive(a, epoch, remainder, xa, ya)
            slips = self._slip(a, spin_a), 0.0
            if kind == Kind.PAIR:
                slips = slips[0], self._slip(b, spin_b)
                other, lag_b = self._arrive(b, epoch, remainder, xb, yb)
                between = nearest(xa - xb, self._periods[0]), nearest(ya - yb, self._periods[1])
                shift = self._pass_pair(a, b, between, (before, (vxa, vya)), (other, (vxb, vyb)), slips)
                self._velocity[b] = vxb, vyb
                self._pull[b] = self._fall[b]
                passed = Passed(event, time, (a, b), (lag, lag_b), shift, joint >= 0, (b, a))
            else:
                shift = self._pass_wall(a, wall, kind, (xa, ya), before, (vxa, vya), slips[0])
                passed = Passed(event, time, (a,), (lag,), shift, joint >= 0, (-1 - wall,))
            self._velocity[a] = vxa, vya
            self._pull[a] = self._slopes[wall] if kind == Kind.REST else self._fall[a]
            yield passed

    def _arrive(self, i: int, epoch: int, remainder: float, x: float, y: float) -> tuple[Vector, float]:
        """Fly disk i to a row: its velocity there, and the time since its last row."""
        since, (vx, vy), (gx, gy) = self._since[i], self._velocity[i], self._pull[i]
        begun, rest = since or (0, 0.0)
        lag = (epoch - begun) * self._stage.epoch_length + (remainder - rest)
        dx, dy, du, dw = self.off[i]
        vx, vy = vx + gx * lag, vy + gy * lag
        off = dx + du * lag, dy + dw * lag, du, dw
        self.off[i] = off if self._rounding is None else self._rounding(off, x, y, vx, vy, lag + remainder)
        self._since[i] = epoch, remainder
        return (vx, vy), math.inf if since is None else lag

    def _slip(self, i: int, spin: float) -> float:
        """By how much a contact changed the velocity of disk i along the tangent: told by its new spin, since it is a torque."""
        before, self.spin[i] = self.spin[i], spin
        return self._moment[i] * self._radius[i] * (before - spin)

    def _pass_pair(
        self,
        i: int,
        j: int,
        between: Vector,
        one: tuple[Vector, Vector],
        other: tuple[Vector, Vector],
        slips: tuple[float, float],
    ) -> Any:
        """Take the deviations of two disks through their contact, from velocities (before, after) and slips; the shift."""
        (ax, ay), (vx, vy) = one
        (bx, by), (ux, uy) = other
        reach = self._radius[i] + self._radius[j]
        # In a small domain the nearest image need not be the one that was met: the push tells the normal.
        nx, ny = (
            _pushed(vx - ax, vy - ay, ax, ay, slips[0])
            or _pushed(bx - ux, by - uy, bx, by, slips[1])
            or _pushed(*between, 0.0, 0.0)
            or (1.0, 0.0)
        )
        approach = nx * (ax - bx) + ny * (ay - by)
        if not (approach < 0.0 and reach > 0.0):
            return 0.0
        (px, py, pu, pw), (qx, qy, qu, qw) = self.off[i], self.off[j]
        gx, gy = self._pull[i][0] - self._pull[j][0], self._pull[i][1] - self._pull[j][1]
        how = meeting(nx, ny, ax - bx, ay - by, 1.0 / reach, px - qx, py - qy, pu - qu, pw - qw, gx, gy)
        part_i, part_j = (
            -(nx * (u - before) + ny * (w - other)) / approach
            for u, w, before, other in ((vx, vy, ax, ay), (ux, uy, bx, by))
        )
        self.off[i] = after(part_i, approach, nx, ny, how, px, py, pu, pw)
        self.off[j] = after(part_j, approach, nx, ny, how, qx, qy, qu, qw)
        if self.spun is not None and self._stage.law.grips[0]:
            shares = mass_fractions(self._mass[i], self._mass[j])
            about = (*shares, self._radius[i], self._radius[j], self._moment[i], self._moment[j], self._rough.pair)
            turn_i, turn_j, k = pair_grip(reach, 0.0, -1.0, 1.0, 0.0, 0.0, *about)  # what surfaces do that slide by at 1
            turned = self._radius[i] * self.spun[i] + self._radius[j] * self.spun[j]
            faster = sliding(nx, ny, ax - bx, ay - by, how, pu - qu, pw - qw, turned, gx, gy)
            self._grip(i, slips[0], -k * shares[1] * reach, turn_i, faster, (nx, ny), how)
            self._grip(j, -slips[1], k * shares[0] * reach, turn_j, faster, (nx, ny), how)
        return how.shift

    def _grip(self, i: int, got: float, share: float, turn: float, faster: Any, normal: Vector, how: Meeting) -> None:
        """Take the deviation of disk i through what a contact does along the surfaces.

        got: the change of its velocity along the tangent; share, turn: that of this velocity and of its spin where surfaces slide
        past each other at 1; faster: the deviation of that velocity.
        """
        assert self.spun is not None
        self.off[i] = after_grip(got, share * faster, *normal, how, *self.off[i])
        self.spun[i] = self.spun[i] + turn * faster

    def _pass_wall(
        self, i: int, wall: int, kind: int, place: Vector, before: Vector, behind: Vector, slip: float
    ) -> Any:
        """Take the deviation of a disk through a row without a partner; the shift."""
        dx, dy, du, dw = self.off[i]
        if kind == Kind.KICK:  # another velocity, at a time that nothing shifts
            self.off[i] = dx, dy, 0.0 * du, 0.0 * dw
            return 0.0
        (ax, ay), (vx, vy) = before, behind
        normal = _pushed(vx - ax, vy - ay, ax, ay, slip)
        approach = 0.0 if normal is None else normal[0] * ax + normal[1] * ay
        if normal is None or not approach < 0.0:
            return 0.0
        nx, ny = normal
        away = self._stage.law.treatment(wall).shaking
        how = meeting(nx, ny, ax, ay, self._curvature(wall, i, place, normal), dx, dy, du, dw, *self._pull[i], away)
        part = -(nx * (vx - ax) + ny * (vy - ay)) / (approach - away)
        self.off[i] = after(part, approach - away, nx, ny, how, dx, dy, du, dw)
        if self.spun is not None and self._stage.law.grips[1]:
            radius = self._radius[i]
            turn, k = wall_grip(1.0, 0.0, -1.0, 1.0, 0.0, radius, self._moment[i], self._rough.wall)
            faster = sliding(nx, ny, ax, ay, how, du, dw, radius * self.spun[i], *self._pull[i])
            self._grip(i, slip, -k, turn, faster, normal, how)
        return how.shift

    def _curvature(self, wall: int, i: int, place: Vector, normal: Vector) -> float:
        """The curvature, at a place of disk i, of the line on which centres touch that wall with this normal.

        It is how fast the normal turns beside the place. Looked at a little above it, since a point on the wall may be behind it.
        """
        (x, y), (nx, ny), radius = place, normal, self._radius[i]
        if not self._pieces[wall]:
            return 0.0
        step = NEAR * (radius or self._scales[wall])
        best, piece = math.inf, None
        for one in self._pieces[wall]:
            mx, my, away = one.nearest(x + nx * step, y + ny * step)
            miss = abs(away - radius - step) / step + math.hypot(mx - nx, my - ny) if away < math.inf else math.inf
            if miss < best:
                best, piece = miss, one
        if piece is None:
            return 0.0
        x, y = x + nx * step, y + ny * step
        (ax, ay, a), (bx, by, b) = (piece.nearest(x - s * ny, y + s * nx) for s in (step, -step))
        if math.isinf(a) or math.isinf(b):
            return 0.0
        turn = float(nx * (ay - by) - ny * (ax - bx)) / (2.0 * step)
        return turn / (1.0 - turn * step)


def _pieces_of(stage: Stage) -> dict[int, list[Shape]]:
    """The shapes of each wall, by its number in the log; none for straight sides of the domain."""
    pieces: dict[int, list[Shape]] = {surface.wall: [] for surface in stage.surfaces}
    for surface in stage.surfaces:
        if not isinstance(surface, Boundary):
            pieces[surface.wall].append(surface.shape)
    return pieces


def _pushed(dx: float, dy: float, vx: float, vy: float, slip: float = 0.0) -> Vector | None:
    """The normal of a change of velocity, `slip` of which is along the tangent; None where it is rounding."""
    size = math.hypot(dx, dy)
    if not size > UNSEEN * math.hypot(vx, vy):
        return None
    nx, ny = dx / size, dy / size
    if slip == 0.0:
        return nx, ny
    sine = min(max(slip / size, -1.0), 1.0)
    cosine = math.sqrt(1.0 - sine * sine)
    return nx * cosine + ny * sine, ny * cosine - nx * sine

"""Predictions: all events that the present flight of a disk can lead to, pushed into the calendar."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeAlias

from eventsim.engines.reference.calendar import CONTACT, CROSSING, WRAP, Calendar, Event
from eventsim.engines.reference.cells import Cells, Group, images_of
from eventsim.engines.reference.state import EngineState
from eventsim.formulas.contact import screened_pair_delay
from eventsim.formulas.corner import passes_sliding
from eventsim.formulas.crossing import crossing_delay
from eventsim.formulas.digits import careful_pair_delay
from eventsim.formulas.motion import position, velocity
from eventsim.formulas.parabola import ANY_OVERLAP, circle_delays
from eventsim.formulas.real import NEVER, Real, is_float
from eventsim.formulas.rest import LEFT, STRUCK, SUPPORTED, border_contact, border_size, held_by, shape_contact
from eventsim.formulas.walls.shape import Shape
from eventsim.scene.corners import is_cornered
from eventsim.scene.stage import Stage

Apart: TypeAlias = tuple[float, float, float, float]
"""The distance and the relative velocity of two disks."""

Border: TypeAlias = tuple[int, int, float, float]
"""An end of the domain: (rank of its events, place of the wall, position, 1 where the radius keeps a centre away from it)."""


class Predictor:
    """Predicts for one stage; `cells` is None where all pairs are looked at.

    straight_delay: the delay of a pair in straight relative flight; nan where it does not know.
    """

    straight_delay: Callable[..., Real] = staticmethod(screened_pair_delay)

    def __init__(self, stage: Stage, state: EngineState, calendar: Calendar, cells: Cells | None) -> None:
        self._stage = stage
        self._state = state
        self._push: Callable[[Event], None] = calendar.push
        self._cells = cells
        self._radius: list[Real] = stage.radius.tolist()
        self._borders = _borders(stage)
        first = len(stage.boundaries)
        self._features = tuple((first + k, feature.shape) for k, feature in enumerate(stage.features))
        self._shifts = stage.shifts
        self._falls = stage.gravity is not None
        self._settles = stage.settles
        self._series = [stage.law.series(stage.law.of_wall(surface.wall)) for surface in stage.surfaces]
        self._unmoved = _classes(stage)
        everyone = list(range(stage.n))
        self._everyone: list[Group] = [(everyone, image) for image in images_of(stage)]

    def predict(self, i: int, now: Real) -> None:
        """Push every event of disk i: contacts with disks and walls, wraps, and the next cell crossing."""
        self._contacts(i, self._everyone if self._cells is None else self._cells.near(i))
        self._alone(i, now)

    def predict_all(self, now: Real) -> None:
        """Push every event of every disk; a pair once."""
        for i in range(self._state.n):
            near = self._everyone if self._cells is None else self._cells.near(i)
            self._contacts(i, [([j for j in members if j > i], image) for members, image in near])
            self._alone(i, now)

    def _alone(self, i: int, now: Real) -> None:
        """Push the events of disk i that involve no other disk."""
        for axis in (0, 1):
            low, high = (None, None) if self._cells is None else self._cells.edges(i, axis)
            if low is None:
                self._border(i, axis, -1)
            if high is None:
                self._border(i, axis, 1)
        self.predict_walls(i)
        if self._cells is not None:
            self._crossing(i, now)

    def predict_walls(self, i: int) -> None:
        """Push the contacts of disk i with shapes inside the domain."""
        for place, shape in self._features:
            self._wall(i, place, shape)

    def predict_pairs(self, i: int, others: list[int]) -> None:
        """Push the contacts of disk i with some others, not with images of them."""
        self._contacts(i, [(others, (0, 0))])

    def predict_ahead(self, i: int, axis: int, step: int, now: Real) -> None:
        """Push what disk i can meet since it entered a new cell: the disks ahead of it, and the end of the domain."""
        cells = self._cells
        assert cells is not None
        self._contacts(i, cells.ahead(i, axis, step))
        if cells.edges(i, axis)[step > 0] is None:
            self._border(i, axis, step)
        self._crossing(i, now)

    def _contacts(self, i: int, near: Iterable[Group]) -> None:
        """Push the contacts of disk i with others; symmetric under exchange of the two, bit for bit."""
        state = self._state
        t, x, y, vx, vy = state.t, state.x, state.y, state.vx, state.vy
        ti, xi, yi, ui, wi = t[i], x[i], y[i], vx[i], vy[i]
        gravity_x, gravity_y, falls = state.gravity_x, state.gravity_y, self._falls
        radius, unmoved, met = self._radius, self._unmoved, state.met
        reach_i = radius[i]
        straight_delay = self.straight_delay
        for members, image in near:
            kx, ky = image
            shift_x, shift_y = self._shifts(image) if kx or ky else (0.0, 0.0)
            for j in members:
                if j == i or (unmoved is not None and unmoved[i] and unmoved[i] == unmoved[j]):
                    continue
                tj = t[j]
                if falls:
                    tr = ti if ti > tj else tj
                    gx, gy = gravity_x[i], gravity_y[i]
                    hx, hy = gravity_x[j], gravity_y[j]
                    lag, lag_j = tr - ti, tr - tj
                    dx = position(xi, ui, lag, gx) - position(x[j], vx[j], lag_j, hx)
                    dy = position(yi, wi, lag, gy) - position(y[j], vy[j], lag_j, hy)
                    du = velocity(ui, lag, gx) - velocity(vx[j], lag_j, hx)
                    dw = velocity(wi, lag, gy) - velocity(vy[j], lag_j, hy)
                else:
                    uj, wj = vx[j], vy[j]
                    du, dw = ui - uj, wi - wj
                    if ti > tj:
                        tr, lag = ti, ti - tj
                        dx, dy = xi - (x[j] + uj * lag), yi - (y[j] + wj * lag)
                    else:
                        tr, lag = tj, tj - ti
                        dx, dy = (xi + ui * lag) - x[j], (yi + wi * lag) - y[j]
                if kx:
                    dx = dx - shift_x
                if ky:
                    dy = dy - shift_y
                if falls and (gx != hx or gy != hy):
                    touches = self._settles and self._touch(i, j, kx, ky)
                    pull = gx - hx, gy - hy
                    delay, _ = circle_delays(dx, dy, du, dw, *pull, reach_i + radius[j], 1.0, ANY_OVERLAP, touches)
                    if not delay < NEVER:
                        continue
                else:
                    delay = straight_delay(dx, dy, du, dw, reach_i + radius[j])
                    if delay == NEVER or (met[i] and met[j] and self._just_met(i, j, kx, ky)):
                        continue
                    if not delay < NEVER:
                        delay = self._careful_delay(i, j, image, (dx, dy, du, dw))
                        if delay == NEVER:
                            continue
                if i < j:
                    self._push(Event(tr + delay, CONTACT, i, j, image, state.count[i], state.count[j]))
                else:
                    self._push(Event(tr + delay, CONTACT, j, i, (-kx, -ky), state.count[j], state.count[i]))

    def _careful_delay(self, i: int, j: int, image: tuple[int, int], apart: Apart) -> float:
        """The delay of a pair from the two flights themselves, right to the last bit; along parabolas from what is apart."""
        s, ri, rj = self._state, self._radius[i], self._radius[j]
        if self._falls:
            return careful_pair_delay(*apart, 0.0, ri, 0.0, 0.0, 0.0, 0.0, 0.0, rj, 0.0, 0.0)
        return careful_pair_delay(
            *(s.x[i], s.y[i], s.vx[i], s.vy[i], s.t[i], ri),
            *(s.x[j], s.y[j], s.vx[j], s.vy[j], s.t[j], rj),
            *self._shifts(image),
        )

    def _just_met(self, i: int, j: int, kx: int, ky: int) -> bool:
        """Whether both remember each other, in this image, as what they met last: flying straight, they only recede."""
        state = self._state
        ux, uy = kx + state.wraps_x[i] - state.wraps_x[j], ky + state.wraps_y[i] - state.wraps_y[j]
        return (j, ux, uy) in state.met[i] and (i, -ux, -uy) in state.met[j]

    def _touch(self, i: int, j: int, kx: int, ky: int) -> bool:
        """Whether the flights of both disks began at their contact with each other."""
        state = self._state
        both = state.begins_on_contact(i) and state.begins_on_contact(j)
        return both and bool(state.t[i] == state.t[j]) and self._just_met(i, j, kx, ky)

    def _border(self, i: int, axis: int, step: int) -> None:
        """Push what happens to disk i at the low (-1) or high (+1) end of the domain: a contact, a wrap, or nothing."""
        border = self._borders[axis][step > 0]
        if border is None:
            return
        rank, place, position_, inset = border
        state = self._state
        target = position_ - step * (inset * self._radius[i])
        if rank == WRAP:
            x, v, g = self._along(i, axis)
            delay, how = crossing_delay(x, v, g, target, -step), STRUCK
        else:
            delay, how = self._border_contact(i, place, axis, -step, target)
            if how == STRUCK and self._slides_past(i, place, -step, delay):
                return
        if delay < NEVER:
            b, image = (axis, (step, 0)) if rank == WRAP else (-1 - place, (-step, how))
            self._push(Event(state.t[i] + delay, rank, i, b, image, state.count[i], 0))

    def _along(self, i: int, axis: int) -> tuple[Real, Real, Real]:
        """The coordinate, velocity and acceleration of disk i along an axis."""
        state = self._state
        if axis == 0:
            return state.x[i], state.vx[i], state.gravity_x[i]
        return state.y[i], state.vy[i], state.gravity_y[i]

    def _border_contact(self, i: int, place: int, axis: int, side: float, target: Real) -> tuple[Real, int]:
        """(delay, STRUCK or SUPPORTED) of the next event at a wall of the domain, which keeps a coordinate at `target`."""
        state = self._state
        x, v, g = self._along(i, axis)
        if state.supports is None:
            return crossing_delay(x, v, g, target, side), STRUCK
        size = border_size(x, abs(state.x[i]) + abs(state.y[i]), target, state.is_as_at_start(i))
        held, e = held_by(state.met[i]), self._series[place]
        since = state.since_met(i, -1 - place)
        delay, how = border_contact(state.supports, held, place, side, target, x, v, g, size, e, state.t[i], since)
        if how == SUPPORTED and self._is_cornered(i, place, int(side)):
            return crossing_delay(x, v, g, target, side), STRUCK
        return delay, how

    def _wall(self, i: int, place: int, shape: Shape) -> None:
        """Push the contact of disk i with a shape inside the domain."""
        state = self._state
        delay, side, how = self._shape_contact(i, place, shape)
        if delay < NEVER and not (how == STRUCK and self._slides_past(i, place, side, delay)):
            self._push(Event(state.t[i] + delay, CONTACT, i, -1 - place, (side, how), state.count[i], 0))

    def _shape_contact(self, i: int, place: int, shape: Shape) -> tuple[Real, int, int]:
        """(delay, side, how) of the next event at a shape inside the domain."""
        state = self._state
        met = next((last[1] for last in state.met[i] if last[0] == -1 - place), 0)
        flight = state.x[i], state.y[i], state.vx[i], state.vy[i], state.gravity_x[i], state.gravity_y[i]
        held = None if state.supports is None else held_by(state.met[i])
        since = state.since_met(i, -1 - place)
        touches = self._settles and met != 0 and bool(since == 0.0)
        if held is not None and held.how == LEFT:
            since = state.since_contact(i)
        beside = state.side_beside(i, place)
        e, t = self._series[place], state.t[i]
        delay, side, how = shape_contact(
            state.supports, held, place, shape, flight, self._radius[i], met, e, t, since, touches, beside
        )
        if how == SUPPORTED and self._is_cornered(i, place, side):
            return *shape.delay(*flight, self._radius[i], met, touches, beside), STRUCK
        return delay, side, how

    def _is_cornered(self, i: int, place: int, side: int) -> bool:
        """Whether disk i, at rest on a wall that it has not met last, would be pressed onto one that it has."""
        state = self._state
        return is_cornered(self._stage, state.met[i], place, side, state.x[i], state.y[i])

    def _slides_past(self, i: int, place: int, side: int, delay: Real) -> bool:
        """Whether disk i is about to rest on the wall that it met last, and to slide there, but not into this one.

        Then it does not meet this one in its last bounces, which nobody tells one by one: these are on both, or on that one.
        """
        state, met = self._state, self._state.met[i]
        if not self._settles or state.supports is None or not delay < NEVER or len(met) != 1:
            return False
        last, side_there, how = met[0]
        if last >= 0 or how != STRUCK or last == -1 - place or state.supports[-1 - last] is None:
            return False
        if not is_float(delay):
            return False
        px, py = state.place(i, state.t[i] + delay)
        normals = *self._stage.normal(-1 - last, side_there, px, py), *self._stage.normal(place, side, px, py)
        flight = state.vx[i], state.vy[i], state.gravity_x[i], state.gravity_y[i]
        return passes_sliding(*normals, *flight) and self._rests_behind(i, -1 - last, delay)

    def _rests_behind(self, i: int, place: int, delay: Real) -> bool:
        """Whether the next event of disk i at a wall is to rest there, after a delay or later."""
        boundary = self._stage.boundary(place)
        if boundary is None:
            shape = self._features[place - len(self._stage.boundaries)][1]
            rest, _, how = self._shape_contact(i, place, shape)
        else:
            rest, how = self._border_contact(i, place, boundary.axis, boundary.side, boundary.target(self._radius[i]))
        return how == SUPPORTED and bool(delay <= rest)

    def _crossing(self, i: int, now: Real) -> None:
        """Push the next passage of disk i into another cell, reckoned from where it is now."""
        state, cells = self._state, self._cells
        assert cells is not None
        x, y = state.place(i, now)
        u, w = state.speed(i, now)
        best, best_axis, best_step = NEVER, 0, 0
        for axis, at, v, g in ((0, x, u, state.gravity_x[i]), (1, y, w, state.gravity_y[i])):
            low, high = cells.edges(i, axis)
            if high is not None and (v > 0.0 or g is not None):
                delay = crossing_delay(at, v, g, high, -1)
                if delay < best:
                    best, best_axis, best_step = delay, axis, 1
            if low is not None and (v < 0.0 or g is not None):
                delay = crossing_delay(at, v, g, low, 1)
                if delay < best:
                    best, best_axis, best_step = delay, axis, -1
        if best < NEVER:
            self._push(Event(now + best, CROSSING, i, best_axis, (best_step, 0), state.count[i], 0))


def _borders(stage: Stage) -> tuple[tuple[Border | None, Border | None], ...]:
    """What is at the low and the high end of the domain along x and y."""
    found: list[list[Border | None]] = [[None, None], [None, None]]
    for axis, length in enumerate(stage.period):
        if length is not None:
            found[axis] = [(WRAP, -1, 0.0, 0.0), (WRAP, -1, length, 0.0)]
    for place, boundary in enumerate(stage.boundaries):
        found[boundary.axis][boundary.side < 0.0] = (CONTACT, place, boundary.position, 1.0)
    return tuple((low, high) for low, high in found)


def _classes(stage: Stage) -> list[int] | None:
    """1 for immovable disks, 2 for tracers, else 0; None where there are neither.  Two of one class do not meet."""
    if stage.mass is None:
        return None
    classes = [1 if mass == float("inf") else 2 if mass == 0.0 else 0 for mass in stage.mass.tolist()]
    return classes if any(classes) else None

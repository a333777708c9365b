"""Predictions in a very wide domain, from places with low parts (`formulas/low_place.py`)."""

from __future__ import annotations

from collections.abc import Iterable

from eventsim.engines.reference.calendar import CONTACT, Calendar, Event
from eventsim.engines.reference.cells import Cells, Group
from eventsim.engines.reference.predict import Predictor
from eventsim.engines.reference.state import EngineState
from eventsim.formulas.low_place import wide_border_delay, wide_pair_delay
from eventsim.formulas.real import NEVER
from eventsim.formulas.rest import STRUCK
from eventsim.formulas.walls.shape import Shape, seen
from eventsim.scene.stage import Stage


class WidePredictor(Predictor):
    """Predicts contacts from the distance to what is met, each the difference of two places with their low parts."""

    def __init__(self, stage: Stage, state: EngineState, calendar: Calendar, cells: Cells | None) -> None:
        super().__init__(stage, state, calendar, cells)
        self._boundaries = stage.boundaries

    def _contacts(self, i: int, near: Iterable[Group]) -> None:
        state, radius, unmoved, met = self._state, self._radius, self._unmoved, self._state.met
        for members, image in near:
            kx, ky = image
            shifts = self._shifts(image)
            for j in members:
                if j == i or (unmoved is not None and unmoved[i] and unmoved[i] == unmoved[j]):
                    continue
                delay = wide_pair_delay(*state.fine_flight(i, radius[i]), *state.fine_flight(j, radius[j]), *shifts)
                if delay == NEVER or (met[i] and met[j] and self._just_met(i, j, kx, ky)):
                    continue
                time = max(state.t[i], state.t[j]) + delay
                if i < j:
                    self._push(Event(time, CONTACT, i, j, (kx, ky), state.count[i], state.count[j]))
                else:
                    self._push(Event(time, CONTACT, j, i, (-kx, -ky), state.count[j], state.count[i]))

    def _border(self, i: int, axis: int, step: int) -> None:
        border = self._borders[axis][step > 0]
        if border is None or border[0] != CONTACT:
            super()._border(i, axis, step)
            return
        state = self._state
        x, low, v = (state.x, state.low_x, state.vx) if axis == 0 else (state.y, state.low_y, state.vy)
        delay = wide_border_delay(x[i], low[i], v[i], border[2], self._radius[i], -step)
        if delay < NEVER:
            self._push(Event(state.t[i] + delay, CONTACT, i, -1 - border[1], (-step, STRUCK), state.count[i], 0))

    def _wall(self, i: int, place: int, shape: Shape) -> None:
        state = self._state
        met = next((last[1] for last in state.met[i] if last[0] == -1 - place), 0)
        near, x, y = seen(shape, state.x[i], state.y[i], (state.low_x[i], state.low_y[i]))
        delay, side = near.delay(x, y, state.vx[i], state.vy[i], None, None, self._radius[i], met)
        if delay < NEVER:
            self._push(Event(state.t[i] + delay, CONTACT, i, -1 - place, (side, STRUCK), state.count[i], 0))

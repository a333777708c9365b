"""Predictions on balls: a screen of floats with a margin leaves out the pairs that certainly do not meet, balls do the rest."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from eventsim.engines.certified.ball import Ball, about, bounds, radius_of
from eventsim.engines.reference.calendar import Event
from eventsim.engines.reference.cells import Cells, Group, images_of
from eventsim.engines.reference.predict import Predictor
from eventsim.engines.reference.state import EngineState
from eventsim.formulas.contact import pair_delay
from eventsim.scene.stage import Stage

MARGIN, SURE = 2.0**-24, 2.0**-34
"""What the screen allows for, relative to the numbers; its own rounding is far below it, and so are the balls that it trusts."""

LEAST, MOST = 2.0**-120, 2.0**120
"""Lengths and speeds within which the screen's products are floats with all their digits; it does not judge others."""


class Screen:
    """The flights as arrays of floats; it tells which pairs may meet before one of the two is stopped by a wall."""

    def __init__(self, stage: Stage) -> None:
        n = stage.n
        self.x, self.y, self.vx, self.vy, self.t = (np.zeros(n) for _ in range(5))
        self.held_up = np.full(n, math.inf)
        self.trusted = np.zeros(n, bool)
        self._shift = np.array(images_of(stage), dtype=float) * [length or 0.0 for length in stage.period]
        self._reach = stage.radius
        self.falls = stage.gravity is not None

    def note(self, i: int, state: EngineState) -> None:
        """Take over the flight of disk i; one that is not known well is not trusted."""
        self.x[i], self.y[i], self.vx[i] = float(state.x[i]), float(state.y[i]), float(state.vx[i])
        self.vy[i], self.t[i] = float(state.vy[i]), float(state.t[i])
        self.held_up[i] = math.inf
        size, speed = abs(self.x[i]) + abs(self.y[i]), abs(self.vx[i]) + abs(self.vy[i])
        self.trusted[i] = (
            radius_of(state.x[i]) <= size * SURE
            and radius_of(state.y[i]) <= size * SURE
            and radius_of(state.vx[i]) <= speed * SURE
            and radius_of(state.vy[i]) <= speed * SURE
            and radius_of(state.t[i]) * speed <= size * SURE
        )

    def may_meet(self, i: int) -> list[list[int]]:
        """For each image, the disks that the balls have to decide on."""
        if self.falls or not self.trusted[i]:
            return [list(range(len(self.x))) for _ in self._shift]
        with np.errstate(all="ignore"):
            return self._not_missed(i)

    def _not_missed(self, i: int) -> list[list[int]]:
        begin = np.maximum(self.t, self.t[i])
        lag, since = begin - self.t[i], begin - self.t
        dx = (self.x[i] + self.vx[i] * lag) - (self.x + self.vx * since)
        dy = (self.y[i] + self.vy[i] * lag) - (self.y + self.vy * since)
        du, dw = self.vx[i] - self.vx, self.vy[i] - self.vy
        far = np.abs(self.x) + abs(self.x[i]) + np.abs(self.y) + abs(self.y[i])
        reach2 = (self._reach + self._reach[i]) ** 2
        fast = np.abs(self.vx) + abs(self.vx[i]) + np.abs(self.vy) + abs(self.vy[i])
        far = far + fast * (lag + since + SURE * begin)
        speed2 = du * du + dw * dw
        judged = self.trusted & (far > LEAST) & (far < MOST) & (fast > LEAST) & (fast < MOST)
        found = []
        for shift_x, shift_y in self._shift:
            px, py = dx - shift_x, dy - shift_y
            size = far + abs(shift_x) + abs(shift_y)
            slack = MARGIN * size * fast
            b = px * du + py * dw
            cross = np.abs(px * dw - py * du)
            c = px * px + py * py - reach2
            least = np.maximum(cross - slack, 0.0)
            largest = speed2 * reach2 + slack * fast * self._reach.max()
            root = np.sqrt(np.maximum(largest - least * least, 0.0))
            earliest = begin + (c - MARGIN * size * size) / (root + slack - b)
            late = (earliest > self.held_up[i]) | (earliest > self.held_up)
            misses = (b > slack) | (least * least > largest) | (late & (b < 0.0) & (c > MARGIN * size * size))
            found.append(np.flatnonzero(~(misses & judged)).tolist())
        return found


class CertifiedPredictor(Predictor):
    """Predicts on balls for one stage, all pairs."""

    straight_delay = staticmethod(pair_delay)

    def __init__(self, stage: Stage, state: EngineState, calendar: Any, cells: Cells | None) -> None:
        super().__init__(stage, state, calendar, cells)
        number = state.number
        self._add = calendar.push
        self._push: Callable[[Event], None] = self._push_and_note
        self._radius = [number(radius) for radius in stage.radius.tolist()]
        self._features = tuple((place, shape.in_numbers(number)) for place, shape in self._features)
        self._images = images_of(stage)
        self._screen = Screen(stage)

    def predict(self, i: int, now: Ball) -> None:
        """Push every event of disk i."""
        self._screen.note(i, self._state)
        with about([i]):
            self._alone(i, now)
            self._contacts(i, self._nearby(i))

    def predict_all(self, now: Ball) -> None:
        """Push every event of every disk; a pair once."""
        everyone = range(self._state.n)
        for i in everyone:
            self._screen.note(i, self._state)
            with about([i]):
                self._alone(i, now)
        for i in everyone:
            with about([i]):
                self._contacts(i, [([j for j in members if j > i], image) for members, image in self._nearby(i)])

    def _nearby(self, i: int) -> Iterable[Group]:
        return zip(self._screen.may_meet(i), self._images, strict=True)

    def _push_and_note(self, event: Event) -> None:
        """Push an event; one of a single disk bounds how long its present flight can last."""
        self._add(event)
        if event.b < 0 or event.rank == 0:
            latest = bounds(event.time)[1] * (1.0 + MARGIN)
            self._screen.held_up[event.a] = min(self._screen.held_up[event.a], latest)

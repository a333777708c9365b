"""What changes, as lists: the free flights of all disks in the engine's numbers."""

from __future__ import annotations

from typing import Any

import numpy as np

from eventsim.engines.base import Snapshot
from eventsim.engines.exact_state import ExactState, Met
from eventsim.engines.turnover import Anchors
from eventsim.formulas.clock import FIRST_WINDOW
from eventsim.formulas.real import Acceleration, Real
from eventsim.scene.sides import Sides
from eventsim.scene.stage import Stage


class EngineState(ExactState):
    """The flights of n disks as lists of numbers."""

    def __init__(self, stage: Stage, number: Any = float) -> None:
        n = stage.n
        self.n = n
        self.number = number
        self.x: list[Real] = [number(value) for value in stage.x.tolist()]
        self.y: list[Real] = [number(value) for value in stage.y.tolist()]
        self.vx: list[Real] = [number(value) for value in stage.vx.tolist()]
        self.vy: list[Real] = [number(value) for value in stage.vy.tolist()]
        self.t: list[Real] = [number(0.0)] * n
        self.count = [0] * n
        self.wraps_x = [0] * n
        self.wraps_y = [0] * n
        self.met: list[Met] = [()] * n
        self.contact_time: list[Real] = [-float("inf")] * n
        self.at_once = [0] * n
        self.low_parts = stage.low_parts and number is float
        self.low_vx = [0.0] * n if self.low_parts else []
        self.low_vy = [0.0] * n if self.low_parts else []
        self.contacts: Any = None if stage.seed is None else [0] * stage.n
        self.spin: Any = None if stage.spin is None else [number(value) for value in stage.spin.tolist()]
        self.gravity_x, self.gravity_y = _accelerations(stage)
        self._free_x, self._free_y = self.gravity_x, self.gravity_y
        self.supports, self.boundaries = stage.supports, len(stage.boundaries)
        if stage.supports is not None:
            self.gravity_x, self.gravity_y = list(self._free_x), list(self._free_y)
        self.sides: Any = None
        self._radius: list[float] = stage.radius.tolist()
        if stage.points and number is float:
            self._walls = Sides(stage)
            self.sides = [[0] * len(self._walls) for _ in range(n)]
            self.set_sides(())
        self.now: Real = number(0.0)
        self.epoch = 0
        self.epoch_length = stage.epoch_length
        self.window_rows = 0
        self.begin_window(FIRST_WINDOW)

    def meet(self, i: int, met: Met) -> None:
        """Let disk i remember whom it met; what it rests on takes a part of its gravity, and anything else frees it."""
        self.met[i] = met
        if self.supports is not None:
            self._pull(i)

    def _pull(self, i: int) -> None:
        support = self.support_of(i)
        free = self._free_x[i], self._free_y[i]
        self.gravity_x[i], self.gravity_y[i] = free if support is None else (support.ax, support.ay)

    @property
    def last_begun(self) -> Real:
        """When the last of all flights began."""
        return max(self.t)

    def anchors(self) -> Anchors:
        """Where all flights begin, rounded."""
        t, x, y, vx, vy = (np.array(list(map(float, each))) for each in (self.t, self.x, self.y, self.vx, self.vy))
        falls = self.gravity_x[0] is not None
        gx, gy = (np.array(each, dtype=float) if falls else None for each in (self.gravity_x, self.gravity_y))
        return Anchors(t, x, y, vx, vy, gx, gy)

    def turn_over(self, end: Real, epochs: int, window: int) -> None:
        """Begin a new window some epochs later: every disk is advanced to `end`, a time in the old one.

        window: the exponent of the new one.
        """
        shift = epochs * self.epoch_length
        for i in range(self.n):
            x, y = self.place(i, end)
            vx, vy = self.speed(i, end)
            self.keep_sides(i, end, (x, y), (vx, vy))
            self.anchor(i, end - shift, x, y, vx, vy)
            self.contact_time[i] = self.contact_time[i] - shift
        self.now = end - shift
        self.epoch += epochs
        self.begin_window(window)
        self.window_rows = 0

    def snapshot(self) -> Snapshot:
        """A copy of all that the future depends on."""
        return Snapshot(
            epoch=self.epoch,
            window=self.window,
            window_rows=self.window_rows,
            now=self.now,
            t=tuple(self.t),
            x=tuple(self.x),
            y=tuple(self.y),
            vx=tuple(self.vx),
            vy=tuple(self.vy),
            wraps_x=tuple(self.wraps_x),
            wraps_y=tuple(self.wraps_y),
            met=tuple(self.met),
            contact_time=tuple(self.contact_time),
            at_once=tuple(self.at_once),
            low_vx=tuple(self.low_vx),
            low_vy=tuple(self.low_vy),
            sides=self.sides_of_all(),
            spin=() if self.spin is None else tuple(self.spin),
            contacts=() if self.contacts is None else tuple(self.contacts),
        )

    def restore(self, saved: Snapshot) -> None:
        """Go back (or on) to a snapshot; predictions made before are stale."""
        self.epoch, self.window_rows, self.now = saved.epoch, saved.window_rows, saved.now
        self.begin_window(saved.window)
        self.close()
        self.t, self.x, self.y = list(saved.t), list(saved.x), list(saved.y)
        self.vx, self.vy = list(saved.vx), list(saved.vy)
        self.wraps_x, self.wraps_y = list(saved.wraps_x), list(saved.wraps_y)
        self.met, self.contact_time, self.at_once = list(saved.met), list(saved.contact_time), list(saved.at_once)
        self.low_vx, self.low_vy = list(saved.low_vx), list(saved.low_vy)
        self.set_sides(saved.sides)
        self.spin = None if self.spin is None else list(saved.spin)
        self.contacts = None if self.contacts is None else list(saved.contacts)
        self.count = [count + 1 for count in self.count]
        if self.supports is not None:
            for i in range(self.n):
                self._pull(i)


def _accelerations(stage: Stage) -> tuple[list[Acceleration], list[Acceleration]]:
    """Each disk's own gravity: None without, 0 for immovable disks."""
    if stage.gravity is None:
        return [None] * stage.n, [None] * stage.n
    gx, gy = stage.gravity
    fixed = [False] * stage.n if stage.mass is None else [mass == float("inf") for mass in stage.mass.tolist()]
    return [0.0 if held else gx for held in fixed], [0.0 if held else gy for held in fixed]

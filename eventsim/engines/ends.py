"""Why a run ends where no contact ends it: at the end of its clock, or where speeds have sunk below the digits."""

from __future__ import annotations

import numpy as np

from eventsim.engines.turnover import Look
from eventsim.formulas.clock import clock_time
from eventsim.formulas.doubt import UNIT
from eventsim.scene.stage import Stage


def end_of_clock(stage: Stage, epoch: int, end: float, due: float, ahead: bool) -> tuple[str, str | None]:
    """Why a run stops where its clock has no further window, and the sentence about it.

    end, due: remainders in this epoch, of the end of its window and of the next contact that is predicted; due is inf where
    there is none.  ahead: whether anything may come.
    """
    if not ahead:
        return "quiet", None
    last = clock_time(epoch, end, stage.epoch_length, stage.start_time)
    what = "may still be ahead"
    if due < np.inf:
        what = f"is still ahead, due then or later (t = {clock_time(epoch, due, stage.epoch_length, stage.start_time):g})"
    return "digits", (
        f"the clock of this scene ends at t = {last:g}, and a contact {what}; "
        "a scene that begins from the state of this end counts its time anew"
    )


def sunk_speeds(stage: Stage, rows: int, look: Look) -> str | None:
    """A sentence where the speeds of disks, as seen from each other, are below the last bits of those that they began with.

    Where nothing but disks takes momentum, contacts that take energy leave a common drift: what rounding made of the total
    momentum.  Disks that are no faster than that, as seen from each other, move by rounding alone.  rows: of the window that
    ends; fewer than one for each disk tell nothing.  look: at the flights.
    """
    alone = stage.gravity is None and not (stage.boundaries or stage.features) and _is_movable(stage)
    if not (alone and stage.law.loses_energy() and rows >= stage.n):
        return None
    flights = look()
    spread = max(float(np.ptp(flights.vx)), float(np.ptp(flights.vy)))
    if spread >= np.ldexp(UNIT, stage.clock.speed):
        return None
    drift = max(abs(float(flights.vx.mean())), abs(float(flights.vy.mean())))
    return (
        f"the speeds of the disks, as seen from each other, have sunk to {spread:.2g}, the last bits of those that they began "
        f"with, while all drift at {drift:.2g}, which rounding has left; a scene that begins from this state less its mean "
        "velocity goes on"
    )


def _is_movable(stage: Stage) -> bool:
    return stage.mass is None or not bool(np.isinf(stage.mass).any())

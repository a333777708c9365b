"""The end of the clock: why a run stops there while a contact is still ahead."""

from __future__ import annotations

import math

from eventsim.formulas.clock import clock_time
from eventsim.scene.stage import Stage


def at_the_last_epoch(stage: Stage, epoch: int, end: float, due: float) -> tuple[str, str | None]:
    """Why a run stops where its clock has no further window, and the sentence about it.

    end, due: remainders in this epoch, of the end of its window and of the next contact that is predicted; due is inf where
    there is none: then all disks part.
    """
    if math.isinf(due):
        return "quiet", None
    last = clock_time(epoch, end, stage.epoch_length, stage.start_time)
    contact = clock_time(epoch, due, stage.epoch_length, stage.start_time)
    return "digits", (
        f"the clock of this scene ends at t = {last:g}, and a contact is still ahead, due then or later (t = {contact:g}); "
        "a scene that begins from the state of this end counts its time anew"
    )

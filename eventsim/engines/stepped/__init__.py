"""Stepped engines: time in steps of equal length, contacts looked for after each of them.

    frames     the per-frame engine of a students' project, rule by rule
    stepped    a fair fixed-step engine; located within the step if asked
    penalty    soft disks, springs, velocity Verlet
    chipmunk   the Chipmunk engine through pymunk

All keep the contract of `engines.base`. They are what event-driven runs are validated against: see `validate`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from eventsim.engines.options import Options, option

IN_A_ROW = 1.5
"""Steps: two impulses of the same disks that are nearer are of one contact, where an engine spreads them."""


@dataclass(frozen=True, slots=True)
class StepOptions(Options):
    """What all stepped engines can be told.

    dt: the step, time; left out, a twentieth of the time in which a typical disk flies its radius.
    late: steps by which rows may come after the contact.  spread: whether the impulse of one contact may go over steps in a row.
    """

    late: ClassVar[float] = 2.0
    spread: ClassVar[bool] = False

    dt: float | None = option(None, "a time")


@dataclass(frozen=True, slots=True)
class FramesOptions(StepOptions):
    """What `frames` can be told.

    memory: when a pair leaves the memory: once its circles are apart, or at the end of the frame.
    """

    memory: Literal["apart", "frame"] = option("apart", "apart or frame")


@dataclass(frozen=True, slots=True)
class FixedStepOptions(StepOptions):
    """What `stepped` can be told.

    locate: look for the time of impact within the step.
    """

    locate: bool = option(False, "true or false")


@dataclass(frozen=True, slots=True)
class PenaltyOptions(StepOptions):
    """What `penalty` can be told.

    stiffness: of the springs, force / length; left out: from the step.
    late: a spring reports the end of a contact, which lasts 20 steps, with a wall or an immovable disk 20 sqrt 2.
    """

    late: ClassVar[float] = 31.0

    stiffness: float | None = option(None, "a number, force / length")


@dataclass(frozen=True, slots=True)
class ChipmunkOptions(StepOptions):
    """What `pymunk` can be told.

    spread: of one contact, each with a row.
    iterations: of its solver in each step.  slop: an overlap that it leaves, length; left out: a part of the least radius.
    """

    spread: ClassVar[bool] = True

    iterations: int = option(10, "a whole number")
    slop: float | None = option(None, "a length")

"""HOW TIME PASSES: engines behind one contract, by name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from eventsim.engines.base import Run, Session, Stop
from eventsim.errors import EventsimError
from eventsim.runner.drive import Wishes, drive
from eventsim.runner.interrupts import unmissed_interrupts
from eventsim.scene import Scene
from eventsim.scene.stage import stage_of


@dataclass(frozen=True, slots=True)
class Engine:
    """An engine: its name, and how to open a session of it."""

    name: str
    open: Callable[..., Session]

    def run(self, scene: Scene, stop: Stop | float, wishes: Wishes | None = None, **options: Any) -> Run:
        """Run a scene to its stop, a Stop or a time on its clock; options are the engine's own.

        Raises EventsimError for options and wishes that the engine cannot fulfil.
        """
        wishes = Wishes() if wishes is None else wishes
        if not isinstance(stop, Stop):
            stop = Stop(until=float(stop))
        stage = stage_of(scene)
        # Where contacts can pile up, the last rows say how.
        with unmissed_interrupts():
            session = self.open(stage, keep_rows=wishes.rows or stage.loses_energy, **options)
        return drive(session, self.name, scene, stop, wishes)


def _reference(*args: Any, **options: Any) -> Session:
    from eventsim.engines.reference import ReferenceSession  # loaded by the run that needs it

    return ReferenceSession(*args, **options)


def _fast(*args: Any, **options: Any) -> Session:
    from eventsim.engines.auto import MISSING, has_compiler

    if not has_compiler():
        raise EventsimError(MISSING)
    from eventsim.engines.fast import FastSession

    return FastSession(*args, **options)


def _auto(*args: Any, **options: Any) -> Session:
    from eventsim.engines.auto import AutoSession

    return AutoSession(*args, **options)


def _certified(*args: Any, **options: Any) -> Session:
    try:
        from eventsim.engines.certified import CertifiedSession
    except ModuleNotFoundError:
        text = "the certified engine needs python-flint, which is not installed: pip install 'eventsim-disks[certify]'"
        raise EventsimError(text) from None
    return CertifiedSession(*args, **options)


def _stepped(module: str, session: str) -> Callable[..., Session]:
    """How to open a session of a stepped engine, loaded by the run that needs it."""

    def opened(*args: Any, **options: Any) -> Session:
        made: Session = getattr(import_module(f"eventsim.engines.stepped.{module}"), session)(*args, **options)
        return made

    return opened


STEPPED: dict[str, Engine] = {
    "frames": Engine("frames", _stepped("frames", "FramesSession")),
    "stepped": Engine("stepped", _stepped("stepped", "FixedStepSession")),
    "penalty": Engine("penalty", _stepped("penalty", "PenaltySession")),
    "pymunk": Engine("pymunk", _stepped("chipmunk", "ChipmunkSession")),
}
"""The engines that advance in steps of a length `dt`; what event-driven runs are validated against."""

AUTO = Engine("auto", _auto)
"""The reference engine, and the fast one when the job proves long."""

ENGINES: dict[str, Engine] = {
    "reference": Engine("reference", _reference),
    "fast": Engine("fast", _fast),
    "certified": Engine("certified", _certified),
    **STEPPED,
}
"""name -> engine; every engine is run(scene, stop) -> Run."""

"""HOW TIME PASSES: engines behind one contract, by name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from eventsim.engines.base import Session
from eventsim.errors import EventsimError


@dataclass(frozen=True, slots=True)
class Engine:
    """An engine: its name, and how to open a session of it."""

    name: str
    open: Callable[..., Session]


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
"""name -> engine."""


def engine_named(name: str) -> Engine:
    """The engine of a name; "auto" is the one that suits.  Raises EventsimError for one that does not exist."""
    if name == "auto":
        return AUTO
    if name not in ENGINES:
        raise EventsimError(f"engine {name!r} does not exist; there are: auto, {', '.join(ENGINES)}")
    return ENGINES[name]

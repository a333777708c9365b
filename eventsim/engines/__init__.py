"""HOW TIME PASSES: engines behind one contract, by name.

To add an engine: a folder with a session (see `base`), its options, and a row here.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

from eventsim.compiler import INTERPRET, SWITCH, is_interpreted, is_switched_off
from eventsim.engines.certified import CertifiedOptions
from eventsim.engines.fast import FastOptions
from eventsim.engines.options import Options, names_of, wrong_value
from eventsim.engines.reference import AutoOptions, ReferenceOptions
from eventsim.engines.stepped import ChipmunkOptions, FixedStepOptions, FramesOptions, PenaltyOptions
from eventsim.errors import EventsimError, did_you_mean

if TYPE_CHECKING:
    from eventsim.engines.base import Session
    from eventsim.scene.stage import Stage


@dataclass(frozen=True, slots=True)
class Engine:
    """A row of the table of engines.

    Attributes:
        name: what users call it.
        words: what it is.
        session: "module:class" of its session, loaded by the run that needs it.
        options: what it can be told.
        stepped: whether it advances in steps of a length `dt`, so that its log is no truth.
        replays: whether all follows from the order of its contacts: it has compact logs and checkpoints.
        needs: (module, what it is called, extra that installs it); None where it needs nothing more.
    """

    name: str
    words: str
    session: str
    options: type[Options] = Options
    stepped: bool = False
    replays: bool = False
    needs: tuple[str, str, str] | None = None

    @property
    def missing(self) -> str | None:
        """A sentence on what it needs and does not find; None where all is there."""
        if self.needs is None:
            return None
        module, called, extra = self.needs
        if module == "numba" and is_interpreted():
            return None
        if find_spec(module) is not None:
            if module != "numba" or not is_switched_off():
                return None
            return (
                f"the engine {self.name} is compiled, and {SWITCH} is set: unset it, take the engine reference, or set "
                f"{INTERPRET} to run kernels as plain Python"
            )
        return f"the engine {self.name} needs {called}, which is not installed: pip install 'eventsim-disks[{extra}]'"

    def options_from(self, given: Mapping[str, Any], others: tuple[str, ...] = ()) -> Options:
        """The options that were given by name; others: names that may have been meant instead.

        Raises EventsimError for a name or a type that the engine does not have.
        """
        for name, value in given.items():
            if name not in names_of(self.options):
                raise EventsimError(self.without(name, others))
            if (words := wrong_value(self.options, name, value)) is not None:
                raise EventsimError(f"{self.name}: {name} = {value!r}: must be {words}")
        return self.options(**given)

    def without(self, name: str, others: tuple[str, ...] = ()) -> str:
        """A sentence on an option that the engine does not have; others: names that may have been meant instead."""
        own = names_of(self.options)
        owners = [engine.name for engine in ENGINES.values() if name in names_of(engine.options)]
        belongs = f"{name} belongs to {', '.join(owners)}" if owners else f"it has {', '.join(own) or 'none'}"
        if others and not owners:
            belongs += f"; the call itself takes {', '.join(others)}"
        near = "" if owners else did_you_mean(name, [*own, *others])
        return f"the engine {self.name} has no option {name!r}{near}; {belongs}"

    def open(self, stage: Stage, keep_rows: bool = True, options: Options | None = None) -> Session:
        """Open a session; EventsimError where the engine is not installed, or cannot simulate the stage or keep the options."""
        if self.missing is not None:
            raise EventsimError(self.missing)
        module, _, name = self.session.partition(":")
        session: Session = getattr(import_module(module), name)(stage, keep_rows, options or self.options())
        return session


TABLE = {
    row.name: row
    for row in (
        Engine(
            "auto",
            "the reference engine, and the fast one when the job proves long",
            "eventsim.engines.auto:AutoSession",
            AutoOptions,
            replays=True,
        ),
        Engine(
            "reference",
            "plain Python that reads like the textbook",
            "eventsim.engines.reference.loop:ReferenceSession",
            ReferenceOptions,
            replays=True,
        ),
        Engine(
            "fast",
            "the same algorithm, compiled",
            "eventsim.engines.fast.session:FastSession",
            FastOptions,
            replays=True,
            needs=("numba", "numba", "fast"),
        ),
        Engine(
            "certified",
            "the reference loop on ball arithmetic: a proof",
            "eventsim.engines.certified.session:CertifiedSession",
            CertifiedOptions,
            needs=("flint", "python-flint", "certify"),
        ),
        Engine(
            "frames",
            "the per-frame engine of a students' project",
            "eventsim.engines.stepped.frames:FramesSession",
            FramesOptions,
            stepped=True,
        ),
        Engine(
            "stepped",
            "a fair modern fixed-step engine",
            "eventsim.engines.stepped.stepped:FixedStepSession",
            FixedStepOptions,
            stepped=True,
        ),
        Engine(
            "penalty",
            "soft disks, springs, velocity Verlet",
            "eventsim.engines.stepped.penalty:PenaltySession",
            PenaltyOptions,
            stepped=True,
        ),
        Engine(
            "pymunk",
            "the Chipmunk engine",
            "eventsim.engines.stepped.chipmunk:ChipmunkSession",
            ChipmunkOptions,
            stepped=True,
            needs=("pymunk", "the Chipmunk engine", "pymunk"),
        ),
    )
}
"""name -> engine, `auto` among them."""

ENGINES = {name: engine for name, engine in TABLE.items() if name != "auto"}
"""name -> engine, each of which is one and no choice among others."""

ONE_LOG = tuple(name for name, engine in ENGINES.items() if engine.replays)
"""The engines that write the one log of a scene, bit for bit."""

STEPPED = {name: engine for name, engine in ENGINES.items() if engine.stepped}
"""The engines that advance in steps of a length `dt`; what event-driven runs are validated against."""


def engine_named(name: str) -> Engine:
    """The engine of a name; "auto" is the one that suits.  Raises EventsimError for one that does not exist."""
    if name not in TABLE:
        raise EventsimError(f"engine {name!r} does not exist{did_you_mean(name, TABLE)}; there are: {', '.join(TABLE)}")
    return TABLE[name]

"""What is wanted of a run: when it is to stop, and what it is to give besides the state it ends in."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import TypeAlias

from eventsim.engines.base import BrokenOffError, Session, Stop
from eventsim.errors import EventsimError, SceneError
from eventsim.record.events import Rows
from eventsim.runner.checkpoint import Checkpoint, Every
from eventsim.runner.checkpoint_writer import USUALLY
from eventsim.scene import Scene
from eventsim.scene.numbers import optional_number, optional_whole

Progress: TypeAlias = Callable[[float | None, int, float], None]
"""Called now and then with the fraction done (None: unknown), the events so far and the time on the scene's clock."""

Notice: TypeAlias = Callable[[str], None]
"""Called with a sentence that somebody who waits should read."""

OnEvent: TypeAlias = Callable[[Rows], None]
"""Called with each block of new rows (an array of ROW)."""


@dataclass(slots=True)
class RunOptions:
    """What is wanted of a run, whichever engine does it.

    Attributes:
        log: True (in memory) or a path; False where no rows are to be kept.
        compact: leave out of the log what replay computes.
        digest: compute the digest also where no log is kept.
        progress: called a few times a second.
        notice: called, once at most, when contacts come ever faster.
        on_event: called with each block of rows, between two stints of the engine.
        takers: called with each block of rows beside the engine, in the writer's thread.
        command: the command line that asked for the run; it is told in the log.
        checkpoint: the file that is replaced again and again, `every` so often.
        resumed: the checkpoint that the run goes on from.
        interrupt: asks the run to end early.
    """

    log: bool | str | PathLike[str] = False
    compact: bool = False
    digest: bool = False
    progress: Progress | None = None
    notice: Notice | None = None
    on_event: OnEvent | None = None
    takers: list[OnEvent] = field(default_factory=list)
    command: str | None = None
    checkpoint: Path | None = None
    every: Every = USUALLY
    resumed: Checkpoint | None = None
    interrupt: Interrupt | None = None

    def __post_init__(self) -> None:
        demand_place_of_log(self.log)
        for name in ("progress", "on_event"):
            if (given := getattr(self, name)) is not None and not callable(given):
                raise EventsimError(f"{name} = {given!r}: must be a function, which is called as the run goes on")

    @property
    def rows(self) -> bool:
        """Whether anything wants the rows."""
        return self.log is not False or self.digest or self.on_event is not None or bool(self.takers)


def demand_place_of_log(log: object) -> None:
    """Raise EventsimError for what says of no log where it is kept."""
    if not isinstance(log, bool | str | PathLike):
        raise EventsimError(f"log = {log!r}: must be True (in memory), False, or the path of a file")


def stop_of(scene: Scene, until: float | None, events: int | None) -> Stop:
    """When to stop: what is asked for here, else what the scene says.

    Raises SceneError for what is neither a finite time on the scene's clock nor a number of events.
    """
    if until is None and events is None:
        until, events = scene.until, scene.events
    if until is None and events is None:
        raise SceneError("nothing says when to stop: give until or events, in the scene or with the run")
    until, events = optional_number(until, "until"), optional_whole(events, "events")
    if until is not None and not math.isfinite(until):
        raise SceneError(f"until = {until!r}: must be a finite time")
    if until is not None and until < scene.start_time:
        raise SceneError(f"until = {until!r}: must not be before the start of the clock, {scene.start_time!r}")
    if events is not None and events < 0:
        raise SceneError(f"events = {events}: must be at least 0")
    return Stop(until, events)


class Interrupt:
    """Asks a run to end; it does so between two stints of its engine, and its outcome says `interrupted`.

    asked: whether it has been asked.  session: the one that is at work, None before and after.
    """

    def __init__(self) -> None:
        self.asked = False
        self.session: Session | None = None

    def ask(self) -> None:
        """Ask the run to end, from wherever."""
        self.asked = True

    def break_in(self, once_more: bool = False) -> None:
        """Ask from a signal handler: what only prepares itself is broken off at once, and so is all by a second call.

        once_more: what the call before raised was lost, so that this is no second one.
        Raises KeyboardInterrupt, or BrokenOffError into a session that prepares itself.
        """
        again, self.asked = self.asked and not once_more, True
        if again or self.session is None:
            raise KeyboardInterrupt
        if self.session.prepares:
            raise BrokenOffError

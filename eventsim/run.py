"""A run, as its user has it in hand: what came out, its log, its states at any time, its measures, its pictures."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from os import PathLike
from typing import TYPE_CHECKING, Any

from eventsim.engines import ENGINES as TABLE
from eventsim.engines import Engine
from eventsim.engines.base import Stop
from eventsim.errors import EventsimError
from eventsim.meant import NamesMeant
from eventsim.replay import log
from eventsim.replay.past import PastRun
from eventsim.runner.loop import run_scene
from eventsim.runner.options import RunOptions
from eventsim.scene import Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from eventsim.measure import Measures
    from eventsim.measure.trust import Trust


class EventLog(log.EventLog):
    """An immutable log: its provenance and one row per impulse.

    Every column is an attribute holding a read-only array (`log.time`, `log.vxa`, ...): `log.kind` holds codes
    (`log.kinds` the text), `log.wall` indices into `log.provenance.wall_names` (`log.wall_name` the text).
    `log[3]` is one event, `log[3:8]` are some, `log.to_pandas()` is a data frame.
    Places in columns (`log.xa`, and in files) count from `log.corner`, the domain's lower-left corner; in `log[3]` and in data
    frames they are on the scene's axes: `log[3].xa` is `log.xa[3] + log.corner[0]`, wrapped where the domain is periodic.
    `log.impulse` is the magnitude of the whole momentum exchanged: where surfaces grip, or a wall heats, more than its normal
    part, which makes the pressure (`force_` and `shear_` of `measure()`).
    path: the file that it was read from, None where it comes from a run.

    `log.measure()` measures it, `log.plot("speeds")` draws a figure, `log.animate("a.gif")` a movie.

    In a compact log the columns that an engine computes again are missing (NaN); `expand()` gives the full log.

    >>> import eventsim as es
    >>> log = es.simulate(es.gallery("two-disks"), events=3, engine="reference", log=True).log
    >>> len(log), log.kinds.tolist()
    (3, ['pair', 'wall', 'pair'])
    >>> log[1].a, log[1].wall
    (1, 'right')
    """

    def measure(self, discard: float | None = None, profile: str | None = None) -> Measures:
        """Measure the run that the log tells: what `simulate(..., measure=True).measures` has.

        discard: time at the beginning that is left out; None: as much as the run needs to settle.  profile: "x" or "y", for
        density and temperature in slices along it.  Raises EventsimError where there is nothing to measure.
        """
        from eventsim.measure import measure  # loaded by who measures

        return measure(self, discard, profile)

    def plot(self, kind: str, ax: Axes | None = None) -> Axes:
        """Draw a figure of the log; kind, ax: as of `Run.plot`.  Raises EventsimError as that does."""
        from eventsim.show.figures.write import plot  # loaded by who wants a picture

        return plot(self, kind, ax)

    def animate(self, path: str | PathLike[str], **options: Any) -> None:
        """Write an animation to `path`; options: as of `Run.animate`.  Raises EventsimError for what does not fit."""
        from eventsim.show.animate import animate_with  # loaded by who wants a picture

        animate_with(self, path, **options)


def load_log(path: str | PathLike[str], law: Callable[..., float] | None = None) -> EventLog:
    """Read a log file of any format; raise LogError with a sentence where it is not one.

    A text log that still grows (NAME.csv.part, NAME.jsonl.part) is read up to its last whole line.  Warns (LogWarning) where
    its numbers were changed since it was written.

    law: the law of contacts of your own that the run had; a compact log needs it, since nothing is run from a log.
    """
    return EventLog.loaded(path, law)


@dataclass(slots=True)
class Run(NamesMeant, PastRun):
    """What a simulation gives: the state it ended in, the log if one was kept, how good it is and why it stopped.

    begun_by: the engine that handed over to `engine`, where `auto` began with another one.
    log_path: where the log was streamed to.  measures: where they were asked for.  trust: until when positions hold, where that
    was asked for or cost little.  stopped: `until`, `events`, `quiet` (no event ahead), `collapse`, `digits`, `law` (none
    tells what a contact does), `interrupted`.  reason: a sentence about that where there is more to say.  elapsed_s: simulating
    only; compile_s and write_s (waiting for rows to be written and measured) apart, seconds.  trajectory: samples, of a stepped
    engine, whose motion does not follow from its log.

    >>> import eventsim as es
    >>> run = es.simulate(es.gallery("galperin", mass_ratio=100), engine="reference", log=True)
    >>> run.counters.events, run.stopped
    (31, 'quiet')
    >>> before, after = run.state_at(0.0), run.state
    >>> abs(after.energy / before.energy - 1.0) < 1e-13
    True
    """

    trust: Trust | None = None
    _measures: Measures | None = None

    @property
    def has_measures(self) -> bool:
        """Whether anything was measured."""
        return self._measures is not None

    @property
    def measures(self) -> Measures:
        """What was measured.  Raises EventsimError where nothing was: that was not asked for, or no time has passed."""
        if self._measures is None:
            then = "simulate(..., measure=True)" + (", or run.log.measure() of the log that it kept" if self.has_log else "")
            raise EventsimError(f"this run measured nothing: {then}")
        return self._measures

    def __eq__(self, other: object) -> bool:
        """Whether another run is of the same scene and came to the same events and the same end; not how long it took."""
        if not isinstance(other, Run):
            return NotImplemented
        if (self.scene, self.stopped, self.counters, self.state) != (other.scene, other.stopped, other.counters, other.state):
            return False
        return not (self.has_log and other.has_log) or self.log == other.log

    @property
    def log(self) -> EventLog:
        """The log; one that was streamed to a file is read when first asked for.  Raises LogError where none was kept."""
        return self._kept(EventLog)

    def __repr__(self) -> str:
        name = self.scene.called
        why = self.stopped if self.reason is None else f"{self.stopped}: {self.reason}"
        return f"Run({name}: {self.counters.events:,} events to t = {self.time!r}, stopped: {why})"

    def animate(self, path: str | PathLike[str], **options: Any) -> None:
        """Write an animation to `path`: .mp4, .gif, .png (a strip of moments) or .html (a page that plays the run).

        options: those of `eventsim animate` (fps, speed or duration, begin, end, moments, size, color, trails,
        velocities, flash, dark).  Raises LogError where no log was kept, EventsimError for what does not fit.
        """
        from eventsim.show.animate import animate_with  # loaded by who wants a picture

        animate_with(self._log_for("animate"), path, **options)

    def plot(self, kind: str, ax: Axes | None = None) -> Axes:
        """Draw a figure of the run, a `kind` of `eventsim figure` (trajectories, speeds, ...); its axes, the first of several.

        ax: matplotlib's axes to draw on; None: those of a new figure of pyplot.  Raises LogError where no log was kept,
        EventsimError for an unknown kind, or one of several panels where axes are given.
        """
        from eventsim.show.figures.write import plot  # loaded by who wants a picture

        return plot(self._log_for("plot"), kind, ax)

    def _repr_html_(self) -> str | None:
        """Return the player for a notebook; None, so plain text, without a log, with too large a one, or without matplotlib."""
        if not self.has_log or find_spec("matplotlib") is None:
            return None
        from eventsim.show.player.page import notebook_frame

        return notebook_frame(self.log)


@dataclass(frozen=True, slots=True)
class RunnableEngine:
    """An engine of the table, to be run."""

    engine: Engine

    @property
    def name(self) -> str:
        """As in `ENGINES`."""
        return self.engine.name

    def run(self, scene: Scene, stop: Stop | float, wanted: RunOptions | None = None, **options: Any) -> Run:
        """Run a scene to its stop, a Stop or a time on its clock; options are the engine's own.

        Raises EventsimError for options and wishes that the engine cannot fulfil.
        """
        stop = stop if isinstance(stop, Stop) else Stop(until=float(stop))
        return Run.of(run_scene(self.engine, scene, stop, wanted, self.engine.options_from(options)))


ENGINES = {name: RunnableEngine(engine) for name, engine in TABLE.items()}
"""name -> engine; every engine is run(scene, stop) -> Run."""

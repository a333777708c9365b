"""Frames: which times of a run a movie shows, and what there is to be seen at each of them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eventsim.errors import EventsimError
from eventsim.record.contacts import contacts_of
from eventsim.record.events import Floats, Rows, State, blank_rows, joined
from eventsim.replay.log import AnyLog
from eventsim.replay.passage import Moment, Passage
from eventsim.scene import Scene
from eventsim.show.turns import Turns

SECONDS = 10.0
"""How long a run plays where neither duration nor speed is given: as a movie, as a page, in the live view."""

GLOW = 0.2
"""Seconds of the movie for which a contact lights up its disks."""

MOST_FRAMES = 1_000_000
"""More frames than anybody watches: beyond it the speed or the span was mistyped."""


@dataclass(frozen=True, slots=True)
class Timing:
    """The times of a movie: frames (F,) on the scene's clock; fps; speed, scene time per second of the movie."""

    times: Floats
    fps: float
    speed: float


def frame_timing(
    span: tuple[float, float],
    fps: float,
    speed: float | None = None,
    duration: float | None = None,
    begin: float | None = None,
    end: float | None = None,
) -> Timing:
    """Return the times of a movie of a log that covers `span`.

    With a speed the frames are 1 / fps seconds apart at that speed; else they are spread over the span from its
    beginning to its end. Raises EventsimError where an option does not fit the log.
    """
    first, last = shown_span(span, begin, end)
    if speed is not None and duration is not None:
        raise EventsimError("speed and duration exclude each other: the one follows from the other")
    for name, value in (("fps", fps), ("speed", speed), ("duration", duration)):
        if value is not None and not (math.isfinite(value) and value > 0.0):
            raise EventsimError(f"{name} = {value}: must be finite and above 0")
    seconds = (last - first) / speed if speed is not None else duration or SECONDS
    if not seconds * fps <= MOST_FRAMES:
        raise EventsimError(f"this movie would have {seconds * fps:.3g} frames: give a higher speed or a shorter span")
    if speed is None:
        count = max(round(seconds * fps), 2)
        return Timing(np.linspace(first, last, count), fps, (last - first) / seconds)
    count = math.floor(seconds * fps * (1.0 + 1e-12)) + 1  # the last frame is kept where fps * seconds rounds down
    return Timing(np.minimum(first + np.arange(count) * (speed / fps), last), fps, speed)


def moments(span: tuple[float, float], count: int, begin: float | None = None, end: float | None = None) -> Floats:
    """Return `count` times, evenly spread over the part of the span that is shown."""
    return np.linspace(*shown_span(span, begin, end), count)


def shown_span(span: tuple[float, float], begin: float | None, end: float | None) -> tuple[float, float]:
    """Return the times between which to show a log; raise EventsimError where it does not cover them."""
    first, last = (span[0] if begin is None else begin), (span[1] if end is None else end)
    for name, value in (("begin (--from)", first), ("end (--to)", last)):
        if not span[0] <= value <= span[1]:
            raise EventsimError(f"{name} = {value!r}: the log tells the time from {span[0]!r} to {span[1]!r}")
    if span[0] == span[1]:
        raise EventsimError(f"there is nothing to show: the log ends where it begins, at {span[0]!r}")
    if not first < last:
        raise EventsimError(f"begin (--from) = {first!r}, end (--to) = {last!r}: the beginning must be before the end")
    return first, last


MOST_RECENT = 20_000
"""Rows between two frames, and ways in a trail, of which nobody can tell more apart; and they would have to be held."""


@dataclass(frozen=True, slots=True)
class Frame:
    """What is to be seen at one time.

    moment: all disks, exactly at that time, and what gravity does to them. events: rows of the log so far. contacts: (N,)
    contacts of each disk so far. glow: (N,) 1 at a contact, fading to 0. energy: as from `energy_of`. recent: the rows since the
    previous frame; None at the first one, and where they are more than `MOST_RECENT`.
    angle: (N,) by which disks have turned; None without spin.
    """

    moment: Moment
    events: int
    contacts: NDArray[np.int64]
    glow: Floats
    energy: float
    recent: Rows | None
    angle: Floats | None = None

    @property
    def state(self) -> State:
        """All disks, exactly at that time."""
        return self.moment.state


def frames_at(passage: Passage, times: Floats, glow_time: float) -> Iterator[Frame]:
    """Yield the frame at each of the ascending times; glow_time: how long a contact is seen, on the scene's clock."""
    log, n = passage.log, passage.stage.n
    news = News(log)
    contacts, latest = np.zeros(n, dtype=np.int64), np.full(n, -np.inf)
    turns = None if passage.stage.spin is None else Turns(passage.stage, passage.stage.spin)
    for place, moment in enumerate(passage.moments(times.tolist())):
        time, recent, count = moment.state.time, [blank_rows(0)], 0
        for rows, clock in news.until(time):
            met, pairs = contacts_of(rows), rows["b"] >= 0
            np.add.at(contacts, met["a"], 1)
            np.add.at(contacts, met["b"][met["b"] >= 0], 1)
            np.maximum.at(latest, rows["a"], clock)
            np.maximum.at(latest, rows["b"][pairs], clock[pairs])
            if turns is not None:
                turns.take(rows, clock)
            count += len(rows)
            recent = [*recent, rows] if count <= MOST_RECENT else []
        glow = np.maximum(1.0 - (time - latest) / glow_time, 0.0)
        since = joined(recent) if recent and place else None
        angle = None if turns is None else turns.at(time)
        yield Frame(moment, news.count, contacts.copy(), glow, energy_of(log, moment.state), since, angle)


class News:
    """The rows of a log in the order in which frames show them.  count: how many have been shown."""

    def __init__(self, log: AnyLog) -> None:
        self.count = 0
        self._blocks = log.blocks()
        self._rows, self._clock, self._latest = blank_rows(0), np.empty(0), -np.inf

    def until(self, time: float) -> Iterator[tuple[Rows, Floats]]:
        """Yield the rows up to a time that have not been shown, with their times, in blocks."""
        while True:
            shown = int(np.searchsorted(self._clock, time, side="right"))
            if shown:
                self.count += shown
                yield self._rows[:shown], self._clock[:shown]
                self._rows, self._clock = self._rows[shown:], self._clock[shown:]
            if len(self._rows):
                return
            rows = next(self._blocks, None)
            if rows is None:
                return
            # logged times may step back by an ulp
            self._rows, self._clock = rows, np.maximum(np.maximum.accumulate(rows["time"]), self._latest)
            self._latest = self._clock[-1] if len(rows) else self._latest


def energy_of(log: AnyLog, state: State) -> float:
    """Return the energy of the disks of finite mass, kinetic and potential."""
    return sum(energies_of(log, state))


def energies_of(log: AnyLog, state: State) -> tuple[float, float]:
    """Return (kinetic energy, that of spins too; potential energy - m g x, 0 at (0, 0)) of the disks of finite mass."""
    scene, disks = log.scene, log.scene.disks
    mass = np.where(np.isfinite(disks.mass), disks.mass, 0.0)
    kinetic = 0.5 * float(mass @ (state.velocity**2).sum(axis=1))
    if state.spin is not None:
        kinetic += 0.5 * float((mass * disks.moments()) @ (disks.radius * state.spin) ** 2)
    if scene.gravity is None or not has_height(scene):
        return kinetic, 0.0
    return kinetic, -float(mass @ (state.position @ np.array(scene.gravity)))


def has_height(scene: Scene) -> bool:
    """Whether disks have a potential energy that their places tell: not where they fall along a period."""
    return scene.gravity is not None and not any(g and p for g, p in zip(scene.gravity, scene.domain.periodic, strict=True))


def energy_name(scene: Scene) -> str:
    """Return what `energy_of` is called."""
    return "kinetic + potential energy" if has_height(scene) else "kinetic energy"


def energy_zero(scene: Scene) -> str | None:
    """Return where the potential energy is 0, in words; None where there is none."""
    if scene.gravity is None or not has_height(scene):
        return None
    along = [axis for axis, pull in zip("xy", scene.gravity, strict=True) if pull]
    return f"0 at {along[0]} = 0" if len(along) == 1 else "0 at (0, 0)"

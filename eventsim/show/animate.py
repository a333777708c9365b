"""Animations: a log as a movie, a strip of moments or a page that plays, by the suffix of the file."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eventsim import suffixes
from eventsim.errors import EventsimError
from eventsim.record.files.atomic import atomic_write
from eventsim.replay.log import AnyLog
from eventsim.replay.passage import Passage
from eventsim.scene.numbers import as_number, as_whole
from eventsim.show.frames import GLOW, SECONDS, Timing, frame_timing, frames_at, moments, shown_span
from eventsim.show.gif import palette_of, write_gif
from eventsim.show.mp4 import ffmpeg, write_mp4
from eventsim.show.output import short_number, span_words, suffix_of
from eventsim.show.picture import Look, Picture
from eventsim.show.player.page import page, write_page
from eventsim.show.strip import write_strip
from eventsim.show.strokes import BANDS

FPS = {".mp4": 30.0, ".gif": 20.0}
ROOM = {".mp4": (1280, 720), ".gif": (640, 480), ".png": (520, 440)}
"""Pixels that a frame may take where no size is given."""

TRAIL = 1.0
"""Seconds of the movie that a trail reaches back; in a strip of moments, of an mp4 of usual length."""

MOMENTS = 6
PALETTE_FRAMES = 8
"""Frames, spread over a movie, from which the 256 colours of a gif are taken."""

Progress = Callable[[float | None, int, float], None]
"""Called for each frame with the fraction done, the events so far and the time on the scene's clock."""


@dataclass(frozen=True, slots=True)
class Film:
    """Which part of a run a movie shows, and how fast.

    fps: frames per second. speed: time of the scene per second; or duration: seconds that the movie lasts. begin, end:
    times on the scene's clock. moments: pictures in a strip.
    """

    fps: float | None = None
    speed: float | None = None
    duration: float | None = None
    begin: float | None = None
    end: float | None = None
    moments: int = MOMENTS


def animate(
    log: AnyLog,
    path: str | PathLike[str],
    film: Film | None = None,
    look: Look | None = None,
    progress: Progress | None = None,
) -> None:
    """Write an animation of a log to `path`: .mp4, .gif, .png (a strip of moments) or .html (a page that plays the log).

    The file appears only when whole. Raises EventsimError where an option does not fit the log, the suffix is unknown,
    ffmpeg is missing or the file cannot be written.
    """
    if not isinstance(path, str | PathLike):
        raise EventsimError(f"path = {path!r}: must be the path of a file, one of {', '.join(suffixes.ANIMATIONS)}")
    file, film, look = Path(path), film or Film(), look or Look()
    suffix = suffix_of(file, suffixes.ANIMATIONS, "an animation")
    if suffix == ".html":
        text = _page(log, film, look)
        with atomic_write(file) as part:
            write_page(part, text)
        return
    passage = Passage(log)
    timing = _timing(passage.span, suffix, film)
    if suffix == ".mp4":
        ffmpeg()  # missing: say so before any work is done
    hidden = BANDS if suffix == ".png" and look.trails else 0
    trail_frames = BANDS if suffix == ".png" else round(TRAIL * timing.fps)
    picture = Picture(passage, look, ROOM[suffix], timing.times, trail_frames, _caption(suffix, look, timing))
    with atomic_write(file) as part:
        drawn = _drawn(picture, passage, timing, hidden, progress)
        if suffix == ".mp4":
            write_mp4(part, drawn, picture.layout.size, timing.fps)
        elif suffix == ".gif":
            write_gif(part, drawn, palette_of(_samples(picture, passage, timing)), len(timing.times), timing.fps)
        else:
            write_strip(part, drawn, len(timing.times), picture.layout.size)


def _caption(suffix: str, look: Look, timing: Timing) -> str:
    """Return how much of the scene's clock passes in a second of a movie, and how far trails reach back on that clock."""
    words = [f"trails: last {span_words(TRAIL * timing.speed)}"] if look.trails else []
    return "   ".join([*words, *([] if suffix == ".png" else [f"\N{MULTIPLICATION SIGN} {short_number(timing.speed)}"])])


def _page(log: AnyLog, film: Film, look: Look) -> str:
    """Return the page that plays a log; what only drawn frames have is refused."""
    for name, value in (("fps", film.fps), ("begin", film.begin), ("end", film.end), ("size", look.size)):
        if value is not None:
            raise EventsimError(f"{name} = {value}: a page plays the whole log, at any size and rate; leave it out")
    span = Passage(log).span
    timing = frame_timing(span, FPS[".mp4"], film.speed, film.duration)
    return page(
        log,
        color=look.color,
        dark=look.dark,
        trails=look.trails,
        velocities=look.velocities,
        flash=look.flash,
        seconds=(span[1] - span[0]) / timing.speed,
    )


def animate_with(log: AnyLog, path: str | PathLike[str], **options: Any) -> None:
    """Write an animation with the options of Film and Look, each by its name; see `animate`."""
    known = {field.name: part for part in (Film, Look) for field in fields(part)}
    unknown = sorted(set(options) - set(known))
    if unknown:
        raise EventsimError(f"animate has no option {', '.join(unknown)}; there are {', '.join(known)}")
    for name in ("fps", "speed", "duration", "begin", "end"):
        if options.get(name) is not None:
            options[name] = _number(options[name], name)
    if "moments" in options and as_whole(options["moments"]) is None:
        raise EventsimError(f"moments = {options['moments']!r}: must be a whole number")
    size = options.get("size")
    if size is not None:
        sides = [as_whole(side) for side in size] if isinstance(size, tuple | list) else []
        if len(sides) != 2 or any(side is None or side < 1 for side in sides):
            raise EventsimError(f"size = {size!r}: must be two numbers of pixels, (width, height)")
    film, look = ({name: value for name, value in options.items() if known[name] is part} for part in (Film, Look))
    animate(log, path, Film(**film), Look(**look))


def _number(value: object, name: str) -> float:
    """The value as a float; EventsimError for what is no number."""
    try:
        return as_number(value)
    except (TypeError, OverflowError) as error:
        raise EventsimError(f"{name} = {value!r}: {error}") from None


def _timing(span: tuple[float, float], suffix: str, film: Film) -> Timing:
    if suffix != ".png":
        return frame_timing(
            span,
            FPS[suffix] if film.fps is None else film.fps,
            film.speed,
            film.duration,
            film.begin,
            film.end,
        )
    if film.moments < 1:
        raise EventsimError(f"moments = {film.moments}: must be at least 1")
    times = moments(span, film.moments, film.begin, film.end)
    first, last = shown_span(span, film.begin, film.end)
    return Timing(times, FPS[".mp4"], (last - first) / SECONDS)


def _drawn(
    picture: Picture, passage: Passage, timing: Timing, hidden: int, progress: Progress | None
) -> Iterator[NDArray[np.uint8]]:
    """Yield the pixels of each frame.

    hidden: how many frames are drawn before each and not shown, for its trail: the moments of a strip are far apart.
    """
    ahead = TRAIL * timing.speed * np.arange(hidden, 0, -1) / max(hidden, 1)
    times: list[float] = []
    shown = []
    for time in timing.times.tolist():
        least = times[-1] if times else np.nextafter(passage.span[0], -np.inf)
        times += [
            early for early in (time - ahead).tolist() if early > least
        ]  # what is before the last moment was drawn for it
        times.append(time)
        shown.append(len(times))
    for place, frame in enumerate(frames_at(passage, np.array(times), GLOW * timing.speed), start=1):
        pixels = picture.draw(frame)
        if place == shown[0]:
            del shown[0]
            yield pixels
        if progress is not None:
            progress(place / len(times), frame.events, frame.state.time)


def _samples(picture: Picture, passage: Passage, timing: Timing) -> Iterator[NDArray[np.uint8]]:
    chosen = timing.times[np.unique(np.linspace(0, len(timing.times) - 1, PALETTE_FRAMES).astype(int))]
    for frame in frames_at(passage, chosen, GLOW * timing.speed):
        yield picture.draw(frame).copy()

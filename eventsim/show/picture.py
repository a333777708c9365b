"""A picture: one frame after another on one canvas, of which only what moves is drawn anew."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import CircleCollection, LineCollection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.path import Path
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

from eventsim.record.events import Floats
from eventsim.replay.passage import Passage
from eventsim.scene.names import plural
from eventsim.show import outlines
from eventsim.show.colouring import colouring_of
from eventsim.show.frames import Frame, energy_name, energy_zero
from eventsim.show.images import disks_with_images, lines_with_images
from eventsim.show.layout import DPI, Bars, layout
from eventsim.show.output import name_of
from eventsim.show.overview import overview_of
from eventsim.show.palette import DARK, LIGHT
from eventsim.show.strokes import Trails, arrows, spokes
from eventsim.show.window import window_of

SMALLEST = 1.5
"""Pixels: the radius at which points, and disks too small to be seen, are drawn."""

EDGED = 4.0
"""Pixels: disks of a larger radius get an edge, that neighbours of one colour can be told apart."""

WALL_WIDTH, WIDEST_WALL = 2.0, 0.08
"""Points, and as a share of the picture's smaller side: a corridor must not be all wall."""

LATEST = 1e15
"""A time from which on it has more digits than anybody reads."""

SHORT = "kin. + pot. energy"
"""Of the energy under gravity, where there is little room."""

WIDEST_NUMBER = "-8.888e-88"

LONGEST_ARROW = 0.08
"""The arrow of the fastest flight is this share of the picture's larger side."""


@dataclass(frozen=True, slots=True)
class Look:
    """What a picture shows besides the disks.

    size: pixels (width, height), None: what suits the scene. color: a mode of `colouring`, None: what suits the scene.
    """

    size: tuple[int, int] | None = None
    color: str | None = None
    trails: bool = False
    velocities: bool = False
    flash: bool = False
    dark: bool = False


class Picture:
    """A canvas for the frames of one log. The background (walls, domain, key) is drawn once.

    Disks are circles of their true radius, one collection; a disk across a periodic boundary is drawn on both sides.
    """

    def __init__(
        self, passage: Passage, look: Look, room: tuple[int, int], times: Floats, trail_frames: int = 1, caption: str = ""
    ) -> None:
        """Begin a picture.

        room: pixels that it may take where the look gives no size. times: of the frames to come.  caption: to stand before the
        clock.
        """
        log, self._look = passage.log, look
        self._log = log
        self._scene = log.scene
        self._palette = DARK if look.dark else LIGHT
        self._radius = log.scene.disks.radius
        self._overview = overview_of(log)
        self._colouring = colouring_of(look.color, log.scene.disks, self._overview)
        shown = window_of(passage, float(times[-1]))
        if look.velocities:
            shown = _with_room_for_arrows(shown, log.scene.domain.periodic)
        self.layout = layout(shown, look.size, room)
        width, height = self.layout.size
        self._figure = Figure(figsize=(width / DPI, height / DPI), dpi=DPI, facecolor=self._palette.paper)
        self._canvas = FigureCanvasAgg(self._figure)
        self._axes = self._figure.add_axes(self.layout.axes)
        self._axes.set(xlim=(shown[0], shown[2]), ylim=(shown[1], shown[3]))
        self._axes.axis("off")
        self._draw_background(shown)
        self._disks = self._disk_artist()
        self._trails = Trails(passage, trail_frames, self.layout.scale) if look.trails else None
        self._trail = self._path_artist(self._palette.trail)
        self._spokes = self._path_artist("black")
        self._spokes.set_path_effects(
            [withStroke(linewidth=2.6 * self.layout.unit, foreground="white")]
        )  # seen on every colour
        self._arrow_time, self._arrows = self._time_of_arrows(shown), self._path_artist(self._palette.arrow)
        self._arrows.set_path_effects([withStroke(linewidth=2.6 * self.layout.unit, foreground=self._palette.paper)])
        self._bars = Bars(self._figure, self.layout, self._palette, name_of(log))
        self._bars.draw_key(self._colouring.key)
        self._caption = f"{caption}   " if caption else ""
        self._energy = self._energy_words()
        self._clock_format = _clock_format(times)
        self._canvas.draw()
        self._background = self._canvas.copy_from_bbox(self._figure.bbox)

    def draw(self, frame: Frame) -> NDArray[np.uint8]:
        """Draw a frame; return its pixels (height, width, 4), red green blue alpha, valid until the next one."""
        self._canvas.restore_region(self._background)
        if self._trails is not None:
            for path, alpha in self._trails.follow(frame):
                self._trail.set(path=path, alpha=alpha)
                self._axes.draw_artist(self._trail)
        self._place_disks(frame)
        self._axes.draw_artist(self._disks)
        if frame.angle is not None:
            place, disk = disks_with_images(frame.state.position, self._radius, self._scene)
            self._spokes.set_path(spokes(place, frame.angle[disk], self._radius[disk]))
            self._axes.draw_artist(self._spokes)
        if self._look.velocities:
            self._arrows.set_path(arrows(*self._from_rims(frame)))
            self._axes.draw_artist(self._arrows)
        self._bars.clock.set_text(f"{self._caption}t = {frame.state.time:{self._clock_format}}")
        self._bars.counter.set_text(self._energy.format(events=plural(frame.events, "event"), energy=f"{frame.energy:.4g}"))
        for text in (self._bars.clock, self._bars.counter):
            self._figure.draw_artist(text)
        return np.asarray(self._canvas.buffer_rgba())

    def _from_rims(self, frame: Frame) -> tuple[Floats, Floats]:
        """Return where the arrows of velocities begin, at the rims of the disks, and how far they go."""
        velocity = frame.state.velocity
        speed = np.hypot(*velocity.T)[:, None]
        way = np.divide(velocity, speed, out=np.zeros_like(velocity), where=speed > 0.0)
        return frame.state.position + self._radius[:, None] * way, velocity * self._arrow_time

    def _energy_words(self) -> str:
        """Return the words of the lower bar, as long as there is room: which energy it is, and where it is 0."""
        name, zero = energy_name(self._scene), energy_zero(self._scene)
        words = [f"{{events}}   {name} {{energy}}"]
        if zero is not None:
            words = [f"{words[0]} ({zero})", *words, f"{{events}}   {SHORT} {{energy}}", f"{SHORT} {{energy}}"]
        most = {"events": plural(len(self._log), "event"), "energy": WIDEST_NUMBER}
        fitting = self._bars.longest_that_fits([text.format(**most) for text in words])
        return next(text for text in words if text.format(**most) == fitting)

    def _place_disks(self, frame: Frame) -> None:
        colours = self._colouring.paint(frame)
        if self._look.flash:
            glow = frame.glow[:, None]
            colours = colours * (1.0 - glow) + np.array(to_rgba(self._palette.glow)) * glow
        place, disk = disks_with_images(frame.state.position, self._radius, self._scene)
        self._disks.set(offsets=place, facecolor=colours[disk])
        self._disks.set_sizes(self._areas[disk], DPI)

    def _disk_artist(self) -> CircleCollection:
        radius = np.maximum(self._radius * self.layout.scale, SMALLEST)
        self._areas = np.pi * (radius * 72.0 / DPI) ** 2  # CircleCollection takes areas, in square points
        width = 0.6 if float(np.median(radius)) > EDGED else 0.0
        disks = CircleCollection(
            self._areas,
            offsets=self._scene.disks.position,
            offset_transform=self._axes.transData,
            edgecolors=self._palette.edge if width else "none",
            # Two equal widths: with one, Agg would draw a lone disk as a marker, snapped to whole pixels.
            linewidths=[width, width],
        )
        disks.set_animated(True)
        self._axes.add_collection(disks, autolim=False)
        return disks

    def _path_artist(self, colour: str) -> PathPatch:
        width = 1.1 * self.layout.unit
        patch = PathPatch(Path(np.zeros((1, 2))), fill=False, edgecolor=colour, linewidth=width, capstyle="round")
        patch.set_animated(True)
        self._axes.add_patch(patch)
        return patch

    def _time_of_arrows(self, shown: outlines.Rectangle) -> float:
        """Return the time of flight that an arrow shows."""
        return LONGEST_ARROW * max(shown[2] - shown[0], shown[3] - shown[1]) / (self._overview.fastest or 1.0)

    def _draw_background(self, shown: outlines.Rectangle) -> None:
        scene = self._scene
        corner, size = (shown[0], shown[1]), (shown[2] - shown[0], shown[3] - shown[1])
        if scene.domain.size is not None:
            corner, size = scene.domain.origin, scene.domain.size
        self._axes.add_patch(Rectangle(corner, *size, facecolor=self._palette.inside, edgecolor="none", zorder=0))
        hard, periodic = outlines.boundary_lines(scene)
        width = min(WALL_WIDTH * self.layout.unit, WIDEST_WALL * min(self.layout.scene[2:]))
        self._add_lines([*lines_with_images(outlines.wall_lines(scene), scene), *hard], width, "solid")
        self._add_lines(periodic, 0.6 * width, "dashed")

    def _add_lines(self, lines: Sequence[Floats], width: float, style: str) -> None:
        artist = LineCollection(
            list(lines),
            colors=self._palette.wall,
            linewidths=width * self.layout.unit,
            linestyles=style,
            zorder=1,
        )
        artist.set_capstyle("round")
        self._axes.add_collection(artist, autolim=False)


def _with_room_for_arrows(shown: outlines.Rectangle, periodic: Sequence[bool]) -> outlines.Rectangle:
    """Return the window with the length of the longest arrow on each side at which disks turn round."""
    length = LONGEST_ARROW * max(shown[2] - shown[0], shown[3] - shown[1])
    x, y = (0.0 if wraps else length for wraps in periodic)
    return shown[0] - x, shown[1] - y, shown[2] + x, shown[3] + y


MISPLACED = 0.02
"""Of the time between frames: a clock that is further off gets more digits (t = 12.8 among steps of 3.2 is not 13)."""


def _clock_format(times: Floats) -> str:
    """Return a format that tells neighbouring frames apart, and shows none as if it were elsewhere between the others."""
    step = float(times[-1] - times[0]) / max(len(times) - 1, 1)
    digits = max(math.ceil(-math.log10(step)), 0) if step > 0.0 else 3
    while digits < 12 and float(np.abs(np.round(times, digits) - times).max()) > MISPLACED * step > 0.0:
        digits += 1
    return f",.{digits}f" if digits < 12 and float(np.abs(times).max()) < LATEST else ".6e"

"""Layout: how large a picture is, where in it the scene is, and the bars of text above and below."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from matplotlib.text import Text

from eventsim.errors import EventsimError
from eventsim.show.colouring import Kinds, Scale, amounts
from eventsim.show.outlines import Rectangle
from eventsim.show.palette import Palette

DPI = 100
BAR, PAD = 34, 12
"""Pixels of a bar of text and of what is left free beside it, in a picture whose shorter side is `USUAL`."""
USUAL = 640
NARROWEST = 440
"""Pixels below which the bars of text would not have their room."""

SMALLEST_UNIT = 0.9
"""Text of 12 pixels, the smallest that reads well."""

SMALLEST_SIZE, LARGEST_SIZE = 160, 8192

AT_LEAST = "\N{GREATER-THAN OR EQUAL TO} "
"""Before the end of a scale whose last colour is for more, too."""


@dataclass(frozen=True, slots=True)
class Layout:
    """Pixels: size (width, height) of the picture; scene (left, bottom, width, height); `unit`, the scale of text.

    scale: pixels per length of the scene.
    """

    size: tuple[int, int]
    scene: tuple[float, float, float, float]
    unit: float
    scale: float

    @property
    def axes(self) -> tuple[float, float, float, float]:
        """The scene's place as shares of the picture."""
        (width, height), (left, bottom, w, h) = self.size, self.scene
        return left / width, bottom / height, w / width, h / height


def layout(shown: Rectangle, size: tuple[int, int] | None, room: tuple[int, int]) -> Layout:
    """Fit a rectangle of the scene into a picture of `size`, or, without one, of the size that suits within `room`.

    Sizes are made even, as movies need it. Raises EventsimError for a size that no picture can have.
    """
    if size is not None and not all(SMALLEST_SIZE <= side <= LARGEST_SIZE for side in size):
        raise EventsimError(
            f"size {size[0]}x{size[1]}: each side must be from {SMALLEST_SIZE} to {LARGEST_SIZE} pixels"
        )
    width, height = shown[2] - shown[0], shown[3] - shown[1]
    unit = min(max(min(size or room) / USUAL, SMALLEST_UNIT), 2.5)
    bar, pad = BAR * unit, PAD * unit
    space = size or room
    scale = min((space[0] - 2 * pad) / width, (space[1] - 2 * bar) / height)
    if size is None:
        size = (
            max(round(width * scale + 2 * pad), round(NARROWEST * unit)),
            max(round(height * scale + 2 * bar), 120),
        )
    size = size[0] + size[0] % 2, size[1] + size[1] % 2
    w, h = width * scale, height * scale
    return Layout(size, ((size[0] - w) / 2, (size[1] - h) / 2, w, h), unit, scale)


class Bars:
    """The text above and below the scene: name and clock, counters and the key of the colours."""

    def __init__(self, figure: Figure, place: Layout, palette: Palette, title: str) -> None:
        self._figure, self._place, self._palette = figure, place, palette
        self._text(PAD, -BAR / 2, title, "left", palette.ink, weight="bold")
        self.clock = self._text(-PAD, -BAR / 2, "", "right", palette.ink)
        self.counter = self._text(PAD, BAR / 2, "", "left", palette.faint)
        for text in (self.clock, self.counter):
            text.set_animated(True)
        self._key = float(PAD)

    def draw_key(self, key: Scale | Kinds | None) -> None:
        """Draw the key of the colours at the right of the lower bar."""
        if isinstance(key, Scale):
            self._key = self._draw_scale(key)
        elif key is not None:
            self._key = self._draw_dots(key.labels, float(PAD))

    def longest_that_fits(self, texts: Sequence[str]) -> str:
        """Return the first of some texts, the longest first, that fits beside the key of colours; the last where none does."""
        room = self._place.size[0] / self._place.unit - PAD - self._key
        for text in texts:
            self.counter.set_text(text)
            if self._width(self.counter) <= room:
                break
        self.counter.set_text("")
        return text

    def _draw_scale(self, key: Scale) -> float:
        """Draw a scale; how far it reaches from the right."""
        right, length, faint = float(PAD), 90.0, self._palette.faint
        high = self._text(-right, BAR / 2, f"{AT_LEAST if key.beyond else ''}{key.high:.3g}", "right", faint)
        right += self._width(high) + 6
        unit, (width, height) = self._place.unit, self._place.size
        strip = self._figure.add_axes(
            (
                1 - (right + length) * unit / width,
                (BAR / 2 - 5) * unit / height,
                length * unit / width,
                10 * unit / height,
            )
        )
        strip.imshow(amounts()(np.linspace(0, 1, 256))[None], aspect="auto", interpolation="bilinear")
        strip.axis("off")
        low = self._text(-(right + length + 6), BAR / 2, f"{key.title}  {key.low:.3g}", "right", faint)
        return self._draw_dots(key.apart, right + length + 6 + self._width(low) + 10)

    def _draw_dots(self, labels: Sequence[tuple[str, str]], right: float) -> float:
        """Draw dots with their labels from the right to the left, as many as there is room for; how far they reach."""
        room = 0.55 * self._place.size[0] / self._place.unit
        for left, (label, colour) in zip(range(len(labels) - 1, -1, -1), reversed(labels), strict=True):
            text = self._text(-right, BAR / 2, label, "right", self._palette.faint)
            right += self._width(text) + 5
            dot = self._text(-right, BAR / 2, "\N{BLACK CIRCLE}", "right", colour)
            right += self._width(dot) + 10
            if right > room and left:
                return right + self._width(self._text(-right, BAR / 2, "...", "right", self._palette.faint)) + 10
        return right

    def _text(self, x: float, y: float, text: str, align: str, colour: str, weight: str = "normal") -> Text:
        """Place a text; x from the left (negative: from the right), y from the bottom (negative: from the top)."""
        unit, (width, height) = self._place.unit, self._place.size
        return self._figure.text(
            (x * unit / width) % 1.0,
            (y * unit / height) % 1.0,
            text,
            ha=align,
            va="center_baseline",
            color=colour,
            fontsize=13.5 * unit * 72 / DPI,
            weight=weight,
        )

    def _width(self, text: Text) -> float:
        """Return the width of a text in pixels of the usual size."""
        return float(text.get_window_extent().width) / self._place.unit

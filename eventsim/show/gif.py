"""gif: frames through Pillow, all in one palette."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

HUNDREDTH = 10
"""Milliseconds: the unit in which a gif counts time."""


def palette_of(frames: Iterable[NDArray[np.uint8]]) -> Image.Image:
    """Return an image whose 256 colours suit all of some frames (height, width, 4)."""
    samples = np.concatenate([frame[..., :3] for frame in frames])
    return Image.fromarray(samples).quantize(256, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)


def write_gif(part: Path, frames: Iterable[NDArray[np.uint8]], palette: Image.Image, count: int, fps: float) -> None:
    """Write `count` frames (height, width, 4), shown for ever; of each only what changed is kept."""
    images = (Image.fromarray(frame[..., :3]).quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames)
    first = next(images)
    # A gif counts in hundredths of a second: each frame ends at the nearest one, so that nothing accumulates.
    ends = np.maximum(np.round(np.arange(1, count + 1) * (100.0 / fps)), np.arange(1, count + 1)).astype(int)
    durations = (np.diff(ends, prepend=0) * HUNDREDTH).tolist()
    first.save(
        part,
        format="GIF",
        save_all=True,
        append_images=images,
        duration=durations,
        loop=0,
        optimize=False,
        disposal=1,
    )

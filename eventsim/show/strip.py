"""Strip: some moments of a run beside and below each other in one picture."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

SHAPE = 1.8
"""Width by height that a strip comes near to: what a page of text and a slide have room for."""


def columns_for(count: int, size: tuple[int, int]) -> int:
    """Return in how many columns `count` pictures of `size` make a strip of the usual shape, rows filled if possible."""

    def misfit(columns: int) -> float:
        rows = -(-count // columns)
        empty = columns * rows - count
        return abs(math.log(columns * size[0] / (rows * size[1]) / SHAPE)) + 0.5 * empty

    return min(range(1, count + 1), key=misfit)


def write_strip(part: Path, frames: Iterable[NDArray[np.uint8]], count: int, size: tuple[int, int]) -> None:
    """Write `count` frames (height, width, 4) as one png, left to right, then down."""
    columns = columns_for(count, size)
    width, height = size
    strip = np.full((-(-count // columns) * height, columns * width, 3), 255, dtype=np.uint8)
    for place, frame in enumerate(frames):
        row, column = divmod(place, columns)
        strip[row * height : (row + 1) * height, column * width : (column + 1) * width] = frame[..., :3]
    Image.fromarray(strip).save(part, format="PNG", optimize=True)

"""The kernel in machine code, where numba is installed; else as it is."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

from eventsim.compiler import has_compiler
from eventsim.growth import kernel

FEW = 48
"""Disks that plain Python compresses before a compiler is even loaded."""


def grower(n: int) -> Callable[..., tuple[int, float, int]]:
    """`kernel.grow` for n disks: compiled where that is possible and pays."""
    return _compiled() if n > FEW and has_compiler() else kernel.grow


@cache
def _compiled() -> Callable[..., tuple[int, float, int]]:
    from numba import njit
    from numba.extending import register_jitable

    for part in (
        kernel.growing_delay,
        kernel.wall_delay,
        kernel.escape_delay,
        kernel.nearest,
        kernel.predict,
        kernel.settle,
        kernel.move,
    ):
        register_jitable(error_model="numpy")(part)
    try:
        grow: Callable[..., tuple[int, float, int]] = njit(error_model="numpy", cache=True)(kernel.grow)
    except RuntimeError:  # no folder to keep it in
        grow = njit(error_model="numpy")(kernel.grow)
    return grow

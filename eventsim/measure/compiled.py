"""The sums in machine code, where numba is installed and the run is long; else as they are.  Both give the same bits."""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple, cast

import numpy as np

from eventsim.compiler import kept_in, kernel_folder
from eventsim.measure import sums
from eventsim.record.events import Floats

FEW_ROWS = 1 << 15
"""Rows up to which plain Python is done before a compiler is even loaded."""

ALONE = {"error_model": "numpy", "_nrt": False, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
"""Of what kernels alone call: nothing is allocated, so no references are counted, and there is no way in from Python."""

VERY_FEW_ROWS = 1 << 11
"""The same where the compiler has been loaded for the run itself."""


class Kernels(NamedTuple):
    """`sums.take`, `sums.finish` and `sums.hold_all`."""

    take: Callable[..., int]
    finish: Callable[[float, sums.Plan, sums.Sums], bool]
    hold_all: Callable[[sums.Plan, sums.Sums, float], float]


def kernels(rows: int, waits: bool = True) -> Kernels:
    """The kernels for a run that has come to so many rows; waits: whether somebody waits for them to be compiled."""
    few = VERY_FEW_ROWS if "numba" in sys.modules else FEW_ROWS
    if not waits and not _compiled.cache_info().currsize:
        return PLAIN
    return _compiled() if rows > few and find_spec("numba") is not None else PLAIN


def _viewed(arrays: Any) -> Any:
    """Arrays as views whose elements are Python's own numbers, which plain Python is several times faster with."""
    return type(arrays)(*(memoryview(cast(Any, item)) if isinstance(item, np.ndarray) else item for item in arrays))



def _view(array: Floats | None) -> Any:
    """The same of an array that may be missing."""
    return None if array is None else memoryview(cast(Any, array))


PLAIN = Kernels(
    lambda block, first, plan, held, told=None, facing=None: sums.take(
        _viewed(block), first, plan, _viewed(held), _view(told), _view(facing)
    ),
    lambda until, plan, held: sums.finish(until, plan, _viewed(held)),
    lambda plan, held, time: sums.hold_all(plan, _viewed(held), time),
)


@cache
def _compiled() -> Kernels:
    """Counting references would take most of the time."""
    from numba import config, njit
    from numba.extending import register_jitable

    for part in (
        sums.first_pair,
        sums.first_wall,
        sums.first_shear,
        sums.first_speed,
        sums.reach,
        sums.turn,
        sums.slot_of,
        sums.swap,
        sums.nearest,
        sums.sample_before,
        sums.leave,
        sums.fly,
        sums.meet,
        sums.normal_part,
        sums.spin,
    ):
        register_jitable(**ALONE, forceinline=True)(part)
    # rare, or long: calls of their own
    for rare in (
        sums.widen,
        sums.merge,
        sums.mark,
        sums.sample,
        sums.hold,
        sums.spread,
        sums.fall_in_bin,
        sums.fall,
        sums.side_of,
        sums.strike,
    ):
        register_jitable(**ALONE)(rare)
    _fetch_disks()
    whole = (sums.take, sums.finish, sums.hold_all)
    try:
        with kept_in(config, kernel_folder("measure", Path(sums.__file__), Path(__file__))):
            return Kernels(*(njit(error_model="numpy", nogil=True, _nrt=False, cache=True)(part) for part in whole))
    except RuntimeError:  # no folder to keep them in
        return Kernels(*(njit(error_model="numpy", nogil=True, _nrt=False)(part) for part in whole))


def _fetch_disks() -> None:
    """Have machine code ask for the two cache lines of a disk where `sums.expect` is called."""
    from numba.extending import overload

    from eventsim.engines.fast.numba_memory import pointer, prefetch

    @overload(sums.expect, inline="always", strict=False)  # type: ignore[untyped-decorator]
    def expect(disks: Any, i: Any) -> Callable[..., None]:
        def asked(disks, i):  # type: ignore[no-untyped-def]
            line = pointer(disks)
            prefetch(line, i * sums.DISK_COLUMNS)
            prefetch(line, i * sums.DISK_COLUMNS + sums.DISK_COLUMNS // 2)

        return asked

"""What kernels are made with, in plain Python: for a debugger, for coverage, for reading along.

Each name does here what its twin in `numba_compiler` and `numba_memory` does there.  Numbers are NumPy's, whose division by zero
gives what machine code gives.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from typing import Any

import numpy as np
from numpy.typing import NDArray


def inline(function: Callable[..., Any]) -> Callable[..., Any]:
    """Leave a part of a kernel as it is."""
    return function


part = inline


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Leave a kernel as it is, but let it compute on where numbers leave their range."""

    @wraps(function)
    def silent(*arguments: Any) -> Any:
        with np.errstate(all="ignore"):
            return function(*arguments)

    return silent


def compiled_law(own: Any) -> Any:
    """A law of the user's own, as it is; nan where it fails."""

    def law(*given: Any) -> float:
        try:
            return float(own(*map(float, given)))
        except (Exception, SystemExit):
            return float("nan")

    return law


def link(has_walls: bool) -> None:
    """Nothing is called by its name here."""


announce = link


@contextmanager
def compiling_alone() -> Iterator[None]:
    """Nobody compiles."""
    yield


@contextmanager
def timed_compiling(note: Callable[[float], None]) -> Iterator[None]:
    """Nothing is compiled."""
    yield


def is_compiling() -> bool:
    """Whether a kernel is being compiled."""
    return False


def mark_warm(kind: str) -> None:
    """Nothing is kept on disk."""


def is_warm(kind: str) -> bool:
    """Whether there is nothing left to compile."""
    return True


class Memory:
    """The memory of an array, whatever is in it: as float64, as int32, as bytes."""

    __slots__ = ("numbers", "reals", "words")

    def __init__(self, array: NDArray[Any]) -> None:
        self.numbers: NDArray[np.uint8] = array.reshape(-1).view(np.uint8)
        self.words: NDArray[np.int32] = self._seen_as(np.int32)
        self.reals: NDArray[np.float64] = self._seen_as(np.float64)

    def _seen_as(self, kind: Any) -> NDArray[Any]:
        size = np.dtype(kind).itemsize
        return self.numbers[: len(self.numbers) // size * size].view(kind)


def pointer(array: NDArray[Any] | None) -> Memory | None:
    """The memory of an array; None stays None."""
    return None if array is None else Memory(array)


def either(thing: Any, given: Any, absent: Any) -> Any:
    """One of two functions: `given` if there is such a thing, `absent` if it is None."""
    return absent if thing is None else given


def real(data: Memory, index: int) -> np.float64:
    """The float64 at an index."""
    number: np.float64 = data.reals[index]
    return number


def word(data: Memory, index: int) -> int:
    """The int32 at an index."""
    return int(data.words[index])


def store(data: Memory, index: int, value: Any) -> None:
    """Store a float as float64, an integer as int32."""
    if isinstance(value, float):
        data.reals[index] = value
    else:
        data.words[index] = value


def put_line(data: Memory, offset: int, line: tuple[Any, ...]) -> None:
    """Store eight numbers of 64 bits at an offset in bytes."""
    for place, value in enumerate(line):
        kind = "<d" if isinstance(value, float) else "<q"
        struct.pack_into(kind, data.numbers.data, offset + 8 * place, value)


def prefetch(data: Memory, index: int) -> None:
    """Nothing: memory is Python's affair."""


def lanes_work() -> bool:
    """Whether pairs can be predicted eight at a time; not here."""
    return False


gather_disks = contact_of_eight = None
"""What lanes do; without them nobody calls it."""

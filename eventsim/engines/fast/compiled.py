"""How a kernel is made from Python: machine code by numba, or, where `EVENTSIM_INTERPRET` says so, Python as it is."""

from __future__ import annotations

from typing import Any

from eventsim.compiler import is_interpreted

chosen: Any
if is_interpreted():
    from eventsim.engines.fast import plain_python as chosen
else:
    from eventsim.engines.fast import numba_compiler as chosen

inline, part, kernel, link = chosen.inline, chosen.part, chosen.kernel, chosen.link
timed_compiling, mark_warm = chosen.timed_compiling, chosen.mark_warm


def is_compiling() -> bool:
    """Whether a kernel is being compiled: it has not begun to work, so an interrupt may break in."""
    return bool(chosen.is_compiling())


def is_warm(kind: str) -> bool:
    """Whether the kernels for a scene of this kind are on disk."""
    return bool(chosen.is_warm(kind))

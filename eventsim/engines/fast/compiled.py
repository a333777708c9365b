"""What kernels are made of: machine code by numba, or, where `EVENTSIM_INTERPRET` says so, Python as it is.

How a kernel is made from Python, and how it reaches memory and registers.
"""

from __future__ import annotations

from typing import Any

from eventsim.compiler import is_interpreted

chosen: Any
memory: Any
if is_interpreted():
    from eventsim.engines.fast import plain_python as chosen

    memory = chosen
else:
    from eventsim.engines.fast import numba_compiler as chosen
    from eventsim.engines.fast import numba_memory as memory

compiled_law = chosen.compiled_law
inline, part, kernel = chosen.inline, chosen.part, chosen.kernel
announce, link = chosen.announce, chosen.link
timed_compiling, compiling_alone, mark_warm = chosen.timed_compiling, chosen.compiling_alone, chosen.mark_warm
pointer, either, real, word, store = memory.pointer, memory.either, memory.real, memory.word, memory.store
put_line, prefetch = memory.put_line, memory.prefetch
lanes_work, gather_disks, contact_of_eight = memory.lanes_work, memory.gather_disks, memory.contact_of_eight


def is_compiling() -> bool:
    """Whether a kernel is being compiled: it has not begun to work, so an interrupt may break in."""
    return bool(chosen.is_compiling())


def is_warm(kind: str) -> bool:
    """Whether the kernels for a scene of this kind are on disk."""
    return bool(chosen.is_warm(kind))

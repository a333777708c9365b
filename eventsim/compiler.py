"""Whether kernels are compiled here: without numba, or where one is told not to, what it would compile runs as plain Python."""

import os
from importlib.util import find_spec

SWITCH = "NUMBA_DISABLE_JIT"
"""The variable of the environment by which numba is told to leave Python as it is."""

INTERPRET = "EVENTSIM_INTERPRET"
"""The variable by which eventsim is told to run its kernels as plain Python: slowly, for a debugger and for coverage."""


def is_switched_off() -> bool:
    """Whether numba, if it is there, is told not to compile."""
    return _is_set(SWITCH)


def is_interpreted() -> bool:
    """Whether kernels run as plain Python, the fast engine's, too."""
    return _is_set(INTERPRET)


def has_compiler() -> bool:
    """Whether numba is installed and compiles."""
    return find_spec("numba") is not None and not is_switched_off() and not is_interpreted()


def _is_set(name: str) -> bool:
    return os.environ.get(name, "").strip() not in ("", "0")

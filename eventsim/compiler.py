"""Whether numba compiles here: without it, or where it is told not to, what it would compile runs as plain Python."""

import os
from importlib.util import find_spec

SWITCH = "NUMBA_DISABLE_JIT"
"""The variable of the environment by which numba is told to leave Python as it is."""


def is_switched_off() -> bool:
    """Whether numba, if it is there, is told not to compile."""
    return os.environ.get(SWITCH, "").strip() not in ("", "0")


def has_compiler() -> bool:
    """Whether numba is installed and compiles."""
    return find_spec("numba") is not None and not is_switched_off()

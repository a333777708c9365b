"""Whether kernels are compiled here: without numba, or where one is told not to, what it would compile runs as plain Python.

And where compiled ones are kept.
"""

import hashlib
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

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


def kernel_folder(name: str, *sources: Path) -> Path:
    """Where compiled kernels of this name are kept: in the user's cache, by a hash of all that they are made from.

    numba itself would not notice an edit in another file than a kernel's own.  sources: files, and folders of them.
    """
    if "EVENTSIM_CACHE_DIR" in os.environ:
        base = Path(os.environ["EVENTSIM_CACHE_DIR"])
    elif sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA", Path.home())) / "eventsim"
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / "Caches" / "eventsim"
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "eventsim"
    digest = hashlib.sha256()
    for source in sources:
        for path in sorted(source.rglob("*.py")) or [source]:
            digest.update(path.read_bytes())
    return base / f"{name}-{digest.hexdigest()[:16]}"


@contextmanager
def kept_in(config: Any, folder: Path) -> Iterator[None]:
    """Let kernels that are decorated inside be kept in a folder; the user's own setting is left alone.

    config: numba's.  It raises RuntimeError inside where it can write to no folder.
    """
    before = config.CACHE_DIR
    config.CACHE_DIR = str(folder)  # read when a function is decorated
    try:
        yield
    finally:
        config.CACHE_DIR = before


def _is_set(name: str) -> bool:
    return os.environ.get(name, "").strip() not in ("", "0")

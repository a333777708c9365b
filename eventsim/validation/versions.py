"""The versions of what is compared: numbers of another version are other numbers."""

from __future__ import annotations

import platform
from importlib.metadata import PackageNotFoundError, version

from eventsim import __version__

COMPARED = ("numpy", "numba", "pymunk")


def versions() -> dict[str, str]:
    """Name -> version of this package, of Python, and of what is installed that engines are made of."""
    found = {"eventsim": __version__, "python": platform.python_version()}
    for name in COMPARED:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found

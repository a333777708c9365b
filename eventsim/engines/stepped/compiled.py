"""How loops of the stepped engines become machine code; where there is no compiler they run as plain Python."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast

from eventsim.compiler import has_compiler

Loop = TypeVar("Loop", bound=Callable[..., Any])

if not has_compiler():
    COMPILED = False

    def kernel(function: Loop) -> Loop:
        """Leave a loop as it is."""
        return function

    part = kernel
else:
    import numba
    from numba import njit

    from eventsim.engines.fast import numba_compiler as compiled  # makes the formulas callable from kernels

    COMPILED = True
    config: Any = numba.config  # its settings are made when it is imported

    def _folder() -> Path:
        """The folder beside that of the fast engine's kernels, by a hash of these sources: numba would not notice edits."""
        digest = hashlib.sha256()
        for path in sorted(Path(__file__).parent.glob("*.py")):
            digest.update(path.read_bytes())
        beside = compiled.cache_folder()
        return beside.with_name(f"{beside.name}-stepped-{digest.hexdigest()[:16]}")

    _FOLDER = str(_folder())

    def kernel(function: Loop) -> Loop:
        """Compile a loop that Python calls; kept on disk where that is possible."""
        before = config.CACHE_DIR
        config.CACHE_DIR = _FOLDER  # read when the function is decorated
        try:
            kept = njit(error_model="numpy", cache=True, pipeline_class=compiled.CallerCompiler)(function)
        except RuntimeError:  # no folder to write to
            return cast(Loop, njit(error_model="numpy", pipeline_class=compiled.CallerCompiler)(function))
        finally:
            config.CACHE_DIR = before
        compiled.name_apart(kept)
        return cast(Loop, kept)

    def part(function: Loop) -> Loop:
        """Compile what loops call."""
        return cast(Loop, njit(error_model="numpy", pipeline_class=compiled.CallerCompiler)(function))

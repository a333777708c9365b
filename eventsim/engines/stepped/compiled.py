"""How loops of the stepped engines become machine code; where there is no compiler they run as plain Python."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast

from eventsim.compiler import has_compiler, kept_in, kernel_folder

Loop = TypeVar("Loop", bound=Callable[..., Any])

if not has_compiler():
    COMPILED = False

    def kernel(function: Loop) -> Loop:
        """Leave a loop as it is."""
        return function

    part = kernel
else:
    from numba import config, njit

    from eventsim.engines.fast import numba_compiler as compiled  # makes the formulas callable from kernels
    from eventsim.formulas import motion

    COMPILED = True
    _FOLDER = kernel_folder("stepped", Path(__file__).parent, Path(compiled.__file__).parent, Path(motion.__file__).parent)

    def kernel(function: Loop) -> Loop:
        """Compile a loop that Python calls; kept on disk where that is possible."""
        try:
            with kept_in(config, _FOLDER):
                kept = njit(error_model="numpy", cache=True, pipeline_class=compiled.CallerCompiler)(function)
        except RuntimeError:  # no folder to write to
            return cast(Loop, njit(error_model="numpy", pipeline_class=compiled.CallerCompiler)(function))
        compiled.name_apart(kept)
        return cast(Loop, kept)

    def part(function: Loop) -> Loop:
        """Compile what loops call."""
        return cast(Loop, njit(error_model="numpy", pipeline_class=compiled.CallerCompiler)(function))

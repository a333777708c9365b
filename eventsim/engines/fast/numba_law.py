"""A law of the user's own as machine code: compiled alone, and called by the kernels by its address."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from functools import cache
from typing import Any

from llvmlite import ir
from numba import cfunc, njit
from numba.core import types
from numba.extending import intrinsic, overload

from eventsim.errors import EventsimError
from eventsim.formulas import impulse

SIGNATURE = types.float64(types.float64, types.float64, types.float64, types.float64)
"""Restitution, approach, since and mass in, the restitution of the contact out; nan where the function raises."""


def law_address(function: Callable[..., float], asks: tuple[str, ...], name: str) -> int:
    """The address of a law.

    Raises:
        EventsimError: with the line of what cannot be compiled.
    """
    try:
        address: int = _compiled(function, asks).address
    except Exception as error:  # the compiler has many kinds of them
        raise EventsimError(
            f"the law {name} cannot be compiled: {_in_short(str(error))}; engine = reference runs it as it is"
        ) from None
    return address


@cache
def _compiled(function: Callable[..., float], asks: tuple[str, ...]) -> Any:
    """The owner of the machine code of a law."""
    names: dict[str, Any] = {"function": njit(error_model="python")(function), "nan": math.nan}
    text = (
        "def law(restitution, approach, since, mass):\n"
        "    try:\n"
        f"        return float(function({', '.join(asks)}))\n"
        "    except Exception:\n"
        "        return nan\n"
    )
    exec(text, names)
    return cfunc(SIGNATURE)(names["law"])


def _in_short(text: str) -> str:
    """What numba says, in one sentence with the line."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    where = re.findall(r'File "[^"<]+", line (\d+)|Raised from \S+ \((\d+)\)', text)
    passed = ("Failed in", "During", "File", "- Resolution")
    said = next((line for line in lines if not line.startswith(passed)), "numba gives no reason")
    return f"line {where[-1][0] or where[-1][1]}: {said}" if where else said


@intrinsic  # type: ignore[untyped-decorator]  # numba annotates nothing
def _called_at(typing: Any, address: Any, restitution: Any, approach: Any, since: Any, mass: Any) -> Any:
    """The machine code at an address, called."""

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        double = ir.DoubleType()
        function = ir.FunctionType(double, [double] * 4)
        return builder.call(builder.inttoptr(values[0], function.as_pointer()), values[1:])

    return types.float64(types.int64, *[types.float64] * 4), code


@overload(impulse.own_restitution, jit_options={"forceinline": True, "error_model": "numpy"})
def _own_restitution(own, restitution, approach, since, mass):  # type: ignore[no-untyped-def]  # as numba wants it
    return lambda own, restitution, approach, since, mass: _called_at(own, restitution, approach, since, mass)

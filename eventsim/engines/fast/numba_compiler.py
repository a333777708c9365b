"""How Python becomes machine code here: the two decorators, where compiled kernels are kept, the formulas made callable."""

from __future__ import annotations

import gc
import math
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from ctypes import addressof, c_void_p
from functools import cache, partial
from pathlib import Path
from time import perf_counter, sleep
from types import ModuleType
from typing import Any
from uuid import uuid4

from llvmlite import binding, ir
from numba import cfunc, config, njit, types
from numba.core import event
from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import cpu_target
from numba.extending import overload, register_jitable

from eventsim.compiler import kept_in, kernel_folder
from eventsim.engines.fast.numba_parts import CallerCompiler as CallerCompiler
from eventsim.engines.fast.numba_parts import KernelCompiler, PartCompiler
from eventsim.errors import LogError
from eventsim.formulas import (
    careful_impulse,
    chance,
    contact,
    corner,
    crossing,
    digits,
    doubt,
    expansion,
    image,
    impulse,
    motion,
    parabola,
    real,
    rest,
    rough,
    slide,
)
from eventsim.formulas.walls import point
from eventsim.record import events
from eventsim.record.files.claim import Claim
from eventsim.scene.walls import SHAPES

_FOLDER = kernel_folder("fast", Path(__file__).parent, Path(motion.__file__).parent, Path(events.__file__))


def is_warm(kind: str) -> bool:
    """Whether the kernels for scenes of this kind are on disk."""
    return (_FOLDER / f"{kind}.ready").exists()


def mark_warm(kind: str) -> None:
    """Note that the kernels for scenes of this kind are on disk."""
    try:
        _FOLDER.mkdir(parents=True, exist_ok=True)
        (_FOLDER / f"{kind}.ready").touch()
    except OSError:  # no folder to write to: they will be compiled again
        return


@contextmanager
def compiling_alone() -> Iterator[None]:
    """Wait until no other process that asks for this is compiling: what it has compiled need not be compiled once more."""
    with suppress(OSError):
        _FOLDER.mkdir(parents=True, exist_ok=True)
    claim = None
    while claim is None:
        try:
            claim = Claim(_FOLDER / "compiling.lock")  # refused where another process has it
            claim.take(make=True)
        except LogError:
            claim = None
            sleep(0.2)
    try:
        yield
    finally:
        claim.release()


@contextmanager
def timed_compiling(note: Callable[[float], None]) -> Iterator[None]:
    """Report the seconds spent on compiling inside; say so first where somebody watches."""
    with event.install_listener("numba:compile", _Watcher(note)):
        yield


def is_compiling() -> bool:
    """Whether a kernel is being compiled: it has not begun to work, so an interrupt may break in."""
    return _Watcher.at_work > 0


class _Watcher(event.Listener):
    """Sums up the outermost of nested compilations."""

    told = False
    at_work = 0

    def __init__(self, note: Callable[[float], None]) -> None:
        self._note = note
        self._depth = 0
        self._began = 0.0
        self._collects = False

    def on_start(self, event: Any) -> None:
        if self._depth == 0:
            self._began = perf_counter()
            if not _Watcher.told and sys.stderr.isatty():
                print("compiling the fast engine (once for scenes of this kind) ...", file=sys.stderr)
            _Watcher.told = True
            _Watcher.at_work += 1
            self._collects = gc.isenabled()
            gc.disable()  # nothing of what a compiler makes is garbage before it is done; looking takes a tenth of its time
        self._depth += 1

    def on_end(self, event: Any) -> None:
        self._depth -= 1
        if self._depth == 0:
            _Watcher.at_work -= 1
            if self._collects:
                gc.enable()
            self._note(perf_counter() - self._began)


def _once(compiler: Callable[..., Any], function: Callable[..., Any]) -> Any:
    """A compiled part, one for all whole numbers: numba would compile it anew for each constant that is handed over."""
    part = compiler(function)
    template = part.get_call_template

    def get_call_template(arguments: tuple[Any, ...], keywords: dict[str, Any]) -> Any:
        return template(tuple(map(_widened, arguments)), {name: _widened(kind) for name, kind in keywords.items()})

    part.get_call_template = get_call_template
    return part


def _widened(kind: Any) -> Any:
    """The type of a constant without its value."""
    if isinstance(kind, types.Tuple):
        return types.Tuple([_widened(item) for item in kind])
    return types.unliteral(kind)


_PART: dict[str, Any] = {
    "error_model": "numpy",
    "no_cpython_wrapper": True,
    "no_cfunc_wrapper": True,
    "_nrt": False,
    "pipeline_class": PartCompiler,
}
"""For what kernels alone call, and what allocates nothing: without these, machine code that nobody uses is made, too."""

inline = partial(_once, njit(forceinline=True, **_PART))
"""A part of a kernel; without force a small helper stays a real call, which costs a fifth of the rate."""


part = partial(_once, njit(**_PART))
"""A part that is rarely reached, and stays a call of its own."""


def kernel(function: Callable[..., Any]) -> Any:
    """A compiled function that Python calls; kept on disk where that is possible.  Other threads go on meanwhile."""
    return _kept(partial(njit, nogil=True, _nrt=False, no_cfunc_wrapper=True), function)


def _kept(compiler: Callable[..., Any], function: Callable[..., Any], *signature: Any) -> Any:
    try:
        with kept_in(config, _FOLDER):
            kept = compiler(*signature, error_model="numpy", cache=True, pipeline_class=KernelCompiler)(function)
    except RuntimeError:  # no folder to write to
        return compiler(*signature, error_model="numpy", pipeline_class=KernelCompiler)(function)
    name_apart(kept)
    return kept


def name_apart(kept: Any) -> None:
    """Let no two processes give one name to two kernels.

    numba numbers the files of a function's versions by the index that it has read; two processes that compile at one time would
    write different machine code under one number, and one of them would later be run with the other's arguments.
    """
    files = getattr(
        kept._cache, "_cache_file", None
    )  # numba's own affair: where it is not there, names stay as they are
    if files is not None:
        files._data_name_pattern = files._data_name_pattern.replace("{number:d}", "{number:d}." + _THIS_PROCESS)


_THIS_PROCESS = uuid4().hex[:8]

_careful = types.ExternalFunction("eventsim_careful_pair_delay", types.float64(*[types.float64] * 15))
_hand = types.ExternalFunction("eventsim_exact_hand", types.float64(*[types.float64] * 8))
LINKED = digits.careful_pair_delay, point.exact_hand, impulse.own_restitution
"""Formulas that kernels call by their names."""


def compiled_law(own: Any) -> int:
    """The address of a law of the user's own.

    Raises EventsimError where it cannot be compiled.
    """
    from eventsim.engines.fast.numba_law import law_address

    return law_address(own.function, own.asks, own.name)


def link(has_walls: bool) -> None:
    """Give kernels what they call by its name: compiled once, and not once more in every kernel.

    has_walls: whether the scene has walls besides the sides of its domain; no other kernel asks for the side of a point.
    """
    for name, formula in _called(has_walls):
        _door(name).value = _linked(name, formula).address


def announce(has_walls: bool) -> None:
    """Give kernels the names alone, so that they can be compiled: to be linked before they are called."""
    for name, _ in _called(has_walls):
        _door(name)


def _called(has_walls: bool) -> list[tuple[Any, Callable[..., float]]]:
    """What kernels call: by which name, and which formula."""
    return [(_careful, digits.careful_pair_delay), *([(_hand, point.exact_hand)] if has_walls else [])]


@cache
def _linked(name: Any, formula: Callable[..., float]) -> Any:
    """The owner of the memory of a formula that kernels call by this name."""
    return _kept(cfunc, formula, name.sig)


@cache
def _door(name: Any) -> c_void_p:
    """Where the address of a formula is kept, and code that has its name and jumps to that address."""
    address, kind = c_void_p(), ir.FunctionType(ir.DoubleType(), [ir.DoubleType()] * len(name.sig.args))
    module = ir.Module(f"{name.symbol}_door")
    function = ir.Function(module, kind, module.name)
    builder = ir.IRBuilder(function.append_basic_block())
    place = builder.inttoptr(ir.Constant(ir.IntType(64), addressof(address)), kind.as_pointer().as_pointer())
    builder.ret(builder.call(builder.load(place), function.args))
    with global_compiler_lock:
        library = cpu_target.target_context.codegen().create_library(module.name)
        library.add_ir_module(module)
        library.finalize()
    binding.add_symbol(name.symbol, library.get_pointer_to_function(module.name))
    _DOORS.append(library)
    return address


_DOORS: list[Any] = []
"""The owners of the code of doors."""


@overload(digits.careful_pair_delay)
def _careful_pair_delay(xi, yi, ui, wi, ti, ri, xj, yj, uj, wj, tj, rj, shift_x, shift_y, side=1.0):
    return lambda xi, yi, ui, wi, ti, ri, xj, yj, uj, wj, tj, rj, shift_x, shift_y, side=1.0: _careful(
        xi, yi, ui, wi, ti, ri, xj, yj, uj, wj, tj, rj, shift_x, shift_y, side
    )


@overload(point.exact_hand)
def _exact_hand(x, y, vx, vy, gx, gy, px, py):
    return lambda x, y, vx, vy, gx, gy, px, py: _hand(x, y, vx, vy, gx, gy, px, py)


@overload(real.is_float, jit_options={"forceinline": True, **_PART})
def _is_float(x):
    return lambda x: True


@overload(real.root_between, jit_options={"forceinline": True, **_PART})
def _root_between(like, coefficients, low, high):
    return lambda like, coefficients, low, high: high  # never called: floats are bisected


@overload(real.sqrt, jit_options={"forceinline": True, **_PART})
def _sqrt(x):  # without annotations: numba compares them with those of the lambda
    if isinstance(x, types.Float):
        return lambda x: math.sqrt(x)
    return None


def _register(module: ModuleType, **options: Any) -> None:
    for function in vars(module).values():
        own = getattr(function, "__module__", None) == module.__name__
        if own and callable(function) and not isinstance(function, type) and function not in LINKED:
            register_jitable(**options)(function)


for _module in (motion, contact, doubt, image, impulse, rough):
    _register(_module, forceinline=True, **_PART)
_shapes = [sys.modules[shape.__module__] for shape in SHAPES]
for _module in (
    careful_impulse,
    chance,
    corner,
    crossing,
    digits,
    expansion,
    parabola,
    point,
    rest,
    slide,
    *_shapes,
):
    _register(_module, **{**_PART, "_nrt": True})  # expansions are lists

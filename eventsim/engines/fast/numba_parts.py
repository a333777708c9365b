"""How parts of kernels are compiled: to code for the optimiser, which a kernel links and optimises once, with all its parts.

numba itself makes machine code of every function that a kernel calls, with copies of all that this calls in turn, and throws it
away: that took a third of the time of a first run.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from types import CodeType
from typing import Any

from numba.core import ir
from numba.core import typed_passes as typed
from numba.core import untyped_passes as untyped
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.compiler_machinery import FunctionPass, PassManager, register_pass
from numba.core.ir_utils import get_definition, guard
from numba.core.typed_passes import NoPythonBackend
from numba.core.types import NamedTuple, NoneType  # type: ignore[attr-defined]  # it collects them when it is imported


class _NoEngine:
    """What a part has to do with machine code: nothing."""

    def set_env(self, name: str, environment: object) -> None:
        """Forget an environment: parts raise no exceptions."""


class PartLibrary(JITCodeLibrary):
    """The code of one part, without what it calls and without machine code."""

    codegen = _NoEngine()  # for `set_env` alone; libraries themselves use `_codegen`

    def _optimize_functions(self, ll_module: Any) -> None:
        ll_module.data_layout = self._codegen._data_layout  # the kernel optimises

    def finalize(self) -> None:
        """Let nothing be added any more."""
        self._raise_if_finalized()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """0: there is no machine code."""
        self._ensure_finalized()
        return 0

    def names(self) -> list[str]:
        """The names of the functions in it."""
        return [function.name for function in self._final_module.functions if not function.is_declaration]

    def _get_module_for_linking(self) -> Any:
        self._ensure_finalized()
        return self._final_module


class KernelLibrary(JITCodeLibrary):
    """The code of a kernel with all its parts."""

    def finalize(self) -> None:
        """Link the parts, those of parts as well, and make machine code of all together."""
        self._linking_libraries = list(_all_linked(self, set()))
        super().finalize()

    def _optimize_final_module(self) -> None:
        parts = {name for linked in self._linking_libraries if isinstance(linked, PartLibrary) for name in linked.names()}
        for function in self._final_module.functions:
            if function.name in parts and not function.is_declaration:
                function.linkage = "internal"  # so each kernel has its own, and drops it where all calls are inlined
        managers = self._codegen._module_pass_manager()
        if isinstance(managers, tuple):
            managers[0].run(self._final_module, managers[1])  # once; numba does it twice, for the sake of reference counts
        else:  # an older numba
            super()._optimize_final_module()


class CallerLibrary(JITCodeLibrary):
    """The code of a function that calls parts, and is compiled as numba compiles everything else."""

    def finalize(self) -> None:
        """Link the parts, those of parts as well."""
        self._linking_libraries = list(_all_linked(self, set()))
        super().finalize()


class CallerCompiler(Compiler):
    """numba's compiler, for functions that call parts."""

    def define_pipelines(self) -> Any:
        """All passes of numba."""
        state = self.state
        if state.library is None:
            state.library = CallerLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
            state.library.enable_object_caching()
        return super().define_pipelines()


def _all_linked(library: Any, seen: set[int]) -> Iterator[Any]:
    for linked in library._linking_libraries:
        if id(linked) not in seen:
            seen.add(id(linked))
            yield linked
            if isinstance(linked, PartLibrary):
                yield from _all_linked(linked, seen)


class _Passes(PassManager):
    """Passes of the compiler one after the other, without an account of each."""

    def _runPass(self, index: int, pss: Any, internal_state: Any) -> None:  # noqa: N802, what numba calls it
        pss.analysis = self._analysis
        pss.run_pass(internal_state)


@register_pass(mutates_CFG=False, analysis_only=False)
class WithoutAbsent(FunctionPass):
    """Make constants of the fields of arguments that are None, so that branches that ask for them are not even typed.

    numba itself does so for arguments that are None themselves.
    """

    _name = "without_absent"

    def __init__(self) -> None:
        FunctionPass.__init__(self)

    def run_pass(self, state: Any) -> bool:
        """Whether there are such fields."""
        found = False
        for block in state.func_ir.blocks.values():
            for statement in block.body:
                if isinstance(statement, ir.Assign) and _is_absent(state, statement.value):
                    definitions = state.func_ir._definitions[statement.target.name]
                    nothing = ir.Const(None, statement.loc)
                    definitions[:] = [nothing if one is statement.value else one for one in definitions]
                    statement.value, found = nothing, True
        return found


def _is_absent(state: Any, value: Any) -> bool:
    """Whether an expression is a field of an argument, and None."""
    if not (isinstance(value, ir.Expr) and value.op == "getattr"):
        return False
    whole = guard(get_definition, state.func_ir, value.value)
    kind = state.args[whole.index] if isinstance(whole, ir.Arg) else None
    if not isinstance(kind, NamedTuple):
        return False
    return isinstance(kind.types[kind.fields.index(value.attr)], NoneType)


PLAIN = (
    untyped.TranslateByteCode,
    untyped.FixupArgs,
    untyped.IRProcessing,
    untyped.RewriteSemanticConstants,
    WithoutAbsent,
    untyped.DeadBranchPrune,
    untyped.GenericRewrites,
    untyped.ReconstructSSA,
    untyped.DeadBranchPrune,
    typed.NopythonTypeInference,
    typed.PreLowerStripPhis,
    typed.IRLegalization,
    typed.NativeLowering,
    NoPythonBackend,
)
"""What numba's compiler does, less what is for closures, loops over mixed tuples, whole arrays and threads."""


def _compiler(kind: Callable[[Any, str], Any]) -> type[Compiler]:
    """numba's compiler, with a library of this kind."""

    class Chosen(Compiler):
        def define_pipelines(self) -> Any:
            state = self.state
            if state.library is None:
                state.library = kind(state.targetctx.codegen(), state.func_id.func_qualname)
                state.library.enable_object_caching()
            if any(isinstance(constant, CodeType) for constant in state.func_id.code.co_consts):
                return super().define_pipelines()  # closures
            passes = _Passes("plain")
            for one in PLAIN:
                passes.add_pass(one, one.__name__)
            passes.finalize()
            return [passes]

    return Chosen


PartCompiler, KernelCompiler = _compiler(PartLibrary), _compiler(KernelLibrary)

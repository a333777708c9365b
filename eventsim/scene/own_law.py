"""A law of contacts of the user's own: one Python function, in a file that a scene names, or handed over as it is.

From a log or a checkpoint it is never run: there it travels by its name, its text and the hash of that.
"""

from __future__ import annotations

import hashlib
import inspect
import math
import textwrap
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any

from eventsim.errors import SceneError

KNOWN = ("restitution", "approach", "since", "mass")
"""What a law may ask for: its parameters have these names.

restitution: the usual one of these two disks, or of this wall.  approach: the speed along the normal.  since: the time since the
last contact of either; inf before the first.  mass: the reduced mass, at a wall that of the disk.
"""

FAILS = Exception, SystemExit
"""What a function or a file of the user's own may raise, and the scene with it is refused, or its run stopped, in a sentence."""

MEANT = f"it must be a function of some of {', '.join(KNOWN)}, and return the restitution"


@dataclass(frozen=True, slots=True)
class OwnLaw:
    """A law of the user's own.

    Attributes:
        name: what it is called, FILE:FUNCTION or MODULE:FUNCTION.
        source: its text, of the whole file where there is one.
        sha256: the hash of that text.
        asks: the names of its parameters.
        function: what is called; None where the law has only been read from a log.
        path: the file; None where the function was handed over.
    """

    name: str
    source: str = field(repr=False)
    sha256: str
    asks: tuple[str, ...] = field(compare=False, repr=False)
    function: Callable[..., float] | None = field(default=None, compare=False, repr=False)
    path: str | None = field(default=None, compare=False, repr=False)

    def __call__(self, restitution: Any, approach: Any, since: Any, mass: Any) -> Any:
        """The restitution of a contact, from what the law asks for.

        Raises:
            SceneError: where there is only its text.
        """
        if self.function is None:
            raise SceneError(str(self.refusal))
        given = {"restitution": restitution, "approach": approach, "since": since, "mass": mass}
        return self.function(*(given[name] for name in self.asks))

    @property
    def file(self) -> str:
        """The file that its lines are in."""
        return self.function.__code__.co_filename if isinstance(self.function, FunctionType) else ""

    @property
    def refusal(self) -> str | None:
        """Why it cannot be run, a sentence; None where it can."""
        if self.function is not None:
            return None
        return (
            f"the law {self.name} is not run from a file that only holds its text: give the function (a scene: "
            "dataclasses.replace(scene, law=function), a log: load_log(path, law=function)), or the scene that names its file "
            "(run SCENE --resume FILE)"
        )

    def run_by(self, function: Callable[..., float]) -> OwnLaw:
        """The same law, which a function runs.

        Raises:
            SceneError: for a function with another text.
        """
        own = own_law(function)
        assert own is not None
        texts = [own.source]
        with suppress(OSError):
            texts.append(Path(own.file).read_text(encoding="utf-8"))
        if self.source not in texts:
            raise SceneError(f"the law {self.name} has another text than {own.name}")
        return replace(self, asks=own.asks, function=own.function)

    def table(self) -> dict[str, str]:
        """What a log, or a scene file, holds of it."""
        own = {} if self.path is None else {"path": self.path}
        return {"name": self.name, "sha256": self.sha256, "source": self.source, **own}


def own_law_in(text: str, folder: Path) -> OwnLaw:
    """The law that a scene file names as "FILE:FUNCTION"; the file is looked for beside it, and run.

    Raises:
        SceneError: for a file that cannot be read or run, or a function that is no law.
    """
    place, _, called = text.rpartition(":")
    if not place or not called.isidentifier():
        raise SceneError(f'contact_law = "{text}": must be "file.py:function"')
    path = folder / place
    try:
        source = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise SceneError(f'contact_law = "{text}": {path} cannot be read ({reason})') from None
    return _run(text, source, path, called)


def own_law_from(table: Mapping[str, Any], runs: bool) -> OwnLaw:
    """The law that a table holds; runs: whether its file may be run, which must have the text of then.

    Raises:
        SceneError: for a table that is none, and for a file that has changed.
    """
    name, sha256, source, path = (table.get(key) for key in ("name", "sha256", "source", "path"))
    if not (isinstance(name, str) and isinstance(source, str) and isinstance(sha256, str)) or sha256 != _hash(source):
        raise SceneError("contact_law: a table of a law holds its name, its source and the sha256 of that")
    if runs and isinstance(path, str):
        law = own_law_in(f"{path}:{name.rpartition(':')[2]}", Path())
        if law.sha256 != sha256:
            raise SceneError(f"contact_law: {path} has changed since the scene was written")
        return OwnLaw(name, source, sha256, law.asks, law.function, law.path)
    return OwnLaw(name, source, sha256, (), None, path if isinstance(path, str) else None)


def own_law(function: Callable[..., float] | OwnLaw | None) -> OwnLaw | None:
    """The law that a function is; None where there is none.

    Raises:
        SceneError: for what is no law.
    """
    if function is None or isinstance(function, OwnLaw):
        return function
    if not isinstance(function, FunctionType):
        raise SceneError(f"law = {function!r}: {MEANT}")
    name = f"{function.__module__}:{function.__qualname__}"
    try:
        source = textwrap.dedent(inspect.getsource(function))
    except (OSError, TypeError):
        source = _words_of(function.__code__)
    outside = inspect.getclosurevars(function)
    values = {**outside.globals, **outside.nonlocals}
    source += "".join(f"# {key} = {value!r}\n" for key, value in sorted(values.items()) if isinstance(value, int | float))
    asks = _asks(function, f"law {name}")
    return OwnLaw(name, source, _hash(source), asks, function)


def _run(text: str, source: str, path: Path, called: str) -> OwnLaw:
    """Run a file, and take a function from it."""
    where = f'contact_law = "{text}"'
    names: dict[str, Any] = {"__name__": path.stem, "__file__": str(path)}
    try:
        exec(compile(source, str(path), "exec"), names)
    except SyntaxError as error:
        raise SceneError(f"{where}: line {error.lineno} is no Python: {error.msg}") from None
    except FAILS as error:
        raise SceneError(f"{where}: running the file fails: {told(error, str(path))}") from None
    function = names.get(called)
    if not isinstance(function, FunctionType):
        raise SceneError(f"{where}: {path} has no function {called}")
    return OwnLaw(text, source, _hash(source), _asks(function, where), function, str(path.resolve()))


def _asks(function: FunctionType, where: str) -> tuple[str, ...]:
    """The names of the parameters of a law; it is tried once."""
    parameters = inspect.signature(function).parameters.values()
    asks = tuple(one.name for one in parameters)
    plain = all(one.kind in (one.POSITIONAL_ONLY, one.POSITIONAL_OR_KEYWORD) for one in parameters)
    if not plain or not asks or not set(asks) <= set(KNOWN):
        raise SceneError(f"{where}: its parameters are {', '.join(asks) or 'none'}: {MEANT}")
    try:
        found: Any = OwnLaw("", "", "", asks, function=function)(1.0, 1.0, math.inf, 1.0)
    except ArithmeticError:  # at other speeds it may well have a value
        return asks
    except FAILS as error:
        raise SceneError(f"{where}: it fails at a trial: {told(error, function.__code__.co_filename)}") from None
    if isinstance(found, bool) or not isinstance(found, int | float):
        raise SceneError(f"{where}: it returns {found!r}: {MEANT}")
    return asks


def told(error: BaseException, path: str) -> str:
    """An error of a user's function in words, with the line where it is in the file `path`."""
    line, trace = None, error.__traceback__
    while trace is not None:
        if trace.tb_frame.f_code.co_filename == path:
            line = trace.tb_lineno
        trace = trace.tb_next
    where = "" if line is None else f" in line {line}"
    said = " ".join(str(error).split())
    return f"{type(error).__name__}{where}" + (f": {said}" if said else "")


def _words_of(code: CodeType) -> str:
    """What tells a function apart whose text is not at hand."""
    return f"{code.co_name} {code.co_varnames} {code.co_consts} {code.co_names} {code.co_code.hex()}"


def _hash(source: str) -> str:
    return hashlib.sha256(source.encode()).hexdigest()

"""Reading what others wrote: ordinary files only, no length believed that the file does not have, one kind of error.

Every byte of a file may be any.  Nothing in it is executed or opened, and whatever a library raises over it becomes an
EventsimError that names the file.
"""

from __future__ import annotations

import math
import os
import stat
import zipfile
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from itertools import islice
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from eventsim.errors import EventsimError

LONGEST_REASON = 200
"""Letters of what a library has to say."""

DENSEST = 1032
"""Bytes that one byte of a deflated text can stand for.  Source: zlib's technical details, "Maximum Compression Factor"."""

MOST_HELD = 1 << 32
"""Bytes of all that is read of a file at once: a packed one of a few MB may stand for many times the memory that there is."""

NUMBERS = "iufUSO"
"""Kinds of arrays that hold numbers, or texts and objects that may be some."""

NEAR = 0.7
"""How much alike the name of a file that is meant is: the share of letters in common, of both."""

WITHOUT_WAITING = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
"""Opening a pipe without it would wait for a writer."""

NO_TEXT = "is not a text file in UTF-8: save it anew with this encoding"
"""What is said of a file that should hold text."""

MOST_NAMES = 10_000
"""Of a folder, among which one that is meant is looked for."""


def no_text(data: bytes, error: UnicodeDecodeError) -> str:
    """Say that bytes hold no text, from which line on, and how that line looks in Latin-1, if it looks like text there."""
    number = data.count(b"\n", 0, error.start) + 1
    begin = data.rfind(b"\n", 0, error.start) + 1
    line = data[begin : error.start + LONGEST_REASON].split(b"\n")[0][:LONGEST_REASON].decode("latin-1").strip()
    shown = f"\n    line {number}: {line}" if line.isprintable() else ""
    return f"{NO_TEXT} (at line {number}){shown}"


def near_file(path: Path, known: Collection[str] = ()) -> str:
    """Return " (did you mean headon.toml?)" for a file that is not there, where one of a like name is beside it.

    known: what such files end in; a name without an end may mean one of them.
    """
    from difflib import get_close_matches  # only who errs pays for it

    try:
        with os.scandir(path.parent) as entries:
            names = [entry.name for entry in islice(entries, MOST_NAMES) if entry.is_file()]
    except (OSError, ValueError):
        return ""
    end = path.suffix.lower()
    alike = [name for name in names if Path(name).suffix.lower() == end] if end else []
    alike += [name for name in names if Path(name).suffix.lower() in known]
    by_name = {Path(name).stem if not end else name: name for name in alike}
    near = get_close_matches(path.name, by_name, n=1, cutoff=NEAR)
    return f" (did you mean {path.with_name(by_name[near[0]])}?)" if near else ""


@contextmanager
def reading(path: Path, error: type[EventsimError], what: str, most: int | None = None) -> Iterator[IO[bytes]]:
    """Open a file, and tell whatever is raised while it is read as one error that names it.

    Args:
        path: the file.
        error: the type of the error.
        what: what the file then is, such as "not a whole .npz event log".
        most: bytes that it may have; None: any number.
    """
    with told_as(path, error, what), open(path, "rb", opener=_opened) as file:
        found = os.fstat(file.fileno())
        if not stat.S_ISREG(found.st_mode):
            raise error(f"{path}: not a file" if stat.S_ISDIR(found.st_mode) else f"{path}: not an ordinary file")
        if most is not None and found.st_size > most:
            raise error(f"{path}: has {found.st_size} bytes; at most {most} are read")
        yield file


def lines_of(path: Path, error: type[EventsimError], what: str) -> list[str]:
    """Read the lines of a text file in UTF-8; error, what: as of `reading`."""
    with reading(path, error, what) as file:
        return file.read().decode("utf-8").splitlines()


def _opened(name: str, flags: int) -> int:
    return os.open(name, flags | WITHOUT_WAITING)


@contextmanager
def told_as(path: Path, error: type[EventsimError], what: str) -> Iterator[None]:
    """Tell whatever is raised over the bytes of a file as one error; see `reading`.  Errors that are ours already pass."""
    try:
        yield
    except EventsimError:
        raise
    except FileNotFoundError as problem:
        raise error(f"{path}: no such file{near_file(path)}") from problem
    except OSError as problem:
        raise error(f"{path}: cannot be read ({problem.strerror or problem})") from problem
    except MemoryError as problem:
        raise error(f"{path}: there is not enough memory to read it") from problem
    except Exception as problem:  # zipfile alone has ten kinds, and numpy's readers let those of Python's parser through
        raise error(f"{path}: {what} ({reason_of(problem)})") from problem


def reason_of(problem: Exception) -> str:
    """What a library has to say about a file, on one line; a bare key says nothing to a reader."""
    said = "" if isinstance(problem, LookupError) else " ".join(str(problem).split())
    return said[:LONGEST_REASON] or type(problem).__name__


def as_floats(values: Any) -> NDArray[np.float64]:
    """Numbers, or texts of numbers, as floats; ValueError for complex numbers, dates, truths, of which NumPy would make some."""
    dtype = getattr(values, "dtype", None)
    if dtype is not None and dtype.kind not in NUMBERS:
        raise ValueError(f"values of the type {dtype} are no numbers")
    return np.asarray(values, dtype=np.float64)


class Npz:
    """The arrays of an .npz file.  Nothing is unpickled, and no array is longer than its entry in the file."""

    def __init__(self, file: IO[bytes]) -> None:
        """Look at what there is; zipfile's errors are the caller's to tell."""
        self._archive = zipfile.ZipFile(file)
        self._held = 0
        for entry in self._archive.infolist():  # a damaged directory must not look like one of fewer arrays
            if entry.comment:
                raise ValueError("its directory is damaged")
            self._archive.open(entry).close()  # the name stands there a second time, and is compared

    @property
    def names(self) -> list[str]:
        """The names of the arrays."""
        return [name.removesuffix(".npy") for name in self._archive.namelist()]

    @property
    def packed(self) -> bool:
        """Whether an array is packed, so that it is longer than the file."""
        return any(entry.compress_type != zipfile.ZIP_STORED for entry in self._archive.infolist())

    def open(self, name: str) -> ArrayReader:
        """Open an array; any number of them may be read side by side.  Raises KeyError or ValueError."""
        return ArrayReader(self._archive, f"{name}.npy")

    def read(self, name: str) -> NDArray[Any]:
        """Return a whole array; raises KeyError or ValueError, also where with those before it is more than is held at once."""
        reader = self.open(name)
        self._held += reader.size
        if self._held > MOST_HELD:
            raise ValueError(f"its arrays have more than {MOST_HELD} bytes")
        flat = reader.read(reader.count)
        return flat.reshape(reader.shape[::-1]).T if reader.along_columns else flat.reshape(reader.shape)


class ArrayReader:
    """An array of an archive, read from its beginning to its end.

    Attributes:
        shape: of the array.
        count: of its numbers, or texts.
        size: their bytes.
        along_columns: whether the first index runs fastest.
    """

    def __init__(self, archive: zipfile.ZipFile, name: str) -> None:
        entry = archive.getinfo(name)
        if entry.file_size > DENSEST * entry.compress_size or entry.compress_type not in PACKED:
            raise ValueError(f"{name} is packed as no array is")
        self._file = archive.open(entry)
        version = np.lib.format.read_magic(self._file)
        read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        self.shape, self.along_columns, self._dtype = read(self._file)
        self.count = math.prod(self.shape)
        self.size = self.count * self._dtype.itemsize
        if self._dtype.hasobject:
            raise ValueError(f"{name} holds pickled objects, which are not read")
        if self._dtype.itemsize == 0 or self._file.tell() + self.size != entry.file_size:
            raise ValueError(f"{name} is not as long as it says")

    def read(self, count: int) -> NDArray[Any]:
        """Return the next `count` numbers or texts (count,); raises ValueError where they are not there."""
        data = self._file.read(count * self._dtype.itemsize)
        if len(data) != count * self._dtype.itemsize:
            raise ValueError("the file was cut off")
        return np.frombuffer(data, self._dtype)


PACKED = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
"""How entries may be packed; other ways can make gigabytes of some bytes."""

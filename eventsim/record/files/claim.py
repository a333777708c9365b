"""A run claims the file that it writes: another one that is to write the same is refused, not mixed in."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path

from eventsim.errors import EventsimError, LogError

if sys.platform == "win32":

    def _lock(descriptor: int) -> bool:
        return True  # an open file cannot be replaced there: the second run fails by itself
else:
    import fcntl

    def _lock(descriptor: int) -> bool:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return False
        except OSError:  # file systems that know no locks
            return True
        return True


class Claim:
    """A file that one run writes; the claim ends with `release`, with whoever holds it, or with the process."""

    def __init__(self, path: Path, error: type[EventsimError] = LogError, what: str = "this log") -> None:
        """Look whether nobody writes this file.

        Args:
            path: the file that is locked, whether it is there yet or not.
            error: the type of the error that refuses a second run.
            what: what the file is, or is for.

        Raises:
            EventsimError: where another run writes it.
        """
        self._path, self._error, self._what = path, error, what
        self._descriptor: int | None = None
        if path.exists():
            self.take()
            self.release()

    def __del__(self) -> None:
        self.release()

    def take(self, make: bool = False) -> None:
        """Claim the file, which is there now, or is made; raises an error where another run was faster."""
        if sys.platform == "win32":
            return
        while self._descriptor is None:
            try:
                self._descriptor = os.open(self._path, os.O_RDWR | os.O_CREAT if make else os.O_RDONLY, 0o666)
            except OSError:  # whoever writes it will say what is wrong with it
                return
            if not _lock(self._descriptor):
                self.release()
                raise self._error(f"{self._path}: another run is writing {self._what}; wait for its end or name another file")
            if make and not self._is_there():  # whoever had it before has just removed it
                self.release()

    def _is_there(self) -> bool:
        """Whether the file that is locked still has its name."""
        assert self._descriptor is not None
        try:
            return os.path.samestat(os.fstat(self._descriptor), os.stat(self._path))
        except OSError:
            return False

    def release(self) -> None:
        """Give the file back."""
        if self._descriptor is not None:
            os.close(self._descriptor)
            self._descriptor = None

    def remove(self) -> None:
        """Give back a file that was made for the claim alone."""
        if self._descriptor is not None:
            with suppress(OSError):
                self._path.unlink()
            self.release()

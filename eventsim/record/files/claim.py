"""A run claims the part that it writes: another one that is to write the same log is refused, not mixed in."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from eventsim.errors import LogError

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
    """A part that one run writes; the claim ends with `release`, with the sink that holds it, or with the process."""

    def __init__(self, part: Path) -> None:
        """Look whether nobody writes this part; raises LogError where a run does."""
        self._part = part
        self._descriptor: int | None = None
        if part.exists():
            self.take()
            self.release()

    def __del__(self) -> None:
        self.release()

    def take(self) -> None:
        """Claim the part, which is there now; raises LogError where another run was faster."""
        if sys.platform == "win32":
            return
        try:
            self._descriptor = os.open(self._part, os.O_RDONLY)
        except OSError:  # whoever writes it will say what is wrong with it
            return
        if not _lock(self._descriptor):
            self.release()
            raise LogError(f"{self._part}: another run is writing this log; wait for its end or name another file")

    def release(self) -> None:
        """Give the part back."""
        if self._descriptor is not None:
            os.close(self._descriptor)
            self._descriptor = None

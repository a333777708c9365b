"""The event log: what happened, as columns, together with where it comes from."""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import replace
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Self, overload

from eventsim.errors import LogError
from eventsim.record.digest import digest_of
from eventsim.record.events import Column, Rows, State
from eventsim.record.files import open_log, open_sink, read_log
from eventsim.record.provenance import Provenance
from eventsim.replay.any_log import AnyLog as AnyLog
from eventsim.replay.excerpt import Event, Excerpt
from eventsim.scene import Scene

if TYPE_CHECKING:
    import pandas as pd

    from eventsim.replay.replay import Replay

SAVE_BLOCK = 1 << 16


class EventLog(Excerpt):
    """An immutable log in memory: its provenance and one row per impulse; `run.EventLog` tells of its columns.

    path: the file that it was read from, None where it comes from a run.
    """

    def __init__(self, provenance: Provenance, rows: Rows) -> None:
        super().__init__(provenance, rows)
        self.path: Path | None = None

    def __repr__(self) -> str:
        ending = self.provenance.ending
        ended = "still open" if ending is None else f"stopped: {ending.reason}"
        form = "compact, " if self.compact else ""
        return f"EventLog({len(self)} rows, {form}{ended}, engine {self.provenance.engine})"

    @property
    def scene(self) -> Scene:
        """The realised scene that the log tells about."""
        return self.provenance.scene

    @property
    def compact(self) -> bool:
        """Whether the computable columns are missing."""
        return self.provenance.compact

    @cached_property
    def _full(self) -> Self:
        return self.expand()

    @overload
    def __getitem__(self, place: int) -> Event: ...
    @overload
    def __getitem__(self, place: slice | list[int] | list[bool] | Column) -> Excerpt: ...

    def __getitem__(self, place: int | slice | list[int] | list[bool] | Column) -> Event | Excerpt:
        """One event, its places on the scene's axes, or some rows, whose columns count places from `corner` as those here do.

        A compact log is made full for it.
        """
        return super(EventLog, self._full).__getitem__(place)

    def to_pandas(self) -> pd.DataFrame:
        """A pandas DataFrame with the columns of the full log: kinds and walls as names, places on the scene's axes.

        Raises EventsimError without pandas.
        """
        return super(EventLog, self._full).to_pandas()

    @cached_property
    def _replay(self) -> Replay:
        from eventsim.replay.replay import Replay  # only who asks for states pays for it

        return Replay(self)

    def state_at(self, time: float) -> State:
        """The state at any time of the run, by replay; at the time of an event, the state after it.

        Raises LogError for a time that the log does not cover.
        """
        return self._replay.state_at(time)

    def blocks(self) -> Generator[Rows]:
        """Yield the full rows block by block."""
        rows = self._full.rows
        yield from (rows[first : first + SAVE_BLOCK] for first in range(0, len(rows), SAVE_BLOCK))

    def expand(self, until: float | None = None) -> Self:
        """Return the full log: an engine runs the scene of a compact one again, and each row is compared.

        until: a time on the scene's clock; a compact log is made full up to there, and ends there.
        Raises LogError where a row is not what the engine finds.
        """
        if not self.compact:
            return self
        from eventsim.replay.expand import expand_rows, expand_until  # only who has a compact log pays for it

        if until is None:
            full = type(self)(replace(self.provenance, compact=False), expand_rows(self.provenance, self.rows))
        else:
            full = type(self)(*expand_until(self.provenance, self.rows, until))
        full.path = self.path
        return full

    def digest(self) -> str:
        """Return the SHA-256 of the log (see `eventsim.record.digest`); a compact log is expanded first."""
        return digest_of(self.expand().rows)

    def save(self, path: str | PathLike[str], compact: bool = False) -> None:
        """Write the log to `path`, in the format of its suffix: .csv, .jsonl, .npz or .parquet.

        compact: leave out what an engine computes again. Raises LogError where no engine would, or the file cannot be written.
        """
        if compact:
            from eventsim.replay.expand import demand_expandable  # only who wants a compact log pays for it

            demand_expandable(self.provenance)
        log = self if compact else self.expand()
        ending = log.provenance.ending
        if ending is not None and ending.digest is None and not log.compact:
            ending = replace(ending, digest=log.digest())
        sink = open_sink(path, log.provenance, compact=compact)
        try:
            for first in range(0, len(log), SAVE_BLOCK):
                sink.write(log.rows[first : first + SAVE_BLOCK])
        except BaseException:
            sink.abandon()
            raise
        sink.close(ending)

    @classmethod
    def loaded(cls, path: str | PathLike[str], law: Callable[..., float] | None = None) -> Self:
        """The log of a file; path, law: as of `run.load_log`."""
        file = Path(path)
        provenance, rows = read_log(file)
        if law is not None:
            scene = provenance.scene
            if scene.law is None:
                raise LogError(f"{file}: its run had no law of contacts of the user's own")
            provenance = replace(provenance, scene=replace(scene, law=scene.law.run_by(law)))
        log = cls(provenance, rows)
        log.path = file
        return log


def stream_log(path: str | PathLike[str], verify: bool = True) -> tuple[Provenance, Generator[Rows]]:
    """Open a log file of any format: its provenance, and its full rows block by block, in bounded memory.

    A compact log is made full in passing.  Warns (LogWarning) after the last block where rows were changed since the run wrote
    them; verify: False where that has been looked at.

    Raises:
        LogError: where it is no log; also while its blocks are read.
    """
    file = Path(path)
    provenance, blocks = open_log(file, verify)
    if provenance.compact:
        from eventsim.replay.expand import expand_blocks  # only who has a compact log pays for it

        return replace(provenance, compact=False), expand_blocks(provenance, blocks)
    return provenance, blocks

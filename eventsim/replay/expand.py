"""From a compact log to the full one: an engine runs the scene again, and each of its rows is compared with the log."""

from __future__ import annotations

import math
from collections.abc import Generator, Iterable
from dataclasses import replace
from fractions import Fraction
from itertools import chain

import numpy as np

from eventsim.engines import TABLE, engine_named
from eventsim.engines.auto import first_engine
from eventsim.engines.base import Session, Stop
from eventsim.errors import LogError
from eventsim.record.events import COMPACT_COLUMNS, Kind, Rows, blank_rows, joined, row_of
from eventsim.record.provenance import BITS, Ending, Provenance, has_spin
from eventsim.record.times import clock_times
from eventsim.replay.clock_windows import MOST_WINDOWS, stage_of_log
from eventsim.runner.recording import Writer

FIRST_BUDGET, LARGEST_BUDGET = 64, 1 << 16
"""Steps of the engine's first stint, and of any: after each its rows are compared, and Ctrl-C is heard."""

PIECE = 1 << 10
"""Rows that are compared at a time: these, and those of the log, stay in a core's own cache."""


def expand_rows(provenance: Provenance, compact: Rows) -> Rows:
    """Return the full rows of a compact log.  It takes about as long as the run did.

    Raises LogError where a row is not what an engine finds next in the scene.
    """
    return Expansion(provenance, len(compact)).follow(compact)


def expand_blocks(provenance: Provenance, blocks: Iterable[Rows]) -> Generator[Rows]:
    """Yield the full rows of a compact log, block by block; LogError as `expand_rows`."""
    coming = iter(blocks)
    first = next(coming, blank_rows(0, has_spin(provenance.scene)))
    expansion = Expansion(provenance, max(provenance.rows or 0, len(first)))
    for block in chain([first], coming):
        yield expansion.follow(block)


def expand_until(provenance: Provenance, compact: Rows, until: float) -> tuple[Provenance, Rows]:
    """Return a compact log as a full one that ends at a time on the scene's clock, or where it ends itself if that is earlier."""
    if not math.isfinite(until):
        return replace(provenance, compact=False), expand_rows(provenance, compact)
    times = clock_times(compact["epoch"], compact["remainder"], provenance.epoch_length, provenance.scene.start_time)
    early = np.flatnonzero(times <= until)
    count = int(early[-1]) + 1 if len(early) else 0
    expansion = Expansion(provenance, count)
    rows = expansion.follow(compact[:count])
    if count == len(compact):
        return replace(provenance, compact=False), rows
    kicks = tuple(kick for kick in provenance.kicks if kick[0] < count)
    ending = Ending(*expansion.pass_to(Fraction(until)), "until")
    return replace(provenance, compact=False, kicks=kicks, ending=ending, rows=count), rows


def demand_expandable(provenance: Provenance) -> None:
    """Raise LogError for a log of an engine whose rows do not follow from the scene."""
    engine = TABLE.get(provenance.engine)
    if engine is not None and not engine.replays:
        raise LogError(
            "a compact log leaves out what the reference and the fast engine compute: "
            f"the log of the engine {engine.name} has to be a full one"
        )


class Expansion:
    """An engine on its way through a compact log."""

    def __init__(self, provenance: Provenance, count: int) -> None:
        """count: how many rows are expected, by which the engine is chosen; all engines give the same ones.

        Raises LogError where the log is that of an engine whose rows do not follow from the scene.
        """
        demand_expandable(provenance)
        self._provenance = provenance
        self._stage = stage_of_log(provenance)
        if provenance.wall_names != self._stage.wall_names:
            raise LogError(
                f"the log does not fit its scene: it names the walls {', '.join(provenance.wall_names)}, "
                f"and the scene has {', '.join(self._stage.wall_names)}"
            )
        chosen = engine_named(first_engine(self._stage, Stop(events=count)))
        self._session: Session = chosen.open(self._stage)
        self._set = {event: (vx, vy) for event, vx, vy in provenance.kicks}
        self._spin = has_spin(provenance.scene)
        self._ahead = blank_rows(0, self._spin)  # rows of a generation that the log has cut, or has not come to
        self._followed, self._epoch, self._budget = 0, 0, FIRST_BUDGET
        self._compact, self._full, self._done = self._ahead, self._ahead, 0

    def follow(self, compact: Rows) -> Rows:
        """Return the next rows of the log as full ones; LogError where the engine finds others."""
        self._demand_reachable(compact)
        self._compact, self._full, self._done = compact, np.empty(len(compact), row_of(self._spin)), 0
        writer = Writer([self._take])
        ahead, self._ahead = self._ahead, blank_rows(0, self._spin)
        try:
            writer.write(ahead)
            for end in [*np.flatnonzero(compact["kind"] == Kind.KICK).tolist(), len(compact)]:
                self._run_to(end, writer)
                if end < len(compact):
                    self._kick(compact[end])
            writer.write(self._session.take_rows())
            writer.finish()
        except BaseException:
            writer.abandon()
            raise
        self._followed += len(compact)
        return self._full

    def pass_to(self, until: Fraction) -> tuple[int, float]:
        """Let time pass to the scene's clock `until`, behind the rows so far: (epoch, remainder)."""
        while self._session.advance(Stop(until), self._budget) is None:
            pass
        return self._session.clock

    def _run_to(self, end: int, writer: Writer) -> None:
        """Run until row `end` of those that are followed is the next one, be it a kick at a later time."""
        counters, target = self._session.counters, self._followed + end
        behind = self._compact[max(counters.events - self._followed, 0) : end + 1]
        until = self._latest(behind) if len(behind) else None
        while counters.events < target:
            stopped = self._session.advance(Stop(until, target), self._budget)
            self._budget = min(2 * self._budget, LARGEST_BUDGET)
            writer.write(self._session.take_rows())
            if stopped is not None and counters.events < target:
                writer.finish()
                raise self._unfit(self._compact[self._done], f"and the engine finds none until then (it stops: {stopped})")

    def _take(self, found: Rows) -> None:
        """Compare the engine's next rows with those of the log; with many this is done beside the engine."""
        left = len(self._compact) - self._done
        if len(found) > left:
            self._ahead = joined([self._ahead, found[left:]])
        for first in range(0, min(len(found), left), PIECE):
            here = found[first : min(first + PIECE, left)]
            rows, same = self._compact[self._done : self._done + len(here)], len(here)
            for name in COMPACT_COLUMNS:
                others = rows[name] != here[name]
                if others.any():
                    same = min(same, int(np.argmax(others)))
            if same < len(here):
                raise self._unfit(rows[same], f"where the engine finds {self._words(here[same])}")
            # As bytes: NumPy copies rows column by column, which takes four times as long.
            self._full[self._done : self._done + len(here)].view(np.uint8)[:] = here.view(np.uint8)
            self._done += len(here)

    def _kick(self, row: np.void) -> None:
        """Set the velocity of a disk at the exact time of a row."""
        event, due = int(row["event"]), self._exact(int(row["epoch"]), float(row["remainder"]))
        if event not in self._set:
            raise self._unfit(row, "and its velocity is not in the metadata (the log was not closed)")
        if self._exact(*self._session.clock) < due:
            self.pass_to(due)
        self._session.kick(int(row["a"]), *self._set[event])

    def _exact(self, epoch: int, remainder: float) -> Fraction:
        """Return a time on the scene's clock."""
        return Fraction(self._stage.start_time) + epoch * Fraction(self._stage.epoch_length) + Fraction(remainder)

    def _latest(self, rows: Rows) -> Fraction:
        """Return the time of the last of some rows; those of one instant may step back."""
        epoch = int(rows["epoch"][-1])
        return self._exact(epoch, float(rows["remainder"][rows["epoch"] == epoch].max()))

    def _demand_reachable(self, compact: Rows) -> None:
        """Raise LogError for rows behind so many wraps that an engine would not come there."""
        if not self._stage.periodic or not len(compact):
            return
        epochs = np.diff(compact["epoch"], prepend=self._epoch)
        self._epoch = int(compact["epoch"][-1])
        if int(epochs.max()) > MOST_WINDOWS << self._stage.clock.idle_cap:
            row = compact[int(np.argmax(epochs))]
            raise self._unfit(row, f"more than {MOST_WINDOWS} turns of the clock after the row before")

    def _unfit(self, row: np.void, why: str) -> LogError:
        made_by = self._provenance
        advice = "the rows or the scene were changed after they were written"
        if made_by.bits != BITS:
            advice = (
                f"it was made by version {made_by.version} under other rules (bits {made_by.bits}, here {BITS}), "
                "or changed since: read it with that version"
            )
        return LogError(
            f"the log does not fit its scene at event {row['event']}: it has {self._words(row)}, {why}; {advice}, "
            "or run the scene again"
        )

    def _words(self, row: np.void) -> str:
        """Return what a row says, in words."""
        disks = f"disk {row['a']}" if row["b"] < 0 else f"disks {row['a']} and {row['b']}"
        wall = f", wall {self._stage.wall_names[row['wall']]}" if row["wall"] >= 0 else ""
        joint = "" if row["joint"] < 0 else f", joint with event {row['joint']}"
        at = f"epoch {row['epoch']}, remainder {float(row['remainder'])!r}"
        return f"{Kind(row['kind']).label} of {disks}{wall}{joint} at {at}"

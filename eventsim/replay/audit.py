"""An audit of a log file: all that it says of itself is checked, every row, every digest."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

from eventsim.errors import LogError, LogWarning
from eventsim.record.digest import Digester
from eventsim.record.provenance import BITS, has_spin
from eventsim.replay.filed import open_filed
from eventsim.replay.passage import Passage


@dataclass(frozen=True, slots=True)
class Audit:
    """What an audit found.

    Attributes:
        rows: their number.
        compact: whether an engine had to make them full.
        engine, version, bits: what wrote them, by which version of the rules.
        begin, end: the times on the scene's clock.
        stopped: why the run ended; None where it goes on, or was killed.
        digest: of the full rows.
        notes: what the log does not vouch for, in sentences.
    """

    rows: int
    compact: bool
    engine: str
    version: str
    bits: int
    begin: float
    end: float
    stopped: str | None
    digest: str
    notes: tuple[str, ...]


def audit(path: str | PathLike[str]) -> Audit:
    """Check a log file: its scene and frame, its rows as they are stored, its full rows, and that they fit a clock.

    A compact log is run again.  Raises LogError with a sentence where something is not as its run wrote it.
    """
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always", LogWarning)
        log = open_filed(path)
        provenance, digester = log.provenance, Digester(has_spin(log.scene))
        for rows in log.blocks():
            digester.update(rows)
    changed = [str(one.message) for one in said if "not what its run wrote" in str(one.message)]
    if changed:
        raise LogError(changed[0])
    ending, digest = provenance.ending, digester.hexdigest()
    if ending is not None and ending.digest not in (None, digest):
        raise LogError(f"{Path(path)}: its full rows have the digest {digest}, and those of its run had {ending.digest}")
    begin, end = Passage(log).span
    notes = list(dict.fromkeys(str(one.message) for one in said))
    if provenance.bits != BITS:
        notes.append(f"{Path(path)}: was made under other rules: bits {provenance.bits}, here {BITS}")
    return Audit(
        rows=len(log),
        compact=provenance.compact,
        engine=provenance.engine,
        version=provenance.version,
        bits=provenance.bits,
        begin=begin,
        end=end,
        stopped=None if ending is None else ending.reason,
        digest=digest,
        notes=tuple(notes),
    )

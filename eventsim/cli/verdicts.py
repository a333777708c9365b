"""The atlas in words: a list of the catalogue, a table of verdicts, JSON."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Any

from eventsim.validate.stress.catalogue import CASES
from eventsim.validate.stress.verdict import Word

if TYPE_CHECKING:
    from eventsim.validate.stress.case import Case
    from eventsim.validate.stress.soak import Finding
    from eventsim.validate.stress.verdict import Verdict

WIDTH = 110


def as_listing(cases: Sequence[Case]) -> str:
    """Each case: its name, what happens, why methods fail, what is true."""
    parts = []
    for case in cases:
        lines = [f"{case.name}: {case.title}", f"fails: {case.why}", f"true: {case.oracle}"]
        lines.append(f"allowed: {case.tolerance:.2g}. {case.because}")
        told = [fill(line, WIDTH, initial_indent="    ", subsequent_indent="      ") for line in lines[1:]]
        parts.append("\n".join([lines[0], *told]))
    return "\n\n".join(parts)


def as_text(verdicts: Sequence[Verdict]) -> str:
    """A table, scenes down and engines across; then a line for each fault."""
    engines = list(dict.fromkeys(v.engine for v in verdicts))
    cells = {(v.case, v.engine): _cell(v) for v in verdicts}
    cases = list(dict.fromkeys(v.case for v in verdicts))
    first = max(len(name) for name in ("scene", *cases)) + 2
    widths = [max(len(engine), *(len(cells[case, engine]) for case in cases)) + 2 for engine in engines]
    lines = ["scene".ljust(first) + "".join(e.ljust(w) for e, w in zip(engines, widths, strict=True))]
    for case in cases:
        lines.append(case.ljust(first) + "".join(cells[case, e].ljust(w) for e, w in zip(engines, widths, strict=True)))
    faults = [v for v in verdicts if v.fault]
    lines += ["", *(f"fault: {v.engine} on {v.case}: {v.sentence}" for v in faults)]
    if not faults:
        lines.append("no fault: the event-driven engines are right everywhere, or refuse with a documented reason")
    return "\n".join(line.rstrip() for line in lines)


def _cell(verdict: Verdict) -> str:
    sized = verdict.word is Word.INACCURATE or (verdict.word is Word.WRONG and math.isfinite(verdict.error))
    return f"{verdict.word} {verdict.error:.1g}" if sized else str(verdict.word)


def as_data(verdicts: Sequence[Verdict], figure: Path | None, table: Path | None) -> dict[str, Any]:
    """The keys of --json."""
    return {
        "scenes": list(dict.fromkeys(v.case for v in verdicts)),
        "engines": list(dict.fromkeys(v.engine for v in verdicts)),
        "verdicts": [
            {
                "scene": v.case,
                "engine": v.engine,
                "verdict": str(v.word),
                "fault": v.fault,
                "error": v.error if math.isfinite(v.error) else None,
                "tolerance": CASES[v.case].tolerance,
                "seconds": v.seconds,
                "sentence": v.sentence,
            }
            for v in verdicts
        ],
        "faults": sum(v.fault for v in verdicts),
        "out": None if figure is None else str(figure),
        "csv": None if table is None else str(table),
    }


def soak_text(seeds: range, engines: Sequence[str], findings: Sequence[Finding]) -> str:
    """What a soak found."""
    lines = [f"seed {found.seed}, {found.engine}: {found.sentence}" for found in findings]
    outcome = (
        "no hang, no NaN, no clock that steps back, no two logs that differ"
        if not findings
        else f"{len(findings)} faults"
    )
    return "\n".join([*lines, f"{len(seeds):,} random scenes, {' against '.join(engines)}: {outcome}"])


def soak_data(seeds: range, engines: Sequence[str], findings: Sequence[Finding]) -> dict[str, Any]:
    """The keys of --soak --json."""
    told = [{"seed": f.seed, "engine": f.engine, "sentence": f.sentence} for f in findings]
    return {
        "soak": len(seeds),
        "seed": seeds.start,
        "engines": list(engines),
        "findings": told,
        "faults": len(findings),
    }

"""A judgement as plain values, for JSON and CSV."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import Any

import numpy as np

from eventsim.validation.judge.judgement import Judgement
from eventsim.validation.judge.words import COUNTS, judged_in_words
from eventsim.validation.versions import versions


def judgement_data(judgement: Judgement) -> dict[str, Any]:
    """All that is known, as plain values; what never happens is None."""
    charge, late = judgement.charge, judgement.charge.errors[:, 1]
    fault = judgement.first_fault
    depth, a, b, time = judgement.deepest
    return {
        "scene": judgement.name,
        "source": judgement.source,
        "told": judgement.told,
        "first_fault": None if fault is None else asdict(fault),
        "compared": judgement.compared,
        "parting": None if charge.parting is None else dict(zip(("time", "sentence"), charge.parting, strict=True)),
        "contacts": {name: getattr(charge, name) for name in COUNTS},
        "tolerance": judgement.tolerance,
        "late": {
            "mean": float(late.mean()) if len(late) else None,
            "rms": float(np.sqrt(np.mean(late**2))) if len(late) else None,
            "worst": float(late[np.argmax(np.abs(late))]) if len(late) else None,
        },
        "positions": {"time": judgement.looks.tolist(), "error": judgement.errors.tolist()},
        "lost": _finite(judgement.lost),
        "believed": _finite(judgement.believed),
        "energy": None if judgement.energy is None else float(judgement.energy[np.isfinite(judgement.energy)][-1]),
        "momentum": judgement.momentum,
        "deepest_overlap": {"depth": depth, "disks": [a, b], "time": time} if depth > 0.0 else None,
        "elapsed_per_time": judgement.elapsed,
        "faults": [asdict(fault) for fault in judgement.faults],
        "remarks": judgement.remarks,
        "verdict": judged_in_words(judgement),
        "versions": versions(),
    }


def judgement_rows(judgement: Judgement) -> list[dict[str, Any]]:
    """A row for each contact that was found, for each fault, and for each time at which positions were compared."""
    rows: list[dict[str, Any]] = [
        {"what": "found", "time": time, "late": late} for time, late in judgement.charge.errors.tolist()
    ]
    rows += [{"what": fault.kind, "time": fault.time, "sentence": fault.sentence} for fault in judgement.faults]
    rows += [
        {"what": "position", "time": time, "error": error}
        for time, error in zip(judgement.looks.tolist(), judgement.errors.tolist(), strict=True)
    ]
    return rows


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None

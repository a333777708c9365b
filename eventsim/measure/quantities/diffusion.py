"""Diffusion: the slope of the mean squared displacement, and the lags that it was read between."""

from __future__ import annotations

import math
from collections.abc import Iterator

from eventsim.measure.correlation import FROM_LAG, TO_LAG, diffusion
from eventsim.measure.ensemble import Ensemble
from eventsim.measure.entries import dash
from eventsim.measure.measures import Measure
from eventsim.measure.records import Records

BOUNDED = 0.1
"""Between walls displacements end somewhere: the slope is read below this share of the width, root mean square."""

UNIT = "length^2 / time"


def measures(records: Records) -> Iterator[Measure]:
    """Yield D = d <r^2> / d (4 t), displacements taken about the common motion."""
    ensemble = records.ensemble
    free_time = records.found.get("mean_free_time")
    why = records.no_temperature if ensemble.n else None
    if why is None and ensemble.billiard and ensemble.n:
        return
    if why is None and ensemble.scene.gravity is not None:
        why = "under gravity disks stay about their height"
    if why is None and ensemble.turns:
        why = "the gas turns as a whole"
    if why is None and free_time is None:
        why = "no contact was seen"
    if why is not None:
        yield dash("diffusion", UNIT, why)
        return
    assert free_time is not None
    if not ensemble.torus and ensemble.scene.domain.size is None and not ensemble.n:
        yield dash("diffusion", UNIT, "walls enclose it")
        return
    widest = BOUNDED * ensemble.width
    slope = diffusion(records.correlations, free_time, widest)
    if slope is None or not slope.value > 0.0:
        yield dash(
            "diffusion",
            UNIT,
            f"no two lags between {FROM_LAG:g} and {TO_LAG:g} mean free times"
            + ("" if math.isinf(widest) else ", before walls are felt,")
            + " are known",
        )
        return
    note = f"slope between lags {slope.first:.3g} and {slope.last:.3g}{_beyond(ensemble)}"
    records.found["diffusion"] = slope.value
    yield Measure(slope.value, slope.error if slope.error > 0.0 else math.nan, unit=UNIT, doubt=note, name="diffusion")


def _beyond(ensemble: Ensemble) -> str:
    """What is known of D at longer lags."""
    if not ensemble.torus:
        return "; walls bound it at longer lags"
    if ensemble.kept_momenta:
        return "; in two dimensions it grows with the lag and with N"
    if not ensemble.n:
        return "; it grows with the lag where straight lanes lead between the posts"
    return ""

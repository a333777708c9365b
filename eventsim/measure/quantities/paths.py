"""Free paths: time and way between contacts, of a gas and of those who fly alone among what stands still."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from eventsim.measure import sums, theory
from eventsim.measure.entries import Expected, average, dash
from eventsim.measure.expected import CLOSED
from eventsim.measure.measures import Measure
from eventsim.measure.quantities.rates import expected_rate
from eventsim.measure.quantities.speeds import as_fixed, with_drift
from eventsim.measure.records import Records
from eventsim.record.events import Floats

ENOUGH = 16
"""Tracers from which on their own scatter is a bar as well."""

GAINS = "an average over this run: tracers gain speed without end from disks that push them"

TABLE = "pi A / P of the table"

PASSED_OVER = "between disks; walls passed over"


def measures(records: Records) -> Iterator[Measure]:
    """Yield the means of a gas, and of tracers; names of tracers begin with tracer_ where there is a gas too."""
    ensemble = records.ensemble
    if ensemble.n and not ensemble.billiard:
        yield from _gas(records)
    if ensemble.billiard:
        yield from _billiard(records, ensemble.tracers if not ensemble.n else 0, "")
    elif ensemble.tracers is not None:
        pushed = any(records.met(ensemble.tracers, kind).any() for kind in records.everyone)
        for entry in _billiard(records, ensemble.tracers, "tracer_"):
            yield _without_bar(entry) if pushed else entry


def _without_bar(entry: Measure) -> Measure:
    """Return the entry as an average over this run: a tracer keeps no balance with the disks that push it."""
    if math.isnan(entry.error) and entry.doubt is not None:
        return entry
    return replace(entry, error=math.nan, doubt=GAINS)


def _gas(records: Records) -> Iterator[Measure]:
    """Between contacts with other disks, reflections at walls passed over."""
    ensemble, met = records.ensemble, records.pair_contacts
    if not met.any():
        if ensemble.n > 1:
            yield dash("mean_free_path", "length", "no contact of disks was seen")
        return
    walls = PASSED_OVER if records.wall_contacts.any() else None
    rate = expected_rate(records)
    expected = None if rate is None else Expected(1.0 / rate.value, 0.0, rate.source)
    yield average(records, "mean_free_time", ensemble.n * records.time, met, "time", expected, walls)
    way = None
    if rate is not None and ensemble.torus and ensemble.at_rest:
        kt, mass = records.found["temperature"], ensemble.species[0].mass
        speed = theory.mean_speed(kt, mass, ensemble.thermal_share(mass), 0.5 * ensemble.freedoms - 1.0)
        way = Expected(speed / rate.value, 0.0, CLOSED if rate.source == CLOSED else rate.source)
    note = "; ".join(filter(None, (walls, with_drift(records)))) or None
    yield average(records, "mean_free_path", records.path, met, "length", way, note)


def _billiard(records: Records, kind: int | None, prefix: str) -> Iterator[Measure]:
    """Between any two contacts, with what stands still, with disks, with walls."""
    assert kind is not None
    ensemble = records.ensemble
    number = ensemble.species[kind].number
    met, walls = records.contacts(kind), records.species(kind, sums.HITS)
    if prefix or not ensemble.n:
        if ensemble.partners:
            yield average(records, f"{prefix}collision_rate", met / number, records.time, "1 / time")
        if records.wall_names:
            yield average(records, f"{prefix}wall_contact_rate", walls, records.time, "1 / time")
    hits, way = met + walls, records.species(kind, sums.PATH)
    if not hits.any():
        yield dash(f"{prefix}mean_free_path", "length", "no contact was seen")
        return
    yield average(records, f"{prefix}mean_free_time", number * records.time, hits, "time")
    path = average(records, f"{prefix}mean_free_path", way, hits, "length", *_table(records, prefix))
    yield replace(path, error=_scatter(records, kind, path.value, path.error))
    if not ensemble.n or prefix:
        speed = average(records, f"{prefix}mean_speed", way, number * records.time, "length / time")
        yield speed if prefix or not ensemble.conserved else as_fixed(speed)


def _table(records: Records, prefix: str) -> tuple[Expected | None, str | None]:
    """(pi A / P where one long way goes everywhere, what to say where it may not)."""
    ensemble = records.ensemble
    table = None if prefix else ensemble.table
    if table is None or not math.isfinite(table.mean_free_path):
        return None, None
    if ensemble.integrable and int(ensemble.movers.sum()) < ENOUGH:
        return (
            None,
            f"pi A / P = {table.mean_free_path:.6g} is the mean over all starts; one way need not go everywhere here",
        )
    return Expected(table.mean_free_path, 0.0, TABLE), None


def _scatter(records: Records, kind: int, mean: float, error: float) -> float:
    """The standard error from the scatter over tracers where it is larger: those that do not mix differ for ever."""
    mine = records.ensemble.species_of == kind
    if mine.sum() < ENOUGH or records.skipped:
        return error
    way, hits = records.sums.disks[mine, sums.LENGTH], records.sums.disks[mine, sums.HIT]
    return _fmax(error, float(np.std(way - mean * hits, ddof=1)) / (float(hits.mean()) * math.sqrt(len(hits))))


def _fmax(error: float, scatter: float) -> float:
    return scatter if math.isnan(error) else max(error, scatter)


def distribution(records: Records) -> Floats:
    """Return the free paths of single tracers, mean by mean, ascending; empty without tracers."""
    mine = records.ensemble.scene.disks.mass == 0.0
    way, hits = records.sums.disks[mine, sums.LENGTH], records.sums.disks[mine, sums.HIT]
    found: Floats = np.sort(way[hits > 0.0] / hits[hits > 0.0])
    return found

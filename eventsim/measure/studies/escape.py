"""Escape through an opening: when the centre of each disk first crosses a segment.

A contact whose place lies on the segment counts, so an opening may lie on a wall: what meets it there would have left.

Source of the rate in a chaotic table, l v / (pi A) to leading order in the length l of an opening in its boundary: W. Bauer, G.
F. Bertsch, Phys. Rev. Lett. 65, 2213 (1990), doi:10.1103/PhysRevLett.65.2213.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import product
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from eventsim.errors import EventsimError
from eventsim.measure.ensemble import ensemble_of
from eventsim.measure.entries import Expected, beside, dash
from eventsim.measure.found import Found, lasting
from eventsim.measure.measures import Measure
from eventsim.record.events import Floats
from eventsim.replay.flight_table import FlightTable, flights
from eventsim.replay.log import AnyLog
from eventsim.replay.passage import Passage

Indices: TypeAlias = NDArray[np.int64]
Mask: TypeAlias = NDArray[np.bool_]

ON_IT = 1e-9
"""Share of the opening and of what is flown below which a place at a contact is on its line."""

TOLD = 64
"""Times at which the share of those still inside is told."""

FEWEST = 16
"""Escapes from which on a rate is told."""

BENT = 4.0
"""Standard errors between the rates of the first half and of the others that chance hardly explains."""

LEADING = 0.05
"""Of the rate, what is left out of it to leading order for openings of at most a fiftieth of the boundary."""


def found(log: AnyLog, discard: float | None, x0: float, y0: float, x1: float, y1: float) -> Found:
    """Return the rate of escape through the segment from (x0, y0) to (x1, y1), and the share of disks still inside by time.

    discard: escapes before that time do not count for the rate.
    """
    ends = np.array([[x0, y0], [x1, y1]])
    if not (np.isfinite(ends).all() and (ends[0] != ends[1]).any()):
        raise EventsimError(f"escape: from {(x0, y0)} to {(x1, y1)} is no segment: two finite points that differ")
    passage = Passage(log)
    start, end = passage.span
    movers = np.isfinite(log.scene.disks.mass)
    if end <= start or not movers.any():
        return Found((dash("escape_rate", "1 / time", "nothing moves in this run"),))
    first, at_contact = np.full(len(movers), math.inf), np.ones(len(movers), np.bool_)
    for table in flights(passage):
        for disks, times, hit in _crossings(table, ends, log.scene.domain.period):
            for i, time, contact in zip(disks.tolist(), times.tolist(), hit.tolist(), strict=True):
                if time < first[i]:
                    first[i], at_contact[i] = time, contact
    times = first[movers] - start
    rate = _rate(times, end - start, discard or 0.0)
    if np.isfinite(times).sum() and at_contact[np.isfinite(first)].all():
        rate = beside(rate, _expected(log, math.dist(*ends)))
    escaped = int(np.isfinite(times).sum())
    quantities = (Measure(float(escaped), unit="1", name="escaped"), rate)
    return Found(quantities, {"escape": lasting(times, np.linspace(0.0, end - start, TOLD), "inside")})


def _crossings(
    table: FlightTable, ends: Floats, period: tuple[float | None, float | None]
) -> Iterator[tuple[Indices, Floats, Mask]]:
    """Yield (disks, times, whether at a contact) of flights that cross a segment or one of its images."""
    if not len(table.disk):
        return
    lag = table.duration[:, None]
    last = table.place + table.velocity * lag + 0.5 * table.pull * lag * lag
    low, high = np.minimum(table.place, last), np.maximum(table.place, last)
    if table.pull.any():  # a parabola keeps within its chord and its sagitta
        bow = 0.125 * np.abs(table.pull) * lag * lag
        low, high = low - bow, high + bow
    shifts = [
        [0.0] if length is None else [k * length for k in _images(low[:, axis], high[:, axis], ends[:, axis], length)]
        for axis, length in enumerate(period)
    ]
    for shift in product(*shifts):
        near = np.flatnonzero(
            ((low <= ends.max(axis=0) + shift + _slack(ends)) & (high >= ends.min(axis=0) + shift - _slack(ends))).all(axis=1)
        )
        yield _crossing(table.at(near), ends + np.array(shift))


def _slack(ends: Floats) -> float:
    return ON_IT * (math.dist(*ends) + float(np.abs(ends).max()))


def _images(low: Floats, high: Floats, ends: Floats, length: float) -> range:
    """By how many periods a segment is to be shifted so that flights may meet it."""
    return range(math.floor((low.min() - ends.max()) / length), math.ceil((high.max() - ends.min()) / length) + 1)


def _crossing(table: FlightTable, ends: Floats) -> tuple[Indices, Floats, Mask]:
    """The flights that cross one segment: (disks, first times of that, whether it is where the flight ends)."""
    along = (ends[1] - ends[0]) / math.dist(*ends)
    across = np.array([-along[1], along[0]])
    gap, rate, bend = (table.place - ends[0]) @ across, table.velocity @ across, table.pull @ across
    lag = table.duration
    times = []
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(rate * rate - 2.0 * bend * gap)
        q = -(rate + np.copysign(root, rate))
        for time in (np.where(q != 0.0, 2.0 * gap / q, math.inf), np.where(bend != 0.0, q / bend, math.inf)):
            inside = (time > 0.0) & (time < lag) & _is_on(table, ends[0], along, time, math.dist(*ends))
            times.append(np.where(inside, time, math.inf))
    off = np.abs(gap + rate * lag + 0.5 * bend * lag * lag)
    lands = (off <= _slack(ends) + ON_IT * np.abs(rate) * lag) & _is_on(table, ends[0], along, lag, math.dist(*ends))
    # who leaves the line that it was on does not cross it
    leaves = np.abs(gap) <= _slack(ends)
    flown = np.where(leaves & (bend == 0.0), math.inf, np.minimum(*times))
    flown = np.where(lands & (np.abs(flown - lag) <= ON_IT * lag), math.inf, flown)
    crossed = np.isfinite(flown) | lands
    return (
        table.disk[crossed],
        (table.time + np.minimum(flown, np.where(lands, lag, math.inf)))[crossed],
        (lands & ~np.isfinite(flown))[crossed],
    )


def _is_on(table: FlightTable, start: Floats, along: Floats, time: Floats, length: float) -> Mask:
    """Whether flights at times are between the ends of a segment."""
    lag = np.where(np.isfinite(time), time, 0.0)[:, None]
    place = (table.place + table.velocity * lag + 0.5 * table.pull * lag * lag - start) @ along
    on_it: Mask = (place >= 0.0) & (place <= length)
    return on_it


def _rate(times: Floats, duration: float, begun: float) -> Measure:
    """The rate of an exponential law: escapes over the time of those who may escape (the largest likelihood)."""
    late = times[times >= begun]
    escapes = np.sort(late[np.isfinite(late)])
    if len(escapes) < FEWEST:
        return dash("escape_rate", "1 / time", f"{len(escapes)} escapes: too few for a rate")

    def between(low: float, high: float) -> tuple[float, float]:
        """Return the rate, and its error, among those inside at `low`, until `high`."""
        stay = float((np.minimum(late[late >= low], high) - low).sum())
        count = int(((escapes >= low) & (escapes < high)).sum())
        return count / stay, math.sqrt(count) / stay

    rate, error = between(begun, math.nextafter(duration, math.inf))
    middle = float(escapes[len(escapes) // 2])
    (early, early_error), (after, after_error) = between(begun, middle), between(middle, duration)
    bent = abs(early - after) > BENT * math.hypot(early_error, after_error)
    note = f"no exponential law: {early:.3g} up to t = {middle:.3g}, {after:.3g} after it" if bent else None
    return Measure(rate, error, unit="1 / time", doubt=note, name="escape_rate")


def _expected(log: AnyLog, length: float) -> Expected | None:
    """L v / (pi A), where all have one speed in one table."""
    ensemble = ensemble_of(log.scene, bool(log.provenance.kicks))
    if not ensemble.billiard or ensemble.table is None:
        return None
    speed = np.hypot(*log.scene.disks.velocity[ensemble.movers].T)
    if np.ptp(speed) > 1e-9 * speed.max():
        return None
    rate = length * float(speed.mean()) / (math.pi * ensemble.table.area)
    return Expected(rate, LEADING * rate, "l v / (pi A) of a chaotic table, to leading order")

"""Lyapunov exponents: how fast neighbouring runs part, by the tangent map along a log.

K deviations are carried along the rows (`measure.tangent`) and made orthonormal again and again.  What that takes from their
lengths is how they have grown.  The deviation of a disk is that at its last row: between rows it only shears, which changes no
exponent.  Disks that carry energy are one system.  A tracer deflects nobody, so each is a system of its own, in the same
surroundings.

Source: G. Benettin, L. Galgani, A. Giorgilli, J.-M. Strelcyn, Meccanica 15, 9 (1980), doi:10.1007/BF02128236; of hard disks: Ch.
Dellago, H. A. Posch, W. G. Hoover, Phys. Rev. E 53, 1485 (1996), doi:10.1103/PhysRevE.53.1485.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from eventsim.errors import EventsimError
from eventsim.measure.blocking import ratio_average
from eventsim.measure.ensemble import ensemble_of
from eventsim.measure.entries import dash, unsteady_note
from eventsim.measure.found import Columns, Found
from eventsim.measure.measures import Measure
from eventsim.measure.tangent import Passed, Tangent
from eventsim.measure.trust import smallest_reach
from eventsim.record.events import Floats, Kind
from eventsim.replay.log import AnyLog
from eventsim.scene.contact_law import law_of_scene
from eventsim.scene.disks import typical_speed
from eventsim.scene.names import plural
from eventsim.scene.scene import Scene

SEED = 1
"""Of the deviations that a run begins with."""

GROWN = 32.0
"""Growth after which deviations are made orthonormal: some twice as many bits are lost meanwhile."""

FORGOTTEN = 1e-12
"""Length below which nothing is left of a deviation but rounding: the contact maps its direction to none."""

PARTS = 1024
"""Parts of a log whose growth is kept apart, for the bars."""

ALIGNING = 0.1
"""Share of a run that is left out where nobody says how much: deviations turn into their directions."""

PER_TIME, PER_CONTACT = "1 / time", "1 / contact of a disk"


class _Ledger:
    """What deviations of one system, or of many like it, have grown by, part by part."""

    def __init__(self, columns: int, stride: int) -> None:
        """columns: deviations of a system.  stride: contacts of a part."""
        self.growth: Floats = np.zeros(columns)
        self.parts: list[tuple[float, int, Floats]] = []
        self._contacts, self._stride = 0, stride

    def add(self, time: float, contacts: int, growth: Floats, last: bool = False) -> None:
        """Add logarithms of growth, and contacts of disks, until a time; last: the part ends, however short."""
        self.growth = self.growth + growth
        self._contacts += contacts
        if self._contacts >= self._stride or (last and self._contacts):
            self.parts.append((time, self._contacts, self.growth))
            self.growth, self._contacts = np.zeros_like(self.growth), 0


class Growth:
    """Carries deviations along rows.

    Attributes:
        carried: ledger of the system of all disks that carry energy; None without any.
        traced: that of the tracers, each a system of its own.
        bodies, tracers: how many there are of either.
        each: numbers that tell a disk: of place and velocity, and of its spin where it has one.
    """

    def __init__(self, log: AnyLog, count: int) -> None:
        """Begin with `count` deviations, or as many as a system has."""
        scene = log.scene
        mass, rng = scene.disks.mass, np.random.default_rng(SEED)
        self._bodies = np.flatnonzero(np.isfinite(mass) & (mass > 0.0)).tolist()
        self._tracers = set(np.flatnonzero(mass == 0.0).tolist())
        nothing = (np.zeros(0),) * 4
        self._tangent = Tangent(scene, [nothing] * len(mass), corner=log.provenance.corner)
        self.each = 4 if self._tangent.spun is None else 5
        self._own = min(count, self.each * len(self._bodies))
        self._theirs = min(count, self.each) if self._tracers else 0
        self.bodies, self.tracers = len(self._bodies), len(self._tracers)
        self._since = 0
        stride = max(len(log) // PARTS, 1)
        self.carried = _Ledger(self._own, stride) if self._bodies else None
        self.traced = _Ledger(self._theirs, stride) if self._tracers else None
        speed = typical_speed(*scene.disks.velocity.T)
        reach = smallest_reach(scene)
        # one unit for places and for velocities: neither exponents nor bits hang on it, as long as both are seen
        self._unit = reach / speed if 0.0 < reach / (speed or math.inf) < math.inf else 1.0
        self._turning = reach * self._unit if self.each == 5 else 1.0
        for i in range(len(mass)):
            self._put(i, np.zeros((self.each, self._own + self._theirs)))
        if self._bodies:
            self._put_bodies(np.linalg.qr(rng.normal(size=(self.each * len(self._bodies), self._own)))[0])
        for i in self._tracers:
            self._put_tracer(i, np.linalg.qr(rng.normal(size=(self.each, self._theirs)))[0])

    def follow(self, log: AnyLog) -> str | None:
        """Go through a log; why that ended before its end, a sentence, or None."""
        length, start, time = log.provenance.epoch_length, log.scene.start_time, 0.0
        for rows in log.blocks():
            times = (rows["epoch"] * length + rows["remainder"]).tolist()
            for passed, row, kind in zip(self._tangent.follow(rows), times, rows["kind"].tolist(), strict=True):
                if passed.joint or kind == Kind.REST:
                    what = "contacts of one instant share disks" if passed.joint else "a disk comes to rest"
                    self._end(time)
                    return f"up to event {passed.event:,}, t = {start + row:.6g}: there {what}, and no tangent map goes on"
                time = row
                self._take(passed, time)
        self._end(time)
        return None

    def _take(self, passed: Passed, time: float) -> None:
        """Keep what a row did."""
        for i in passed.disks:
            if i in self._tracers and self.traced is not None:
                frame, growth = _straightened(self._frame(i)[:, self._own :])
                self._put_tracer(i, frame)
                self.traced.add(time, 1, growth)
        if self.carried is None:
            return
        bodies = [i for i in passed.disks if i not in self._tracers]
        self._since += len(bodies)
        if self._since >= len(self._bodies) or any(self._first(i) > GROWN for i in bodies):
            self._straighten(time)

    def _first(self, i: int) -> float:
        """How large the first deviation, which grows fastest, is at a disk."""
        x, y, u, w = self._tangent.off[i]
        largest: float = max(abs(x[0]), abs(y[0]), abs(u[0]) * self._unit, abs(w[0]) * self._unit)
        return largest

    def _straighten(self, time: float, last: bool = False) -> None:
        assert self.carried is not None
        frame = np.concatenate([self._frame(i)[:, : self._own] for i in self._bodies])
        frame, growth = _straightened(frame)
        self._put_bodies(frame)
        self.carried.add(time, self._since, growth, last)
        self._since = 0

    def _end(self, time: float) -> None:
        if self.carried is not None:
            self._straighten(time, last=True)
        if self.traced is not None:
            self.traced.add(time, 0, np.zeros(self._theirs), last=True)

    def _frame(self, i: int) -> Floats:
        """The deviations of a disk (`each`, columns) in lengths."""
        x, y, u, w = self._tangent.off[i]
        spun = () if self._tangent.spun is None else (self._tangent.spun[i] * self._turning,)
        frame: Floats = np.array((x, y, u * self._unit, w * self._unit, *spun))
        return frame

    def _put_bodies(self, frame: Floats) -> None:
        rest = np.zeros(self._theirs)
        for place, i in enumerate(self._bodies):
            self._put(i, [np.concatenate((row, rest)) for row in frame[self.each * place : self.each * (place + 1)]])

    def _put_tracer(self, i: int, frame: Floats) -> None:
        rest = np.zeros(self._own)
        self._put(i, [np.concatenate((rest, row)) for row in frame])

    def _put(self, i: int, off: list[Floats] | Floats) -> None:
        x, y, u, w, *spun = off
        self._tangent.off[i] = x, y, u / self._unit, w / self._unit
        if self._tangent.spun is not None:
            self._tangent.spun[i] = spun[0] / self._turning


def _straightened(frame: Floats) -> tuple[Floats, Floats]:
    """Deviations (rows, columns) made orthonormal, and the logarithms of what that took (columns,): -inf if forgotten."""
    straight, left = np.linalg.qr(frame)
    length = np.abs(np.diag(left))
    growth: Floats = np.log(length, out=np.full(len(length), -math.inf), where=length > FORGOTTEN)
    return straight, growth


class _Rates(NamedTuple):
    """Exponents (columns,) and bars of them, per time and per contact of a disk; and of their sum per time."""

    time: list[tuple[float, float]]
    contact: list[tuple[float, float]]
    total: tuple[float, float]


def found(log: AnyLog, discard: float | None, count: int) -> Found:
    """Return the `count` largest Lyapunov exponents of the run that a log tells.

    Args:
        log: full or compact.
        discard: time at the beginning that is left out; None: the scene's `equilibration`, or else the time in which deviations
            turn into their directions.
        count: at least 1; where there are fewer exponents (4 a disk that can be deflected, 5 where disks have spin), all of them.

    Raises:
        EventsimError: for a count below 1.
    """
    if count < 1:
        raise EventsimError(f"lyapunov: K = {count}: must be at least 1")
    scene = log.scene
    discard = scene.equilibration if discard is None else discard
    why = _no_meaning(log)
    if why is not None:
        return Found((dash("lyapunov_1", PER_TIME, why),))
    growth = Growth(log, count)
    stopped = growth.follow(log)
    quantities: list[Measure] = []
    tables: dict[str, Columns] = {}
    for name, ledger, systems, disks in (
        ("lyapunov", growth.carried, 1, growth.bodies),
        ("lyapunov_tracer", growth.traced, growth.tracers, growth.tracers),
    ):
        if ledger is None:
            continue
        rates = _rates(ledger, systems, disks, discard)
        if rates is None:
            quantities.append(dash(f"{name}_1", PER_TIME, stopped or _too_few(log, discard)))
            continue
        quantities += _entries(name, rates, scene, len(ledger.growth) == growth.each * (disks // systems))
        tables[name] = {
            "k": [float(k + 1) for k in range(len(rates.time))],
            "exponent": [value for value, _ in rates.time],
            "error": [error for _, error in rates.time],
            "per_contact": [value for value, _ in rates.contact],
            "per_contact_error": [error for _, error in rates.contact],
        }
    notes = () if stopped is None or not tables else (f"Lyapunov exponents {stopped}.",)
    return Found(tuple(quantities), tables, notes)


def _no_meaning(log: AnyLog) -> str | None:
    """Why a run has no exponents, a clause; None where it may have."""
    scene = log.scene
    if not np.isfinite(scene.disks.mass).any():
        return "no disk can be deflected"
    if log.provenance.kicks:
        return "kicks set velocities, whatever these were before"
    if not len(log):
        return "nothing meets anything in this run"
    return law_of_scene(scene).no_tangent


def _too_few(log: AnyLog, discard: float | None) -> str:
    left = "" if discard is None else f" with {discard:g} units of time left out"
    return f"{plural(len(log), 'event')}{left}: too few"


def _rates(ledger: _Ledger, systems: int, disks: int, discard: float | None) -> _Rates | None:
    """Exponents from the parts of a ledger; None where too little is left.  systems: how many it is about; disks: in all."""
    first = math.ceil(ALIGNING * len(ledger.parts)) if discard is None else 1
    begun = discard or 0.0
    kept = [k for k in range(max(first, 1), len(ledger.parts)) if ledger.parts[k - 1][0] >= begun]
    if not kept:
        return None
    time = np.array([ledger.parts[k][0] - ledger.parts[k - 1][0] for k in kept]) * systems
    contacts = np.array([float(ledger.parts[k][1]) for k in kept]) * (systems / disks)
    growth = np.array([ledger.parts[k][2] for k in kept])
    return _Rates(
        [_ratio(column, time) for column in growth.T],
        [_ratio(column, contacts) for column in growth.T],
        _ratio(growth.sum(axis=1), time),
    )


def _ratio(above: Floats, below: Floats) -> tuple[float, float]:
    """sum(above) / sum(below) and its bar; -inf where a direction was forgotten."""
    if not np.isfinite(above).all():
        return -math.inf, math.nan
    bar = ratio_average(above, below)
    return bar.mean, bar.error


def _entries(name: str, rates: _Rates, scene: Scene, whole: bool) -> list[Measure]:
    """The largest exponent, and the sum of all where these are all."""
    note = unsteady_note(ensemble_of(scene))
    entries = []
    for key, (value, error), unit in (
        (f"{name}_1", rates.time[0], PER_TIME),
        (f"{name}_1_per_contact", rates.contact[0], PER_CONTACT),
        *([(f"{name}_sum", rates.total, PER_TIME)] if whole else ()),
    ):
        if not math.isfinite(value):
            entries.append(dash(key, unit, "a contact with restitution 0 forgets how disks approached"))
            continue
        short = None if error > 0.0 or key.endswith("_sum") else "the run is too short for an error bar"
        doubts = [text for text in (short, note) if text]
        entries.append(
            Measure(value, error if note is None else math.nan, unit=unit, doubt="; ".join(doubts) or None, name=key)
        )
    return entries

"""A meter takes rows in blocks and keeps sums and correlations; memory does not grow with the run.

The sums do not depend on how the rows were cut into blocks: they are taken up in blocks of the meter's own.
"""

from __future__ import annotations

import math

import numpy as np

from eventsim.errors import EventsimError
from eventsim.measure.cooling import Cooling
from eventsim.measure.correlation import Correlator
from eventsim.measure.ensemble import ensemble_of
from eventsim.measure.equilibration import settled_after
from eventsim.measure.flights import Flights, Follower
from eventsim.measure.pace import at_full_pace, slowed_rows
from eventsim.measure.results import Measures, Records, results_of
from eventsim.measure.series import FIRST_BINS, Series
from eventsim.measure.tally import ENERGY, VIRIAL, Tally
from eventsim.record.events import Floats, Rows
from eventsim.record.provenance import Kick
from eventsim.replay.log import EventLog
from eventsim.scene.pace import later, pace_of_scene, slowed_scene
from eventsim.scene.scene import Scene
from eventsim.scene.stage import stage_of

BLOCK = 1 << 15
"""Rows that are taken up together."""

WATCHED = 512
"""Disks whose displacements and velocities are correlated, evenly picked where there are more."""

SAMPLES_PER_FLIGHT = 4
"""Samples in the mean time between two events of a disk."""


class Meter:
    """Measures a run of a scene from its rows.

    >>> meter = Meter(scene); meter.write(rows); meter.write(more_rows); meter.finish(duration)
    """

    def __init__(self, scene: Scene, discard: float | None = None, kicks: tuple[Kick, ...] = ()) -> None:
        """discard: time from the start that is left out; None: the scene's `equilibration`, or else found from the pressure.

        kicks: velocities that are set from outside.  Very fast and very slow runs are measured at their pace (`scene.pace`).

        Raises EventsimError for a negative or infinite time, and for a scene without disks that carry energy.
        """
        if discard is not None and not 0.0 <= discard < math.inf:
            raise EventsimError(f"discard = {discard!r}: must be a finite time, at least 0")
        self._pace = pace_of_scene(scene, kicks)
        self._epoch_length = math.ldexp(stage_of(scene).epoch_length, self._pace)
        self.scene = scene = slowed_scene(scene, self._pace)
        self.ensemble = ensemble_of(scene)
        if not self.ensemble.n:
            raise EventsimError("there is nothing to measure: no disk has a finite positive mass")
        self.discard = scene.equilibration if discard is None else later(discard, self._pace)
        self._stage = stage_of(scene)
        self._tally = Tally(self.ensemble, self._stage)
        self._follower = Follower(self._stage)
        counted = np.flatnonzero(self.ensemble.counted)
        self._watched = counted[np.linspace(0, len(counted) - 1, min(WATCHED, len(counted))).astype(np.int64)]
        self._waiting: list[Rows] = []
        self._waiting_rows = 0
        self._series: Series | None = None
        self._correlator: Correlator | None = None
        self._samples_taken = 0
        self._time = 0.0
        self._energy = self.ensemble.start_energy
        self._cooling = Cooling(self._energy)

    def write(self, rows: Rows) -> None:
        """Take a block of full rows, the next of the run."""
        self._waiting.append(slowed_rows(rows, self._pace) if self._pace else rows.copy())
        self._waiting_rows += len(rows)
        if self._waiting_rows >= BLOCK:
            every = np.concatenate(self._waiting)
            whole = len(every) - len(every) % BLOCK
            for first in range(0, whole, BLOCK):
                self._take(every[first : first + BLOCK])
            self._waiting, self._waiting_rows = [every[whole:].copy()], len(every) - whole

    def finish(self, duration: float) -> Measures:
        """The measures of the run, which lasted `duration` (time since the start).

        Raises EventsimError where no time has passed, or less than is to be discarded.
        """
        if not duration > 0.0:
            raise EventsimError("there is nothing to measure: no time passes in this run")
        length, duration = duration, math.ldexp(duration, self._pace)
        if self.discard is not None and self.discard >= duration:
            raise EventsimError(f"discard = {math.ldexp(self.discard, -self._pace)!r}: the run lasts {length!r} only")
        if self._waiting_rows:
            self._take(np.concatenate(self._waiting))
            self._waiting, self._waiting_rows = [], 0
        series, correlator = self._scales(duration, 0)
        samples = self._sample_times(correlator, duration)
        flights, way, velocity = self._follower.rest(duration, samples, self._watched)
        correlator.add(way, velocity)
        self._add_flights(flights, series)
        if self.scene.gravity is None:
            end = max(duration, self._time)
            series.add_held(ENERGY, np.array([self._time, end]), np.array([self._energy]))
        bins = series.whole_bins(duration)
        settled = self.discard
        if settled is None:
            settled = settled_after(bins[:, VIRIAL]) * series.width if self.ensemble.steady else 0.0
        way = np.hypot(*self._follower.way[self._watched].T)
        longest = float(way.max())
        moved = longest * float(np.sqrt(((way / longest) ** 2).mean())) if longest > 0.0 else 0.0
        records = Records(
            ensemble=self.ensemble,
            tally=self._tally,
            wall_names=self._stage.wall_names,
            duration=duration,
            discarded=settled,
            discard_given=self.discard is not None,
            width=series.width,
            bins=bins[series.bin_after(settled) :],
            correlations=correlator.result(),
            cooling=self._cooling,
            moved=moved,
        )
        measures = results_of(records)
        return at_full_pace(measures, self._pace) if self._pace else measures

    def _take(self, rows: Rows) -> None:
        """Take up a block of the meter's own."""
        time = rows["epoch"] * self._epoch_length + rows["remainder"]
        time = np.maximum.accumulate(np.maximum(time, self._time))  # logged times may step back by an ulp
        end = float(time[-1])
        series, correlator = self._scales(end, len(rows))
        samples = self._sample_times(correlator, end)
        flights, way, velocity = self._follower.follow(rows, time, samples, self._watched)
        correlator.add(way, velocity)
        self._tally.add_contacts(series, rows, time)
        self._add_flights(flights, series)
        if self.scene.gravity is None:
            energy = self._energy + np.cumsum(self._tally.energy_changes(flights, len(rows)))
            held = np.concatenate([[self._energy], energy[:-1]])
            series.add_held(ENERGY, np.concatenate([[self._time], time]), held)
            self._energy = float(energy[-1])
            self._cooling.add(rows, energy)
        self._time = end

    def _add_flights(self, flights: Flights, series: Series) -> None:
        self._tally.add_flights(series, flights)
        if self.scene.gravity is not None:
            self._tally.add_energy(series, flights)
            self._tally.add_weight(series, flights)

    def _scales(self, end: float, rows: int) -> tuple[Series, Correlator]:
        """The series and the correlator, made from the pace of the first block."""
        if self._series is None or self._correlator is None:
            span = end if end > 0.0 else 1.0
            self._series = Series(self._tally.channels, span / FIRST_BINS)
            flight = span * self.ensemble.n / max(2 * rows, 1)
            self._correlator = Correlator(flight / SAMPLES_PER_FLIGHT)
        return self._series, self._correlator

    def _sample_times(self, correlator: Correlator, end: float) -> Floats:
        """The times at which samples are due, up to `end`."""
        begin = self.discard or 0.0
        due = max(math.floor((end - begin) / correlator.interval) + 1, self._samples_taken)
        numbers = np.arange(self._samples_taken, due, dtype=np.float64)
        self._samples_taken = due
        return begin + correlator.interval * numbers


def measure(log: EventLog, discard: float | None = None) -> Measures:
    """Measure the run that a log tells; a compact log is expanded first.

    discard: as of Meter.  Raises EventsimError where there is nothing to measure, LogError for a log without an end.
    """
    full = log.expand()
    meter = Meter(full.scene, discard, full.provenance.kicks)
    for first in range(0, len(full), BLOCK):
        meter.write(full.rows[first : first + BLOCK])
    ending = full.provenance.ending
    length = full.provenance.epoch_length
    if ending is not None:
        return meter.finish(ending.epoch * length + ending.remainder)
    if not len(full):
        return meter.finish(0.0)
    return meter.finish(float((full.epoch * length + full.remainder).max()))

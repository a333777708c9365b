"""What is summed up by time: the channels of a series, and how rows and flights go into them."""

from __future__ import annotations

import numpy as np

from eventsim.measure.ensemble import Ensemble
from eventsim.measure.flights import Flights
from eventsim.measure.series import Series
from eventsim.record.events import Column, Floats, Kind, Rows
from eventsim.scene.stage import Stage

PAIRS, VIRIAL, ENERGY, WALL_CONTACTS, WALL_VIRIAL = range(5)
GENERAL = 5
"""Channels: number of pair contacts; sum of reach x impulse; energy x time; wall contacts; sum of lever x impulse at walls."""

DISK_TIME, PATH, SPEED2, CONTACTS = range(4)
PER_SPECIES = 4
"""Channels of a species: sums over flights of duration, length, mean v^2 x duration; pair contacts of its disks."""

SPEED_BINS, FASTEST = 50, 5.0
"""Bins of the speed histogram, up to this many thermal speeds sqrt(kT / m); one more bin for what is beyond."""

MOST_WALLS = 64
"""More walls than this are measured together only."""


class Tally:
    """Puts rows and flights into the channels of a series."""

    def __init__(self, ensemble: Ensemble, stage: Stage) -> None:
        self.ensemble = ensemble
        disks = ensemble.scene.disks
        self.walls = len(stage.wall_names) if len(stage.wall_names) <= MOST_WALLS else 0
        self.kinds = len(ensemble.species)
        self.first_species = GENERAL + self.walls
        self.first_pair = self.first_species + PER_SPECIES * self.kinds
        self.first_speed = self.first_pair + self.kinds**2
        self.channels = self.first_speed + self.kinds * (SPEED_BINS + 1)
        self._radius = disks.radius
        self._mass = np.where(ensemble.counted, disks.mass, 0.0)
        start = ensemble.temperature(ensemble.start_energy)
        start = start if start > 0.0 and not ensemble.drowned else 1.0
        self.thermal_speed = start**0.5  # of a unit mass
        thermal = self.thermal_speed / np.sqrt(np.where(self._mass > 0.0, self._mass, 1.0))
        # histogram bins per unit of speed, for each disk
        self._speed_scale = SPEED_BINS / (FASTEST * thermal)
        # how hard a disk of unit mass presses on each wall that it rests on
        across = np.array(stage.gravity or (0.0, 0.0)) - stage.slopes
        self._press = np.hypot(across[:, 0], across[:, 1])
        # the lever of a wall of the domain, seen from its middle: half the width less the radius
        self._lever = np.zeros(len(stage.wall_names) + 1)
        self._lever_radius = np.zeros(len(stage.wall_names) + 1)
        for boundary in stage.boundaries:
            assert stage.size is not None
            self._lever[boundary.wall] = 0.5 * stage.size[boundary.axis]
            self._lever_radius[boundary.wall] = 1.0

    def add_contacts(self, series: Series, rows: Rows, time: Floats) -> None:
        """Add what rows at times (R,) say by themselves."""
        pair = rows["kind"] == Kind.PAIR
        chosen, when = rows[pair], time[pair]
        a, b = chosen["a"], chosen["b"]
        ones = np.ones(len(chosen))
        series.add(PAIRS, when, ones)
        series.add(VIRIAL, when, (self._radius[a] + self._radius[b]) * chosen["impulse"])
        first, second = self.ensemble.species_of[a], self.ensemble.species_of[b]
        for own, other in ((first, second), (second, first)):
            known = own >= 0
            series.add(self.first_species + PER_SPECIES * own[known] + CONTACTS, when[known], ones[known])
            known &= other >= 0
            place = self.first_pair + self.kinds * own[known] + other[known]
            series.add(place, when[known], ones[known])
        wall = rows["kind"] == Kind.WALL
        if wall.any():
            chosen, when = rows[wall], time[wall]
            series.add(WALL_CONTACTS, when, np.ones(len(chosen)))
            lever = self._lever[chosen["wall"]] - self._lever_radius[chosen["wall"]] * self._radius[chosen["a"]]
            series.add(WALL_VIRIAL, when, lever * chosen["impulse"])
            if self.walls:
                series.add(GENERAL + chosen["wall"].astype(np.int64), when, chosen["impulse"])

    def add_weight(self, series: Series, flights: Flights) -> None:
        """Add the impulse that walls give to the disks that rest on them."""
        if flights.wall is None or not self.walls:
            return
        rests = np.flatnonzero(flights.wall >= 0)
        wall, end, duration = flights.wall[rests], flights.end[rests], flights.duration[rests]
        weight = self._mass[flights.disk[rests]] * self._press[wall]
        series.add_spread(GENERAL + wall, end - duration, end, weight * duration)

    def add_flights(self, series: Series, flights: Flights) -> None:
        """Add what flights say: lengths, speeds, times; each at its end, or evenly over the time that a disk rests."""
        kind = self.ensemble.species_of[flights.disk]
        known = kind >= 0
        if not known.all():
            flights = flights.take(known)
            kind = kind[known]
        begun, before = (np.einsum("fk,fk->f", v, v) for v in (flights.begun, flights.before))
        speed = np.sqrt(begun)
        if before is not begun:
            middle = 0.5 * (flights.begun + flights.before)
            half = np.einsum("fk,fk->f", middle, middle)
            square = (begun + 4.0 * half + before) / 6.0  # Simpson's rule, exact for v^2
            speed = (speed + 4.0 * np.sqrt(half) + np.sqrt(before)) / 6.0
        else:
            square = begun
        place = self.first_species + PER_SPECIES * kind
        _add(series, place + DISK_TIME, flights, flights.duration)
        _add(series, place + PATH, flights, speed * flights.duration)
        _add(series, place + SPEED2, flights, square * flights.duration)
        bin_ = np.minimum(speed * self._speed_scale[flights.disk], SPEED_BINS).astype(np.int64)
        _add(series, self.first_speed + (SPEED_BINS + 1) * kind + bin_, flights, flights.duration)

    def energy_changes(self, flights: Flights, count: int) -> Floats:
        """By how much each of `count` rows changes the kinetic energy, without gravity."""
        before = np.einsum("fk,fk->f", flights.before, flights.before)
        after = np.einsum("fk,fk->f", flights.after, flights.after)
        gain = 0.5 * self._mass[flights.disk] * (after - before)
        return np.bincount(flights.row, gain, count).astype(np.float64)

    def add_energy(self, series: Series, flights: Flights) -> None:
        """Add the energy x time of each flight; Simpson's rule, exact under gravity."""
        middle = 0.5 * (flights.begun + flights.before)
        parts = [np.einsum("fk,fk->f", v, v) for v in (flights.begun, middle, flights.before)]
        square = (parts[0] + 4.0 * parts[1] + parts[2]) / 6.0
        energy = 0.5 * self._mass[flights.disk] * square * flights.duration
        _add(series, np.full(len(energy), ENERGY), flights, energy)


def _add(series: Series, channel: Column, flights: Flights, amount: Floats) -> None:
    """Add amounts (F,) at the ends of flights, those of disks at rest, which may last, over their time."""
    if flights.wall is None:
        series.add(channel, flights.end, amount)
        return
    rests = flights.wall >= 0
    series.add(channel[~rests], flights.end[~rests], amount[~rests])
    end = flights.end[rests]
    series.add_spread(channel[rests], end - flights.duration[rests], end, amount[rests])

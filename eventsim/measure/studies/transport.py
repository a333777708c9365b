"""Transport coefficients of a fluid by Einstein-Helfand moments: viscosity, heat conductivity, self-diffusion, against the lag.

The moments' rates are J_xy = sum m v_x v_y and J_e = sum m v^2 v / 2 in free flight, and a contact adds r dp and r dE: what it
carries over the distance r of the two disks.  So each contact is an addition, rows are forgotten, and runs may be of any length.
With W the integral of a rate, the coefficient at a lag is the slope of <(W(t + lag) - W(t))^2> / 2 V kT (heat: / 2 V kT^2)
between half that lag and the lag.  J_xy and (J_xx - J_yy) / 2 are two looks at one viscosity, J_e along x and y at one
conductivity.

In two dimensions these coefficients have no limit: they grow with the logarithm of the lag and of the size.

Source: B. J. Alder, D. M. Gass, T. E. Wainwright, J. Chem. Phys. 53, 3813 (1970), doi:10.1063/1.1673845; of the logarithm: B. J.
Alder, T. E. Wainwright, Phys. Rev. A 1, 18 (1970), doi:10.1103/PhysRevA.1.18.
"""

from __future__ import annotations

import math

import numpy as np

from eventsim.measure import theory
from eventsim.measure.blocking import ErrorBar, block_average
from eventsim.measure.ensemble import Ensemble, ensemble_of
from eventsim.measure.entries import UNSURE, Expected, averaged, beside, dash
from eventsim.measure.found import Columns, Found
from eventsim.measure.measures import Measure
from eventsim.measure.meter import Meter, handed_on
from eventsim.record.events import Floats, Kind, Rows
from eventsim.replay.log import AnyLog
from eventsim.scene.numbers import Point
from eventsim.scene.scene import Scene
from eventsim.scene.stage import stage_of

SAMPLES = 4
"""In a mean free time."""

LAGS = (1, 2, 4, 8, 12, 16, 24, 32, 40, 60, 80, 120, 160)
"""Lags that are told, in samples."""

FROM, TO = 20, 60
"""Lags, in samples, between which the coefficients are read: 5 to 15 mean free times."""

FIRST = 4
"""Contacts of a disk from which the mean free time is made."""

XY, DIFFERENCE, HEAT_X, HEAT_Y = range(4)
"""Moments."""

VISCOSITY, CONDUCTIVITY = "mass / time", "1 / time"
LOGARITHM = "in two dimensions it grows with the logarithm of the lag and of N"


class Transport:
    """Adds up the moments of a run from its rows as they come, and tells the coefficients.

    >>> transport = Transport(scene); transport.write(rows); transport.write(more_rows); transport.found(duration)
    """

    def __init__(self, scene: Scene, discard: float | None = None, kicked: bool = False, corner: Point | None = None) -> None:
        """Begin with a scene.

        Args:
            scene: what is simulated.
            discard: time at the beginning that is left out; None: the scene's `equilibration`, or nothing.
            kicked: whether velocities are set from outside.
            corner: what places in rows are relative to; None: as engines have it now.
        """
        self._ensemble = ensemble = ensemble_of(scene, kicked)
        self.why = _no_meaning(ensemble)
        if self.why is not None:
            return
        self._meter = Meter(scene, discard, corner=corner)
        self._stage, disks = stage_of(scene, corner), scene.disks
        self._mass, self._drift = disks.mass, ensemble.drift
        self._current = _currents(disks.velocity - ensemble.drift, disks.mass).sum(axis=0)
        self._begun, self._time = (scene.equilibration if discard is None else discard) or 0.0, 0.0
        self._moments = np.zeros(len(self._current))
        self._waiting: list[Rows] = []
        self._rows, self._step, self._next = 0, 0.0, 0
        self._samples: list[Floats] = []

    def write(self, rows: Rows) -> None:
        """Take a block of full rows, the next of the run."""
        if self.why is not None or not len(rows):
            return
        joint = np.flatnonzero(rows["joint"] >= 0)
        if len(joint):
            self.why = f"event {int(rows['event'][joint[0]]):,} is one of several contacts of one instant that share disks"
            return
        self._meter.write(rows)
        self._rows += len(rows)
        if self._step == 0.0:
            self._waiting.append(rows.copy())
            if 2 * self._rows < FIRST * self._ensemble.n:
                return
            rows, self._waiting = np.concatenate(self._waiting), []
            self._step = self._clock(rows)[-1] * self._ensemble.n / (2.0 * self._rows * SAMPLES)
        self._take(rows)

    def found(self, duration: float) -> Found:
        """Return the coefficients of the run, which lasted `duration` (time since the start)."""
        names = (("viscosity", VISCOSITY), ("heat_conductivity", CONDUCTIVITY), ("self_diffusion", "length^2 / time"))
        if self.why is not None:
            return Found(tuple(dash(name, unit, self.why) for name, unit in names))
        if self._step > 0.0:
            self._sample(np.array([duration]), np.array([self._moments + self._current * (duration - self._time)]), duration)
        walks = np.array(self._samples).reshape(-1, len(self._current))
        if len(walks) <= TO:
            why = f"{self._rows:,} contacts: too few for a lag of {TO // SAMPLES} mean free times"
            return Found(tuple(dash(name, unit, why) for name, unit in names))
        kt = self._ensemble.temperature(self._ensemble.start_energy)
        assert self._stage.size is not None
        volume = float(np.prod(self._stage.size))
        expected = _expected(self._ensemble, kt)
        columns: Columns = {"lag": [lag * self._step for lag in LAGS[1:] if lag < len(walks)]}
        entries = []
        for (name, unit), pair, scale, theory_ in zip(
            names, ((XY, DIFFERENCE), (HEAT_X, HEAT_Y)), (2.0 * volume * kt, 2.0 * volume * kt * kt), expected, strict=False
        ):
            if name == "heat_conductivity" and self._ensemble.kinds > 1:
                entries.append(dash(name, unit, "in a mixture heat and diffusion go together"))
                continue
            bar = _slope(walks[:, pair], FROM, TO, self._step * scale)
            entries.append(
                beside(_entry(name, unit, bar, f"lags {FROM * self._step:.3g} to {TO * self._step:.3g}; {LOGARITHM}"), theory_)
            )
            slopes = [_slope(walks[:, pair], lag // 2, lag, self._step * scale) for lag in LAGS[1:] if lag < len(walks)]
            columns |= {name: [slope.mean for slope in slopes], f"{name}_error": [slope.error for slope in slopes]}
        entries.append(self._diffusion(duration, kt, names[2]))
        return Found(tuple(entries), {"transport": columns}, (f"Transport coefficients: {LOGARITHM[3:]}.",))

    def _clock(self, rows: Rows) -> Floats:
        """Times since the start (n,), ascending: logged ones may step back by an ulp."""
        time: Floats = np.maximum.accumulate(np.maximum(rows["epoch"] * self._stage.epoch_length + rows["remainder"], self._time))
        return time

    def _take(self, rows: Rows) -> None:
        """Add rows to the moments, and keep these at even times."""
        time = self._clock(rows)
        jumps, changes = self._of_contacts(rows)
        current = np.vstack([self._current, self._current + np.cumsum(changes, axis=0)])
        flown = current[:-1] * np.diff(time, prepend=self._time)[:, None]
        after = self._moments + np.cumsum(flown + jumps, axis=0)
        self._sample(time, after - jumps, float(time[-1]), after)
        self._moments, self._current, self._time = after[-1], current[-1], float(time[-1])

    def _sample(self, time: Floats, before: Floats, until: float, after: Floats | None = None) -> None:
        """Keep the moments at the even times up to `until`, from their values before and after rows."""
        last = int((until - self._begun) / self._step) if until > self._begun else -1
        told = self._begun + self._step * np.arange(self._next, last + 1)
        self._next = max(self._next, last + 1)
        if not len(told):
            return
        place = np.searchsorted(time, told, side="left")
        place = np.minimum(place, len(time) - 1)
        starts = np.concatenate([[self._time], time[:-1]])
        values = np.vstack([self._moments, (before if after is None else after)[:-1]])
        share = (told - starts[place]) / np.where(time > starts, time - starts, 1.0)[place]
        self._samples += list(values[place] + share[:, None] * (before[place] - values[place]))

    def _of_contacts(self, rows: Rows) -> tuple[Floats, Floats]:
        """What contacts add to the moments (n, 4), and to the currents."""
        pair = rows["kind"] == Kind.PAIR
        dx, dy = self._stage.nearest(np.column_stack([rows["xa"] - rows["xb"], rows["ya"] - rows["yb"]])).T
        reach = np.hypot(dx, dy)
        push = np.where(pair, rows["impulse"] / np.where(reach > 0.0, reach, 1.0), 0.0)
        px, py = push * dx, push * dy
        jumps = np.zeros((len(rows), 4))
        changes = np.zeros((len(rows), 4))
        gained = 0.0
        for name, sign in (("a", 1.0), ("b", -1.0)):
            mass = self._mass[rows[name]]
            after = np.column_stack([rows[f"vx{name}"], rows[f"vy{name}"]]) - self._drift
            before = after - sign * np.column_stack([px, py]) / mass[:, None]
            changes += _currents(after, mass) - _currents(before, mass)
            if name == "a":
                gained = 0.5 * mass * ((after * after).sum(axis=1) - (before * before).sum(axis=1))
        jumps[:, XY], jumps[:, DIFFERENCE] = px * dy, 0.5 * (px * dx - py * dy)
        jumps[:, HEAT_X], jumps[:, HEAT_Y] = gained * dx, gained * dy
        return jumps, changes

    def _diffusion(self, duration: float, kt: float, told: tuple[str, str]) -> Measure:
        """Self-diffusion, of the measures of the same rows."""
        found = self._meter.finish(duration)["diffusion"]
        name, unit = told
        if math.isnan(found.value):
            return dash(name, unit, found.doubt or "")
        rate = 2.0 * self._rows / (self._ensemble.n * duration)
        expected = None
        if self._ensemble.equal:
            value = theory.enskog_diffusion(kt, float(self._mass[self._ensemble.counted][0]), rate)
            expected = Expected(value, 0.0, "kT / (m rate), low density")
        return beside(Measure(found.value, found.error, unit=unit, doubt=found.doubt, name=name), expected)


def found(log: AnyLog, discard: float | None) -> Found:
    """Return the transport coefficients of the run that a log tells; `Transport` makes them of rows as they come."""
    provenance = log.provenance
    transport = Transport(log.scene, discard, bool(provenance.kicks), provenance.corner)
    return transport.found(handed_on(provenance, log.blocks(), transport.write))


def _no_meaning(ensemble: Ensemble) -> str | None:
    """Why a scene has no such coefficients, a clause."""
    if not ensemble.torus:
        return f'the domain is "{ensemble.scene.domain.kind}": the moments are those of periodic ones'
    if not ensemble.simple:
        return ensemble.no_temperature or ("gravity pulls" if ensemble.alone else "walls and posts take momentum")
    if ensemble.tracers is not None:
        return "there are tracers, which take no part"
    return ensemble.no_temperature


def _currents(velocity: Floats, mass: Floats) -> Floats:
    """The currents of single disks (n, 4)."""
    vx, vy = velocity[:, 0], velocity[:, 1]
    energy = 0.5 * mass * (vx * vx + vy * vy)
    return np.column_stack([mass * vx * vy, 0.5 * mass * (vx * vx - vy * vy), energy * vx, energy * vy])


def _slope(walks: Floats, low: int, high: int, scale: float) -> ErrorBar:
    """The slope of the mean square of walks (samples, 2) between two lags, in samples, over `scale`; with its bar."""
    count = len(walks) - high
    far, near = walks[high:] - walks[:count], walks[low : low + count] - walks[:count]
    series = (far * far - near * near).mean(axis=1) / ((high - low) * scale)
    return block_average(series)


def _entry(name: str, unit: str, bar: ErrorBar, note: str) -> Measure:
    return averaged(name, bar, unit, note if bar.independent else f"{note}; {UNSURE}")


def _expected(ensemble: Ensemble, kt: float) -> tuple[Expected | None, Expected | None]:
    """Enskog's viscosity and heat conductivity, of equal disks."""
    eta = ensemble.packing_fraction
    if not ensemble.equal or eta is None or eta > theory.KOLAFA_ROTTNER_UP_TO:
        return None, None
    mass = ensemble.species[0].mass
    source = "Enskog, Gass 1971"
    return (
        Expected(theory.enskog_viscosity(eta, ensemble.diameter, kt, mass), 0.0, source),
        Expected(theory.enskog_conductivity(eta, ensemble.diameter, kt, mass), 0.0, source),
    )

"""A meter takes rows in blocks and keeps sums and correlations; neither memory nor pace depends on what the run does.

The sums do not depend on how the rows were cut into blocks: they are taken up in blocks of the meter's own.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import replace
from os import PathLike

import numpy as np
from numpy.typing import NDArray

from eventsim.engines import STEPPED
from eventsim.errors import EventsimError
from eventsim.measure import sums
from eventsim.measure.compiled import Kernels, kernels
from eventsim.measure.correlation import Correlator
from eventsim.measure.ensemble import Ensemble, ensemble_of
from eventsim.measure.gathered import measures_of
from eventsim.measure.groups import Groups
from eventsim.measure.measures import Measures
from eventsim.measure.profile import Profiler
from eventsim.measure.pull import Pull
from eventsim.measure.records import Records
from eventsim.measure.speeds import FASTEST
from eventsim.measure.walls import described_walls
from eventsim.record.events import SPINS, Floats, Kind, Rows, has_spins, row_of
from eventsim.record.provenance import Kick, Provenance, has_spin
from eventsim.replay.log import AnyLog, stream_log
from eventsim.scene.numbers import Point, optional_number
from eventsim.scene.scene import Scene
from eventsim.scene.stage import Stage, stage_of

BLOCK = 1 << 15
"""Rows that are taken up together."""

"""A row as it lies in memory: copied at once, and not column by column."""

FIRST_BINS = 64
"""Bins into which the first block of rows is cut: from there on the width only doubles."""

WATCHED = 512
"""Disks whose displacements and velocities are correlated, evenly picked where there are more."""

SAMPLES_PER_FLIGHT = 4
"""Samples in the mean time between two events of a disk; fewer where the run slows down."""

MOST_SAMPLED = 1 << 18
"""Disks times samples that are kept before they are added; where one block of rows fills that, samples become half as many."""

MORE_SAMPLES = 1.25
"""Times the samples of the first block that another may have: a gas that slows down has more time in a block, at no more cost."""

MOST_WALLS = 64
"""More walls than this are measured together only."""


class Meter:
    """Measures a run of a scene from its rows.

    >>> meter = Meter(scene); meter.write(rows); meter.write(more_rows); meter.finish(duration)
    """

    def __init__(
        self,
        scene: Scene,
        discard: float | None = None,
        kicks: tuple[Kick, ...] = (),
        profile: str | None = None,
        engine: str | None = None,
        corner: Point | None = None,
    ) -> None:
        """Begin to measure a scene.

        Args:
            scene: what is simulated.
            discard: time from the start that is left out; None: the scene's `equilibration`, or else found from the pressure.
            kicks: velocities that are set from outside.
            profile: "x" or "y" for profiles along that axis as well.
            engine: the name of the one whose rows these are; those of an engine of steps are told to be no exact contacts.
            corner: what places in rows are relative to; None: as engines have it now.

        Raises:
            EventsimError: for a negative or infinite time, and for a scene in which nothing can be deflected.
        """
        discard = optional_number(discard, "discard")
        if discard is not None and not 0.0 <= discard < math.inf:
            raise EventsimError(f"discard = {discard!r}: must be a finite time, at least 0")
        self._steps = engine if engine in STEPPED else None
        self.scene = scene
        self.ensemble = ensemble = ensemble_of(scene, bool(kicks))
        if not ensemble.movers.any():
            raise EventsimError("there is nothing to measure: no disk can be deflected (all have mass inf)")
        self.discard = scene.equilibration if discard is None else discard
        self._stage = stage = stage_of(scene, corner)
        movers = np.flatnonzero(ensemble.movers)
        watched = movers[np.linspace(0, len(movers) - 1, min(WATCHED, len(movers))).astype(np.int64)]
        self._profiler = None if profile is None else Profiler(scene, ensemble, profile)
        self._correlated: NDArray[np.intp] | slice = slice(None)  # all
        if self._profiler is not None:
            self._correlated = np.searchsorted(movers, watched)
            watched = movers
        walls = len(stage.wall_names) if len(stage.wall_names) <= MOST_WALLS else 0
        self._pull = Pull(scene, stage)
        shears = walls if self._pull.walls.any() else 0
        along_x, along_y = stage.period
        self._plan = sums.Plan(len(ensemble.species), walls, along_x or 0.0, along_y or 0.0, shears)
        self._sums = _sums(scene, stage, ensemble, self._plan, watched)
        self._sums.numbers[sums.ORIGIN] = self.discard or 0.0
        self._groups = Groups(ensemble.counted)
        self._block = np.empty(BLOCK, dtype=row_of(has_spin(scene)))
        self._whole = np.dtype((np.void, self._block.itemsize))
        self._filled, self._rows = 0, 0
        self._correlator: Correlator | None = None
        self._most_samples = len(self._sums.way)
        self._time, self._waits = 0.0, True

    def write(self, rows: Rows) -> None:
        """Take a block of full rows, the next of the run."""
        begin = 0
        while begin < len(rows):
            count = min(len(rows) - begin, BLOCK - self._filled)
            part = rows[begin : begin + count]
            self._block[self._filled : self._filled + count].view(self._whole)[:] = part.view(self._whole)
            self._filled, begin = self._filled + count, begin + count
            if self._filled == BLOCK:
                self._take(self._block)
                self._filled = 0

    def finish(self, duration: float, waits: bool = True) -> Measures:
        """Return the measures of the run, which lasted `duration` (time since the start).

        waits: whether somebody waits for kernels to be compiled; not where the run was asked to end at once.

        Raises:
            EventsimError: where no time has passed, or less than is to be discarded.
        """
        if not duration > 0.0:
            raise EventsimError("there is nothing to measure: no time passes in this run")
        if self.discard is not None and self.discard >= duration:
            left_out = f"the first {self.discard!r} are to be left out (discard, or equilibration of the scene)"
            raise EventsimError(f"the run lasts {duration!r} only, and {left_out}")
        self._waits = waits
        if self._filled:
            self._take(self._block[: self._filled])
            self._filled = 0
        correlator = self._scales(duration, 0)
        end = max(duration, self._time)
        self._make_room(end)
        kernel = kernels(self._rows, waits)
        while not kernel.finish(end, self._plan, self._sums):
            self._drain(coarsen=True)
        self._drain()
        records = Records(
            ensemble=self.ensemble,
            plan=self._plan,
            wall_names=self._stage.wall_names,
            duration=duration,
            end=end,
            discard=self.discard,
            sums=self._sums,
            correlations=correlator.result(),
            profile=None if self._profiler is None else self._profiler.result(),
            groups=self._groups.count,
        )
        measures = measures_of(records)
        if self._steps is not None:
            rows = f"contacts are as the engine {self._steps} found them, at the ends of its steps"
            measures = replace(measures, doubts=(*measures.doubts, rows))
        return measures

    def _take(self, rows: Rows) -> None:
        """Take up a block of the meter's own."""
        time = rows["epoch"] * self._stage.epoch_length + rows["remainder"]
        time = np.maximum.accumulate(np.maximum(time, self._time))  # logged times may step back by an ulp
        self._scales(float(time[-1]), len(rows))
        self._rows += len(rows)
        pairs = rows["kind"] == Kind.PAIR
        self._groups.add(rows["a"][pairs].astype(np.intp), rows["b"][pairs].astype(np.intp))
        kernel = kernels(self._rows, self._waits)
        self._hold(kernel)
        self._time = float(time[-1])
        self._make_room(self._time)
        block = sums.Block(time, *(rows[name] for name in sums.Block._fields[1:]))
        told = np.stack([rows[name] for name in SPINS], axis=1) if has_spins(rows) else None
        done, facing = 0, self._pull.directions(rows)
        while (done := kernel.take(block, done, self._plan, self._sums, told, facing)) < len(rows):
            self._drain(coarsen=True)
        self._drain()

    @property
    def kinetic_energies(self) -> tuple[float, float] | None:
        """Kinetic energy at the start and after the rows so far; None under gravity, where it changes in flight."""
        return None if self.scene.gravity is not None else (self.ensemble.start_energy, float(self._sums.numbers[sums.HEAT]))

    def _hold(self, kernel: Kernels) -> None:
        """Make rates and energy anew from the velocities: sums of changes lose digits where a gas has cooled."""
        numbers = self._sums.numbers
        energy = kernel.hold_all(self._plan, self._sums, max(self._time - numbers[sums.ORIGIN], 0.0))
        if self.scene.gravity is None:
            numbers[sums.HEAT] = energy

    def _scales(self, end: float, rows: int) -> Correlator:
        """Return the correlator; width of bins and interval of samples are made from the pace of the first block."""
        if self._correlator is None:
            numbers = self._sums.numbers
            span = end - numbers[sums.ORIGIN] if end > numbers[sums.ORIGIN] else end if end > 0.0 else 1.0
            numbers[sums.WIDTH] = span / FIRST_BINS
            movers = max(int(self.ensemble.movers.sum()), 1)
            flight = (end if end > 0.0 else 1.0) * movers / max(2 * rows, 1)
            self._correlator = Correlator(flight / SAMPLES_PER_FLIGHT)
            numbers[sums.INTERVAL] = self._correlator.interval
            usual = MORE_SAMPLES * span / self._correlator.interval
            self._most_samples = int(min(max(usual, 4.0), float(len(self._sums.way))))
            self._hold(kernels(rows, self._waits))
        return self._correlator

    def _make_room(self, end: float) -> None:
        """Take samples half as often until those that are due up to a time fit into the buffer."""
        numbers, counts = self._sums.numbers, self._sums.counts
        while (end - numbers[sums.ORIGIN]) / numbers[sums.INTERVAL] - counts[sums.SAMPLED] > self._most_samples:
            self._drain(coarsen=True)

    def _drain(self, coarsen: bool = False) -> None:
        """Add the samples that are in the buffer; coarsen: take them half as often from here on."""
        assert self._correlator is not None
        numbers, counts = self._sums.numbers, self._sums.counts
        filled = int(counts[sums.FILLED])
        if filled:
            way, velocity = self._sums.way[:filled], self._sums.velocity[:filled]
            taken = int(counts[sums.SAMPLED])
            times = numbers[sums.INTERVAL] * np.arange(taken - filled, taken, dtype=np.float64)
            drift = self.ensemble.drift  # diffusion is motion about the common one
            moved = way[:, self._correlated] - times[:, None, None] * drift
            self._correlator.add(moved, velocity[:, self._correlated] - drift)
            if self.ensemble.angular_momentum is not None:
                self._add_rotation(times, way)
            if self._profiler is not None:
                self._profiler.add(times, float(numbers[sums.INTERVAL]), way, velocity)
        counts[sums.FILLED] = 0
        if coarsen:
            self._correlator.coarsen()
            numbers[sums.INTERVAL] *= 2.0
            counts[sums.SAMPLED] = -(-int(counts[sums.SAMPLED]) // 2)

    def _add_rotation(self, times: Floats, way: Floats) -> None:
        """Add the energy of the common rotation, L^2 / 2 I, at the times of samples."""
        turning = self.ensemble.angular_momentum
        assert turning is not None
        watched = self._sums.watched
        mass = self._sums.disks[watched, sums.MASS]
        arm = way + (self.scene.disks.position[watched] - np.array(self.ensemble.middle))
        inertia = np.einsum("swk,swk,w->s", arm, arm, mass) * (self.ensemble.total_mass / mass.sum())
        bins = self._sums.bins
        place = np.minimum((times / self._sums.numbers[sums.WIDTH]).astype(np.int64), len(bins) - 1)
        np.add.at(bins[:, sums.ROTATION], place, 0.5 * turning * (turning / inertia))
        np.add.at(bins[:, sums.SAMPLES], place, 1.0)


def _thermal_speed(ensemble: Ensemble) -> float:
    """Of a unit mass, at the start; where there is no temperature, the root mean square of all speeds."""
    start = ensemble.temperature(ensemble.start_energy) if ensemble.n else math.nan
    if start > 0.0 and not ensemble.drowned:
        return math.sqrt(start)
    if ensemble.n:
        return 1.0
    speed2 = (ensemble.scene.disks.velocity[ensemble.movers] ** 2).sum(axis=1)
    return math.sqrt(float(speed2.mean())) or 1.0


def _disks(stage: Stage, ensemble: Ensemble) -> Floats:
    """The disks (N, DISK_COLUMNS) as sums know them, at the start."""
    mass = np.where(ensemble.counted, ensemble.scene.disks.mass, 0.0)
    thermal = _thermal_speed(ensemble) / np.sqrt(np.where(mass > 0.0, mass, 1.0))
    falls = np.ones(stage.n) if stage.mass is None else np.isfinite(stage.mass).astype(np.float64)
    disks = np.zeros((stage.n, sums.DISK_COLUMNS))
    disks[:, sums.VX], disks[:, sums.VY], disks[:, sums.LIES_ON] = stage.vx, stage.vy, -1.0
    disks[:, sums.MASS], disks[:, sums.RADIUS], disks[:, sums.SPECIES] = mass, stage.radius, ensemble.species_of
    for column, fall, pull in zip(
        (sums.GX, sums.GY), (sums.FALL_X, sums.FALL_Y), stage.gravity or (0.0, 0.0), strict=True
    ):
        disks[:, column] = disks[:, fall] = falls * pull
    disks[:, sums.SCALE] = sums.SPEED_BINS / (FASTEST * thermal)
    return disks


def _spins(stage: Stage, ensemble: Ensemble) -> Floats:
    """The spins of disks at the start, and their moments of inertia; (0, 2) where they have none."""
    if stage.spin is None or stage.moment is None:
        return np.zeros((0, 2))
    mass = np.where(ensemble.counted, ensemble.scene.disks.mass, 0.0)
    return np.stack([stage.spin, stage.moment * mass * stage.radius**2], axis=1)


def _sums(scene: Scene, stage: Stage, ensemble: Ensemble, plan: sums.Plan, watched: NDArray[np.intp]) -> sums.Sums:
    """Empty sums, with the disks at the start of the run."""
    numbers, counts = np.zeros(sums.NUMBERS), np.zeros(sums.COUNTS, dtype=np.int64)
    numbers[sums.HEAT], counts[sums.STRIDE] = ensemble.start_energy, 1
    channels, room = sums.channels_of(plan), max(MOST_SAMPLED // len(watched), 4)
    return sums.Sums(
        disks=_disks(stage, ensemble),
        walls=described_walls(scene, stage, ensemble),
        bins=np.zeros((sums.MOST_BINS, channels)),
        rates=np.zeros(channels),
        since=np.zeros(channels),
        numbers=numbers,
        counts=counts,
        points=np.zeros((sums.MOST_POINTS, sums.POINT_COLUMNS)),
        watched=watched.astype(np.int64),
        way=np.zeros((room, len(watched), 2)),
        velocity=np.zeros((room, len(watched), 2)),
        spins=_spins(stage, ensemble),
    )


def measure(log: AnyLog, discard: float | None = None, profile: str | None = None) -> Measures:
    """Measure the run that a log tells, block by block; a compact log is expanded first.

    discard, profile: as of Meter.  Raises EventsimError where there is nothing to measure, LogError for a log without an end.
    """
    return _measured(log.provenance, log.blocks(), discard, profile)


def measure_file(
    path: str | PathLike[str], discard: float | None = None, profile: str | None = None
) -> tuple[Measures, Provenance]:
    """Measure the run that a log file tells, block by block: a full log of any length in the same memory.

    discard, profile, errors: as of `measure`.  The provenance is that of the log.
    """
    provenance, blocks = stream_log(path)
    return _measured(provenance, blocks, discard, profile), provenance


def _measured(provenance: Provenance, blocks: Iterable[Rows], discard: float | None, profile: str | None) -> Measures:
    meter = Meter(provenance.scene, discard, provenance.kicks, profile, provenance.engine, provenance.corner)
    return meter.finish(handed_on(provenance, blocks, meter.write))


def handed_on(provenance: Provenance, blocks: Iterable[Rows], write: Callable[[Rows], None]) -> float:
    """Hand the blocks of a log on to who measures; how long its run lasted, as far as it tells (time since the start)."""
    length, latest = provenance.epoch_length, 0.0
    for rows in blocks:
        if len(rows):
            write(rows)
            latest = max(latest, float((rows["epoch"] * length + rows["remainder"]).max()))
    ending = provenance.ending
    return latest if ending is None else ending.epoch * length + ending.remainder

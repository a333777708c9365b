"""Mean squared displacement and velocity autocorrelation over all lags, in constant memory.

The order-n scheme without averaging: level l keeps the last few samples that are 2^l apart, so lags grow like powers of two.
Source: D. Dubbeldam, D. C. Ford, D. E. Ellis, R. Q. Snurr, Mol. Simul. 35, 1084 (2009), doi:10.1080/08927020902818039.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from eventsim.measure.plain import plain
from eventsim.record.events import Floats

LAGS_PER_LEVEL = 8
MOST_LEVELS = 40
FEWEST_ORIGINS = 4
"""Non-overlapping stretches of the run that a lag must have."""

FROM_LAG, TO_LAG = 10.0, 40.0
"""Lags, in mean free times, between which the mean squared displacement is taken to be a line."""


class Correlations(NamedTuple):
    """Arrays (lags,): lag, time; mean squared displacement, length^2, and its error; <v(0) v(t)> and its error."""

    lag: Floats
    msd: Floats
    msd_error: Floats
    vacf: Floats
    vacf_error: Floats

    @property
    def diffusion(self) -> Floats:
        """D against the lag (lags,): the slope of <r^2> / 4 from half the lag to the lag; NaN where there is no half."""
        half, known = self._half()
        return np.where(known, (self.msd - self.msd[half]) / (2.0 * self.lag), np.nan)

    @property
    def diffusion_error(self) -> Floats:
        """The standard error of `diffusion`."""
        # the displacement at half the lag is part of that at the lag: their errors do not add
        return np.where(self._half()[1], self.msd_error / (2.0 * self.lag), np.nan)

    def _half(self) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
        """(Index of half of each lag, whether there is such a lag)."""
        half = np.minimum(np.searchsorted(self.lag, 0.5 * self.lag), max(len(self.lag) - 1, 0))
        return half, self.lag[half] == 0.5 * self.lag

    def to_dict(self) -> dict[str, list[float | None]]:
        """As plain data."""
        told = {**self._asdict(), "diffusion": self.diffusion, "diffusion_error": self.diffusion_error}
        return {name: plain(array) for name, array in told.items()}


class Correlator:
    """Correlates samples that are `interval` apart; each is displacement and velocity (W, 2) of the watched disks."""

    def __init__(self, interval: float) -> None:
        self.interval = interval
        # squares of squared displacements are sums of floats in a unit of length that speeds, which are moderate, make here
        self._unit = max(int(np.frexp(interval)[1]), -1000)  # 2^1000 is a float
        self._taken = [0] * MOST_LEVELS
        self._kept: list[tuple[Floats, Floats] | None] = [None] * MOST_LEVELS
        # per level and lag: number of origins, sums and sums of squares of both means over disks
        self._sums = np.zeros((MOST_LEVELS, LAGS_PER_LEVEL + 1, 5))

    def add(self, way: Floats, velocity: Floats) -> None:
        """Add samples (S, W, 2)."""
        way = way * 2.0**-self._unit
        for level in range(MOST_LEVELS):
            if not len(way):
                return
            self._add_level(level, way, velocity)
            # every second sample of the level goes one level up, whatever the cut into blocks
            begin = self._taken[level] % 2
            self._taken[level] += len(way)
            way, velocity = way[begin::2], velocity[begin::2]

    def coarsen(self) -> None:
        """Double the interval: every second sample is left out from here on, and what was summed stays."""
        first, half = self._sums[0].copy(), LAGS_PER_LEVEL // 2
        self.interval *= 2.0
        self._sums = np.concatenate([self._sums[1:], np.zeros_like(self._sums[:1])])
        self._sums[0, 1 : half + 1] += 0.5 * first[2::2]  # at twice as many starts as will follow
        self._taken = [*self._taken[1:], 0]
        self._kept = [*self._kept[1:], None]

    def _add_level(self, level: int, way: Floats, velocity: Floats) -> None:
        kept = self._kept[level]
        if kept is not None:
            way, velocity = np.concatenate([kept[0], way]), np.concatenate([kept[1], velocity])
        old = 0 if kept is None else len(kept[0])
        for step in range(1 if level == 0 else LAGS_PER_LEVEL // 2 + 1, LAGS_PER_LEVEL + 1):
            low = max(old, step)
            if low >= len(way):
                continue
            moved = way[low:] - way[low - step : len(way) - step]
            squared = np.einsum("swk,swk->s", moved, moved) / way.shape[1]
            product = np.einsum("swk,swk->s", velocity[low:], velocity[low - step : len(way) - step]) / way.shape[1]
            self._sums[level, step] += (
                len(squared), squared.sum(), (squared**2).sum(), product.sum(), (product**2).sum(),
            )  # fmt: skip
        self._kept[level] = way[-LAGS_PER_LEVEL:].copy(), velocity[-LAGS_PER_LEVEL:].copy()

    def result(self) -> Correlations:
        """The averages over all origins.  Origins less than a lag apart overlap, so they count as one for the error."""
        levels, steps = np.nonzero(self._sums[:, :, 0] >= FEWEST_ORIGINS * np.arange(LAGS_PER_LEVEL + 1).clip(1))
        order = np.argsort(steps * 2.0**levels)
        levels, steps = levels[order], steps[order]
        origins, d1, d2, v1, v2 = self._sums[levels, steps].T
        means, errors = [], []
        for first, second in ((d1, d2), (v1, v2)):
            mean = first / origins
            spread = np.maximum(second / origins - mean * mean, 0.0)
            means.append(mean)
            errors.append(np.sqrt(spread / np.maximum(origins / steps - 1.0, 1.0)))
        with np.errstate(over="ignore", under="ignore"):  # areas may be no floats in the scene's unit: inf or 0
            msd, msd_error = (np.ldexp(area, 2 * self._unit) for area in (means[0], errors[0]))
        return Correlations(steps * 2.0**levels * self.interval, msd, msd_error, means[1], errors[1])


class Slope(NamedTuple):
    """D and its standard error, and the lags, time, that it was read between."""

    value: float
    error: float
    first: float
    last: float


def diffusion(correlations: Correlations, free_time: float, widest: float) -> Slope | None:
    """D from the slope 4 D of the mean squared displacement; None where there are too few lags.

    free_time: mean, of disks.  widest: displacements beyond it, root mean square, are left out; length.
    """
    lag, msd = correlations.lag, correlations.msd
    early = np.isfinite(msd) & (msd <= widest * widest)
    usable = early & (lag >= FROM_LAG * free_time) & (lag <= TO_LAG * free_time)
    if usable.sum() < 2:
        return None
    first, last = np.flatnonzero(usable)[[0, -1]]
    span = 4.0 * (lag[last] - lag[first])
    # the displacement at the short lag is part of that at the long one: their errors do not add
    return Slope(
        float((msd[last] - msd[first]) / span),
        float(correlations.msd_error[last] / span),
        float(lag[first]),
        float(lag[last]),
    )

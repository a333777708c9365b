"""Sums by time, in constant memory: bins of equal width that are merged in pairs when there are too many."""

from __future__ import annotations

import numpy as np

from eventsim.record.events import Column, Floats

MOST_BINS = 2048
FIRST_BINS = 64
"""Bins into which the first block of rows is cut: from there on the width only doubles."""


class Series:
    """Sums of several channels over bins of time since the start, (bins, channels); at most `MOST_BINS` bins."""

    def __init__(self, channels: int, width: float) -> None:
        """width: of a bin, time; doubled as often as needed."""
        self.width = width
        self._sums = np.zeros((MOST_BINS, channels))

    def add(self, channel: Column | int, time: Floats, amount: Floats) -> None:
        """Add amounts (n,) to channels (n,) or one for all, in the bins of their times (n,)."""
        if not len(time):
            return
        self._reach(float(time.max()))
        place = np.minimum((time / self.width).astype(np.int64), MOST_BINS - 1)
        low, high = int(place.min()), int(place.max()) + 1
        channels = self._sums.shape[1]
        if isinstance(channel, int):
            self._sums[low:high, channel] += np.bincount(place - low, amount, high - low)
            return
        flat = np.bincount((place - low) * channels + channel, amount, (high - low) * channels)
        self._sums[low:high] += flat.reshape(-1, channels)

    def add_spread(self, channel: Column, begin: Floats, end: Floats, amount: Floats) -> None:
        """Add amounts (n,), not negative, to channels (n,), evenly spread between times (n,), cut exactly where bins end."""
        if not len(end):
            return
        self._reach(float(end.max()))
        low, high = (np.minimum((at / self.width).astype(np.int64), MOST_BINS - 1) for at in (begin, end))
        span = end - begin
        rate = np.divide(amount, span, out=np.zeros_like(amount), where=span > 0.0)
        parts = high > low
        first = np.where(parts, rate * ((low + 1) * self.width - begin), amount)
        np.add.at(self._sums, (low, channel), first)
        if parts.any():
            low, high, channel, rate, end = low[parts], high[parts], channel[parts], rate[parts], end[parts]
            np.add.at(self._sums, (high, channel), rate * (end - high * self.width))
            lowest = int(low.min())
            steps = np.zeros((int(high.max()) - lowest + 1, self._sums.shape[1]))
            np.add.at(steps, (low + 1 - lowest, channel), rate)
            np.subtract.at(steps, (high - lowest, channel), rate)
            self._sums[lowest : lowest + len(steps)] += self.width * np.maximum(np.cumsum(steps, axis=0), 0.0)

    def add_held(self, channel: int, time: Floats, value: Floats) -> None:
        """Add value x time of values (n,) that are held between times (n + 1,), cut exactly where bins end."""
        self._reach(float(time[-1]))
        gone = np.concatenate([[0.0], np.cumsum(value * np.diff(time))])
        low, high = int(time[0] / self.width), int(time[-1] / self.width)
        edges = self.width * np.arange(low + 1, high + 1)
        parts = np.diff(np.interp(edges, time, gone), prepend=0.0, append=gone[-1])
        self._sums[low : high + 1, channel] += parts

    def whole_bins(self, until: float) -> Floats:
        """The bins (bins, channels) that end at or before a time."""
        return self._sums[: min(int(until / self.width), MOST_BINS)]

    def bin_after(self, time: float) -> int:
        """The first bin that begins at or after a time."""
        return int(np.ceil(time / self.width))

    def _reach(self, time: float) -> None:
        """Double the width until a time has a bin."""
        while time >= self.width * MOST_BINS:
            merged = self._sums.reshape(MOST_BINS // 2, 2, -1).sum(axis=1)
            self._sums[: MOST_BINS // 2] = merged
            self._sums[MOST_BINS // 2 :] = 0.0
            self.width *= 2.0

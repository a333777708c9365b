"""Error bars of correlated series: block averages, with the block length found.

Source: H. Flyvbjerg, H. G. Petersen, J. Chem. Phys. 91, 461 (1989), doi:10.1063/1.457480; the automatic choice of the block
length is M. Jonsson, Phys. Rev. E 98, 043304 (2018), doi:10.1103/PhysRevE.98.043304.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from eventsim.record.events import Floats

FEWEST_BLOCKS = 8
"""With fewer, the scatter of blocks says little about their mean; so many must be left at the chosen length."""

TRUSTED_BLOCKS = 16
"""With fewer, a test can hardly tell that neighbouring blocks are correlated."""

NORMAL_99 = 2.3263478740408408
"""The 99 % point of the normal distribution: how surprised one must be to call neighbouring blocks correlated."""


class ErrorBar(NamedTuple):
    """Mean of a series, its standard error, and how it was found.

    error: NaN where there are too few blocks.  blocks: how many were averaged.  length: of a block, in entries of the series.
    independent: whether the blocks look independent; if not, the true error is larger.
    """

    mean: float
    error: float
    blocks: int
    length: int
    independent: bool


def block_average(series: Floats) -> ErrorBar:
    """The mean of a series (n,) and its standard error; O(n).

    Neighbours are averaged pairwise again and again.  The block length is the shortest from which on all longer ones agree
    that neighbouring blocks are uncorrelated (a chi-squared test at 1 %).
    """
    mean = float(series.mean()) if len(series) else math.nan
    if len(series) < FEWEST_BLOCKS:
        return ErrorBar(mean, math.nan, len(series), 1, independent=False)
    count, variance, surprise = [], [], []
    x = series - mean
    # in units of a power of two, in which fourth powers are floats and no bit changes
    unit = int(np.frexp(np.abs(x).max())[1])
    x = np.ldexp(x, -unit)
    while len(x) >= FEWEST_BLOCKS:
        n = len(x)
        spread = float(x.var())
        neighbours = float((x[1:] * x[:-1]).sum()) / n
        count.append(n)
        variance.append(spread)
        # n ((n-1) var / n^2 + cov)^2 / var^2: chi-squared of one degree of freedom where cov is only noise
        surprise.append(n * ((n - 1) * spread / n**2 + neighbours) ** 2 / spread**2 if spread > 0.0 else 0.0)
        x = 0.5 * (x[0 : n - n % 2 : 2] + x[1 : n - n % 2 : 2])
    total = np.cumsum(surprise[::-1])[::-1]
    levels = len(count)
    chosen = next((k for k in range(levels) if total[k] < _chi_squared_99(levels - k)), None)
    k = levels - 1 if chosen is None else chosen
    n = count[k]
    # the scatter of few blocks is itself uncertain: Student's distribution, one standard deviation's worth
    error = math.ldexp(math.sqrt(variance[k] / (n - 1)) * (1.0 + 0.5 / (n - 1)), unit)
    return ErrorBar(mean, error, n, 1 << k, independent=chosen is not None and n >= TRUSTED_BLOCKS)


def plain_average(series: Floats) -> ErrorBar:
    """The same of entries (n,) that are known to be independent, two at least."""
    return ErrorBar(float(series.mean()), math.sqrt(float(series.var(ddof=1)) / len(series)), len(series), 1, independent=True)


def errors_apart(one: ErrorBar, other: ErrorBar) -> float:
    """By how many standard errors two means differ; 0 where they have none."""
    spread = math.hypot(one.error, other.error)
    return abs(one.mean - other.mean) / spread if spread > 0.0 else 0.0


def ratio_average(above: Floats, below: Floats) -> ErrorBar:
    """sum(above) / sum(below) and its standard error, by linearisation about the ratio; series (n,)."""
    scale = float(below.mean()) if len(below) else 0.0
    if scale == 0.0:
        return ErrorBar(math.nan, math.nan, len(above), 1, independent=False)
    ratio = float(above.sum()) / float(below.sum())
    bar = block_average((above - ratio * below) / scale)
    return bar._replace(mean=ratio)


def _chi_squared_99(k: int) -> float:
    """The 99 % point of chi-squared with k degrees of freedom (Wilson and Hilferty 1931; good to 2 % from k = 1)."""
    part = 2.0 / (9.0 * k)
    return float(k * (1.0 - part + NORMAL_99 * math.sqrt(part)) ** 3)

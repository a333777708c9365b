"""Orders of convergence: the slope of error against step size, where there is one."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

SATURATED = 0.3
"""In diameters: errors above are those of a run that has lost its way, and say nothing about the step."""

ROUNDING = 1e-11
"""In diameters: errors below are rounding."""


def fitted_order(steps: Sequence[float], errors: Sequence[float]) -> float:
    """The slope of a log-log fit, from at least two points that are neither saturated nor rounding; nan without."""
    points = [
        (math.log(step), math.log(error))
        for step, error in zip(steps, errors, strict=True)
        if math.isfinite(error) and ROUNDING < error < SATURATED
    ]
    if len(points) < 2:
        return math.nan
    x, y = np.array(points).T
    return float(np.polyfit(x, y, 1)[0])

"""Positions on the scene's own axes, from positions relative to the corner of the domain."""

from __future__ import annotations

import numpy as np

from eventsim.record.events import Floats


def on_scene_axes(x: Floats, corner: float, length: float | None) -> Floats:
    """One coordinate (n,) of all disks; along a period it lies in [corner, corner + length)."""
    if length is None:
        return x + corner
    inside = np.where(x < 0.0, x + length, np.where(x >= length, x - length, x))
    shown = inside + corner
    return np.where(shown - corner < length, shown, corner)  # rounding may reach the far end

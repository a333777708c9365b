"""Invariants of a run, recomputed by brute force: slow, for tests and for `check=True`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from eventsim.engines.reference.calendar import CONTACT, Calendar
from eventsim.engines.reference.predict import Predictor
from eventsim.formulas.image import nearest_image

if TYPE_CHECKING:
    from eventsim.engines.reference.loop import ReferenceSession

DEEPEST = 1e-9
"""Overlap, in reaches, beyond which something was missed; rounding stays far below it."""


def check_invariants(session: ReferenceSession) -> None:
    """Assert that no disk overlaps, every disk is in its cell, and no contact is missing from the calendar."""
    _check_overlaps(session)
    _check_cells(session)
    _check_calendar(session)


def _check_overlaps(session: ReferenceSession) -> None:
    state, stage = session.state, session.stage
    places = [state.place(i, state.now) for i in range(state.n)]
    radius = stage.radius.tolist()
    mass = None if stage.mass is None else stage.mass.tolist()
    for i, (xi, yi) in enumerate(places):
        for j in range(i + 1, state.n):
            if mass is not None and mass[i] == mass[j] and mass[i] in (0.0, math.inf):
                continue
            dx = nearest_image(xi - places[j][0], stage.period[0])
            dy = nearest_image(yi - places[j][1], stage.period[1])
            reach = radius[i] + radius[j]
            if math.hypot(dx, dy) < reach * (1.0 - DEEPEST):
                raise AssertionError(f"disks {i} and {j} overlap: distance {math.hypot(dx, dy)!r} < {reach!r}")


def _check_cells(session: ReferenceSession) -> None:
    state, cells = session.state, session.cells
    if cells is None:
        return
    for i in range(state.n):
        for axis, x in enumerate(state.place(i, state.now)):
            low, high = cells.edges(i, axis)
            slack = 1e-9 * cells.side[axis]
            if (low is not None and x < low - slack) or (high is not None and x > high + slack):
                raise AssertionError(f"disk {i} at {x!r} has left its cell [{low}, {high}] along axis {axis}")


def _check_calendar(session: ReferenceSession) -> None:
    """The earliest contact that all pairs predict is in the calendar, unless an event that finds it comes first."""
    brute = Calendar()
    Predictor(session.stage, session.state, brute, None).predict_all(session.state.now)
    expected = next((event for event in brute if event.rank == CONTACT), None)
    if expected is None:
        return
    for event in session.calendar:
        if session.is_stale(event):
            continue
        if event == expected or event.time < expected.time or event.rank < CONTACT:
            return
        break
    raise AssertionError(f"the calendar lacks {expected}")

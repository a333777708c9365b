"""Time passes without a contact: wraps around periodic boundaries, cell crossings, the turn of the clock."""

from __future__ import annotations

from eventsim.engines.reference.calendar import Event
from eventsim.engines.reference.cells import Cells
from eventsim.engines.reference.state import EngineState
from eventsim.formulas.real import Real


def wrap(state: EngineState, cells: Cells | None, event: Event, length: float) -> None:
    """Take a disk to the other side of the domain: its coordinate becomes exactly 0 or the period."""
    i, axis, step, t = event.a, event.b, event.image[0], event.time
    x, y = state.place(i, t)
    vx, vy = state.speed(i, t)
    entry: Real = 0.0 if step > 0 else length
    if axis == 0:
        state.keep_sides(i, t, (length - entry, y), (vx, vy))
        x = entry
        state.wraps_x[i] += step
    else:
        state.keep_sides(i, t, (x, length - entry), (vx, vy))
        y = entry
        state.wraps_y[i] += step
    state.keep_sides_behind(i, axis, step)
    state.anchor(i, t, x, y, vx, vy)
    if state.support_of(i) is None:  # on this side of the domain it can meet the shape again that it met last
        state.met[i] = tuple(met for met in state.met[i] if met[0] >= -state.boundaries)
    if cells is not None:
        cells.move(i, axis, step)


def cross(cells: Cells, event: Event) -> None:
    """Take a disk into the next cell; its flight goes on untouched."""
    cells.move(event.a, event.b, event.image[0])


def refill(state: EngineState, cells: Cells) -> None:
    """Put every disk into the cell where it is now."""
    cells.clear()
    for i in range(state.n):
        cells.place(i, *state.place(i, state.now))

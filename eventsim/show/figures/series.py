"""Series: energy, temperature, pressure and collision rate along a run, against time and against the contacts of a disk.

Means over stretches of the run are steps as wide as the stretch; a line joins what is known at moments.
Source of the curve of a cooling gas: P. K. Haff, J. Fluid Mech. 134, 401 (1983), doi:10.1017/S0022112083003419.
"""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from eventsim.errors import LogError
from eventsim.measure import Measures, measure
from eventsim.measure.theory import cooling_exponent
from eventsim.record.events import Floats
from eventsim.replay.log import AnyLog
from eventsim.replay.passage import Passage
from eventsim.scene.names import plural
from eventsim.show.figures.demands import passage_with_time
from eventsim.show.figures.style import BLUE, GREEN, ORANGE, TIME, label, say_none, scale_to
from eventsim.show.frames import energies_of, energy_zero
from eventsim.show.output import name_of, span_words
from eventsim.show.palette import LIGHT

MOMENTS = 400
"""Moments, besides those of events, at which the energy of a short run is looked at."""

MOST_EVENTS = 500
"""More than these are not looked at one by one: of a longer run means over stretches are drawn."""

LEVEL = 1e-9
"""Share by which stretches of equal length differ by rounding."""

NO_OTHERS = "a disk has no others to meet"
NO_MEANING = "it has no meaning here"
PRESSURE = "N kT / area + part of contacts, not hits on walls"
"""What the curve of the pressure is."""


PANELS = ("energy", "temperature", "collision rate", "pressure")
"""What they show, in their order."""


def draw(figure: Figure, log: AnyLog) -> None:
    """Draw energy against time and temperature against contacts above, rate and pressure against time below: those there are."""
    passage = passage_with_time(log)
    measures = measure(log, discard=0.0)
    series = measures.series
    if not len(series.time):
        raise LogError("series: there is nothing to draw: no time passes")
    panels = figure.subplots(2, 2)
    time = f"time [{TIME}]" if log.scene.start_time == 0.0 else f"time since the start [{TIME}]"
    reasons = {name: measures[name].doubt for name in ("Z", "temperature") if name in measures}
    steps = [
        _draw_energy(panels[0, 0], passage, measures, time),
        _draw_temperature(panels[0, 1], log, measures, reasons.get("temperature")),
    ]
    rate = series.collision_rate if "collision_rate" in measures or not measures.disks else np.full_like(series.time, np.nan)
    steps.append(_steps(panels[1, 0], series.ends, rate, time, "contacts of a disk\nwith others / time", NO_OTHERS))
    steps.append(_steps(panels[1, 1], series.ends, series.pressure, time, "pressure", reasons.get("Z")))
    if steps[-1]:
        panels[1, 1].set_title(PRESSURE, loc="left", fontsize=8, color=LIGHT.faint)
    who = plural(measures.disks, "disk") if measures.disks else plural(measures.tracers, "tracer")
    told = f"{name_of(log)}: {who} along the run" + (f"; {steps_words(series.ends)}" if any(steps) else "")
    for why, names in _leave_out(figure, dict(zip(PANELS, panels.ravel().tolist(), strict=True))).items():
        told += f"; no {' and no '.join(names)}: {why}"
    figure.suptitle(told, fontsize=11, x=0.02, ha="left", wrap=True)


def _leave_out(figure: Figure, panels: dict[str, Axes]) -> dict[str, list[str]]:
    """Take away panels without a curve, and give the others their room; what is said of each -> the names of those."""
    empty = {name: axes for name, axes in panels.items() if not (axes.lines or axes.patches)}
    if len(empty) == len(panels):
        return {}
    left_out: dict[str, list[str]] = {}
    for name, axes in empty.items():
        left_out.setdefault(axes.texts[0].get_text().removeprefix("none: ").replace("\n", " "), []).append(name)
        figure.delaxes(axes)
    kept = [axes for name, axes in panels.items() if name not in empty]
    grid = figure.add_gridspec(1 if len(kept) < 3 else 2, min(len(kept), 2))
    for place, axes in enumerate(kept):
        axes.set_subplotspec(grid[divmod(place, grid.ncols)])
    return left_out


def steps_words(ends: Floats) -> str:
    """Say what the steps between some times are."""
    spans = np.diff(ends)
    if len(spans) > 1 and np.ptp(spans[:-1]) > LEVEL * spans.max():
        return "steps: means over stretches of equally many contacts"
    return f"steps: means over stretches of {span_words(float(spans[0]), 3)}"


def _draw_energy(axes: Axes, passage: Passage, measures: Measures, along: str) -> bool:
    """Draw the energies at moments where these tell the whole of it, else means of the kinetic energy; whether these."""
    log, series = passage.log, measures.series
    if series.start_energy is None and len(log) > MOST_EVENTS:
        return _steps(axes, series.ends, series.energy, along, "kinetic energy")
    label(axes, along, "kinetic energy", "")
    if len(log) > MOST_EVENTS:
        energy = np.concatenate([[series.start_energy], series.energy])
        axes.plot(series.ends, energy, ".-", ms=3.5, lw=1.0, color=BLUE)
        scale_to(axes, energy)
        return False
    times = moments_of(passage)
    kinetic, potential = np.array([energies_of(log, state) for state in passage.states(times.tolist())]).T
    times = times - log.scene.start_time
    axes.plot(times, kinetic, lw=1.2, color=BLUE, label="kinetic")
    zero = energy_zero(log.scene)
    if zero is None:
        scale_to(axes, kinetic)
        return False
    axes.plot(times, potential, lw=1.2, color=GREEN, label=f"potential, {zero}")
    axes.plot(times, kinetic + potential, lw=1.2, color=ORANGE, label="sum")
    axes.set_ylabel("energy")
    every = np.concatenate([kinetic, potential, kinetic + potential])
    low, high = min(float(every.min()), 0.0), max(float(every.max()), 0.0)
    room = high - low or 1.0
    axes.set_ylim(low - 0.05 * room if low < 0.0 else 0.0, high + 0.45 * room)
    axes.legend(frameon=False, fontsize=8, loc="upper right", ncols=2)
    return False


def moments_of(passage: Passage) -> Floats:
    """Return ascending times that tell all of a short run: evenly spread ones, and those just before and at each event."""
    first, last = passage.span
    events = np.concatenate([np.empty(0), *(rows["time"] for rows in passage.log.blocks())])
    times = np.concatenate([np.linspace(first, last, MOMENTS), np.nextafter(events, -np.inf), events])
    found: Floats = np.unique(np.clip(times, first, last))
    return found


def _draw_temperature(axes: Axes, log: AnyLog, measures: Measures, why: str | None) -> bool:
    """Draw the temperature at the ends of stretches, beside Haff's law, or its means; whether these."""
    series, restitution = measures.series, log.scene.restitution
    along, what = "contacts of a disk with others", "temperature kT"
    fall = measures.by_name.get("cooling_exponent")
    known = np.isfinite(series.temperature)
    if series.start_energy is None or not known.any():
        return _steps(axes, np.concatenate([[0.0], series.contacts]), series.temperature, along, what, why)
    label(axes, along, what, "")
    axes.plot(series.contacts[known], series.temperature[known], ".-", ms=3.5, lw=1.0, color=BLUE)
    scale_to(axes, series.temperature[known])
    if fall is not None and fall.theory is not None and restitution is not None:
        start = float(series.temperature[0]) * np.exp(fall.theory * series.contacts[0])
        axes.plot(
            series.contacts,
            start * np.exp(-cooling_exponent(restitution.pair) * series.contacts),
            color=ORANGE, lw=1.3, label="Haff",
        )  # fmt: skip
        axes.legend(frameon=False)
    return False


def _steps(axes: Axes, ends: Floats, y: Floats, along: str, what: str, why: str | None = None) -> bool:
    """Draw means (K,) over stretches between ends (K + 1,) as steps; whether any is known, else `why` is written."""
    label(axes, along, what, "")
    known = np.isfinite(y)
    if not known.any():
        say_none(axes, f"none: {why or NO_MEANING}")
        return False
    axes.stairs(y, ends, baseline=None, lw=1.2, color=BLUE)
    scale_to(axes, y[known])
    return True

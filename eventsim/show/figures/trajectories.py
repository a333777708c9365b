"""Trajectories: the paths of the disks through the scene, their contacts marked."""

from __future__ import annotations

import numpy as np
from matplotlib.axis import Axis
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from matplotlib.patches import Rectangle as Box
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from eventsim.record.events import Floats
from eventsim.replay.flight_table import flights, together
from eventsim.replay.log import AnyLog
from eventsim.scene.names import plural
from eventsim.show import outlines
from eventsim.show.colouring import own_colours
from eventsim.show.figures.demands import passage_with_time
from eventsim.show.figures.style import LENGTH, SIZE, label
from eventsim.show.images import lines_with_images, wrapped_pieces
from eventsim.show.output import name_of
from eventsim.show.palette import LIGHT
from eventsim.show.window import window_of

MOST_DISKS = 16
"""More ways than these cannot be told apart: of larger scenes some disks are drawn, evenly spread over the list."""

MOST_EVENTS = 50_000
"""Of a longer run the beginning is drawn: of more events nothing but ink would be seen."""

TALLEST, NARROWEST, LABELS = 6.4, 4.6, 0.8
"""Inches: of the scene in a figure, of a figure, and what labels take."""

FLAT, SLIM = 0.6, 1.2
"""Inches of a side on which numbers above each other, or beside each other, would overlap."""


def draw(figure: Figure, log: AnyLog) -> None:
    """Draw the paths of up to MOST_DISKS disks; dots are their events, rings the disks at the start, circles those at the end."""
    passage = passage_with_time(log)
    scene, n = log.scene, passage.stage.n
    disks = np.unique(np.linspace(0, n - 1, min(n, MOST_DISKS)).astype(np.int64))
    until, events = _drawn_until(log, disks)
    table = together([part.of(disks) for part in flights(passage, until)])
    shades = own_colours(scene.disks)
    _, ends, disk = table.pieces()
    ends, disk = wrapped_pieces(ends, disk, scene.domain.period, scene.domain.origin)
    shown = window_of(passage, until)
    figure.set_size_inches(*inches_for(shown))
    axes = figure.add_subplot(aspect="equal")
    axes.set(xlim=(shown[0], shown[2]), ylim=(shown[1], shown[3]))
    ways = LineCollection(list(ends), colors=shades[disk], linewidths=0.9, alpha=0.75)
    axes.add_collection(ways, autolim=False)
    if scene.domain.size is not None:
        inside = Box(scene.domain.origin, *scene.domain.size, transform=axes.transData)
        ways.set_clip_path(inside)
    hit = ~table.first
    axes.scatter(
        table.place[hit, 0],
        table.place[hit, 1],
        s=7,
        c=shades[table.disk[hit]],
        edgecolors="white",
        linewidths=0.3,
        zorder=3,
    )
    last = passage.final() if until is None else next(passage.states([until]))
    at_end = last.position[disks]
    at_start = scene.disks.position[disks]
    rings, circles = (_circles(places, scene.disks.radius[disks]) for places in (at_start, at_end))
    axes.add_collection(
        PatchCollection(rings, facecolor="none", edgecolor=shades[disks], linewidth=0.9, linestyle="dashed", zorder=3.5)
    )
    axes.add_collection(
        PatchCollection(circles, facecolor=shades[disks], edgecolor=LIGHT.edge, linewidth=0.6, alpha=0.9, zorder=4)
    )
    hard, open_ = outlines.boundary_lines(scene)
    walls = [*lines_with_images(outlines.wall_lines(scene), scene), *hard]
    axes.add_collection(LineCollection(walls, colors=LIGHT.wall, linewidths=1.6), autolim=False)
    axes.add_collection(LineCollection(open_, colors=LIGHT.wall, linewidths=1.0, linestyles="dashed"), autolim=False)
    told = plural(events, "event") if until is None else f"until t = {until:.6g}: the first {events:,} events"
    some = f"disks {', '.join(map(str, disks[:3]))}, ..., {disks[-1]} ({len(disks)} of {n})"
    which = some if len(disks) < n else "all disks" if n > 1 else "the disk"
    label(
        axes,
        f"x [{LENGTH}]",
        f"y [{LENGTH}]",
        f"{name_of(log)}: the paths of {which}, {told} (dots); dashed: the start",
    )
    axes.grid(visible=False)
    width, height = sides_of(shown)
    if height < FLAT:
        _keep_one_tick(axes.yaxis, shown[1], shown[3])
    if width < SLIM:
        _keep_one_tick(axes.xaxis, shown[0], shown[2])


def _circles(places: Floats, radii: Floats) -> list[Circle]:
    return [Circle((x, y), r) for (x, y), r in zip(places.tolist(), radii.tolist(), strict=True)]


def _drawn_until(log: AnyLog, disks: NDArray[np.int64]) -> tuple[float | None, int]:
    """Return until when a figure shows the ways of some disks, None: to the end; and how many events they have by then."""
    events = 0
    for rows in log.blocks():
        theirs = np.flatnonzero(np.isin(rows["a"], disks) | np.isin(rows["b"], disks))
        if events + len(theirs) > MOST_EVENTS:
            return float(rows["time"][theirs[MOST_EVENTS - events]]), MOST_EVENTS
        events += len(theirs)
    return None, events


def inches_for(shown: outlines.Rectangle) -> tuple[float, float]:
    """Return the size of a figure that a rectangle of the scene fills, labels included."""
    aspect = (shown[3] - shown[1]) / (shown[2] - shown[0])
    width = min(max(TALLEST / aspect, NARROWEST), SIZE[0])
    return width, min(max((width - LABELS) * aspect, 1.0), TALLEST) + LABELS


def sides_of(shown: outlines.Rectangle) -> tuple[float, float]:
    """Return about how many inches wide and high the rectangle itself is drawn."""
    width, height = (side - LABELS for side in inches_for(shown))
    aspect = (shown[3] - shown[1]) / (shown[2] - shown[0])
    return min(width, height / aspect), min(height, width * aspect)


def _keep_one_tick(axis: Axis, low: float, high: float) -> None:
    """Label one place of an axis that is too short for more, a round number near its middle."""
    middle = 0.5 * (low + high)
    axis.set_ticks([min(MaxNLocator(2).tick_values(low, high), key=lambda tick: abs(tick - middle))])

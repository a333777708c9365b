"""Raster: a mark for every event of every disk, against time."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from eventsim.record.events import Kind
from eventsim.replay.log import AnyLog
from eventsim.show.figures.demands import passage_with_time, with_events
from eventsim.show.figures.marks import Marks
from eventsim.show.figures.style import BLUE, GREEN, ORANGE, TIME, label
from eventsim.show.output import name_of

MARKS = {
    Kind.PAIR: (BLUE, "|"),
    Kind.WALL: (ORANGE, "|"),
    Kind.REST: (GREEN, "o"),
    Kind.KICK: ("#D55E00", "^"),
}
BINS = 100
"""Of the time, in which events are counted."""

BINS = 100
"""Of the time, in which events are counted."""

MOST_VECTORS = 20_000
"""More marks than these are put into an svg or pdf as pixels."""


def draw(figure: Figure, log: AnyLog) -> None:
    """Draw the raster, and above it how many events there were in each hundredth of the time."""
    with_events(log)
    span = passage_with_time(log).span
    n = len(log.scene.disks)
    over, axes = figure.subplots(2, 1, sharex=True, height_ratios=[1, 4])
    handles = []
    height = min(max(200.0 / n, 0.8), 12.0)
    marks = {kind: Marks(span, (-0.5, n - 0.5), n) for kind in Kind}
    edges = np.linspace(*span, BINS + 1)
    counts, of_kind = np.zeros(BINS), np.zeros(len(Kind), np.int64)
    for rows in log.blocks():
        pairs = rows["b"] >= 0
        time = np.concatenate([rows["time"], rows["time"][pairs]])
        disk = np.concatenate([rows["a"], rows["b"][pairs]])
        what = np.concatenate([rows["kind"], rows["kind"][pairs]])
        for kind, dots in marks.items():
            dots.add(time[what == kind], disk[what == kind])
        counts += np.histogram(rows["time"], bins=edges)[0]
        of_kind += np.bincount(rows["kind"], minlength=len(Kind))
    for kind in Kind:
        if not of_kind[kind]:
            continue
        colour, marker = MARKS[kind]
        handles.append(Line2D([], [], color=colour, marker="s", ls="none", label=f"{kind.label}: {of_kind[kind]:,}"))
        axes.plot(
            *marks[kind].drawn(), marker, color=colour, markersize=height, markeredgewidth=0.9, linestyle="none",
            rasterized=marks[kind].count > MOST_VECTORS,
        )  # fmt: skip
    over.stairs(counts / (edges[1] - edges[0]), edges, color="#39424e", fill=True, alpha=0.35)
    label(over, "", "events per\ntime unit", f"{name_of(log)}: {len(log):,} events of {n:,} disks")
    label(axes, f"time [{TIME}]", "disk", "")
    axes.set(xlim=span, ylim=(-0.7, n - 0.3))
    axes.grid(visible=False)
    if n <= 20:
        axes.set_yticks(range(n))
    figure.legend(handles=handles, loc="outside lower right", ncols=4, frameon=False, fontsize=9)

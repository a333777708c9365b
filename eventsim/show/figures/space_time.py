"""Space-time: where along a line every disk is, against time."""

from __future__ import annotations

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from eventsim.record.events import Kind
from eventsim.replay.flight_table import flights, together
from eventsim.replay.log import AnyLog
from eventsim.scene.names import plural
from eventsim.show.colouring import FEW, own_colours
from eventsim.show.figures.demands import passage_with_time
from eventsim.show.figures.style import LENGTH, TIME, label
from eventsim.show.images import wrapped_pieces
from eventsim.show.output import name_of
from eventsim.show.window import window_of

MOST_VECTORS = 20_000
MOST_CONTACTS = 800
"""Of a longer run the beginning is drawn, up to this many contacts: more cannot be told apart."""


def draw(figure: Figure, log: AnyLog) -> None:
    """Draw the coordinate along which the disks spread most; dots are contacts of two disks."""
    passage = passage_with_time(log)
    begin, end = passage.span
    pairs, every, last = 0, 0, end
    for rows in log.blocks():
        hits, seen = np.flatnonzero(rows["kind"] == Kind.PAIR), int(np.isin(rows["kind"], (Kind.PAIR, Kind.WALL)).sum())
        if pairs <= MOST_CONTACTS < pairs + len(hits):
            last = min(last, float(rows["time"][hits[MOST_CONTACTS - pairs]]))
        if every <= MOST_VECTORS < every + seen:
            last = min(last, float(rows["time"][MOST_VECTORS - every]))
        pairs, every = pairs + len(hits), every + seen
    until, end = (None, end) if last == end else (last, last)
    scene, table = log.scene, together(list(flights(passage, until)))
    time, ends, disk = table.pieces()
    spread = np.ptp(table.place if scene.domain.size is not None else ends.reshape(-1, 2), axis=0)
    axis = int(spread[1] > spread[0])
    lines = np.stack([time, ends[:, :, axis]], axis=2)
    period = scene.domain.period[axis]
    lines, disk = wrapped_pieces(lines, disk, (None, period), (0.0, scene.domain.origin[axis]))
    axes = figure.add_subplot()
    axes.add_collection(
        LineCollection(
            list(lines), colors=own_colours(scene.disks)[disk], linewidths=1.0, rasterized=len(lines) > MOST_VECTORS
        ),
        autolim=False,
    )
    axes.plot(table.time[table.pair], table.place[table.pair, axis], ".", ms=2.5, color="#1b1f24")
    shown = window_of(passage, until)
    axes.set(xlim=(begin, end), ylim=(shown[axis], shown[axis + 2]))
    if scene.domain.size is not None:
        for edge in (scene.domain.origin[axis], scene.domain.origin[axis] + scene.domain.size[axis]):
            axes.axhline(edge, color="#39424e", lw=1.2, ls="--" if scene.domain.periodic[axis] else "-")
    drawn = int(table.pair.sum()) // 2
    which = f"{pairs:,}" if drawn == pairs else f"the first {drawn:,} of {pairs:,}"
    told = f", {which} of them between disks (dots)" if pairs else ""
    label(
        axes, f"time [{TIME}]", f"{'xy'[axis]} [{LENGTH}]",
        f"{name_of(log)}: {plural(passage.stage.n, 'disk')}, {plural(every, 'contact')}{told}",
    )  # fmt: skip
    if 1 < passage.stage.n <= FEW:
        keys = [Line2D([], [], color=colour) for colour in own_colours(scene.disks)]
        axes.legend(keys, [f"disk {k}" for k in range(passage.stage.n)], frameon=False, fontsize="small", loc="upper right")
    axes.grid(visible=False)

"""Residuals: what ought to be conserved, and how deep disks overlapped at their contacts, over time."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from matplotlib.figure import Figure

from eventsim.record.events import Floats, Kind
from eventsim.replay.log import AnyLog
from eventsim.replay.motion import Motion
from eventsim.show.figures.demands import passage_with_time
from eventsim.show.figures.marks import Marks
from eventsim.show.figures.style import BLUE, ORANGE, TIME, label
from eventsim.show.frames import energy_of
from eventsim.show.output import name_of

SAMPLES = 400
MOST_VECTORS = 20_000
"""More dots than these are put into an svg or pdf as pixels."""


def draw(figure: Figure, log: AnyLog) -> None:
    """Draw the relative change of energy above, the gap of each pair at its contact, in reaches, below."""
    passage = passage_with_time(log)
    times = np.linspace(*passage.span, SAMPLES)
    energy = np.array([energy_of(log, state) for state in passage.states(times.tolist())])
    above, below = figure.subplots(2, 1, sharex=True)
    scale = energy[0] or 1.0
    lossy = log.scene.restitution is not None or any((rows["kind"] == Kind.KICK).any() for rows in log.blocks())
    change = energy / scale if lossy else energy / scale - 1.0
    above.plot(times, change, color=BLUE, lw=1.2)
    least, most = math.inf, -math.inf
    for _, gap in gaps_at_contact(passage):
        least, most = float(gap.min(initial=least)), float(gap.max(initial=most))
    dots = Marks(passage.span, (least, most))
    for time, gap in gaps_at_contact(passage):
        dots.add(time, gap)
    below.plot(*dots.drawn(), ".", ms=2.5, color=ORANGE, rasterized=dots.count > MOST_VECTORS)
    if lossy:
        said = f"energy ends at {change[-1]:.3g} of itself"
        if change.min() > 0.0 and change[-1] < 0.1:
            above.set_yscale("log")
        else:
            above.set_ylim(0.0, None)
    else:
        said = f"energy keeps to {np.abs(change).max():.1g}"
    deepest = max(-least, 0.0) if dots.count else 0.0
    name = name_of(log)
    label(
        above,
        "",
        "energy / start" if lossy else "energy / start \N{MINUS SIGN} 1",
        f"{name}: {said}, overlaps to {deepest:.1g}",
    )
    label(below, f"time [{TIME}]", "gap at contact\n[sum of radii]", "")
    below.axhline(0.0, color="#39424e", lw=0.8)
    below.set_xlim(passage.span)
    if not dots.count:
        below.text(0.5, 0.5, "no pair contacts", transform=below.transAxes, ha="center", va="center", color="#5b6570")


def gaps_at_contact(motion: Motion) -> Iterator[tuple[Floats, Floats]]:
    """Yield the times (K,) of pair contacts and the gaps there, in reaches, block by block; what an exact contact has is 0."""
    radius = motion.log.scene.disks.radius
    for block in motion.log.blocks():
        rows = block[block["kind"] == Kind.PAIR]
        apart = motion.stage.nearest(np.stack([rows["xa"] - rows["xb"], rows["ya"] - rows["yb"]], axis=-1))
        reach = radius[rows["a"]] + radius[rows["b"]]
        wide = reach > 0.0  # two points have no reach to measure by
        yield rows["time"][wide], (np.hypot(*apart.T) - reach)[wide] / reach[wide]

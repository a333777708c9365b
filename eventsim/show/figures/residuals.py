"""Residuals: what ought to be conserved, and how deep disks overlapped at their contacts, over time."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from eventsim.engines import base
from eventsim.record.events import Floats, Kind, State
from eventsim.replay.log import AnyLog
from eventsim.replay.motion import Motion
from eventsim.replay.passage import Passage
from eventsim.runner.residuals import energy_change, keeps_energy
from eventsim.scene.stage import Stage
from eventsim.show.figures.demands import passage_with_time
from eventsim.show.figures.marks import Marks
from eventsim.show.figures.style import BLUE, ORANGE, TIME, label, scale_to
from eventsim.show.frames import energy_name, energy_of, energy_zero, has_height
from eventsim.show.output import name_of
from eventsim.show.palette import LIGHT

SAMPLES = 400
MOST_VECTORS = 20_000
"""More dots than these are put into an svg or pdf as pixels."""


def draw(figure: Figure, log: AnyLog) -> None:
    """Draw the energy, or its change where contacts keep it, above; the gap of each pair at its contact, in reaches, below."""
    passage = passage_with_time(log)
    times = np.linspace(*passage.span, SAMPLES)
    above, below = figure.subplots(2, 1, sharex=True)
    said = _draw_energy(above, passage, times)
    least, most = math.inf, -math.inf
    for _, gap in gaps_at_contact(passage):
        least, most = float(gap.min(initial=least)), float(gap.max(initial=most))
    dots = Marks(passage.span, (least, most))
    for time, gap in gaps_at_contact(passage):
        dots.add(time, gap)
    below.plot(*dots.drawn(), ".", ms=2.5, color=ORANGE, rasterized=dots.count > MOST_VECTORS)
    deepest = f"; overlaps to {-least:.1g}" if least < 0.0 else "; no overlaps" if dots.count else ""
    above.set_title(f"{name_of(log)}: {said}{deepest}", loc="left", fontsize=11, color=LIGHT.ink, wrap=True)
    label(below, f"time [{TIME}]", "gap at contact\n[sum of radii]", "")
    below.set_xlim(passage.span)
    if dots.count:
        below.axhline(0.0, color="#39424e", lw=0.8)
    else:
        below.set_yticks([])
        below.text(0.5, 0.5, "no contacts between disks", transform=below.transAxes, ha="center", va="center", color=LIGHT.faint)


def _draw_energy(axes: Axes, passage: Passage, times: Floats) -> str:
    """Draw the energy, where contacts keep it its change as a run tells it; what to say of it in the title."""
    log, stage = passage.log, passage.stage
    name, zero = energy_name(log.scene), energy_zero(log.scene)
    falls = log.scene.gravity is not None and not has_height(log.scene)
    lossy = falls or not keeps_energy(stage) or any((rows["kind"] == Kind.KICK).any() for rows in log.blocks())
    if lossy:
        energy = np.array([energy_of(log, state) for state in passage.states(times.tolist())])
        axes.plot(times, energy, color=BLUE, lw=1.2)
        label(axes, "", name, "")
        scale_to(axes, energy)
        return f"{name} from {energy[0]:.3g} to {energy[-1]:.3g}" + (f" ({zero})" if zero else "")
    motions = [motion_of(stage, state) for state in passage.states(times.tolist())]
    change = np.array([energy_change(stage, motions[0], motion) for motion in motions])
    axes.plot(times, change, color=BLUE, lw=1.2)
    label(axes, "", "change of energy\n[of its start]", "")
    if not change.any():
        return "energy conserved to the last bit"
    return f"energy changed by {change[-1]:.1e} of itself, on the way by {np.abs(change).max():.1g} at most"


def motion_of(stage: Stage, state: State) -> base.Motion:
    """Return a state as engines have it, places counted from the corner."""
    (x, y), (vx, vy) = (state.position - np.array(stage.corner)).T, state.velocity.T
    still = np.zeros(stage.n, np.int64)
    return base.Motion(x, y, vx, vy, still, still, state.spin)


def gaps_at_contact(motion: Motion) -> Iterator[tuple[Floats, Floats]]:
    """Yield the times (K,) of pair contacts and the gaps there, in reaches, block by block; what an exact contact has is 0."""
    radius = motion.log.scene.disks.radius
    for block in motion.log.blocks():
        rows = block[block["kind"] == Kind.PAIR]
        apart = motion.stage.nearest(np.stack([rows["xa"] - rows["xb"], rows["ya"] - rows["yb"]], axis=-1))
        reach = radius[rows["a"]] + radius[rows["b"]]
        wide = reach > 0.0  # two points have no reach to measure by
        yield rows["time"][wide], (np.hypot(*apart.T) - reach)[wide] / reach[wide]

"""Mean squared displacement: ballistic at first, then diffusive, in a box at last bounded.

Source for the diffusive line: Enskog's D = kT / (m rate), rate = contacts of a disk per time; S. Chapman, T. G. Cowling,
The Mathematical Theory of Non-uniform Gases (1970), chapter 16; good at low density.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from eventsim.errors import LogError
from eventsim.measure.displacement import mean_square
from eventsim.measure.theory import enskog_diffusion
from eventsim.replay.flights import flight_table
from eventsim.replay.log import EventLog
from eventsim.scene.pace import in_words, slowed
from eventsim.show.figures.demands import replay_with_time
from eventsim.show.figures.style import BLUE, GREEN, LENGTH, ORANGE, TIME, label, name_of
from eventsim.show.frames import pace_of_log

SAMPLES, LAGS = 600, 40
"""Times at which displacements are read; lags shown, evenly spread on a logarithmic scale."""


def draw(figure: Figure, log: EventLog) -> None:
    """Draw the displacement of finite masses against the lag, averaged over disks and starting times."""
    replay = replay_with_time(log)
    mass = log.scene.disks.mass
    moving = np.flatnonzero(np.isfinite(mass))
    if not len(moving):
        raise LogError("msd: 0 finite masses in this scene; the figure is of disks that contacts deflect")
    start, end = replay.span
    times = np.linspace(start, end, SAMPLES)
    table = flight_table(replay)
    lags = np.unique(np.geomspace(1, SAMPLES // 2, LAGS).astype(int))
    mean, error = mean_square(table, moving, times, lags)
    if not mean.any():
        raise LogError("msd: nothing moves in this run")
    tau = lags * (times[1] - times[0])
    axes = figure.add_subplot()
    axes.errorbar(tau, mean, error, fmt="o", ms=3.5, lw=1, color=BLUE, label="measured, standard error over disks")
    weight = table.duration * np.isin(table.disk, moving)
    pace = pace_of_log(log)
    lag = np.ldexp(tau, pace)
    velocity2 = float(np.average((slowed(table.velocity, pace) ** 2).sum(axis=1), weights=weight))
    axes.plot(tau, velocity2 * lag**2, color=ORANGE, lw=1.3, label=r"ballistic, $\langle v^2\rangle\,\tau^2$")
    pairs = int((log.b >= 0).sum())
    verdict = ""
    if pairs and len(np.unique(mass)) == 1 and log.scene.gravity is None:
        rate = 2.0 * pairs / (len(mass) * float(np.ldexp(end - start, pace)))
        diffusion = enskog_diffusion(0.5 * velocity2, 1.0, rate)  # per mass
        axes.plot(
            tau,
            4.0 * diffusion * lag,
            color=GREEN,
            lw=1.3,
            label=r"Enskog, $4 D \tau$, $D = kT / (m \cdot$ rate)",
        )
        verdict = f", Enskog's D = {in_words(diffusion, pace, 3)} {LENGTH}$^2$ / {TIME}"
    low, high = 0.5 * float(mean.min()), 4.0 * float(mean.max())
    for curve in axes.lines:
        heights = np.asarray(curve.get_ydata())
        if not ((heights > low) & (heights < high)).any():
            curve.set_label("_outside")  # the legend lists what is seen
    axes.set(xscale="log", yscale="log", ylim=(low, high))
    label(
        axes, f"lag [{TIME}]", f"mean squared displacement [{LENGTH}$^2$]",
        f"{name_of(log)}: {len(moving):,} disks{verdict}",
    )  # fmt: skip
    axes.legend(frameon=False)

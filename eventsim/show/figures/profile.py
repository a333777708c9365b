"""Profile: density and temperature in slices along gravity, or along x, with error bars; the barometric curve beside."""

from __future__ import annotations

from textwrap import fill

import numpy as np
from matplotlib.figure import Figure

from eventsim.measure import measure
from eventsim.replay.log import AnyLog
from eventsim.show.colouring import measured_labels
from eventsim.show.figures.demands import passage_with_time
from eventsim.show.figures.style import BLUE, LENGTH, ORANGE, WIDE, label
from eventsim.show.output import name_of


def draw(figure: Figure, log: AnyLog) -> None:
    """Draw the number density of each species above, its temperature below."""
    passage_with_time(log)
    gravity = log.scene.gravity or (0.0, 0.0)
    profile = measure(log, profile="y" if abs(gravity[1]) > abs(gravity[0]) else "x").profile
    assert profile is not None
    middle = 0.5 * (profile.edges[1:] + profile.edges[:-1])
    above, below = figure.subplots(2, 1, sharex=True)
    theory = False
    looks = measured_labels(log.scene)
    for one in profile.species:
        name, colour = looks[one.species] if len(profile.species) > 1 else ("measured", BLUE)
        look = {"fmt": "o", "ms": 3.0, "lw": 1.0, "color": colour}
        above.errorbar(middle, one.density, np.nan_to_num(one.density_error), label=name, **look)
        if one.theory is not None:
            above.plot(middle, one.theory, color=ORANGE, lw=1.4, label="hydrostatics of the fluid")
            theory = True
        if np.isfinite(one.temperature).any():
            below.errorbar(middle, one.temperature, np.nan_to_num(one.temperature_error), **look)
    label(above, "", f"disks / ({LENGTH})$^2$", f"{name_of(log)}: density and temperature along {profile.axis}")
    label(below, f"{profile.axis} [{LENGTH}]", "temperature kT", "")
    above.set_ylim(0.0, None)
    below.set_ylim(0.0, None)
    if profile.no_temperature is not None:
        label(above, f"{profile.axis} [{LENGTH}]", f"disks / ({LENGTH})$^2$", f"{name_of(log)}: density along {profile.axis}")
        above.tick_params(labelbottom=True)
        below.axis("off")
        below.text(0.5, 0.5, fill(f"no temperature: {profile.no_temperature}", WIDE), transform=below.transAxes, ha="center")
    if theory or len(profile.species) > 1:
        above.legend(frameon=False)

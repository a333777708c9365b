"""Boundary map: where contacts of a billiard are, and at which angle they leave; `measure.boundary_map` says how both count."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from eventsim.errors import LogError
from eventsim.measure.boundary_map import boundary_map
from eventsim.replay.log import AnyLog
from eventsim.scene.names import plural
from eventsim.show.colouring import own_colours
from eventsim.show.figures.demands import with_events
from eventsim.show.figures.style import LENGTH, label
from eventsim.show.output import name_of
from eventsim.show.palette import LIGHT

MOST_DOTS = 200_000
"""More dots than these are only ink: of a longer run the beginning is drawn."""


def draw(figure: Figure, log: AnyLog) -> None:
    """Draw a dot for each contact, disks in their colours; lines where one side of the table ends and the next begins."""
    with_events(log)
    mapped = boundary_map(log)
    if isinstance(mapped, str):
        raise LogError(f"boundary: {mapped}")
    axes = figure.add_subplot()
    shades, drawn, contacts = own_colours(log.scene.disks), 0, 0
    for block in mapped.all_contacts(log):
        shown = slice(0, max(MOST_DOTS - drawn, 0))
        axes.scatter(
            block.arc[shown], block.sine[shown], s=2.0, linewidths=0, c=shades[block.disk[shown]], alpha=0.7, rasterized=True
        )
        contacts, drawn = contacts + len(block.arc), min(contacts + len(block.arc), MOST_DOTS)
    for begin in np.append(mapped.begins, mapped.table.perimeter).tolist():
        axes.axvline(begin, color=LIGHT.wall, linewidth=0.6, alpha=0.5)
    axes.set(xlim=(0.0, mapped.table.perimeter), ylim=(-1.0, 1.0))
    told = plural(contacts, "contact") if drawn == contacts else f"the first {drawn:,} of {contacts:,} contacts"
    label(axes, f"arc length along the boundary [{LENGTH}]", "sine of the angle", f"{name_of(log)}: boundary map, {told}")

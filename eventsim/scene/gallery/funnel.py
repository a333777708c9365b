"""Disks fall through a funnel.

What happens
    A few dozen disks start in a lattice above two sloped walls and fall, under gravity, through the
    neck between them onto the floor. All contacts are elastic, so they rise again, and some find the
    way back up.

Why
    The neck is three diameters wide. Each disk flies on a parabola between contacts; two disks fall
    alike, so gravity cancels from their relative motion and only the walls see it. Without loss nothing
    settles: in the end the disks are a gas under gravity, denser below.

Source
    The contact of a parabola with a sloped line is a quadratic equation; for the density of a gas under
    gravity L. Boltzmann's exp(-m g y / kT), here with the excluded volume of the disks.

A question
    Count the disks below the neck against time. How does that curve change with the width of the neck?
"""

from eventsim.scene.files import scene_from_dict
from eventsim.scene.gallery._demand import demand
from eventsim.scene.scene import Scene


def scene(*, n: int = 36, neck: float = 1.5, seed: int = 1) -> Scene:
    """`n` disks of diameter 1/2 above a `neck` of that width; small random velocities from `seed`."""
    demand(0 < neck < 8, "neck", neck, "must be above 0 and below 8, the width of the box")
    left, right = 4.0 - neck / 2, 4.0 + neck / 2
    return scene_from_dict(
        {
            "name": "funnel",
            "until": 12.0,
            "gravity": [0.0, -1.0],
            "domain": {"kind": "box", "size": [8.0, 14.0]},
            "gas": [
                {
                    "count": n,
                    "radius": 0.25,
                    "temperature": 0.01,
                    "arrangement": "square",
                    "region": [0.5, 9.0, 7.5, 13.5],
                    "seed": seed,
                }
            ],
            "wall": [
                {"kind": "segment", "start": [0.0, 8.0], "end": [left, 5.0], "name": "slope left"},
                {"kind": "segment", "start": [8.0, 8.0], "end": [right, 5.0], "name": "slope right"},
            ],
        },
        source="gallery scene funnel",
    )

"""A granular gas cools by itself.

What happens
    Every contact of two disks takes (1 - e^2) of the energy of their approach. The gas gets colder and
    slower, and its disks begin to drift in groups.

Why
    While it is still evenly spread, the temperature falls as exp(-(1 - e^2) s / 2), s the contacts per
    disk so far (Haff's law). Later, contacts come in bursts, so dense that their number can grow
    without bound in finite time; contact_duration is the remedy: a contact that follows a disk's
    previous one within that time is elastic, as for bodies that need some time to be in contact.

Source
    P. K. Haff, Grain flow as a fluid-mechanical phenomenon, Journal of Fluid Mechanics 134, 401 (1983),
    doi:10.1017/S0022112083003419; the TC model: S. Luding, S. McNamara, How to handle the inelastic
    collapse of a dissipative hard-sphere gas with the TC model, Granular Matter 1, 113 (1998),
    doi:10.1007/s100350050017.

A question
    From which s on does the energy leave Haff's law, and how does the picture look at that moment?
"""

from eventsim.scene.files import scene_from_dict
from eventsim.scene.scene import Scene


def scene(*, n: int = 200, restitution: float = 0.9, contact_duration: float = 1e-6, seed: int = 1) -> Scene:
    """`n` disks with pair `restitution` and TC time `contact_duration` fill 30 % of a torus; from `seed`."""
    return scene_from_dict(
        {
            "name": "cooling",
            "events": 10_000,
            "restitution": {"pair": restitution, "wall": 1.0},
            "contact_duration": contact_duration,
            "domain": {"kind": "periodic", "size": [1.0, 1.0]},
            "gas": [
                {
                    "count": n,
                    "packing_fraction": 0.3,
                    "temperature": 1.0,
                    "arrangement": "random",
                    "seed": seed,
                }
            ],
        },
        source="gallery scene cooling",
    )

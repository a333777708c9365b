"""A granular gas is kept alive by a floor that shakes.

What happens
    Disks that lose energy at every contact hover above a floor that moves in a saw-tooth of vanishing
    amplitude: it always comes to meet them with the same speed V. What falls onto it is thrown up again.

Why
    A contact with such a floor turns v into -e v + (1 + e) V, so each gives energy, and contacts between
    disks take it. The gas finds the height at which both are equal: the lighter the layer, and the
    less each contact takes, the hotter it is. At a restitution of 0.9 it is three times as hot.

Source
    S. McNamara, S. Luding, Energy flows in vibrated granular media, Physical Review E 58, 813 (1998),
    doi:10.1103/PhysRevE.58.813; V. Kumaran, Temperature of a granular material fluidized by external
    vibrations, Physical Review E 57, 5660 (1998), doi:10.1103/PhysRevE.57.5660.

A question
    Were disks points, energies would scale as V^2. How near does the mean height come to a factor of 4 where V is doubled?
    Above the floor it is 7.90 +- 0.04 for V = 1, and 26.5 +- 0.2 for V = 2; kT is 5.99 +- 0.03, and 22.8 +- 0.2.
"""

from eventsim.scene.files import scene_from_dict
from eventsim.scene.gallery._demand import demand
from eventsim.scene.scene import Scene


def scene(*, n: int = 60, shaking: float = 1.0, restitution: float = 0.8, seed: int = 1) -> Scene:
    """`n` disks of diameter 1 with pair `restitution` above a floor that shakes at `shaking`, gravity 1; from `seed`."""
    demand(shaking > 0.0, "shaking", shaking, "must be above 0")
    return scene_from_dict(
        {
            "name": "vibrated",
            "events": 4_000,
            "gravity": [0.0, -1.0],
            "restitution": {"pair": restitution, "wall": 1.0},
            "contact_duration": 1e-6,
            "domain": {"kind": "channel", "size": [40.0, 100.0], "walls": {"bottom": {"shaking": shaking}}},
            "gas": [{"count": n, "radius": 0.5, "temperature": 1.0, "region": [0.0, 0.0, 40.0, 20.0], "seed": seed}],
        },
        source="gallery scene vibrated",
    )

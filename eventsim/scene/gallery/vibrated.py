"""A granular gas is kept alive by a floor that shakes.

What happens
    Disks that lose energy at every contact hover above a floor that moves in a saw-tooth of vanishing
    amplitude: it always comes to meet them with the same speed V. What falls onto it is thrown up again.

Why
    A contact with such a floor turns v into -e v + (1 + e) V, so each gives energy, and contacts between
    disks take it. The gas finds the height at which both are equal: the lighter the layer, and the
    less each contact takes, the hotter it is. Of a few layers the middle floats above a hot, thin gas.

Source
    S. McNamara, S. Luding, Energy flows in vibrated granular media, Physical Review E 58, 813 (1998),
    doi:10.1103/PhysRevE.58.813; V. Kumaran, Temperature of a granular material fluidized by external
    vibrations, Physical Review E 57, 5660 (1998), doi:10.1103/PhysRevE.57.5660.

A question
    Energies scale as V^2. Does the mean height grow by a factor of 4 where V is doubled?
"""

from eventsim.scene.files import scene_from_dict
from eventsim.scene.gallery._demand import demand
from eventsim.scene.scene import Scene


def scene(*, n: int = 60, shaking: float = 1.0, restitution: float = 0.95, seed: int = 1) -> Scene:
    """`n` disks of diameter 1 with pair `restitution` above a floor that shakes at `shaking`, gravity 1; from `seed`."""
    demand(shaking > 0.0, "shaking", shaking, "must be above 0")
    return scene_from_dict(
        {
            "name": "vibrated",
            "events": 4_000,
            "gravity": [0.0, -1.0],
            "restitution": {"pair": restitution, "wall": 1.0},
            "contact_duration": 1e-6,
            "domain": {"kind": "channel", "size": [40.0, 200.0], "walls": {"bottom": {"shaking": shaking}}},
            "gas": [
                {"count": n, "radius": 0.5, "temperature": 1.0, "region": [0.0, 0.0, 40.0, 20.0], "seed": seed}
            ],
        },
        source="gallery scene vibrated",
    )

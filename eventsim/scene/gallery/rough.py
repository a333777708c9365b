"""Rough disks share their energy, and not evenly.

What happens
    Disks fly without spin through a torus. Where two meet, their surfaces grip, so that each contact sets them spinning;
    what slides comes back only in part, so the gas cools. After some ten contacts of each disk the temperature of the
    spins is a fixed part of that of the flights, and both fall together.

Why
    Were disks smooth, spins would stay as they are; were they perfectly rough, both would have the same temperature
    (equipartition). In between contacts take energy, from flights and from spins, and give some of what they take from the
    one to the other: the ratio settles where these balance. For homogeneous disks of e = 1 and beta = 1/2 it is 0.64.

Source
    M. Huthmann, A. Zippelius, Dynamics of inelastically colliding rough spheres: relaxation of translational and
    rotational energy, Physical Review E 56, R6275 (1997), doi:10.1103/PhysRevE.56.R6275; S. Luding, M. Huthmann,
    S. McNamara, A. Zippelius, Homogeneous cooling of rough, dissipative particles: theory and simulations, Physical
    Review E 58, 3416 (1998), doi:10.1103/PhysRevE.58.3416.

A question
    What is the ratio for a roughness of -1/2, at which surfaces slide on, and does the direction of spin matter at all?
"""

from eventsim.scene.files import scene_from_dict
from eventsim.scene.scene import Scene


def scene(
    *, n: int = 400, restitution: float = 1.0, roughness: float = 0.5, moment: float = 0.5, spin: float = 0.0, seed: int = 1
) -> Scene:
    """`n` disks in a torus with `restitution`, `roughness`, `spin` at the start and I = `moment` m r^2; from `seed`."""
    return scene_from_dict(
        {
            "name": "rough disks",
            "events": 15 * n // 2,
            "restitution": restitution,
            "tangential_restitution": {"pair": roughness},
            "domain": {"kind": "periodic", "size": [1.0, 1.0]},
            "gas": [
                {
                    "count": n,
                    "packing_fraction": 0.2,
                    "temperature": 1.0,
                    "moment": moment,
                    "spin": spin,
                    "seed": seed,
                }
            ],
        },
        source="gallery scene rough",
    )

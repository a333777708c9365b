"""A fluid of equal disks without walls.

What happens
    Disks start in a hexagonal lattice on a torus, dense enough to be a fluid close to freezing when
    packing_fraction is 0.7, a thin gas at 0.1. The lattice melts (or does not) and the fluid forgets
    it.

Why
    Without walls every disk sees the same surroundings, so small systems stand for large ones. The
    number of contacts gives the pressure through the virial; the collision rate is that of the gas
    scene without its walls.

Source
    B. J. Alder, T. E. Wainwright, Phase transition in elastic disks, Physical Review 127, 359 (1962),
    doi:10.1103/PhysRev.127.359; E. P. Bernard, W. Krauth, Two-step melting in two dimensions, Physical
    Review Letters 107, 155704 (2011), doi:10.1103/PhysRevLett.107.155704.

A question
    Between which packing fractions does the lattice stop melting? What do you need to measure to tell?
"""

from eventsim.scene.files import scene_from_dict
from eventsim.scene.scene import Scene


def scene(*, n: int = 256, packing_fraction: float = 0.5, arrangement: str = "hexagonal", seed: int = 1) -> Scene:
    """`n` disks fill `packing_fraction` of a torus in an `arrangement`; velocities drawn from `seed`."""
    return scene_from_dict(
        {
            "name": "periodic fluid",
            "until": 0.5,
            "domain": {"kind": "periodic", "size": [1.0, 0.8660254037844386]},
            "gas": [
                {
                    "count": n,
                    "packing_fraction": packing_fraction,
                    "temperature": 1.0,
                    "arrangement": arrangement,
                    "seed": seed,
                }
            ],
        },
        source="gallery scene periodic-fluid",
    )

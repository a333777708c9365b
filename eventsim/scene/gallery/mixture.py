"""Two species, each in its own half of a box.

What happens
    Small light disks start on the left, in a hexagonal lattice; large heavy ones on the right, in a
    square lattice. Both have the same temperature. The lattices melt within a few contacts, then the
    species diffuse into each other.

Why
    Nothing keeps them apart, and there are many more mixed states than separated ones. Equal
    temperature means equal mean energy: the light disks are faster by the root of the mass ratio, from
    the beginning and for ever.

Source
    J. T. Jenkins, F. Mancini, Balance laws and constitutive relations for plane flows of a dense,
    binary mixture, Journal of Applied Mechanics 54, 27 (1987), doi:10.1115/1.3172990.

A question
    Reverse all velocities at the end (Simulation.set_velocity). Do the species separate again? How long
    may the run be for that?
"""

from eventsim.scene.files import scene_from_dict
from eventsim.scene.scene import Scene


def scene(*, n_small: int = 200, n_large: int = 50, mass_ratio: float = 4.0, seed: int = 1) -> Scene:
    """`n_small` disks, and `n_large` of twice the radius and `mass_ratio` times the mass; from `seed`."""
    small = {
        "count": n_small,
        "radius": 0.02,
        "mass": 1.0,
        "temperature": 1.0,
        "arrangement": "hexagonal",
        "region": [0.0, 0.0, 1.0, 1.0],
        "seed": seed,
    }
    large = {
        "count": n_large,
        "radius": 0.04,
        "mass": mass_ratio,
        "temperature": 1.0,
        "arrangement": "square",
        "region": [1.0, 0.0, 2.0, 1.0],
        "seed": seed + 1,
    }
    return scene_from_dict(
        {
            "name": "mixture",
            "until": 1.0,
            "domain": {"kind": "box", "size": [2.0, 1.0]},
            "gas": [small, large],
        },
        source="gallery scene mixture",
    )

"""A large heavy disk in a bath of small ones.

What happens
    The large disk is at rest in the middle. The small disks strike it from all sides, never quite
    evenly, and it begins to wander.

Why
    Each contact gives it a small random kick and, since it meets more disks on the side to which it
    moves, a friction. The two balance when its mean kinetic energy per direction is kT/2, like that of
    any small disk.

Source
    A. Einstein, Ueber die von der molekularkinetischen Theorie der Waerme geforderte Bewegung, Annalen
    der Physik 322, 549 (1905), doi:10.1002/andp.19053220806.

A question
    After what time has the large disk about its share kT of the energy? How does that time change with
    mass?
"""

from eventsim.scene.files import scene_from_dict
from eventsim.scene.scene import Scene


def scene(*, n: int = 200, mass: float = 50.0, radius: float = 3.0, seed: int = 1) -> Scene:
    """Disk 0 with `mass` and `radius` among `n` disks of mass 1, radius 1/2, kT = 1; drawn from `seed`."""
    side = 26.0
    return scene_from_dict(
        {
            "name": "Brownian motion",
            "until": 30.0,
            "domain": {"kind": "box", "size": [side, side]},
            "disk": [{"position": [side / 2, side / 2], "radius": radius, "mass": mass}],
            "gas": [{"count": n, "radius": 0.5, "temperature": 1.0, "arrangement": "random", "seed": seed}],
        },
        source="gallery scene brownian",
    )

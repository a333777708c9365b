"""Disks in a round jar, under gravity.

What happens
    Disks fall and rise in a circular container. Their lattice breaks at the first contact with the
    curved wall, and nothing ever comes to rest: every contact is elastic.

Why
    A parabola and a circle meet where a polynomial of degree four is zero, so this is the hardest
    contact that the scene file knows. The jar is a container: the disks live inside. A round thing that
    the disks meet from outside is a post, a disk of infinite mass.

Source
    One disk alone in the jar is the gravitational billiard: H. J. Korsch, J. Lang, A new integrable
    gravitational billiard, Journal of Physics A 24, 45 (1991), doi:10.1088/0305-4470/24/1/015, for a
    wall that is a parabola; in a circle the motion is chaotic.

A question
    Set n = 1. For which starts does the disk trace the same curve again and again?
"""

from eventsim.scene.files import scene_from_dict
from eventsim.scene.scene import Scene


def scene(*, n: int = 36, gravity: float = 1.0, seed: int = 1) -> Scene:
    """`n` disks of diameter 1 in a jar of radius 8 under `gravity`; velocities (kT = 0.1) from `seed`."""
    return scene_from_dict(
        {
            "name": "jar",
            "until": 20.0,
            "gravity": [0.0, -gravity],
            "domain": {"kind": "open"},
            "gas": [
                {
                    "count": n,
                    "radius": 0.5,
                    "temperature": 0.1,
                    "arrangement": "square",
                    "region": [-5.0, -5.0, 5.0, 5.0],
                    "seed": seed,
                }
            ],
            "wall": [{"kind": "circle", "center": [0.0, 0.0], "radius": 8.0, "name": "jar"}],
        },
        source="gallery scene jar",
    )

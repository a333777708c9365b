"""Rain on a sculpture of polygons and chains.

What happens
    Disks rain on a triangle and on a zigzag of sloped walls. They hit edges and corners and scatter;
    the number of the edge is in the log, as in `triangle.0` or `stairs.2`.

Why
    A polygon is a closed chain of segments, a polyline an open one. Both sides are hard, and each
    corner is a post of radius 0, so a disk that strikes a corner leaves along the line from the corner
    to its centre, as from a small round peg.

Source
    F. Galton, Natural Inheritance (1889), chapter V, for disks that rain on pegs.

A question
    Which fraction of the contacts with the triangle happens at its corners? How would it change for
    smaller disks?
"""

from eventsim.scene.files import scene_from_dict
from eventsim.scene.scene import Scene


def scene(*, n: int = 30, radius: float = 0.2, seed: int = 1) -> Scene:
    """`n` disks of `radius` fall from rest out of a random start above the sculpture, drawn from `seed`."""
    return scene_from_dict(
        {
            "name": "sculpture",
            "until": 12.0,
            "gravity": [0.0, -1.0],
            "domain": {"kind": "box", "size": [10.0, 12.0], "origin": [-5.0, 0.0]},
            "gas": [
                {
                    "count": n,
                    "radius": radius,
                    "arrangement": "random",
                    "region": [-4.5, 8.0, 4.5, 11.5],
                    "seed": seed,
                }
            ],
            "wall": [
                {"kind": "polygon", "points": [[-3.0, 4.0], [-1.0, 4.0], [-2.0, 6.0]], "name": "triangle"},
                {
                    "kind": "polyline",
                    "points": [[0.5, 6.0], [1.5, 5.0], [2.5, 5.5], [3.5, 4.0], [4.0, 4.25]],
                    "name": "stairs",
                },
            ],
        },
        source="gallery scene sculpture",
    )

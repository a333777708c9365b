"""An immovable disk ploughs through a gas.

What happens
    A disk of infinite mass moves at constant velocity through a periodic gas. It sweeps up a denser
    front and leaves a wake; the gas gets hotter.

Why
    Mass inf means that no contact can deflect it: in its own frame it is a post in a wind. Seen from
    the gas it is a moving wall, which does work; so the energy of the run is not conserved, and its
    residual says so.

Source
    The same geometry, with the question how the drag grows with speed, is Newton's: Principia (1687),
    book II, proposition 34.

A question
    How does the mean force on the obstacle (impulses along x, divided by time) change when its speed
    doubles?
"""

from eventsim.scene.files import scene_from_dict
from eventsim.scene.scene import Scene


def scene(*, n: int = 160, speed: float = 1.0, radius: float = 2.0, seed: int = 1) -> Scene:
    """Obstacle 0 with `radius` and `speed` among `n` disks of diameter 1, kT = 1, drawn from `seed`."""
    return scene_from_dict(
        {
            "name": "obstacle",
            "until": 30.0,
            "domain": {"kind": "periodic", "size": [32.0, 16.0]},
            "disk": [{"position": [8.0, 8.0], "velocity": [speed, 0.0], "radius": radius, "mass": float("inf")}],
            "gas": [{"count": n, "radius": 0.5, "temperature": 1.0, "arrangement": "random", "seed": seed}],
        },
        source="gallery scene obstacle",
    )

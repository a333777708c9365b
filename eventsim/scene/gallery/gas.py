"""A gas of equal disks in a hard box.

What happens
    Three hundred disks with Maxwell velocities fill 30 % of a box. They keep colliding; no disk forgets
    its energy, all together forget everything else.

Why
    The standard scene for pressure, collision rate and mean free path: at packing fraction 0.3 the
    compressibility factor Z is 2.063, and each disk has about 4 (Z - 1) / (sqrt(pi) d) contacts with
    others in the time unit in which it flies the thermal distance 1.

Source
    B. J. Alder, T. E. Wainwright, Studies in molecular dynamics I, Journal of Chemical Physics 31, 459
    (1959), doi:10.1063/1.1730376; Z from J. Kolafa, M. Rottner, Molecular Physics 104, 3435 (2006),
    doi:10.1080/00268970600967963.

A question
    Change one velocity in the twelfth decimal. After how many contacts per disk is the rest of the log
    another one?
"""

from eventsim.scene.files import scene_from_dict
from eventsim.scene.scene import Scene


def scene(*, n: int = 300, packing_fraction: float = 0.3, temperature: float = 1.0, seed: int = 1) -> Scene:
    """`n` disks fill `packing_fraction` of a unit box, at `temperature` kT; drawn from `seed`."""
    return scene_from_dict(
        {
            "name": "gas",
            "until": 1.0,
            "domain": {"kind": "box", "size": [1.0, 1.0]},
            "gas": [
                {
                    "count": n,
                    "packing_fraction": packing_fraction,
                    "temperature": temperature,
                    "arrangement": "random",
                    "seed": seed,
                }
            ],
        },
        source="gallery scene gas",
    )

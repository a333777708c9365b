"""Heat flows through a gas from a warm plate to a cold one.

What happens
    The plates below and above are kept at two temperatures. A disk that meets one forgets how it came, and
    leaves with a velocity drawn from the Maxwell flux of that plate. So energy goes in below and out
    above, and the gas between is warmer, and thinner, below.

Why
    The pressure is the same everywhere, and the heat conductivity of a dilute gas of disks goes as the
    square root of the temperature T. The heat flux is the same at all heights, so T^(3/2) is a straight
    line across the gas: half way it is ((T1^(3/2) + T2^(3/2)) / 2)^(2/3) = 1.54 for T1 = 1, T2 = 2. Near the
    plates, within a free path, the gas is less warm or less cold than they are.

Source
    S. Chapman, T. G. Cowling, The Mathematical Theory of Non-Uniform Gases (1970), chapters 7 and 10;
    walls that draw from a flux: R. Tehver, F. Toigo, J. Koplik, J. R. Banavar, Thermal walls in computer
    simulations, Physical Review E 57, R17 (1998), doi:10.1103/PhysRevE.57.R17.

A question
    Does the temperature half way (measure heat-flow --profile y) come to 1.54, or to the mean of the plates?
"""

from eventsim.scene.files import scene_from_dict
from eventsim.scene.gallery._demand import demand
from eventsim.scene.scene import Scene


def scene(*, n: int = 200, warm: float = 2.0, cold: float = 1.0, seed: int = 1) -> Scene:
    """`n` disks fill a tenth of a channel between plates at kT = `warm` below and `cold` above; from `seed`."""
    demand(warm > 0.0, "warm", warm, "must be above 0")
    demand(cold > 0.0, "cold", cold, "must be above 0")
    return scene_from_dict(
        {
            "name": "heat flow",
            "events": 4_000,
            "seed": seed,
            "domain": {
                "kind": "channel",
                "size": [1.0, 1.0],
                "walls": {"bottom": {"temperature": warm}, "top": {"temperature": cold}},
            },
            "gas": [
                {"count": n, "packing_fraction": 0.1, "temperature": 0.5 * (warm + cold), "arrangement": "random", "seed": seed}
            ],
        },
        source="gallery scene heat-flow",
    )

"""Heat flows through a gas from a warm plate to a cold one.

What happens
    The plates below and above are kept at two temperatures. A disk that meets one forgets how it came, and
    leaves with a velocity drawn from the Maxwell flux of that plate. So energy goes in below and out
    above, and the gas between is warmer, and thinner, below.

Why
    Pressure and heat flux are the same at all heights, and the heat conductivity of a dilute gas of disks goes
    as the square root of the temperature T. So T^(3/2) is a straight line across the gas, which half way is
    at T = 1.54 between plates at 1 and 2; at this density, where the cold gas conducts better, 1.53. But disks
    that come to a plate bring the T of a free path away, so that beside the plates the gas is at 1.88 and
    1.09. Half way it is at 1.495 +- 0.002, and with 2000 disks, whose free path is a third, at 1.513 +- 0.003.

Source
    S. Chapman, T. G. Cowling, The Mathematical Theory of Non-Uniform Gases (1970), chapters 7 and 10; D. M. Gass,
    Enskog theory for a rigid disk fluid, Journal of Chemical Physics 54, 1898 (1971), doi:10.1063/1.1675116;
    walls that draw from a flux: R. Tehver, F. Toigo, J. Koplik, J. R. Banavar, Thermal walls in computer
    simulations, Physical Review E 57, R17 (1998), doi:10.1103/PhysRevE.57.R17.

A question
    How warm is the gas beside the plates, and half way, for n = 50 (measure heat-flow --profile y, 1000000 events)?
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

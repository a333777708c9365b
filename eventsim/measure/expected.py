"""What theory expects of a scene: a value, its accuracy and its source for each quantity that has one."""

from __future__ import annotations

import math
from typing import NamedTuple

from eventsim.measure import theory
from eventsim.measure.ensemble import Ensemble

FIXED_ENERGY = "Maxwell at fixed energy"
VIRIAL = "from the measured Z"
CLOSED = "closed form for two disks"
ENSKOG = "Enskog, a guide at low density"
MIXTURE = "Jenkins & Mancini 1987"
HAFF = "Haff 1983, homogeneous"
BULK = "Kolafa & Rottner 2006, bulk: walls change it by about d / L"


class Expected(NamedTuple):
    """What theory says; accuracy: absolute, NaN for a guide."""

    value: float
    accuracy: float
    source: str


def expected_of(ensemble: Ensemble, kt: float, measured: dict[str, float]) -> dict[str, Expected]:
    """Theory for each quantity that has one, by name.

    measured: the values so far; some relations connect measured quantities and hold whatever the equation of state.
    """
    if not ensemble.elastic:
        restitution = ensemble.scene.restitution
        assert restitution is not None
        if not (ensemble.torus and ensemble.alone):
            return {}
        return {"cooling_exponent": Expected(theory.cooling_exponent(restitution.pair), 0.0, HAFF)}
    if not ensemble.simple or not kt > 0.0:
        return {}
    # speeds and paths depend on a common motion of all disks, contacts do not
    found = _maxwell(ensemble, kt) if ensemble.at_rest else {}
    if ensemble.box and "Z" in measured:
        found["Z_walls"] = Expected(measured["Z"], 0.0, "virial theorem: the measured Z")
    if not ensemble.equal:
        return found | _mixture(ensemble, kt)
    found |= _equal(ensemble, kt, measured)
    rate = measured.get("collision_rate", 0.0)
    if rate > 0.0:
        diffusion = theory.enskog_diffusion(kt, ensemble.species[0].mass, rate)
        found["diffusion"] = Expected(diffusion, math.nan, ENSKOG)
    return found


def _maxwell(ensemble: Ensemble, kt: float) -> dict[str, Expected]:
    """Mean speeds and temperatures, the same at every density."""
    power = 0.5 * ensemble.freedoms - 1.0
    found = {}
    several = len(ensemble.species) > 1
    for kind, species in enumerate(ensemble.species):
        if not math.isfinite(species.mass):
            return {}
        speed = theory.mean_speed(kt, species.mass, ensemble.thermal_share(species.mass), power)
        found["mean_speed" + (f"_{kind}" if several else "")] = Expected(speed, 0.0, FIXED_ENERGY)
        if several:
            found[f"temperature_{kind}"] = Expected(kt, 0.0, "equipartition")
    return found


def _equal(ensemble: Ensemble, kt: float, measured: dict[str, float]) -> dict[str, Expected]:
    """Equal disks: the equation of state, and rates that follow from Z."""
    mass, d, n, f = ensemble.species[0].mass, ensemble.diameter, ensemble.n, ensemble.freedoms
    eta, area, size = ensemble.packing_fraction, ensemble.area, ensemble.scene.domain.size
    assert eta is not None
    assert area is not None
    assert size is not None
    if d == 0.0:
        return {}
    if n == 2 and ensemble.box and min(size) >= 2.0 * d:
        return _two_in_a_box(size[0] - d, size[1] - d, d, kt, mass)
    found = {}
    if n == 2 and ensemble.torus and d <= 0.5 * min(size):
        z = theory.two_disk_torus(area, d)
        rate = theory.collision_rate(z, d, kt, mass, f)
        found = {"Z": Expected(z, 0.0, CLOSED), "collision_rate": Expected(rate, 0.0, CLOSED)}
    elif n > 2 and eta <= theory.KOLAFA_ROTTNER_UP_TO:
        bulk = theory.compressibility_factor(eta)
        if ensemble.torus:
            z = theory.finite_compressibility_factor(eta, n)
            # the correction to finite n is itself the first of a series in 1 / n
            accuracy = math.hypot(theory.KOLAFA_ROTTNER_ACCURACY * z, (z - bulk) / math.sqrt(n))
            found["Z"] = Expected(z, accuracy, f"Kolafa & Rottner 2006, N = {n}")
        else:
            z = bulk
            found["Z"] = Expected(z, math.nan, BULK)
    if ensemble.torus and "Z" in measured:
        if "collision_rate" not in found:
            rate = theory.collision_rate(measured["Z"], d, kt, mass, f)
            found["collision_rate"] = Expected(rate, 0.0, VIRIAL)
        rate = found["collision_rate"].value
        speed = theory.mean_speed(kt, mass, ensemble.thermal_share(mass), 0.5 * f - 1.0)
        source = found["collision_rate"].source
        if rate > 0.0:
            found["mean_free_time"] = Expected(1.0 / rate, 0.0, source)
        if rate > 0.0 and ensemble.at_rest:
            found["mean_free_path"] = Expected(speed / rate, 0.0, source)
    if "Z" in found and ensemble.torus:
        scale = n * kt / area
        found["pressure"] = Expected(scale * found["Z"].value, scale * found["Z"].accuracy, found["Z"].source)
    return found


def _two_in_a_box(a: float, b: float, d: float, kt: float, mass: float) -> dict[str, Expected]:
    exact = theory.two_disk_box(a, b, d, kt, mass)
    values = {
        "Z": exact.z,
        "Z_walls": exact.z,
        "collision_rate": exact.pair_rate,
        "mean_free_time": 1.0 / exact.pair_rate,
        "wall_contact_rate": exact.wall_rate,
        "force_left": exact.force_x,
        "force_right": exact.force_x,
        "force_bottom": exact.force_y,
        "force_top": exact.force_y,
    }
    return {name: Expected(value, 0.0, CLOSED) for name, value in values.items()}


def _mixture(ensemble: Ensemble, kt: float) -> dict[str, Expected]:
    """A mixture in a periodic box."""
    eta, area = ensemble.packing_fraction, ensemble.area
    assert eta is not None
    assert area is not None
    if not ensemble.torus or eta > theory.MIXTURE_UP_TO or any(math.isnan(s.mass) for s in ensemble.species):
        return {}
    parts = [theory.Component(s.number / area, 2.0 * s.radius, s.mass) for s in ensemble.species]
    if any(part.diameter == 0.0 for part in parts):
        return {}
    z = theory.mixture_compressibility_factor(parts)
    values = {"Z": z, "pressure": ensemble.n * kt / area * z}
    for i in range(len(parts)):
        rates = [theory.mixture_rate(parts, i, j, kt) for j in range(len(parts))]
        values[f"collision_rate_{i}"] = sum(rates)
        values |= {f"collision_rate_{i}_{j}": rate for j, rate in enumerate(rates)}
    return {name: Expected(v, theory.MIXTURE_ACCURACY * v, MIXTURE) for name, v in values.items()}

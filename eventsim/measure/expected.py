"""What theory expects of a whole gas: its equation of state, closed forms for two disks, its parts as a mixture."""

from __future__ import annotations

import math

from eventsim.measure import theory
from eventsim.measure.ensemble import Ensemble
from eventsim.measure.entries import Expected
from eventsim.measure.records import FEW, Records

VIRIAL = "from the measured Z"
CLOSED = "closed form for two disks"
MIXTURE = "Jenkins & Mancini 1987"


def virial_z(records: Records) -> Expected | None:
    """Z of equal disks in a periodic domain; None where no theory holds."""
    ensemble = records.ensemble
    eta, d, n = ensemble.packing_fraction, ensemble.diameter, ensemble.n
    if not (records.mixed and ensemble.simple and ensemble.torus and ensemble.equal) or d == 0.0 or eta is None:
        return None
    size, area = ensemble.scene.domain.size, ensemble.area
    assert size is not None
    assert area is not None
    if n == 2 and d <= 0.5 * min(size):
        return Expected(theory.two_disk_torus(area, d), 0.0, CLOSED)
    if n < FEW or eta > theory.KOLAFA_ROTTNER_UP_TO:
        return None
    z, bulk = theory.finite_compressibility_factor(eta, n), theory.compressibility_factor(eta)
    # the correction to finite n is itself the first of a series in 1 / n
    accuracy = math.hypot(theory.KOLAFA_ROTTNER_ACCURACY * z, (z - bulk) / math.sqrt(n))
    return Expected(z, accuracy, f"Kolafa & Rottner 2006, N = {n}")


def two_in_a_box(records: Records) -> dict[str, float]:
    """Closed forms for two equal disks in a hard box, by the names of quantities; empty for anything else."""
    ensemble, size = records.ensemble, records.ensemble.scene.domain.size
    d = ensemble.diameter
    if not (records.mixed and ensemble.simple and ensemble.box and ensemble.equal and ensemble.n == 2) or d == 0.0:
        return {}
    assert size is not None
    if min(size) < 2.0 * d:
        return {}
    exact = theory.two_disk_box(size[0] - d, size[1] - d, d, records.found["temperature"], ensemble.species[0].mass)
    return {
        "Z": exact.z,
        "collision_rate": exact.pair_rate,
        "wall_contact_rate": exact.wall_rate,
        "force_left": exact.force_x,
        "force_right": exact.force_x,
        "force_bottom": exact.force_y,
        "force_top": exact.force_y,
    }


def mixture_of(ensemble: Ensemble) -> list[theory.Component] | None:
    """The species as parts of a mixture; None where they are no such thing."""
    if ensemble.area is None or not ensemble.alone:
        return None
    species = ensemble.species[: ensemble.kinds]
    if any(math.isnan(one.mass) or one.radius == 0.0 for one in species):
        return None
    return [theory.Component(one.number / ensemble.area, 2.0 * one.radius, one.mass) for one in species]

"""Rates: how often disks meet each other, and walls."""

from __future__ import annotations

from collections.abc import Iterator

from eventsim.measure import theory
from eventsim.measure.entries import Expected, average
from eventsim.measure.expected import CLOSED, VIRIAL, two_in_a_box, virial_z
from eventsim.measure.measures import Measure
from eventsim.measure.records import Records


def measures(records: Records) -> Iterator[Measure]:
    """Yield contacts of a disk with others per time, posts included, tracers not; and contacts of all disks with walls."""
    ensemble = records.ensemble
    if not ensemble.n:
        return
    if ensemble.n > 1 or ensemble.posts is not None:
        yield average(
            records,
            "collision_rate",
            records.pair_contacts / ensemble.n,
            records.time,
            "1 / time",
            expected_rate(records),
        )
    if records.wall_names:
        closed = two_in_a_box(records)
        walls = Expected(closed["wall_contact_rate"], 0.0, CLOSED) if closed else None
        yield average(records, "wall_contact_rate", records.wall_contacts, records.time, "1 / time", walls)


def expected_rate(records: Records) -> Expected | None:
    """What kinetic theory says of the contacts of a disk per time: it follows from Z, whatever the equation of state."""
    ensemble = records.ensemble
    closed = two_in_a_box(records)
    if closed:
        return Expected(closed["collision_rate"], 0.0, CLOSED)
    if not (records.mixed and ensemble.torus and ensemble.simple and ensemble.equal and ensemble.diameter > 0.0):
        return None
    z = virial_z(records)
    exact = z is not None and z.source == CLOSED
    if not exact and "Z" not in records.found:
        return None
    value = z.value if exact and z is not None else records.found["Z"]
    kt, mass = records.found["temperature"], ensemble.species[0].mass
    rate = theory.collision_rate(value, ensemble.diameter, kt, mass, ensemble.freedoms)
    return Expected(rate, 0.0, CLOSED if exact else VIRIAL)

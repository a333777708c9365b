"""Quantities: one module a family, each with `measures(records)`; to add one is its file and one line in `FAMILIES`.

A family finds in `records.found` the values that families before it have found.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

from eventsim.measure.measures import Measure
from eventsim.measure.quantities import (
    cooling,
    diffusion,
    paths,
    pressure,
    rates,
    rotation,
    species,
    speeds,
    temperature,
    walls,
)
from eventsim.measure.records import Records


class Family(NamedTuple):
    """A family of quantities: how help calls them, and what makes them of the records of a run."""

    words: str
    measures: Callable[[Records], Iterator[Measure]]


FAMILIES = (
    Family(
        "temperature (kT = 2 E / f, f = 2 N less the components of the momentum that are kept);\n"
        "  where there is none: energy_start, energy_end; kinetic_energy",
        temperature.measures,
    ),
    Family(
        "Z (1 + virial of the pairs / 2 N kT; periodic: P V / N kT), Z_walls (the same from walls, over the area that\n"
        "  centres have; p V / N kT of the live page takes all of it and is larger by about 2 r / L), pressure (periodic:\n"
        "  from the virial; else mean force on a length of wall), contact_value or contact_value_I_J",
        pressure.measures,
    ),
    Family(
        "collision_rate (contacts of a disk with others per time), wall_contact_rate (of all disks)", rates.measures
    ),
    Family(
        "force_WALL (across it: impacts, and the weight of disks at rest), force_WALL_SIDE, pressure_WALL, shear_WALL (along it)",
        walls.measures,
    ),
    Family("mean_free_time, mean_free_path; of tracers beside a gas: tracer_...", paths.measures),
    Family("mean_speed", speeds.measures),
    Family(
        "temperature_I, mean_speed_I, collision_rate_I, collision_rate_I_J (of a disk of species I)", species.measures
    ),
    Family("diffusion (d <r^2> / d 4t about the common motion; its lags; D against lag)", diffusion.measures),
    Family(
        "rotational_energy_start, rotational_energy_end; rotational_temperature (kT of spins); rotation_ratio (the same over\n"
        "  kT of flights, averaged along the contacts)",
        rotation.measures,
    ),
    Family("cooling_exponent (-d ln T per contact of a disk)", cooling.measures),
)
"""The table of families, in the order of the page."""


def quantities_of(records: Records) -> tuple[Measure, ...]:
    """Return all quantities of a run."""
    return tuple(quantity for family in FAMILIES for quantity in family.measures(records))

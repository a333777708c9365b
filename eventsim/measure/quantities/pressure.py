"""Pressure: from the contacts of pairs (the virial) and from walls; and how often disks are at contact."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from eventsim.measure import sums, theory
from eventsim.measure.entries import Expected, average, beside, dash
from eventsim.measure.expected import CLOSED, MIXTURE, mixture_of, two_in_a_box, virial_z
from eventsim.measure.measures import Measure
from eventsim.measure.records import Records


def measures(records: Records) -> Iterator[Measure]:
    """Yield Z = 1 + virial / (2 N kT), the same from walls, the pressure, and contact values."""
    ensemble, n = records.ensemble, records.ensemble.n
    why = records.no_pressure
    if why is not None:
        if ensemble.n:
            yield dash("Z", "1", why)
        return
    area, kt = ensemble.area, records.found["temperature"]
    assert area is not None
    heat = np.full_like(records.time, kt) * records.time
    virial = records.channel(sums.VIRIAL)
    z = _expected_z(records)
    if float(records.channel(sums.PAIRS).sum()) == 0.0:
        yield dash("Z", "1", "no contact of disks was seen")
        return
    excess = average(records, "Z", virial / (2.0 * n), heat, "1", z)
    records.found["Z"] = 1.0 + excess.value
    yield beside(_shifted(excess), z)
    if ensemble.torus:
        expected = None if z is None else Expected(n * kt / area * z.value, n * kt / area * z.accuracy, z.source)
        yield average(
            records, "pressure", (n * heat + 0.5 * virial) / area, records.time, "energy / length^2", expected
        )
    if ensemble.box or ensemble.circle is not None:
        lever = records.channel(sums.WALL_VIRIAL)
        closed = two_in_a_box(records)
        same = None
        if records.mixed:
            # the virial theorem speaks of the whole kinetic energy, of which a turning gas keeps a part for itself
            virial_theorem = records.found["Z"] + ensemble.start_energy / (n * kt) - 1.0
            same = Expected(closed["Z"], 0.0, CLOSED) if closed else Expected(
                virial_theorem, 0.0 if math.isnan(excess.error) else excess.error, "virial theorem: the measured Z"
            )  # fmt: skip
        if not lever.any():
            for name, unit in (("Z_walls", "1"), ("pressure", "energy / length^2")):
                yield dash(name, unit, "no contact with a wall was seen")
            return
        yield average(records, "Z_walls", lever / (2.0 * n), heat, "1", same)
        force = records.boundary_force[records.skipped :]
        yield average(records, "pressure", force / (2.0 * area), records.time, "energy / length^2")
    if ensemble.torus and ensemble.equal and ensemble.diameter > 0.0:
        eta = ensemble.packing_fraction
        assert eta is not None
        g = None if z is None else Expected((z.value - 1.0) / (2.0 * eta), z.accuracy / (2.0 * eta), z.source)
        yield average(records, "contact_value", virial / (4.0 * n * eta), heat, "1", g)
    elif ensemble.torus:
        yield from _contact_values(records, kt)


def _shifted(excess: Measure) -> Measure:
    return replace(excess, value=1.0 + excess.value)


def _expected_z(records: Records) -> Expected | None:
    """The equation of state, where it holds."""
    closed = two_in_a_box(records)
    if closed:
        return Expected(closed["Z"], 0.0, CLOSED)
    return _mixture_z(records) if records.ensemble.kinds > 1 else virial_z(records)


def _mixture_z(records: Records) -> Expected | None:
    """Z of a mixture in a periodic domain; None where no theory holds."""
    ensemble, parts = records.ensemble, mixture_of(records.ensemble)
    eta = ensemble.packing_fraction
    if parts is None or eta is None or eta > theory.MIXTURE_UP_TO or not (records.mixed and ensemble.simple and ensemble.torus):
        return None
    z = theory.mixture_compressibility_factor(parts)
    return Expected(z, theory.MIXTURE_ACCURACY * z, MIXTURE)


def _contact_values(records: Records, kt: float) -> Iterator[Measure]:
    """g_ij of each pair of species, from how often they meet."""
    ensemble, parts = records.ensemble, mixture_of(records.ensemble)
    if parts is None:
        return
    eta = ensemble.packing_fraction
    known = records.mixed and eta is not None and eta <= theory.MIXTURE_UP_TO
    for i, one in enumerate(ensemble.species[: ensemble.kinds]):
        for j in range(i, ensemble.kinds):
            others = ensemble.species[j].number - (i == j)
            if not others:
                continue
            alone = theory.ideal_rate(parts, i, j, kt) * theory.fixed_energy_speed(ensemble.freedoms)
            alone *= others / ensemble.species[j].number
            g = theory.mixture_contact_value(parts, i, j)
            expected = Expected(g, theory.MIXTURE_ACCURACY * g, MIXTURE) if known else None
            met = records.met(i, j) / one.number
            yield average(
                records,
                f"contact_value_{ensemble.called[i]}_{ensemble.called[j]}",
                met,
                alone * records.time,
                "1",
                expected,
            )

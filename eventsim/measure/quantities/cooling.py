"""Cooling: how the energy falls with the number of contacts, Haff's law in its own variable."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from eventsim.measure import sums, theory
from eventsim.measure.blocking import block_average, errors_apart, plain_average
from eventsim.measure.ensemble import Ensemble
from eventsim.measure.entries import Expected, beside, dash
from eventsim.measure.measures import Measure
from eventsim.measure.records import FEW, Records

PARTS = 16
"""Stretches of equal numbers of contacts whose slopes are averaged."""

CHANGED = 3.5
"""Standard errors between the two halves of the run that chance hardly explains: 1 in 2000."""

SETTLED = 3.0
"""Decays of what a gas of rough disks begins with, behind which it is averaged: spins have taken their share by then."""

ROUGH_ACCURACY = 0.05
"""Share to which theory tells of rough disks: tails of distributions, and how spins and flights go together, are left out."""

MOST_FLOWING = 0.02
"""Share of the energy in common motion up to which a gas is homogeneous; the law itself neglects as much."""

MOST_WAVES, MOST_GROWN = 64, 60.0
"""Wave numbers along a side that are looked at, and exponents of growth: with either the gas has long flowed together."""

UNIT = "1 / contact of a disk"


def measures(records: Records) -> Iterator[Measure]:
    """Yield -d ln T / d (contacts of a disk), where contacts alone change the energy; of rough disks in the second half."""
    ensemble = records.ensemble
    if not ensemble.n or ensemble.elastic or ensemble.kicked or ensemble.pushed or ensemble.scene.gravity is not None:
        return
    if ensemble.law.drives or ensemble.law.keeps_energy():  # perfectly rough disks: spins take, and give back
        return
    if ensemble.walls_take:
        yield dash("cooling_exponent", UNIT, "walls take energy as well, as often as disks come to them")
        return
    count, stride = int(records.sums.counts[sums.POINTS]), int(records.sums.counts[sums.STRIDE])
    energy = np.concatenate([[ensemble.start_energy], records.sums.points[:count, sums.POINT_ENERGY]])
    warm = np.array([ensemble.temperature(float(e)) for e in energy])
    cold = np.flatnonzero(~(warm > 0.0))  # from there on rounding leaves no digits
    count = int(cold[0]) - 1 if len(cold) else count
    grips = any(ensemble.law.grips)
    begun = count // 2 if grips else 0  # at first flights warm spins up
    whole = (count - begun) // PARTS * PARTS
    if whole < PARTS:
        yield dash("cooling_exponent", UNIT, f"it is told from {2 * PARTS if grips else PARTS} stretches of contacts on")
        return
    step = whole // PARTS
    slopes = -np.diff(np.log(warm[begun : begun + whole + 1 : step])) / (2.0 * step * stride / ensemble.n)
    bar = block_average(slopes)
    first, second = map(plain_average, np.split(slopes, 2))
    note = None
    restitution, rough = ensemble.scene.restitution, rough_gas(ensemble)
    expected = None
    if errors_apart(first, second) > CHANGED:
        where = "what is averaged" if grips else "the run"
        note = f"it is {first.mean:.3g} in the first half of {where} and {second.mean:.3g} in the second: see the series"
    elif restitution is not None and _is_told(ensemble):
        loss = 0.5 * theory.cooling_exponent(restitution.pair)
        share = flowing(ensemble, 2.0 * whole * stride / ensemble.n, loss)
        if share < MOST_FLOWING:
            accuracy = max(share, MOST_FLOWING) * theory.cooling_exponent(restitution.pair)
            expected = Expected(theory.cooling_exponent(restitution.pair), accuracy, "Haff 1983, homogeneous")
        else:
            note = "Haff's law does not hold any more: disks that cool flow together"
    elif rough is not None:
        before, contacts = (2.0 * points * stride / ensemble.n for points in (begun, begun + whole))
        _, decay, loss = rough
        if decay * before < SETTLED:
            note = "spins have not settled: they still take more from flights, or give more, than they will"
        elif flowing(ensemble, contacts, loss) < MOST_FLOWING:
            expected = Expected(2.0 * loss, ROUGH_ACCURACY * 2.0 * loss, "Luding et al. 1998, homogeneous")
    error = bar.error if bar.error > 0.0 else math.nan
    yield beside(Measure(bar.mean, error, unit=UNIT, doubt=note, name="cooling_exponent", blocks=bar.blocks), expected)


def _is_told(ensemble: Ensemble) -> bool:
    """Whether theory speaks of such a gas."""
    if ensemble.law.by_speed or ensemble.law.pairs is not None or any(ensemble.law.grips):
        return False
    return ensemble.torus and ensemble.alone and ensemble.equal and ensemble.n >= FEW


def rough_gas(ensemble: Ensemble) -> tuple[float, float, float] | None:
    """Ratio, decay and loss of `theory.rotation_ratio`; None where theory does not speak of such a gas."""
    law, disks = ensemble.law, ensemble.scene.disks
    moments = np.unique(disks.moments()[ensemble.counted])
    plain = not law.by_speed and law.pairs is None and law.duration is None and ensemble.scene.gravity is None
    alone = ensemble.torus and ensemble.alone and ensemble.equal and ensemble.n >= FEW and len(moments) == 1
    if not plain or not alone or law.rough is None or not law.grips[0] or ensemble.kicked:
        return None
    return theory.rotation_ratio(law.pair, law.rough.pair, float(moments[0]))


def flowing(ensemble: Ensemble, contacts: float, loss: float) -> float:
    """The share of the thermal energy that shear modes have gained, after so many contacts of a disk.

    A mode of wave number k has a share 1 / 2 N at first; relative to the thermal energy it grows like
    exp(2 (gamma - k^2 nu / omega) s), gamma = `loss`, half of what a contact of a disk takes of the thermal energy.
    Source: R. Brito, M. H. Ernst, Europhys. Lett. 43, 497 (1998), doi:10.1209/epl/i1998-00388-9.
    """
    size, eta = ensemble.scene.domain.size, ensemble.packing_fraction
    assert size is not None
    assert eta is not None
    d = ensemble.diameter
    if d == 0.0 or eta > theory.KOLAFA_ROTTNER_UP_TO:
        return math.inf
    damping = theory.shear_damping(eta) * d * d
    last = [min(math.ceil(math.sqrt(loss / damping) * length / (2.0 * math.pi)), MOST_WAVES) for length in size]
    x, y = (2.0 * math.pi * np.arange(-n, n + 1) / length for n, length in zip(last, size, strict=True))
    growth = loss - damping * (x[:, None] ** 2 + y**2)
    growth[last[0], last[1]] = 0.0  # the momentum itself is kept
    gained = np.expm1(np.minimum(2.0 * growth[growth > 0.0] * contacts, MOST_GROWN))
    return float(gained.sum()) / (2.0 * ensemble.n)

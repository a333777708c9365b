"""From the records of a run to its measures: quantities, doubts, speeds, correlations, series."""

from __future__ import annotations

import numpy as np

from eventsim.measure import sums
from eventsim.measure.blocking import block_average, errors_apart
from eventsim.measure.equilibration import DRIFT, doubts, strangers, transient
from eventsim.measure.measures import Measures
from eventsim.measure.quantities import quantities_of
from eventsim.measure.quantities.species import legend as species_legend
from eventsim.measure.quantities.walls import legend as walls_legend
from eventsim.measure.records import FEWEST_CONTACTS, Records
from eventsim.measure.series import series_of
from eventsim.measure.speeds import speed_histograms
from eventsim.record.events import Floats


def measures_of(records: Records) -> Measures:
    """Return the measures that records amount to."""
    ensemble = records.ensemble
    quantities = quantities_of(records)
    unshared = records.no_sharing and records.no_temperature
    found = _doubts(records)
    if not found and ensemble.steady:
        found = strangers((quantity.name, quantity.deviation, quantity.source) for quantity in quantities)
    table = ensemble.table if ensemble.billiard else None
    return Measures(
        disks=ensemble.n,
        tracers=0 if ensemble.tracers is None else ensemble.species[ensemble.tracers].number,
        packing_fraction=ensemble.packing_fraction,
        table_seen=None if table is None else (table.area, table.perimeter),
        duration=records.duration,
        discarded=records.discarded,
        discard_given=records.discard is not None,
        steady=ensemble.steady,
        driven=ensemble.driven,
        doubts=tuple(found),
        quantities=quantities,
        speeds=speed_histograms(records),
        correlations=records.correlations,
        series=series_of(records),
        profile=None if records.profile is None else records.profile.without_temperature(unshared),
        by_name={quantity.name: quantity for quantity in quantities},
        legend=(*species_legend(records), *walls_legend(records)),
    )


def _doubts(records: Records) -> list[str]:
    """Reasons why there is no steady state, or why the run cannot tell."""
    ensemble = records.ensemble
    if records.no_temperature is not None and not ensemble.driven:
        return [records.no_temperature]
    if records.shared < FEWEST_CONTACTS:
        return [f"{records.shared:.2g} contacts of a disk are too few to tell (at least {FEWEST_CONTACTS:g})"]
    if records.groups > 1:
        return [f"the disks fall into {records.groups} groups that have not met"]
    few, kind = records.exchanged
    if few < FEWEST_CONTACTS:
        return [
            f"species {ensemble.called[kind]} has shared its energy as in {few:.2g} contacts of equal disks:"
            f" too few to tell (at least {FEWEST_CONTACTS:g})"
        ]
    rates = records.channel(sums.VIRIAL) / records.time
    late = records.discard is None and transient(records.discarded - records.origin, records.end - records.origin)
    way = np.hypot(*(records.sums.disks[ensemble.counted, sums.WX : sums.WY + 1] - records.end * ensemble.drift).T)
    longest = float(way.max())
    moved = longest * float(np.sqrt(((way / longest) ** 2).mean())) if longest > 0.0 else 0.0
    return doubts(ensemble, rates, block_average(rates), late, moved) + _heating(records) + _exchanging(records)


def _halves(records: Records, energy: Floats) -> float:
    """By how many standard errors the mean energies of the halves of the run differ."""
    half = len(records.time) // 2
    parts = slice(half), slice(half, None)
    return errors_apart(*(records.ratio(energy[part], records.time[part], remembered=True) for part in parts))


def _heating(records: Records) -> list[str]:
    """A clause where walls still give more energy than they take, or less, or where the run is too short to tell."""
    if not records.ensemble.driven:
        return []
    energy = records.channel(sums.ENERGY)
    away = _halves(records, energy)
    if away > DRIFT:
        return [f"the energy drifts: its halves differ by {away:.1f} standard errors"]
    bar = records.ratio(energy, records.time, remembered=True)
    slow = "the energy changes slowly: no block length was found beyond which blocks are independent"
    return [] if bar.independent else [slow]


def _exchanging(records: Records) -> list[str]:
    """A clause where one species still gives energy to others."""
    for kind in records.everyone if records.ensemble.kinds > 1 else ():
        if _halves(records, records.species(kind, sums.SPEED2)) > DRIFT:
            return [
                f"species {records.ensemble.called[kind]} still exchanges energy with others:"
                " its mean v^2 differs between the halves of the run"
            ]
    return []

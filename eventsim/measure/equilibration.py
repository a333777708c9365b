"""Whether and when a run has settled: how much of its beginning to leave out, and reasons for doubt."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from eventsim.measure.blocking import ErrorBar, block_average, errors_apart
from eventsim.measure.ensemble import Ensemble
from eventsim.record.events import Floats

BATCHES = 64
"""Stretches into which the run is cut to look for the end of the transient; it must end in the first half."""

DRIFT = 3.5
"""Standard errors between the two halves that chance hardly explains: 1 in 2000."""

FAR = 5.0
"""Standard errors from theory that chance does not explain, with few blocks and a dozen quantities either: 1 in 1000."""

DENSE = 0.5
"""Packing fraction from which disks may stay in the cages that they started in."""

SLOW = 0.68, 0.74
"""Packing fractions around melting (0.700 to 0.716), where order relaxes by diffusion over the whole system.

Source: E. P. Bernard, W. Krauth, Phys. Rev. Lett. 107, 155704 (2011), doi:10.1103/PhysRevLett.107.155704.
"""

ACROSS, BY_CHANCE = 0.5, 4.0
"""Of the domain's length, that disks must have come where species began apart; standard errors of the middle of a species."""

FEWEST_DISKS = 16
"""With fewer, a disk need not come far to have been everywhere."""


FEWEST_PER_BATCH, FEWEST_PER_DISK = 8, 20
"""Contacts in a stretch, and of a disk in the whole run, from which on the stretches can show an end of the transient; with
fewer, what looks like one is chance."""


def settled_after(series: Floats, contacts: float, disks: int) -> int:
    """How many entries of a series (n,) belong to the transient: those whose loss makes the mean most certain.

    contacts: between disks, in the whole run.  Source: K. P. White, Simulation 69, 323 (1997),
    doi:10.1177/003754979706900601 (MSER).
    """
    size = len(series) // BATCHES
    if size < 1 or contacts < FEWEST_PER_BATCH * BATCHES or 2.0 * contacts < FEWEST_PER_DISK * disks:
        return 0
    batches = series[: size * BATCHES].reshape(BATCHES, size).mean(axis=1)
    best = min(range(BATCHES // 2), key=lambda first: float(batches[first:].var()) / (BATCHES - first))
    # one batch is no transient: the mean of a steady series moves about as much by chance
    return best * size if best > 1 else 0


def doubts(ensemble: Ensemble, rates: Floats, bar: ErrorBar, late: bool, moved: float) -> list[str]:
    """Reasons why a steady state may not have been reached, a clause each; none: nothing speaks against it.

    rates: the virial per time in the part that is kept.  bar: its mean.  late: the transient reaches to the middle of the run.
    moved: root mean square displacement over the run, length.
    """
    found = []
    if late:
        found.append("the pressure still changes in the second half of the run")
    if math.isnan(bar.error):
        found.append("the run is too short for error bars")
    elif not bar.independent:
        found.append("no block length was found beyond which blocks are independent")
    half = len(rates) // 2
    away = errors_apart(block_average(rates[:half]), block_average(rates[half:]))
    if away > DRIFT:
        found.append(f"the pressure drifts: its halves differ by {away:.1f} standard errors")
    return found + _caged(ensemble, moved) + _unmixed(ensemble, moved)


def strangers(deviations: Iterable[tuple[str, float | None, str | None]]) -> list[str]:
    """A clause on the quantity that is furthest from what holds in equilibrium, if one is too far for chance.

    deviations: (name, measured less theory in standard errors or None, where the theory comes from) each.
    """
    far = [(abs(off), name, source) for name, off, source in deviations if off is not None and abs(off) > FAR]
    if not far:
        return []
    off, name, source = max(far, key=lambda one: one[0])
    apart = f"{off:.3g} standard errors" if math.isfinite(off) else "further than any error bar"
    others = f", and {len(far) - 1} more are far off" if len(far) > 1 else ""
    return [f"{name} is {apart} from equilibrium ({source}){others}: the disks do not mix, or have not yet"]


def _unmixed(ensemble: Ensemble, moved: float) -> list[str]:
    """A clause where species began in places of their own, and disks have not come far enough to leave them."""
    size = ensemble.scene.domain.size
    if ensemble.kinds < 2 or size is None or moved >= ACROSS * max(size):
        return []
    middles = []
    for kind in range(ensemble.kinds):
        place = (ensemble.scene.disks.position[ensemble.species_of == kind] - ensemble.scene.domain.origin) / np.array(size)
        chance = BY_CHANCE / np.sqrt(12.0 * len(place))  # of places that are even in a domain of width 1
        middles.append((place.mean(axis=0), chance))
    apart = any(
        (np.abs(here - there) > off + other).any() for here, off in middles for there, other in middles
    )
    share = moved / max(size)
    return [f"species began apart, and disks have moved {share:.2g} of the domain's length only"] if apart else []


def _caged(ensemble: Ensemble, moved: float) -> list[str]:
    eta, diameter = ensemble.packing_fraction, ensemble.diameter
    if eta is None or eta < DENSE or ensemble.n < FEWEST_DISKS or diameter == 0.0:
        return []
    if moved < diameter:
        return [f"disks have moved {moved / diameter:.2g} diameters only: they remember where they started"]
    size = ensemble.scene.domain.size
    if SLOW[0] < eta < SLOW[1] and size is not None and moved < max(size):
        share = moved / max(size)
        return [
            f"near melting order relaxes by diffusion over the whole system,"
            f" and disks have moved {share:.2g} of its length only"
        ]
    return []


def transient(discarded: float, duration: float) -> bool:
    """Whether the search for the end of the transient ran into its bound."""
    return discarded >= (0.5 - 1.5 / BATCHES) * duration

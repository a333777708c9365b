"""Free paths: how far a disk flies between contacts with other disks, and what kinetic theory says of it.

A disk of speed v meets others at a rate nu(v) proportional to the mean of |v - v'| over Maxwell's v'; its free paths are
exponential with the mean v / nu(v), so the paths of all are a mixture of exponentials. Its mean is 1 / (2 sqrt 2 rho d g).
Source: S. Chapman, T. G. Cowling, The Mathematical Theory of Non-uniform Gases (1970), 5.2.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from eventsim.record.events import Floats
from eventsim.replay.flight_table import FlightTable


def free_paths(tables: Iterable[FlightTable], n: int) -> Iterator[Floats]:
    """Yield the lengths of all ways between contacts with disks that deflect; tables: flights of n disks in order."""
    since = np.full(n, np.nan)  # flown since its last pair contact
    for table in tables:
        if not len(table.disk):
            continue
        begins = np.flatnonzero(np.diff(table.disk, prepend=-1))
        ends, disk = np.append(begins[1:], len(table.disk)), table.disk[begins]
        gone = np.concatenate(
            [[0.0], np.cumsum(table.lengths())]
        )  # length flown before each flight, all disks in a row
        at = np.flatnonzero(table.deflected)
        whole = np.diff(gone[at])[table.disk[at[1:]] == table.disk[at[:-1]]]
        low, high = np.searchsorted(at, begins), np.searchsorted(at, ends)
        met = low < high
        first, last = at[low[met]], at[high[met] - 1]
        carried = since[disk[met]] + gone[first] - gone[begins[met]]
        since[disk] += gone[ends] - gone[begins]
        since[disk[met]] = gone[ends[met]] - gone[last]
        paths = np.concatenate([whole, carried])
        yield paths[paths > 0.0]  # contacts of one instant have no path between them


def path_density(x: Floats) -> Floats:
    """Return the density of free paths x (K,), measured in mean free paths."""
    v, dv = np.linspace(1e-3, 7.0, 350, retstep=True)
    angle = np.linspace(0.0, np.pi, 181)
    other = v[:, None] * np.exp(-(v[:, None] ** 2) / 2.0)  # Maxwell's density of the other speed
    relative = np.array(
        [np.sqrt(v[:, None] ** 2 + w * w - 2.0 * v[:, None] * w * np.cos(angle)).mean(axis=1) for w in v]
    )
    rate = (relative * other * dv).sum(axis=0)  # proportional to nu(v)
    share = rate * v * np.exp(-(v**2) / 2.0)
    share /= share.sum()
    free = v / rate
    free /= (share * free).sum()
    density: Floats = (share / free * np.exp(-x[:, None] / free)).sum(axis=1)
    return density

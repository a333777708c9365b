"""What a picture needs to know of a whole log before it is drawn: how fast, how often."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eventsim.record.contacts import contacts_of
from eventsim.replay.log import AnyLog

FASTEST_SHARE = 0.98
"""The colour map of speeds ends where this share of all flights is slower: one fast disk must not darken the rest."""

MOST_SPEEDS = 1 << 20
"""Speeds from which the scale is taken: of more, every second one, every fourth, and so on."""


@dataclass(frozen=True, slots=True)
class Overview:
    """A log at a glance.

    usual: a speed above 0 that `FASTEST_SHARE` of the flights do not pass. fastest: of any. contacts: (N,) of each disk.
    falls: whether disks may be faster between their rows than these tell.
    """

    usual: float
    fastest: float
    contacts: NDArray[np.int64]
    falls: bool


def overview_of(log: AnyLog) -> Overview:
    """Go through a log."""
    disks = log.scene.disks
    speeds = [np.hypot(*disks.velocity.T)]
    fastest, stride, passed = float(speeds[0].max(initial=0.0)), 1, 0
    contacts = np.zeros(len(disks), np.int64)
    for rows in log.blocks():
        pairs = rows["b"] >= 0
        found = np.concatenate([np.hypot(rows["vxa"], rows["vya"]), np.hypot(rows["vxb"][pairs], rows["vyb"][pairs])])
        fastest = max(fastest, float(found.max(initial=0.0)))
        speeds.append(found[-passed % stride :: stride])
        passed += len(found)
        if sum(map(len, speeds)) > MOST_SPEEDS:
            speeds, stride = [np.concatenate(speeds)[::2]], 2 * stride
        met = contacts_of(rows)
        contacts += np.bincount(np.concatenate([met["a"], met["b"][met["b"] >= 0]]), minlength=len(disks))
    usual = float(np.quantile(np.concatenate(speeds), FASTEST_SHARE)) or fastest or 1.0
    return Overview(usual, fastest, contacts, log.scene.gravity is not None)

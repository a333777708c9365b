"""Which tables of a scene file its disks come from: their numbers, and gases that begin alike."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple


class Origins(NamedTuple):
    """Where disks come from.

    shares: (what describes them, how many there are), in the order of their numbers.  twins: indices of gases with one seed.
    """

    shares: tuple[tuple[str, int], ...]
    twins: tuple[tuple[int, ...], ...]


def origins_of(data: Mapping[str, Any], disks: int, seed: int | None) -> Origins:
    """The origins of the disks of a valid scene, as many as `disks`; seed: what the i-th gas is seeded with, and i."""
    from eventsim.scene.tables import gases_of

    gases = gases_of(data)
    single = len(data.get("disk", ()))
    filed = disks - single - sum(gas.count for _, gas in gases)
    shares = [("[[disk]]", single), ("[[disks_file]]", filed), *((f"gas[{i}]", gas.count) for i, gas in gases)]
    seeded: dict[int | None, list[int]] = {}
    for i, gas in gases:
        if gas.uses_chance and seed is None:
            seeded.setdefault(gas.seed, []).append(i)
    twins = tuple(tuple(group) for group in seeded.values() if len(group) > 1)
    return Origins(tuple(share for share in shares if share[1]), twins)

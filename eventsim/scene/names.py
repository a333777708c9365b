"""How messages call the disks of a scene: by their index, or by where a file describes them."""

from __future__ import annotations

from dataclasses import dataclass

from eventsim.scene.cells import Indices


class DiskNames:
    """Names by index, as in a scene built in code."""

    def disk(self, index: int) -> str:
        """The disk in a sentence."""
        return f"disk[{index}]"

    def key(self, index: int, key: str) -> str:
        """One of its numbers (position, velocity, radius or mass), as a user finds it."""
        return f"disk[{index}].{key}"


@dataclass(frozen=True, slots=True)
class SelectedNames(DiskNames):
    """Names of disks selected from others: the i-th selected is the index[i]-th of `names`."""

    names: DiskNames
    index: Indices

    def disk(self, index: int) -> str:
        """The disk in a sentence."""
        return self.names.disk(int(self.index[index]))

    def key(self, index: int, key: str) -> str:
        """One of its numbers, as a user finds it."""
        return self.names.key(int(self.index[index]), key)

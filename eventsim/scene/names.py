"""How messages call things: a disk by its index, or by where a file describes it; many of a kind by their number."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass

from eventsim.scene.cells import Indices


def plural(count: int, noun: str) -> str:
    """Return "1 disk" or "1,000 disks"."""
    return f"{count:,} {noun}" if count == 1 else f"{count:,} {noun}s"


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


class BlockNames(DiskNames):
    """Names by the place in a file: blocks of disks, each with a label and the numbers to put into it."""

    def __init__(self) -> None:
        self.starts: list[int] = []
        self.blocks: list[tuple[str, Sequence[int] | Indices]] = []

    def add(self, start: int, label: str, numbers: Sequence[int] | Indices) -> None:
        """Call the disks from `start` on by a label, with one of the numbers each."""
        self.starts.append(start)
        self.blocks.append((label, numbers))

    def disk(self, index: int) -> str:
        """The disk in a sentence."""
        block = bisect_right(self.starts, index) - 1
        label, numbers = self.blocks[block]
        return label.format(numbers[index - self.starts[block]])

    def key(self, index: int, key: str) -> str:
        """One of its numbers, as a user finds it."""
        name = self.disk(index)
        return f"{name}.{key}" if name.endswith("]") else f"{name}: {key}"

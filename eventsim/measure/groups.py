"""Groups: disks that met, directly or through others, share energy; those of different groups never did."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Indices = NDArray[np.intp]


class Groups:
    """The groups of some disks by the contacts so far; a group is called by the smallest index in it."""

    def __init__(self, members: NDArray[np.bool_]) -> None:
        """Begin with each member (of (N,) disks) as a group of its own."""
        self._members = members
        self._label = np.arange(len(members))
        self.count = int(members.sum())

    def add(self, a: Indices, b: Indices) -> None:
        """Join the groups of disks that met, (K,) each; at most log N passes over those that are of different groups."""
        if self.count < 2:
            return
        both = self._members[a] & self._members[b]
        one, other = a[both], b[both]
        while True:
            one_label, other_label = self._label[one], self._label[other]
            apart = one_label != other_label
            if not apart.any():
                break
            one, other = one[apart], other[apart]
            root = np.arange(len(self._label))
            low, high = np.minimum(one_label, other_label)[apart], np.maximum(one_label, other_label)[apart]
            np.minimum.at(root, high, low)
            while (root[root] != root).any():
                root = root[root]
            self._label = root[self._label]
        self.count = len(np.unique(self._label[self._members]))

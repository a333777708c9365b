"""Records seen column by column: one number of every disk, by the disk's number in the scene."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.exact_state import Met
from eventsim.engines.fast.layout import COUNTS, FLAGS, MET, MET_KX, MET_KY, NOBODY, RESTING, SEVERAL
from eventsim.formulas.rest import SUPPORTED, held_by
from eventsim.scene.stage import Stage

if TYPE_CHECKING:
    from eventsim.engines.fast.state import FastState

Integers: TypeAlias = NDArray[np.int32]


class Column:
    """One number of every record, by the disk's number in the scene."""

    def __init__(self, values: NDArray[Any], place_of: Integers) -> None:
        self._values = values
        self._place_of = place_of

    def __getitem__(self, i: int) -> Any:
        return self._values[self._place_of[i]].item()

    def __setitem__(self, i: int, value: Any) -> None:
        self._values[self._place_of[i]] = value

    def every(self) -> NDArray[Any]:
        """The numbers of all disks, a copy, in the order of the scene."""
        return self._values[self._place_of]

    def set_all(self, values: Any) -> None:
        """Set the numbers of all disks."""
        self._values[self._place_of] = values


class SidesColumn(Column):
    """The sides of walls that every point is on, a list for each disk."""

    def __getitem__(self, i: int) -> list[int]:
        sides: list[int] = self._values[self._place_of[i]].tolist()
        return sides


class CountColumn(Column):
    """Invalidation counts, which begin again after the largest."""

    def __setitem__(self, i: int, value: int) -> None:
        super().__setitem__(i, value & (COUNTS - 1))


class AccelerationColumn:
    """A component of every disk's gravity: None without, 0 for immovable disks, that along its wall for one at rest."""

    def __init__(self, state: FastState, axis: int, stage: Stage) -> None:
        self._state = state
        self._axis = axis
        self._g = None if stage.gravity is None else stage.gravity[axis]
        self._mass = stage.mass

    def __getitem__(self, i: int) -> float | None:
        if self._g is None:
            return None
        if (support := self._state.support_of(i)) is not None:
            return support.ax if self._axis == 0 else support.ay
        return 0.0 if self._mass is not None and np.isinf(self._mass[i]) else self._g

    def every(self) -> Any:
        """The components of all disks: one number, or an array (n,)."""
        if self._g is None or (self._mass is None and self._state.supports is None):
            return self._g
        pulls = np.full(self._state.n, self._g)
        if self._mass is not None:
            pulls[np.isinf(self._mass)] = 0.0
        for i in self._state.resting():
            pulls[i] = self[i]
        return pulls


class MetColumn:
    """Whom every disk met last."""

    def __init__(self, state: FastState) -> None:
        self._state = state

    def __getitem__(self, i: int) -> Met:
        state = self._state
        record = state.words[state.place_of[i]]
        met = int(record[MET])
        if met == NOBODY:
            return ()
        if met != SEVERAL:
            return (self._entry(met, int(record[MET_KX]), int(record[MET_KY])),)
        entries, row = [], int(record[MET_KX])
        while row >= 0:
            partner, kx, ky, row = state.several[row].tolist()
            if partner != NOBODY:
                entries.append(self._entry(partner, kx, ky))
        return tuple(entries)

    def __setitem__(self, i: int, met: Met) -> None:
        state = self._state
        record = state.words[state.place_of[i]]
        if state.supports is not None:
            held = held_by(met)
            resting = held is not None and held.how == SUPPORTED
            record[FLAGS] = (record[FLAGS] & ~RESTING) | (RESTING if resting else 0)
        if not met:
            record[MET] = NOBODY
        elif len(met) == 1:
            record[MET], record[MET_KX], record[MET_KY] = self._coded(met[0])
        else:
            first = state.room_for(len(met))
            for k, entry in enumerate(met, first):
                state.several[k, :3] = self._coded(entry)
                state.several[k, 3] = k + 1
            state.several[first + len(met) - 1, 3] = -1
            record[MET], record[MET_KX] = SEVERAL, first

    def _entry(self, partner: int, kx: int, ky: int) -> tuple[int, int, int]:
        return (int(self._state.labels[partner]) if partner >= 0 else partner), kx, ky

    def _coded(self, entry: tuple[int, int, int]) -> tuple[int, int, int]:
        other, kx, ky = entry
        return (int(self._state.place_of[other]) if other >= 0 else other), kx, ky


LINE, PAGE = 64, 4096


def aligned(count: int, kind: Any) -> NDArray[Any]:
    """Zeros that begin with a page, and some to spare behind them: the lanes read a little past the end."""
    size = count * np.dtype(kind).itemsize
    raw = np.zeros(size + PAGE + 4 * LINE, np.uint8)
    start = -raw.ctypes.data % PAGE
    return raw[start : start + size].view(kind)

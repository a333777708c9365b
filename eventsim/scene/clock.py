"""The clock of a scene: how long its epochs are, and its longest windows."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from eventsim.formulas.clock import FIRST_WINDOW, MOST_EPOCHS
from eventsim.formulas.walls.point import is_point
from eventsim.scene.domain import Channel, Open, Periodic
from eventsim.scene.scene import Scene

LONGEST_WINDOW = 900
"""Without wraps nothing accumulates between contacts, so a scene with few rows may have windows of any length."""

LONGEST_PERIODIC_WINDOW = 13
"""A window of 2**13 epochs, as the disks that move now would have them: beyond it few rows make no window longer in a periodic
domain, so a disk that only wraps keeps its digits; and windows are that long at once, so a gas that has cooled is not slowed."""

LONGEST_WRAPPING_WINDOW = 8
"""The same behind a window with wraps and no row: a disk that only wraps is some 1e-9 domains off after 1e6 rounds, and its wraps
take longer than its turnovers.  Of many disks a turnover takes longer, so their windows are up to those of above."""

ROUNDS = 3
"""A window behind one without a row or a wrap lasts for 2**3 ways of the fastest disk through the scene, or less: so it is not
without a row for ever, and windows grow again where rows are rare."""

FINEST, FINEST_ALONE = 28, 20
"""An epoch is at least 2**-28 of the time in which the fastest disk crosses the scene, for a single disk 2**-20, however small it
is: so a clock counts 2**33 such times, or 2**41.  Windows grow to the size of the scene where little happens in between."""

SLIGHTLY_LESS = 1.0 - 2.0**-32
"""The outline of a round wall is rounded: so it makes no difference whether that gives a power of two or a little less."""

WIDE = 2.0**16
"""Diameters of the largest disk across a scene, without gravity, beyond which a crowd in a corner has the clock of a crowd."""

SHORTEST_EPOCH, LONGEST_EPOCH = -1000, 960
"""Exponents of the epoch's length; so MOST_EPOCHS of the longest ones, and a window more, are still a float."""


class SceneClock(NamedTuple):
    """How a clock counts the time of a scene.

    epoch_length: time, a power of two.  speed: exponent of the speed that it was made for; pull: of the speed which gravity gives
    on the way from disk to disk, None without gravity.  window_cap: the largest exponent of a window with few rows while disks
    are as fast as at the start; idle_cap: of one behind a window without a row.  paced: the exponent from which on a window with
    few rows is followed by one of this exponent for the pace of its disks.
    """

    epoch_length: float
    speed: int
    pull: int | None
    window_cap: int
    idle_cap: int
    paced: int

    def slowing(self, fastest: float) -> int:
        """By which power of two disks are slower than at the start, 0 if not; fastest: their largest component of a velocity."""
        speeds = [] if self.pull is None else [self.pull]
        if fastest > 0.0:
            speeds.append(math.frexp(fastest)[1])
        return max(0, self.speed - max(speeds)) if speeds else LONGEST_WINDOW

    def window_at_pace(self, exponent: int, fastest: float) -> int:
        """The exponent of the window behind a long one with few rows; fastest: the largest component of a velocity now.

        So a gas that cools does not turn its clock over for every doubling of its times.
        """
        longest = self.paced + self.slowing(fastest)
        return min(longest if self.paced == self.window_cap else max(exponent + 1, longest), MOST_EPOCHS.bit_length() - 1)


def clock_of(scene: Scene) -> SceneClock:
    """The clock of a scene.

    An epoch is about the time in which the fastest disk flies from one disk to the next.  Only exponents enter, so that a scene
    with all velocities times 2**k has an epoch of exactly 2**-k times the length.
    """
    disks, domain, gravity = scene.disks, scene.domain, scene.gravity
    n = len(disks)
    whole = _extent(scene)
    usual = _distance(scene, n, whole)
    length = usual
    diameter = 2.0 * float(disks.radius.max())
    if gravity is None and 0.0 < diameter < max(domain.size or np.ptp(disks.position, axis=0).tolist()) / WIDE:
        length = math.frexp(diameter / math.sqrt(n))[1]
    length = max(length, whole - (FINEST if n > 1 else FINEST_ALONE))
    fastest = float(np.abs(disks.velocity).max())
    speeds = [math.frexp(fastest)[1]] if fastest > 0.0 else []
    pull = None
    if gravity is not None:
        pull = (math.frexp(max(abs(gravity[0]), abs(gravity[1])))[1] + length) // 2
        speeds.append(pull)
    speed = max(speeds, default=0)
    exponent = max(SHORTEST_EPOCH, min(length - speed, LONGEST_EPOCH))
    window_cap, idle_cap = LONGEST_WINDOW, FIRST_WINDOW + (n - 1).bit_length()
    paced = LONGEST_PERIODIC_WINDOW + usual - length
    if isinstance(domain, Periodic | Channel):
        window_cap = paced
        idle_cap = max(LONGEST_WRAPPING_WINDOW, min(idle_cap, LONGEST_PERIODIC_WINDOW)) + usual - length
    else:
        idle_cap = max(idle_cap, whole - length + ROUNDS)
    return SceneClock(math.ldexp(1.0, exponent), speed, pull, window_cap, idle_cap, paced)


def _distance(scene: Scene, n: int, whole: int) -> int:
    """The exponent of the mean distance of disks; whole: of the way through the scene.

    A disk as small as a point is one: else the clock of a lone one would turn over on its way to a wall, and round its place.
    """
    disks, domain = scene.disks, scene.domain
    radius = float(disks.radius.max())
    radius = 0.0 if is_point(radius, math.ldexp(1.0, whole)) else radius
    if isinstance(domain, Open):
        width, height = np.ptp(disks.position, axis=0).tolist()
        extent = max(math.sqrt(width) * math.sqrt(height), radius, width, height)
    else:
        width, height = domain.size
        extent = max(math.sqrt(width) * math.sqrt(height), radius)
    return math.frexp(extent / math.sqrt(n) or 1.0)[1]


def _extent(scene: Scene) -> int:
    """The exponent of the longest way through the scene: through the domain, or along all centres and walls on the open plane."""
    if not isinstance(scene.domain, Open):
        return math.frexp(max(scene.domain.size))[1]
    lines = [part.outline() for wall in scene.walls for part in wall.parts("")]
    extent = float(np.ptp(np.concatenate([scene.disks.position, *lines]), axis=0).max())
    return math.frexp(extent * SLIGHTLY_LESS or 1.0)[1]

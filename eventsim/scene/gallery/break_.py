"""The break: a cue disk into fifteen touching ones.

What happens
    The cue disk strikes the apex of the rack along the axis of the table. The impulse spreads through
    the rack at one instant, row by row, and the disks fly apart. Aimed along the axis, the rack bursts
    symmetrically.

Why
    An equilateral rack cannot touch exactly in binary numbers: half a diameter times sqrt 3 is
    irrational, and whether two disks touch or miss by the last bit would depend on rounding. This rack
    is built on the whole-number triangle 451, 780, 901 (451^2 + 780^2 = 901^2), which is almost half an
    equilateral one: each disk touches its neighbours in the next row exactly, and neighbours of one row
    are 1/901 of a diameter apart. Lengths are 2^-14 of a metre, so every starting coordinate is exact,
    the contacts of the first instant are exactly simultaneous, and the law for them decides the
    outcome, not the order of the list.

Source
    Rules of play of the World Pool-Billiard Association for the rack, the 2 : 1 table and the head
    spot; almost equilateral triangles of whole numbers are the solutions of a Pell equation (5, 65,
    901, ... are the long sides).

A question
    How long does the picture stay symmetric? Disks 2 and 3 are mirror images: find the event from which
    their speeds differ, and say where that difference comes from. Then set aim to one unit of length,
    2^-14 = 6.103515625e-05.
"""

from eventsim.scene.disks import Disks
from eventsim.scene.domain import Box
from eventsim.scene.gallery._demand import demand
from eventsim.scene.scene import Scene

UNIT = 2.0**-14  # metres
DIAMETER, ROW, HALF = 901, 780, 451  # units; a right triangle
TABLE = (41_600, 20_800)  # units: 2.54 m by 1.27 m


def scene(*, speed: float = 6.0, aim: float = 0.0) -> Scene:
    """Cue disk 0 with `speed` (m/s), its line `aim` metres above the table's axis; the rack is 1 to 15."""
    demand(speed > 0, "speed", speed, "must be above 0")
    length, width = TABLE
    apex = 3 * length // 4
    rack = [(apex + ROW * row, width // 2 + HALF * (2 * place - row)) for row in range(5) for place in range(row + 1)]
    disks = Disks(
        position=[[length // 4 * UNIT, width // 2 * UNIT + aim]] + [[x * UNIT, y * UNIT] for x, y in rack],
        velocity=[[speed, 0.0]] + [[0.0, 0.0]] * 15,
        radius=DIAMETER * UNIT / 2,
        mass=0.17,
    )
    return Scene(disks=disks, domain=Box((length * UNIT, width * UNIT)), until=4.0, name="break")

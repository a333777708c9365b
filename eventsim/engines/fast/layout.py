"""What a disk is in memory: one record of two cache lines, and the numbers that stand for its next event.

Line 0 is all that a neighbour's prediction reads, line 1 the disk's own affairs.  Record n is a sentinel of NaNs that no disk
ever meets: it fills the empty slots of cells.
"""

from __future__ import annotations

from typing import NamedTuple

REALS, WORDS = 16, 32
"""float64 and int32 numbers in a record."""

X, Y, VX, VY, T, RADIUS, DUE, CONTACT_TIME = 0, 1, 2, 3, 4, 5, 8, 9
"""Places of float64 numbers: the flight (as in the reference engine), the time of the next event, of the last contact."""

MET, COUNT, FLAGS, LABEL = 12, 13, 14, 15
"""Places of int32 numbers in line 0: whom the disk met last, invalidation count, flags, its number in the scene."""

PARTNER, PARTNER_COUNT, LINK, NEXT, COLUMN, ROW = 20, 21, 22, 23, 25, 26
"""In line 1: the next event and its partner's count when it was predicted; the calendar's links (the place of the word that
holds this disk's number, a bucket or a NEXT; the disk that follows on the same day); the cell, counted from 1."""

AT_ONCE, WRAPS_X, WRAPS_Y, MET_KX, MET_KY = 27, 28, 29, 30, 31
"""In line 1: contacts at the time of the last one; wraps; the image in which it was met (of a wall: the side, and STRUCK,
SUPPORTED or LEFT)."""

REGISTER = 16
"""Slots that are read at once, also past the end of what is wanted."""

USUAL_DEPTH = 4
"""Slots in a cell that is too narrow for a fifth disk."""

EDGE, IMMOVABLE, TRACER, RESTING, FIRST_LEVEL = 1, 2, 4, 8, 16
"""Flags: in a cell at the border of the grid; infinite mass; no mass; on a wall that supports it.  From FIRST_LEVEL on the number
of the disk's level."""

CLASSES = IMMOVABLE | TRACER

NOBODY, SEVERAL = 1 - 2**31, -(2**31)
"""Values of MET besides a disk and -1 - number of a surface; SEVERAL: MET_KX is the first of a chain in the table `several`."""

RIGHT, LEFT, UP, DOWN = -1, -2, -3, -4
LOOK = -5
WRAP_RIGHT, WRAP_LEFT, WRAP_UP, WRAP_DOWN = -6, -7, -8, -9
NOTHING = -10
WALL = -16
"""Values of PARTNER besides a disk: cell crossings, time to look for smaller disks, wraps, no event; WALL - 2 place - (1 if the
side is -1)."""

COUNTS = 1 << 30
"""Invalidation counts stay below; the bit itself in PARTNER_COUNT says that two events share the time of this one."""

WAITING = 16
"""Places in the waiting room of the calendar."""

MOST_DISKS = 1 << 25
"""So many records and buckets still have int32 places."""


SUPPORT = 22
"""Numbers in the table of supports for every wall: the acceleration along it, how far it goes, which line it is on, its face."""

SUPPORT_X, SUPPORT_Y, SUPPORT_LOW, SUPPORT_HIGH, SUPPORT_LINE, SUPPORT_FACE = 0, 1, 2, 3, 4, 5
"""Their places; a wall that supports nobody goes from 0 to 0."""


OWN_OF_WALL, SHARE, SERIES, TEMPERATURE, SHAKING, SLIDE = 5, 0, 1, 2, 3, 4
"""How many numbers each wall has of its own, and their places: see `rules.shares_of`."""


class Arrays(NamedTuple):
    """The memory of a kernel: arrays where Python makes it, pointers inside; None is what the scene does not need.

    disks: the records, and behind them the calendar's buckets and its waiting room.
    several: whom disks met in joint contacts, (partner, kx, ky, next) each.  near: room for a list of neighbours.  low: the low
    parts of velocities, (vx, vy) each.  sides: of points, one number for each shape
    (`scene.sides`); images: see `rules.images_of`.  levels: the table of `cells`.  shares: see
    `rules.shares_of`.  species: of each disk; pairs: see `rules.pairs_of`.  contacts: how many each disk has had, where chance
    hangs on that.  rows: the log's buffer, bytes.  spin: the angular velocity and the moment of each disk; spin_rows: what rows
    have of spins, two numbers each.  near_walls: see `wall_cells.shapes_in_cells`.
    """

    disks: object
    slots: object
    near: object
    several: object
    mass: object
    low: object
    features: object
    levels: object
    supports: object
    sides: object
    images: object
    shares: object
    species: object
    pairs: object
    contacts: object
    rows: object
    spin: object
    spin_rows: object
    near_walls: object


class Rules(NamedTuple):
    """What the scene says; None: it does not have that.

    wall_x, wall_y: place of the first of two hard walls across an axis.  series_restitution: see `Law.series`.  law: its
    `numbers`; by_speed: it looks at the speed of approach; own: where it is the user's, the extent of places; driven: walls heat,
    shake or slide; seed: of chance.  classes: there are immovable disks or tracers.  features: number of wall shapes; shapes: of
    each of the kinds of `shapes` whether there is one; first_feature: the place of the first.  instant, at_once_limit: see
    `instant_of`.
    still: see `stillness_of`, None where disks do not settle.  tie_screen: see `formulas.doubt`, in the present window.
    sinks: the part of places that sunk gaps are, None where none sink.  pair_roughness, wall_roughness: the tangential
    restitution, None where contacts turn no disk.
    """

    gx: object
    gy: object
    length_x: object
    length_y: object
    wall_x: object
    wall_y: object
    width: float
    height: float
    pair_restitution: float
    wall_restitution: float
    series_restitution: float
    law: object
    by_speed: object
    own: object
    driven: object
    seed: object
    classes: object
    common_mass: float
    features: object
    shapes: tuple[object, ...]
    first_feature: int
    instant: float
    at_once_limit: int
    still: object
    tie_screen: float
    sinks: object
    pair_roughness: object
    wall_roughness: object


class Grid(NamedTuple):
    """Disks, cells and the calendar.

    n: disks.  columns, rows: of cells, without the ring of ghosts.  depth: slots in a cell; deep: None where it is the usual
    one.  low: the corner of the grid; on the open plane its outer cells reach to infinity.  days: buckets, a power of two.
    lanes: eight pairs at a time, or None.  look_ahead: days at which memory is prefetched, or None.  levels: how many grids
    there are, None for one; first: the first slot of this one, None for 0.  posts: where nothing but immovable disks at rest can
    be met, how many there are, in the first places; else None.
    """

    n: int
    columns: int
    rows: int
    depth: int
    deep: object
    low_x: float
    low_y: float
    side_x: float
    side_y: float
    days: int
    day_length: float
    days_per_time: float
    lanes: object
    look_ahead: object
    levels: object
    first: object
    posts: object


STATUS_BUDGET, STATUS_LIMIT, STATUS_EVENTS, STATUS_ROWS = 0, 1, 2, 3
"""Why a kernel returned: its steps are done; no event before the limit; enough events; the row buffer is full."""

STATUS_TIE, STATUS_FULL, STATUS_STUCK, STATUS_IDLE = 4, 5, 6, 7
"""Contacts of equal time; a full cell; an instant does not end; a long time without events."""

DAY, EVENTS, PAIRS, WALLS, WRAPS, CROSSINGS, STALE, WINDOW_ROWS, ROW_COUNT, ROOM, DISK, STEPS, EPOCH = range(13)
"""Places in `counts`.  ROW_COUNT: rows in the buffer; ROOM: how many fit; DISK: the one that a
status is about; EPOCH: of the clock."""

NOW, DEEPEST, OUTER_X, OUTER_Y, EPOCH_BEGIN, EPOCH_ERROR = range(6)
"""Places in `sums`: the time, the deepest overlap, momentum from outside; where the epoch begins on the scene's clock, and
the rounding error of that."""

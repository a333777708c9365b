"""What a run sums up, row by row: every disk is followed from contact to contact, in memory that does not grow.

Plain Python, and machine code where there is a compiler (`compiled`): both give the same bits.  All is in one file, so that
numba, which keeps compiled code by the file it came from, notices every edit.

What disks do between contacts without gravity is a constant: speed, energy, the bin of the speed histogram.  A channel holds the
sum of these over all disks, its rate, and rate x time goes to the present bin of time when the rate changes or the bin ends.
So sums are right to the very end of a run, flights under way included.  A flight under gravity is added when it ends: to each bin
that it passed through, what it did in there.  When the run outgrows the bins, they double in width, and so does the interval
between samples.  So a run that slows down by many decades costs no more than one that does not.
"""

from __future__ import annotations

import math
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]
Indices: TypeAlias = NDArray[np.int64]

PAIR, WALL, REST, KICK = 0, 1, 2, 3
"""Kinds of rows, as `record.events.Kind` has them."""

MOST_BINS = 2048
VIRIAL, PAIRS, WALL_VIRIAL, ROTATION, SAMPLES, ENERGY, XX, XY, YY, TURNING = range(10)
GENERAL = 10
"""Channels of a bin.  Sums of reach x impulse along the normal, and number of contacts, between disks that carry energy; sum of
lever x impulse across walls at these; energy of the common rotation, summed over samples, and the number of these; of disks that
carry energy, the integrals over time of the energy, and of m v_x^2, m v_x v_y, m v_y^2; and that of the energy of their spins."""

PATH, SPEED2, HITS = 0, 1, 2
PER_SPECIES = 3
"""Channels of a species: length of its flights; integral of v^2; contacts with walls."""

SPEED_BINS = 80
"""Bins of the speed histogram; an even number.  They double in width when a disk is faster than the last one."""

PIECES = 4
"""Parts of a flight under gravity, each with a speed of its own in the histogram."""

MOST_POINTS = 2048
POINT_TIME, POINT_ENERGY, POINT_VIRIAL, POINT_TURNING, POINT_ACTION = range(5)
POINT_COLUMNS = 5
"""Columns of the points along the contacts: time, energy, the sum of FORCE by then, the energy of spins, and ACTION by then."""

WIDTH, ORIGIN, INTERVAL, HEAT, FORCE, SPUN, ACTION, SEEN = range(8)
NUMBERS = 8
"""Numbers that change: width of a bin; time at which the bins begin; interval of samples; energy now; sum of reach x impulse so
far, between disks and at the walls that hold them; energy of spins now; the integral of the energy over time without gravity, and
until when."""

PLACE, SAMPLED, FILLED, CONTACTS, STRIDE, POINTS = range(6)
COUNTS = 6
"""Counts that change: the present bin; samples so far; those in the buffer; pair contacts so far; contacts from point to point;
points so far."""

TIME, VX, VY, GX, GY, WX, WY, LIES_ON, LENGTH, HIT, MASS, RADIUS, SPECIES, FALL_X, FALL_Y, SCALE = range(16)
DISK_COLUMNS = 16
"""Columns of a disk, two cache lines.  Of its present flight: when it began, velocity and acceleration then, displacement since
the start of the run, the wall on which it rests or -1.  Length of its flights, number of its contacts.  What it is: mass, 0 where
it carries no energy; radius; species; acceleration in free flight; bins of the histogram per unit of speed."""

WALL_X, WALL_Y, OUT_X, OUT_Y, LEVER, INSET, PRESS, SLOPE_X, SLOPE_Y, BEND, HALF, FACE = range(12)
WALL_COLUMNS = 12
"""Columns of a wall: its middle; from there to the left, as far as a straight one is long, or from the centre of a round one to
its middle; from the middle of the region to the wall, a disk's own being shorter by `INSET` radii; how hard a disk of unit mass
presses that rests on it, and its acceleration; the radius of a round one, 0 of a straight one; the cosine of half its turn;
the side that all disks are on, or `BOTH`."""

AHEAD = 4
"""Rows ahead of which disks are asked for: many disks do not fit into the nearest cache, and memory is slower than a contact."""

SIDES = 3
LEFT, RIGHT, END, BOTH = 0, 1, 2, -1
"""Of a wall: left or inner, right or outer, ends."""

POINT_LIKE = 1e-7
"""Share of a wall's size below which a radius does not tell on which side a centre is: well above rounding."""


class Block(NamedTuple):
    """Columns (R,) of rows of a log; time since the start of the run, ascending."""

    time: Floats
    kind: NDArray[np.int32]
    a: NDArray[np.int32]
    b: NDArray[np.int32]
    wall: NDArray[np.int32]
    xa: Floats
    ya: Floats
    vxa: Floats
    vya: Floats
    vxb: Floats
    vyb: Floats
    impulse: Floats


class Plan(NamedTuple):
    """Where things go: numbers of species and of walls with channels of their own; periods, 0 where there is none.

    shears: as many as walls where some of these pull along themselves, else 0.
    """

    kinds: int
    walls: int
    period_x: float
    period_y: float
    shears: int = 0


class Sums(NamedTuple):
    """What is gathered.

    disks: (N, DISK_COLUMNS).  walls: (W, WALL_COLUMNS).  bins: (MOST_BINS, channels).  rates, since: (channels,) the rate of each
    channel, and until when it is in the bins.  spins: (N, 2) spin and moment of inertia, 0 where a disk carries no energy; (0, 2)
    where disks have no spin.  numbers, counts: see WIDTH, PLACE.  points: (MOST_POINTS, POINT_COLUMNS).
    watched: (W,) disks that are sampled.  way, velocity: (S, W, 2) buffers of samples.
    """

    disks: Floats
    walls: Floats
    bins: Floats
    rates: Floats
    since: Floats
    numbers: Floats
    counts: Indices
    points: Floats
    watched: Indices
    way: Floats
    velocity: Floats
    spins: Floats


def channels_of(plan: Plan) -> int:
    """The number of channels of a bin."""
    return first_speed(plan) + plan.kinds * SPEED_BINS


def first_pair(plan: Plan) -> int:
    """Channels from here on: contacts of species with species (kinds x kinds)."""
    return GENERAL + plan.kinds * PER_SPECIES


def first_wall(plan: Plan) -> int:
    """Channels from here on: momentum across the wall that is given to each side of each wall."""
    return first_pair(plan) + plan.kinds * plan.kinds


def first_shear(plan: Plan) -> int:
    """Channels from here on: momentum along the wall that is given to each side of each wall."""
    return first_wall(plan) + SIDES * plan.walls


def first_speed(plan: Plan) -> int:
    """Channels from here on: time at speeds, species by species."""
    return first_shear(plan) + SIDES * plan.shears


def merge(sums: Sums) -> None:
    """Double the width of the bins."""
    bins = sums.bins
    for c in range(len(sums.rates)):
        for k in range(MOST_BINS // 2):
            bins[k, c] = bins[2 * k, c] + bins[2 * k + 1, c]
        for k in range(MOST_BINS // 2, MOST_BINS):
            bins[k, c] = 0.0
    sums.numbers[WIDTH] *= 2.0
    sums.counts[PLACE] //= 2


def reach(sums: Sums, time: float) -> None:
    """Come to a time since ORIGIN: all channels are added to the bins that end before it."""
    numbers, counts = sums.numbers, sums.counts
    while time >= numbers[WIDTH] * (counts[PLACE] + 1):
        place = counts[PLACE]
        if place == MOST_BINS - 1:
            merge(sums)
            continue
        end = numbers[WIDTH] * (place + 1)
        for c in range(len(sums.rates)):
            if sums.rates[c] != 0.0:
                sums.bins[place, c] += sums.rates[c] * (end - sums.since[c])
            sums.since[c] = end
        counts[PLACE] = place + 1


def turn(sums: Sums, channel: int, time: float, change: float) -> None:
    """Change the rate of a channel at a time in the present bin."""
    if sums.rates[channel] != 0.0:
        sums.bins[sums.counts[PLACE], channel] += sums.rates[channel] * (time - sums.since[channel])
    sums.since[channel] = time
    sums.rates[channel] += change


def slot_of(plan: Plan, sums: Sums, i: int, speed: float, time: float) -> int:
    """The channel of a speed in the histogram of the species of disk i, at a time since ORIGIN."""
    disks = sums.disks
    doublings, scale = 0, disks[i, SCALE]
    while speed * scale >= SPEED_BINS:
        doublings, scale = doublings + 1, 0.5 * scale
    if doublings > 0:
        widen(plan, sums, int(disks[i, SPECIES]), time, doublings)
    return first_speed(plan) + SPEED_BINS * int(disks[i, SPECIES]) + int(speed * disks[i, SCALE])


def widen(plan: Plan, sums: Sums, species: int, time: float, doublings: int) -> None:
    """Double the width of the bins of speed of a species so many times."""
    first, bins, rates = first_speed(plan) + SPEED_BINS * species, sums.bins, sums.rates
    for k in range(SPEED_BINS):
        turn(sums, first + k, time, 0.0)
    for k in range(1, SPEED_BINS):
        one, other = first + (k >> min(doublings, 62)), first + k
        rates[one], rates[other] = rates[one] + rates[other], 0.0
        for place in range(MOST_BINS):
            bins[place, one], bins[place, other] = bins[place, one] + bins[place, other], 0.0
    for i in range(len(sums.disks)):
        if int(sums.disks[i, SPECIES]) == species:
            for _ in range(doublings):
                sums.disks[i, SCALE] *= 0.5


def hold(plan: Plan, sums: Sums, i: int, time: float, sign: float) -> None:
    """Add what disk i does in a flight without gravity to the rates (sign 1), or take it away (-1), at a time since ORIGIN."""
    disks = sums.disks
    if disks[i, GX] != 0.0 or disks[i, GY] != 0.0:
        return
    vx, vy, mass, species = disks[i, VX], disks[i, VY], disks[i, MASS], int(disks[i, SPECIES])
    speed2 = vx * vx + vy * vy
    speed = math.sqrt(speed2)
    general = GENERAL + PER_SPECIES * species
    turn(sums, general + PATH, time, sign * speed)
    turn(sums, general + SPEED2, time, sign * speed2)
    turn(sums, slot_of(plan, sums, i, speed, time), time, sign)
    if mass > 0.0:
        turn(sums, ENERGY, time, sign * 0.5 * mass * speed2)
        turn(sums, XX, time, sign * mass * vx * vx)
        turn(sums, XY, time, sign * mass * vx * vy)
        turn(sums, YY, time, sign * mass * vy * vy)
        wall = int(disks[i, LIES_ON])
        if wall >= 0 and plan.walls > 0:
            turn(sums, first_wall(plan) + SIDES * wall, time, sign * mass * sums.walls[wall, PRESS])


def hold_all(plan: Plan, sums: Sums, time: float) -> float:
    """Make all rates anew: sums of changes lose digits where a gas has cooled.  The energy that the velocities have."""
    disks, energy = sums.disks, 0.0
    for c in range(len(sums.rates)):
        turn(sums, c, time, -sums.rates[c])
        sums.rates[c] = 0.0
    for i in range(len(disks)):
        hold(plan, sums, i, time, 1.0)
        energy += 0.5 * disks[i, MASS] * (disks[i, VX] * disks[i, VX] + disks[i, VY] * disks[i, VY])
    spun = 0.0
    for i in range(len(sums.spins)):
        spun += 0.5 * sums.spins[i, 1] * (sums.spins[i, 0] * sums.spins[i, 0])
    turn(sums, TURNING, time, spun)
    sums.numbers[SPUN] = spun
    return energy


def swap(plan: Plan, sums: Sums, i: int, time: float, vx: float, vy: float) -> None:
    """Change the rates by what another velocity of disk i changes, at a time since ORIGIN; nothing makes it fall."""
    disks = sums.disks
    ux, uy, mass = disks[i, VX], disks[i, VY], disks[i, MASS]
    old2, new2 = ux * ux + uy * uy, vx * vx + vy * vy
    old, new = math.sqrt(old2), math.sqrt(new2)
    general = GENERAL + PER_SPECIES * int(disks[i, SPECIES])
    turn(sums, general + PATH, time, new - old)
    turn(sums, general + SPEED2, time, new2 - old2)
    turn(sums, slot_of(plan, sums, i, old, time), time, -1.0)
    turn(sums, slot_of(plan, sums, i, new, time), time, 1.0)
    if mass > 0.0:
        turn(sums, ENERGY, time, 0.5 * mass * (new2 - old2))
        turn(sums, XX, time, mass * (vx * vx - ux * ux))
        turn(sums, XY, time, mass * (vx * vy - ux * uy))
        turn(sums, YY, time, mass * (vy * vy - uy * uy))


def spread(sums: Sums, begin: float, end: float, channel: int, rate: float) -> None:
    """Add a rate x time to a channel, between two times since ORIGIN, both in bins that have been reached."""
    begin = max(begin, 0.0)
    if not end > begin:
        return
    width = sums.numbers[WIDTH]
    low, high = min(int(begin / width), MOST_BINS - 1), min(int(end / width), MOST_BINS - 1)
    for k in range(low, high + 1):
        part = (end if k == high else (k + 1) * width) - (begin if k == low else k * width)
        sums.bins[k, channel] += rate * part


def fall_in_bin(plan: Plan, sums: Sums, i: int, k: int, span: float, ux: float, uy: float, time: float) -> None:
    """Add a part of a flight of disk i under gravity: its bin, how long it is, the velocity at its beginning.

    time: at the end of the flight, since ORIGIN.
    """
    disks, bins = sums.disks, sums.bins
    mass, species = disks[i, MASS], int(disks[i, SPECIES])
    general = GENERAL + PER_SPECIES * species
    gx, gy = disks[i, GX], disks[i, GY]
    mx, my = ux + gx * (0.5 * span), uy + gy * (0.5 * span)  # in its middle
    ex, ey = ux + gx * span, uy + gy * span  # at its end
    middle = mx * mx + my * my
    # Simpson's rule, exact for v^2
    speed2 = ((ux * ux + uy * uy) + 4.0 * middle + (ex * ex + ey * ey)) / 6.0
    speed = (math.sqrt(ux * ux + uy * uy) + 4.0 * math.sqrt(middle) + math.sqrt(ex * ex + ey * ey)) / 6.0
    bins[k, general + PATH] += speed * span
    bins[k, general + SPEED2] += speed2 * span
    slot = slot_of(plan, sums, i, math.sqrt(middle), time)
    bins[k, slot] += span
    if mass > 0.0:
        bins[k, ENERGY] += 0.5 * mass * speed2 * span
        bins[k, XX] += mass * (ux * ux + 4.0 * mx * mx + ex * ex) / 6.0 * span
        bins[k, XY] += mass * (ux * uy + 4.0 * mx * my + ex * ey) / 6.0 * span
        bins[k, YY] += mass * (uy * uy + 4.0 * my * my + ey * ey) / 6.0 * span
    disks[i, LENGTH] += speed * span


def fall(plan: Plan, sums: Sums, i: int, duration: float, time: float) -> None:
    """Add a flight of disk i under gravity, which ends at a time since ORIGIN, to the bins; the disk has its velocity then."""
    disks = sums.disks
    gx, gy = disks[i, GX], disks[i, GY]
    part = duration / PIECES
    wall = int(disks[i, LIES_ON])
    if wall >= 0 and plan.walls > 0:
        press = disks[i, MASS] * sums.walls[wall, PRESS]
        spread(sums, time - duration, time, first_wall(plan) + SIDES * wall, press)
    width = sums.numbers[WIDTH]
    for piece in range(PIECES):
        begin = time - duration + piece * part
        end = time if piece == PIECES - 1 else begin + part
        ux, uy = disks[i, VX], disks[i, VY]
        low, high = max(begin, 0.0), max(end, 0.0)
        first, last = min(int(low / width), MOST_BINS - 1), min(int(high / width), MOST_BINS - 1)
        for k in range(first, last + 1):  # a bin has the part of the flight that lies in it
            since = low if k == first else k * width
            share = (high if k == last else (k + 1) * width) - since
            if share > 0.0:
                lag = since - begin
                fall_in_bin(plan, sums, i, k, share, ux + gx * lag, uy + gy * lag, time)
        disks[i, VX], disks[i, VY] = ux + gx * part, uy + gy * part


def fly(plan: Plan, sums: Sums, i: int, time: float) -> None:
    """Bring disk i to a time along its present flight."""
    disks, origin = sums.disks, sums.numbers[ORIGIN]
    start = disks[i, TIME]
    duration = time - start
    if not duration > 0.0:
        return
    disks[i, TIME] = time
    vx, vy, gx, gy = disks[i, VX], disks[i, VY], disks[i, GX], disks[i, GY]
    disks[i, WX] += duration * (vx + 0.5 * duration * gx)
    disks[i, WY] += duration * (vy + 0.5 * duration * gy)
    if gx != 0.0 or gy != 0.0:
        fall(plan, sums, i, duration, time - origin)
    elif time > origin:
        disks[i, LENGTH] += math.sqrt(vx * vx + vy * vy) * (time - max(start, origin))


def nearest(d: float, period: float) -> float:
    """A difference of coordinates to the nearest image; period 0: there are no images."""
    return d - period * round(d / period) if period > 0.0 else d


def side_of(plan: Plan, sums: Sums, wall: int, radius: float, x: float, y: float, vx: float, vy: float) -> int:
    """Which side a disk that has just met a wall is on; at an end where its foot is not on the wall."""
    walls = sums.walls
    face = int(walls[wall, FACE])
    if face != BOTH:
        return face
    dx, dy = nearest(x - walls[wall, WALL_X], plan.period_x), nearest(y - walls[wall, WALL_Y], plan.period_y)
    ox, oy, bend = walls[wall, OUT_X], walls[wall, OUT_Y], walls[wall, BEND]
    if bend > 0.0:
        cx, cy = dx + ox, dy + oy
        far = math.sqrt(cx * cx + cy * cy)
        if cx * ox + cy * oy < far * bend * walls[wall, HALF]:
            return END
        off, away, size = far - bend, cx * vx + cy * vy, bend
    else:
        size = math.sqrt(ox * ox + oy * oy)
        if abs(dx * oy - dy * ox) > 0.5 * size * size:
            return END
        off, away = -(ox * dx + oy * dy) / size, -(ox * vx + oy * vy)
    if radius > POINT_LIKE * size:
        return RIGHT if off > 0.0 else LEFT
    return RIGHT if away > 0.0 else LEFT  # a point leaves on the side that it is on


def sample(sums: Sums, time: float) -> None:
    """Put displacement and velocity of the watched disks at a time into the buffer."""
    disks, place = sums.disks, sums.counts[FILLED]
    for w in range(len(sums.watched)):
        i = int(sums.watched[w])
        lag = time - disks[i, TIME]
        vx, vy, gx, gy = disks[i, VX], disks[i, VY], disks[i, GX], disks[i, GY]
        sums.way[place, w, 0] = disks[i, WX] + lag * (vx + 0.5 * lag * gx)
        sums.way[place, w, 1] = disks[i, WY] + lag * (vy + 0.5 * lag * gy)
        sums.velocity[place, w, 0] = vx + lag * gx
        sums.velocity[place, w, 1] = vy + lag * gy
    sums.counts[FILLED] = place + 1
    sums.counts[SAMPLED] += 1


def sample_before(sums: Sums, time: float) -> bool:
    """Take the samples that are due before a time; False where the buffer is full first."""
    numbers, counts = sums.numbers, sums.counts
    while numbers[ORIGIN] + numbers[INTERVAL] * counts[SAMPLED] < time:
        if counts[FILLED] == len(sums.way):
            return False
        sample(sums, numbers[ORIGIN] + numbers[INTERVAL] * counts[SAMPLED])
    return True


def mark(sums: Sums, time: float) -> None:
    """Put a point along the contacts; every second one goes where there are too many."""
    counts, points, numbers = sums.counts, sums.points, sums.numbers
    if counts[POINTS] == MOST_POINTS:
        for k in range(MOST_POINTS // 2):
            for c in range(POINT_COLUMNS):
                points[k, c] = points[2 * k + 1, c]
        counts[POINTS] = MOST_POINTS // 2
        counts[STRIDE] *= 2
        if counts[CONTACTS] % counts[STRIDE] != 0:
            return
    place = counts[POINTS]
    points[place, POINT_TIME] = time
    points[place, POINT_ENERGY] = numbers[HEAT]
    points[place, POINT_VIRIAL] = numbers[FORCE]
    points[place, POINT_TURNING] = numbers[SPUN]
    points[place, POINT_ACTION] = numbers[ACTION]
    counts[POINTS] = place + 1


def leave(plan: Plan, sums: Sums, i: int, time: float, vx: float, vy: float) -> float:
    """Disk i begins a free flight at a time with a new velocity; return by how much its energy changes."""
    disks, since = sums.disks, max(time - sums.numbers[ORIGIN], 0.0)
    falls = disks[i, GX] != 0.0 or disks[i, GY] != 0.0 or disks[i, FALL_X] != 0.0 or disks[i, FALL_Y] != 0.0
    if falls:
        hold(plan, sums, i, since, -1.0)
    else:
        swap(plan, sums, i, since, vx, vy)
    fly(plan, sums, i, time)
    old_x, old_y = disks[i, VX], disks[i, VY]
    disks[i, VX], disks[i, VY] = vx, vy
    if falls:
        disks[i, GX], disks[i, GY], disks[i, LIES_ON] = disks[i, FALL_X], disks[i, FALL_Y], -1.0
        hold(plan, sums, i, since, 1.0)
    change: float = 0.5 * disks[i, MASS] * ((vx * vx + vy * vy) - (old_x * old_x + old_y * old_y))
    return change


def spin(sums: Sums, i: int, time: float, spun: float) -> None:
    """Disk i turns at another rate from a time on."""
    spins, numbers = sums.spins, sums.numbers
    change = 0.5 * spins[i, 1] * (spun * spun - spins[i, 0] * spins[i, 0])
    spins[i, 0] = spun
    turn(sums, TURNING, max(time - numbers[ORIGIN], 0.0), change)
    numbers[SPUN] += change


def normal_part(sums: Sums, a: int, impulse: float, spun: float) -> float:
    """The part along the normal of the momentum that rough disks exchange; the other part turns disk a, to the rate `spun`."""
    spins, radius = sums.spins, sums.disks[a, RADIUS]
    if not radius > 0.0:
        return impulse
    along = spins[a, 1] * (spun - spins[a, 0]) / radius
    return math.sqrt(max(impulse * impulse - along * along, 0.0))


def meet(plan: Plan, sums: Sums, a: int, b: int, time: float, impulse: float) -> None:
    """Count a contact of two disks; impulse: the momentum that they exchange along the normal."""
    disks, bins, numbers, counts = sums.disks, sums.bins, sums.numbers, sums.counts
    counted, place = time >= numbers[ORIGIN], counts[PLACE]
    if counted:
        one, other, pairs = int(disks[a, SPECIES]), int(disks[b, SPECIES]), first_pair(plan)
        bins[place, pairs + plan.kinds * one + other] += 1.0
        bins[place, pairs + plan.kinds * other + one] += 1.0
        disks[a, HIT] += 1.0
        disks[b, HIT] += 1.0
    if disks[a, MASS] > 0.0 and disks[b, MASS] > 0.0:
        force = (disks[a, RADIUS] + disks[b, RADIUS]) * impulse
        numbers[FORCE] += force
        if counted:
            bins[place, VIRIAL] += force
            bins[place, PAIRS] += 1.0
        counts[CONTACTS] += 1
        if counts[CONTACTS] % counts[STRIDE] == 0:
            mark(sums, time)


def strike(plan: Plan, sums: Sums, a: int, wall: int, side: int, impulse: float, along: float) -> None:
    """Add the momentum across a wall that a disk gives to it, and the one along it."""
    disks, bins, place = sums.disks, sums.bins, sums.counts[PLACE]
    if disks[a, MASS] > 0.0 and impulse > 0.0:
        lever = sums.walls[wall, LEVER] - sums.walls[wall, INSET] * disks[a, RADIUS]
        bins[place, WALL_VIRIAL] += lever * impulse
        if plan.walls > 0:
            bins[place, first_wall(plan) + SIDES * wall + side] += impulse
            if plan.shears > 0:
                bins[place, first_shear(plan) + SIDES * wall + side] += along


def expect(disks: Floats, i: int) -> None:
    """Disk i is needed soon: machine code fetches it, plain Python does nothing."""


def take(
    block: Block, first: int, plan: Plan, sums: Sums, told: Floats | None = None, facing: Floats | None = None
) -> int:
    """Take up rows from `first` on; return the number of the next row: all are taken, or the buffer of samples is full.

    told: (R, 2) the spins of their disks; None where these have none.  facing: (R, 2) the unit vector along the wall where it may
    pull along itself, 0 in rows whose impulse is all across it; None where no wall pulls.
    """
    disks, numbers = sums.disks, sums.numbers
    for row in range(first, len(block.time)):
        if row + AHEAD < len(block.time):
            expect(disks, block.a[row + AHEAD])
            expect(disks, max(block.b[row + AHEAD], 0))
        time = block.time[row]
        if not sample_before(sums, time):
            return row
        reach(sums, time - numbers[ORIGIN])
        numbers[ACTION] += numbers[HEAT] * (time - numbers[SEEN])
        numbers[SEEN] = time
        kind, a, b, wall = int(block.kind[row]), int(block.a[row]), int(block.b[row]), int(block.wall[row])
        vx, vy, impulse, along = block.vxa[row], block.vya[row], block.impulse[row], 0.0
        if facing is not None and kind == WALL and (facing[row, 0] != 0.0 or facing[row, 1] != 0.0):
            lag = time - disks[a, TIME]
            dx = disks[a, MASS] * (vx - (disks[a, VX] + lag * disks[a, GX]))
            dy = disks[a, MASS] * (vy - (disks[a, VY] + lag * disks[a, GY]))
            impulse = abs(facing[row, 0] * dy - facing[row, 1] * dx)
            along = -(facing[row, 0] * dx + facing[row, 1] * dy)
        change = leave(plan, sums, a, time, vx, vy)
        if b >= 0:
            change += leave(plan, sums, b, time, block.vxb[row], block.vyb[row])
        numbers[HEAT] += change
        if told is not None:
            if kind == PAIR and disks[a, MASS] > 0.0 and disks[b, MASS] > 0.0:
                impulse = normal_part(sums, a, impulse, told[row, 0])
            spin(sums, a, time, told[row, 0])
            if b >= 0:
                spin(sums, b, time, told[row, 1])
        if kind == PAIR:
            meet(plan, sums, a, b, time, impulse)
        elif kind != KICK:
            numbers[FORCE] += sums.walls[wall, INSET] * disks[a, RADIUS] * impulse
            if time >= numbers[ORIGIN]:
                side = side_of(plan, sums, wall, disks[a, RADIUS], block.xa[row], block.ya[row], vx, vy)
                strike(plan, sums, a, wall, side, impulse, along)
                # a disk without energy gives no impulse; a disk that reaches the end of its wall meets nothing
                if kind == WALL and (block.impulse[row] > 0.0 or not disks[a, MASS] > 0.0):
                    sums.bins[sums.counts[PLACE], GENERAL + PER_SPECIES * int(disks[a, SPECIES]) + HITS] += 1.0
                    disks[a, HIT] += 1.0
            if kind == REST:
                since = max(time - numbers[ORIGIN], 0.0)
                hold(plan, sums, a, since, -1.0)
                disks[a, LIES_ON] = wall
                disks[a, GX], disks[a, GY] = sums.walls[wall, SLOPE_X], sums.walls[wall, SLOPE_Y]
                hold(plan, sums, a, since, 1.0)
    return len(block.time)


def finish(until: float, plan: Plan, sums: Sums) -> bool:
    """Bring all disks to the end of the run, flights under way included; False where the buffer of samples is full first."""
    if not sample_before(sums, until):
        return False
    since = max(until - sums.numbers[ORIGIN], 0.0)
    reach(sums, since)
    for c in range(len(sums.rates)):
        turn(sums, c, since, 0.0)
    for i in range(len(sums.disks)):
        fly(plan, sums, i, until)
    return True

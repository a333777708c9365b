"""Scenes in which a disk makes two contacts at exactly one time, in numbers that are all floats.

Places at the contact are Pythagorean and velocities have few bits; the start is taken back from there, and every number that is
no float is thrown away.  So nothing is rounded, and the tie is one of the floats as they are given.
"""

import math
import random
from fractions import Fraction

import eventsim as es

TIME_BITS = (5, 30, 40, 44, 47)
"""With many of them, a contact time as floats compute it is off by some last bits of the places, and no two are alike."""

TRIPLES = [(3, 4, 5), (5, 12, 13), (8, 15, 17), (7, 24, 25), (20, 21, 29), (9, 40, 41)]


def _few_bits(rng, bits, exponent):
    """A float with few bits, about 2**exponent."""
    return math.ldexp(rng.randrange(1 << (bits - 1), 1 << bits), exponent - bits)


def _directions(rng):
    """Two unit vectors with one rational denominator each, at least a right angle apart."""
    while True:
        found = []
        for _ in range(2):
            a, b, c = rng.choice(TRIPLES)
            if rng.random() < 0.5:
                a, b = b, a
            found.append((a * rng.choice((-1, 1)), b * rng.choice((-1, 1)), c))
        (a, b, c), (p, q, r) = found
        if Fraction(a * p + b * q, c * r) < 0:
            return found


def _exact(*values):
    """Fractions as floats; None where one of them is none."""
    floats = [float(value) for value in values]
    return floats if all(Fraction(f) == v for f, v in zip(floats, values, strict=True)) else None


def _spectator(rng, middle, time):
    """A disk that meets nobody, but has a say in the units of the clock."""
    speed = math.ldexp(rng.choice((0.0, 1.0, 2.0**-9)), math.frexp(middle / time)[1] - 5)
    return (1.75 * middle, 1.75 * middle), (-speed, speed / 2), math.ldexp(middle, -rng.randint(5, 20))


def _middle(rng, fastest, time, reach):
    """Where the two contacts are: so far from the corner of the domain that all begins inside."""
    far = math.frexp(2.0 * float(fastest * time) + 8.0 * float(reach))[1]
    return Fraction(2) ** far + Fraction(_few_bits(rng, 4, far - 4)), Fraction(2) ** far


def _in_a_box(rng, disks, middle, time, walls=()):
    """The scene of disks (place, velocity, radius), mostly with a spectator."""
    if rng.random() < 0.7:
        disks = [*disks, _spectator(rng, float(middle[1]), float(time))]
    places, velocities, radii = zip(*disks, strict=True)
    side = 2.0 * float(middle[1])
    return es.Scene(es.Disks(places, velocities, radii), es.Box((side, side)), walls)


def two_partners(seed, remainder=(-20, 10)):
    """A disk that two others hit at one time, at a remainder of 2**remainder; with or without a spectator."""
    rng = random.Random(seed)
    while True:
        time = Fraction(_few_bits(rng, rng.choice(TIME_BITS), rng.randint(*remainder)))
        directions, radius, velocity = _directions(rng), [Fraction(1, 4)], [(Fraction(0), Fraction(0))]
        for a, b, c in directions:
            radius.append(Fraction(c, 1 << rng.randint(3, 5)) - radius[0])
            speeds = [Fraction(_few_bits(rng, rng.randint(1, 3), rng.randint(-3, 3))) for _ in range(2)]
            velocity.append((-int(math.copysign(1, a)) * speeds[0], -int(math.copysign(1, b)) * speeds[1]))
        middle = _middle(rng, max(abs(v) for pair in velocity for v in pair), time, max(radius))
        place = [middle]
        for (a, b, c), r in zip(directions, radius[1:], strict=True):
            place.append((middle[0] + (radius[0] + r) * Fraction(a, c), middle[1] + (radius[0] + r) * Fraction(b, c)))
        start = [(x - u * time, y - w * time) for (x, y), (u, w) in zip(place, velocity, strict=True)]
        if min(radius) <= 0 or _exact(*(v for pair in start for v in pair), *radius) is None:
            continue
        if _meet_early(start, velocity, radius, time):
            continue
        disks = [(tuple(map(float, p)), tuple(map(float, v)), float(r)) for p, v, r in zip(start, velocity, radius, strict=True)]
        return _in_a_box(rng, disks, middle, time)


def _meet_early(start, velocity, radius, time):
    """Whether the two partners meet each other until then."""
    reach = radius[1] + radius[2]
    dx, dy = start[1][0] - start[2][0], start[1][1] - start[2][1]
    du, dw = velocity[1][0] - velocity[2][0], velocity[1][1] - velocity[2][1]
    a, b = du * du + dw * dw, dx * du + dy * dw
    nearest = min(-b / a, time) if a > 0 > b else 0
    return (dx + nearest * du) ** 2 + (dy + nearest * dw) ** 2 <= reach * reach


def two_walls(seed, remainder=(-20, 10)):
    """A disk that meets two slanted walls at one time, at a remainder of 2**remainder; with or without a spectator."""
    rng = random.Random(seed)
    while True:
        time = Fraction(_few_bits(rng, rng.choice(TIME_BITS), rng.randint(*remainder)))
        velocity = [Fraction(_few_bits(rng, rng.randint(1, 3), rng.randint(-3, 3))) * rng.choice((-1, 1)) for _ in range(2)]
        directions = _directions(rng)
        radius = Fraction(directions[0][2] * directions[1][2], 1 << rng.randint(3, 6))
        if any(a * velocity[0] + b * velocity[1] <= 0 for a, b, _ in directions):
            continue
        middle = _middle(rng, max(map(abs, velocity)), time, 4 * radius)
        walls = []
        for a, b, c in directions:
            foot = middle[0] + radius * Fraction(a, c), middle[1] + radius * Fraction(b, c)
            half = rng.randint(1, 3) * radius / c
            walls.append([(foot[0] - s * half * b, foot[1] + s * half * a) for s in (-1, 1)])
        start = middle[0] - velocity[0] * time, middle[1] - velocity[1] * time
        if _exact(*start, radius, *(v for wall in walls for p in wall for v in p)) is None or _crosses(walls):
            continue
        segments = [es.Segment(tuple(map(float, p)), tuple(map(float, q))) for p, q in walls]
        return _in_a_box(rng, [(tuple(map(float, start)), tuple(map(float, velocity)), float(radius))], middle, time, segments)


def _crosses(walls):
    """Whether the two walls cross each other: then the disk may not come from where it is to come from."""

    def side(p, q, r):
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    (p, q), (r, s) = walls
    return side(p, q, r) * side(p, q, s) <= 0 and side(r, s, p) * side(r, s, q) <= 0


def is_cluster(run):
    """Whether the first two rows of a run are one cluster."""
    return len(run.log) >= 2 and run.log.joint.tolist()[:2] == [0, 0]

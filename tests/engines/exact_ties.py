"""Scenes in which a disk makes two contacts at exactly one time, in numbers that are all floats.

Places at the contact are Pythagorean and velocities have few bits; the start is taken back from there, and every number that is
no float is thrown away.  So nothing is rounded, and the tie is one of the floats as they are given.
"""

import math
import random
from fractions import Fraction

import eventsim as es
from eventsim.record.events import Kind

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


def falls_beside(seed):
    """A disk that falls to the floor and meets there, at that instant, one that slides on it or stands: the time is a root of
    a quartic, that of the floor one of a quadratic."""
    rng = random.Random(seed)
    while True:
        time = Fraction(_few_bits(rng, rng.choice((3, 6, 12, 20)), rng.randint(-2, 2)))
        radius = Fraction(rng.choice((1, 2, 3, 5)), 1 << rng.randint(2, 4))
        falls = [Fraction(_few_bits(rng, rng.randint(1, 3), rng.randint(-2, 1))) * rng.choice((-1, 1)) for _ in range(2)]
        slides = rng.choice((Fraction(0), falls[0] * rng.choice((-2, -1, Fraction(1, 2)))))
        middle = 4 + 2 * abs(falls[0]) * math.ceil(time)
        start = middle - falls[0] * time, radius - falls[1] * time + time * time / 2
        other = middle + (2 * radius if falls[0] > slides else -2 * radius)
        begun = other - slides * time
        if start[1] <= radius or _exact(*start, *falls, radius, begun, slides, other) is None:
            continue
        disks = es.Disks(
            [tuple(map(float, start)), (float(begun), float(radius))],
            [tuple(map(float, falls)), (float(slides), 0.0)],
            float(radius),
            [1.0, rng.choice((0.5, 1.0, 3.0)) if slides else rng.choice((1.0, math.inf))],
        )
        size = math.ceil(middle * 4), math.ceil(start[1] + 4 + abs(falls[1]) * time + falls[1] ** 2)
        restitution = rng.choice((0.5, 1.0))
        return es.Scene(disks, es.Box(tuple(map(float, size))), gravity=(0.0, -1.0), restitution=restitution)


def falls_on_two(seed):
    """A disk that falls on two others at once, which stand; both times are roots of quartics."""
    rng = random.Random(seed)
    while True:
        time = Fraction(_few_bits(rng, rng.choice((3, 6, 12, 20)), rng.randint(-2, 2)))
        (a, b, c), (p, q, r) = rng.choice(TRIPLES), rng.choice(TRIPLES)
        unit = Fraction(1, 1 << rng.randint(4, 8))
        offsets = (a * r * unit, -b * r * unit), (-p * c * unit, -q * c * unit)
        speed = [Fraction(_few_bits(rng, rng.randint(1, 3), rng.randint(-3, 0))) * rng.choice((-1, 1)) for _ in range(2)]
        strikes = speed[0], speed[1] - time
        radius = c * r * unit / 2
        if any(strikes[0] * dx + strikes[1] * dy <= 0 for dx, dy in offsets) or _too_near(*offsets, 2 * radius):
            continue
        middle = 4 + 2 * abs(speed[0]) * math.ceil(time) + 4 * radius, 4 + abs(speed[1]) * math.ceil(time) + 4 * radius
        start = middle[0] - speed[0] * time, middle[1] - speed[1] * time + time * time / 2
        others = [(middle[0] + dx, middle[1] + dy) for dx, dy in offsets]
        if _exact(*start, *speed, radius, *others[0], *others[1]) is None or _fell_early(start, speed, others, radius, time):
            continue
        places = [tuple(map(float, place)) for place in (start, *others)]
        disks = es.Disks(places, [tuple(map(float, speed)), (0.0, 0.0), (0.0, 0.0)], float(radius), [1.0, math.inf, math.inf])
        size = math.ceil(middle[0] * 4), math.ceil(start[1] * 2 + speed[1] ** 2)
        return es.Scene(disks, es.Box(tuple(map(float, size))), gravity=(0.0, -1.0), restitution=rng.choice((0.5, 1.0)))


def _too_near(one, other, reach):
    return (one[0] - other[0]) ** 2 + (one[1] - other[1]) ** 2 <= reach * reach


def _fell_early(start, speed, others, radius, time):
    """Whether a disk is near one of the others before, or so near a wall."""
    for k in range(200):
        t = time * Fraction(k, 200)
        place = start[0] + speed[0] * t, start[1] + speed[1] * t - t * t / 2
        if min(place) <= radius or any(_too_near(place, other, 2 * radius) for other in others):
            return True
    return False


def is_cluster(run):
    """Whether the first contact of a run is one of a cluster, whose others may give nothing."""
    return run.log.joint[run.log.kind != Kind.REST][0] >= 0

"""Contact times and the bounds of their errors, against exact rationals.

    python -m tests.formulas.doubt_cases [--cases 1000000] [--seed 0]

Half of the cases are random, half are near a degeneracy: grazes, gaps of last bits, far away, very uneven speeds.
"""

from __future__ import annotations

import argparse
import math
import statistics
from fractions import Fraction

import numpy as np

from eventsim.formulas.contact import leaving_delay, screened_pair_delay
from eventsim.formulas.crossing import crossing_delay
from eventsim.formulas.digits import careful_pair_delay
from eventsim.formulas.doubt import contact_doubt, round_size
from eventsim.formulas.motion import position, velocity
from tests.formulas.test_digits import root

KINDS = ("pair", "container", "border", "falling border")


def flight(rng, hard):
    """(x, y, vx, vy, t) of a disk."""
    scale = 2.0 ** rng.integers(-6, 20) if hard else 1.0
    x, y = scale * rng.normal(size=2) + rng.choice([0.0, 0.0, 100.0]) * hard
    speed = 2.0 ** rng.integers(-20, 20) if hard else 1.0
    vx, vy = speed * rng.normal(size=2)
    return float(x), float(y), float(vx), float(vy), float(rng.uniform(0.0, 4.0))


def aimed(rng, one, other, reach, graze):
    """The second flight so aimed that it comes near the first one: centrally, or along its rim."""
    x, y, u, w, t = other
    dx, dy = one[0] - x, one[1] - y
    distance = math.hypot(dx, dy)
    if distance <= 1.5 * reach:
        return None
    miss = reach * (1.0 - 2.0 ** -float(rng.uniform(1, 45)) if graze else rng.uniform(-1.0, 1.0))
    angle = math.atan2(dy, dx) + math.asin(max(-1.0, min(1.0, miss / distance)))
    speed = math.hypot(u, w)
    return x, y, one[2] + speed * math.cos(angle), one[3] + speed * math.sin(angle), t


def pair(rng, hard):
    """(computed time, exact time, bound) of a pair; None where it does not meet."""
    reach = float(rng.uniform(0.2, 1.0))
    one = flight(rng, hard)
    other = aimed(rng, one, flight(rng, hard), reach, hard and rng.random() < 0.5)
    if other is None:
        return None
    begin = max(one[4], other[4])
    (px, py), (qx, qy) = ((f[0] + f[2] * (begin - f[4]), f[1] + f[3] * (begin - f[4])) for f in (one, other))
    dx, dy, du, dw = px - qx, py - qy, one[2] - other[2], one[3] - other[3]
    delay = screened_pair_delay(dx, dy, du, dw, reach)
    careful = delay != delay
    if careful:
        delay = careful_pair_delay(*one, 0.5 * reach, *other, 0.5 * reach, 0.0, 0.0)
    if not delay < math.inf:
        return None
    exact = exact_round([*map(Fraction, one)], [*map(Fraction, other)], Fraction(reach), -1)
    a, cross = du * du + dw * dw, dx * dw - dy * du
    discriminant = a * reach * reach - cross * cross
    if exact is None or discriminant <= 0.0 or math.hypot(dx, dy) <= reach:
        return None
    places = sum(abs(f[k]) + abs(f[k + 2] * (begin - f[4])) for f in (one, other) for k in (0, 1))
    size = 0.0 if careful else round_size(places, math.hypot(dx, dy), reach, math.sqrt(a) * delay)
    return begin + delay, exact, contact_doubt(size, math.sqrt(discriminant) / reach, a / reach, begin + delay)


def container(rng, hard):
    """The same of a disk in a round container around the origin."""
    inner, radius = float(rng.uniform(0.5, 3.0)), float(rng.uniform(0.0, 0.4))
    angle, far = (
        rng.uniform(0.0, 2.0 * math.pi),
        (inner - radius) * (1.0 - 2.0 ** -float(rng.uniform(1, 40 if hard else 5))),
    )
    x, y = float(far * math.cos(angle)), float(far * math.sin(angle))
    vx, vy, t = (float(v) for v in (*rng.normal(size=2), rng.uniform(0.0, 4.0)))
    reach = inner - radius
    delay = leaving_delay(x, y, vx, vy, radius, 0.0, 0.0, inner)
    still = [Fraction(0)] * 4 + [Fraction(t)]
    exact = exact_round([*map(Fraction, (x, y, vx, vy, t))], still, Fraction(inner) - Fraction(radius), 1)
    a, cross = vx * vx + vy * vy, x * vy - y * vx
    discriminant = a * reach * reach - cross * cross
    if exact is None or discriminant <= 0.0:
        return None
    size = round_size(abs(x) + abs(y), math.hypot(x, y), reach, math.sqrt(a) * delay) + inner
    return t + delay, exact, contact_doubt(size, math.sqrt(discriminant) / reach, a / reach, t + delay)


def border(rng, hard, falls=False):
    """The same of a disk and a wall along an axis."""
    x, _, v, _, t = flight(rng, hard)
    side = 1.0 if v < 0.0 else -1.0
    target = x - side * abs(float(rng.normal())) * 2.0 ** -float(rng.uniform(0, 30 if hard else 3))
    g = float(-side * rng.uniform(0.1, 10.0)) if falls else None
    delay = crossing_delay(x, v, g, target, side)
    if not 0.0 < delay < math.inf:
        return None
    gap, rate, pull = Fraction(side) * (Fraction(x) - Fraction(target)), Fraction(side * v), Fraction(side * (g or 0.0))
    exact = -gap / rate if pull == 0 else (rate + root(rate * rate - 2 * pull * gap)) / -pull
    approach = abs(velocity(v, delay, g))
    size = abs(x) + abs(target) + abs(v) * delay + abs(position(0.0, 0.0, delay, g))
    return t + delay, Fraction(t) + exact, contact_doubt(size, approach, abs(g or 0.0), t + delay)


def exact_round(one, other, reach, side):
    """When straight flights are `reach` apart: first (-1), or last (+1)."""
    begin = max(one[4], other[4])
    dx, dy = ((one[k] + one[k + 2] * (begin - one[4])) - (other[k] + other[k + 2] * (begin - other[4])) for k in (0, 1))
    du, dw = one[2] - other[2], one[3] - other[3]
    a, b = du * du + dw * dw, dx * du + dy * dw
    discriminant = a * reach * reach - (dx * dw - dy * du) ** 2
    if a == 0 or discriminant <= 0:
        return None
    return begin + (-b + side * root(discriminant)) / a


def case(rng, kind, hard):
    """A case of one kind, None where there is no contact."""
    if kind == "pair":
        return pair(rng, hard)
    if kind == "container":
        return container(rng, hard)
    return border(rng, hard, falls=kind == "falling border")


def tried(cases, seed):
    """kind -> (how much too wide each bound is, cases in which a bound does not hold)."""
    rng = np.random.default_rng(seed)
    found = {kind: ([], []) for kind in KINDS}
    for k in range(cases):
        kind = KINDS[k % len(KINDS)]
        hard = (k // len(KINDS)) % 2 == 1
        outcome = case(rng, kind, hard)
        if outcome is None:
            continue
        time, exact, bound = outcome
        error = abs(Fraction(time) - exact)
        wide, broken = found[kind]
        wide.append(bound / float(error) if error else math.inf)
        if error > bound:
            broken.append((k, float(error), bound))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=float, default=1e6)
    parser.add_argument("--seed", type=int, default=0)
    chosen = parser.parse_args()
    for kind, (wide, broken) in tried(int(chosen.cases), chosen.seed).items():
        counts = f"{len(wide):8} contacts, {len(broken)} beyond the bound"
        print(f"{kind:15} {counts}, in the median {statistics.median(wide):.3g} times too wide")
        for example in broken[:3]:
            print("   ", example)


if __name__ == "__main__":
    main()

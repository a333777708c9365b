"""Contacts: one, or several at one instant; a point at the very end of a wall; the maps of deviations through them."""

from __future__ import annotations

import math
from decimal import Decimal
from typing import Any

import numpy as np

from tests.oracle.digits import ONE, UNIT, ZERO, is_float, root
from tests.oracle.doubt import SAFE, NoDoubt, contact_map, last_bits
from tests.oracle.impact import MOST_TOGETHER, Together, lightness, parted, shares
from tests.oracle.order import demand_ends, demand_small, is_same, lateness, predict
from tests.oracle.rest import settle
from tests.oracle.search import Meeting, pair_key, wall_key
from tests.oracle.state import State, floats, size
from tests.oracle.story import PAIR, WALL, BeyondError
from tests.oracle.table import Bow, Line, Tip, Vector, across, names_of

ASIDE = 1e-6
"""A point that slides is so far beside its wall, as an angle seen from the end of that, to tell on which side."""

NONE = Decimal("1e-40")
"""What is below this part of a velocity, in the digits of the first round, is nothing where the reason is known."""


def resolve(run: State, cluster: list[Meeting]) -> list[int]:
    """Resolve the contacts of one instant: rows, new flights, predictions; the disks that take part."""
    cluster = without_doubles(run, cluster)
    es = [restitution_of(run, m) for m in cluster]
    normals = [run.normal(m) for m in cluster]
    clock = run.tick()
    delays = {i: float(run.now - run.flights[i].time) for i in cluster[0].disks}
    late = lateness(run, cluster[0]) + UNIT * (clock + max(delays.values()))
    disks = sorted({i for m in cluster for i in m.disks})
    pulls = {i: (run.flights[i].ax, run.flights[i].ay) for i in disks}
    terms = max(run.terms_of(m) for m in cluster)
    states = {i: run.fly_to_now(i, clock, sides_met(run, i, cluster), terms) for i in disks}
    before = {i: states[i][1] for i in disks}
    may_refuse = False
    if len(cluster) == 1:
        m, e = cluster[0], es[0]
        if m.at_end and is_convex(run, m.a, [m], before[m.a]):
            after, impulses, unique, may_refuse = {m.a: _turned(before[m.a], e)}, [ONE], True, True
        else:
            after, impulses, unique = parted_by_one(run, m, normals[0], before, e)
        map_contact(run, m, normals[0], before, after, pulls, e)
        turn_normal(run, m, normals[0], states, {i: UNIT * (clock + since) for i, since in delays.items()}, e)
    elif all(m.at_end for m in cluster) and len(disks) == 1 and is_convex(run, disks[0], cluster, before[disks[0]]):
        i = disks[0]
        after, unique, may_refuse = {i: _turned(before[i], es[0])}, True, True
        impulses = [ONE] + [ZERO] * (len(cluster) - 1)  # one row, whatever ends there
    else:
        if any(run.table.mass[i] == 0 for i in disks):
            raise BeyondError("a cluster with tracers")
        together = [Together(m.a, m.b, n, e) for m, n, e in zip(cluster, normals, es, strict=True)]
        if len(together) > MOST_TOGETHER:
            raise BeyondError("a large cluster")
        after, impulses, unique = parted(together, before, run.table.mass)
        map_cluster(run, cluster, normals, es, before, after, impulses, pulls)
    after = {i: _without_noise(v, before[i]) for i, v in after.items()}
    run.group += 1
    touches: dict[int, dict[tuple[int, ...], bool]] = {i: {} for i in disks}
    for m, e in zip(cluster, es, strict=True):
        still = e == 0 and len(cluster) == 1
        if m.b >= 0:
            touches[m.a][pair_key(m.a, m.b, m.image)] = still
            touches[m.b][pair_key(m.b, m.a, (-m.image[0], -m.image[1]))] = still
        else:
            touches[m.a][wall_key(m.shape, m.image, m.side)] = still
    for i in disks:
        run.round_velocity(i, before[i], after[i], clock)
        held = run.flights[i].held
        if held is not None:
            touches[i].setdefault(wall_key(held[0], (0, 0), held[1]), is_along(run, held[0], after[i]))
        run.begin_flight(i, states[i][0], after[i], touches[i])
        run.rest_due.pop(i, None)
    for m, q in zip(cluster, impulses, strict=True):
        if q == 0 and len(cluster) > 1 and unique:
            continue
        walls = names_at(run, m, cluster) if m.b < 0 else frozenset()
        kind = WALL if m.b < 0 else PAIR
        idle = all(_change(before[i], after[i]) <= 1e-13 * (1e-300 + size(before[i])) for i in m.disks)
        run.add_row(kind, m.disks, walls, late, loose=not unique, may_refuse=may_refuse, idle=idle)
    for i in disks:
        run.met[i] = run.now
    run.last = run.now
    demand_small(run, disks)
    demand_ends(run)
    settled = [] if may_refuse and len(cluster) > 1 else settled_by(run, cluster, es, impulses)
    predict(run, [i for i in disks if i not in settled])
    for i in settled:
        predict(run, [i])
    return disks


def settled_by(run: State, cluster: list[Meeting], es: list[Decimal], impulses: list[Decimal]) -> list[int]:
    """The disk, if any, that comes to rest behind a contact with one wall; with others at the same time that give it nothing."""
    given = [k for k, q in enumerate(impulses) if q != 0]
    if len(given) != 1 or any(m.b >= 0 for m in cluster):
        return []
    m, others = cluster[given[0]], [other for k, other in enumerate(cluster) if k != given[0]]
    return [m.a] if settle(run, m, es[given[0]], others) else []


def restitution_of(run: State, m: Meeting) -> Decimal:
    """The restitution of a contact; 1 within the contact duration after the last one of its disks."""
    e = run.table.pair_restitution if m.b >= 0 else run.table.wall_restitution
    duration = run.table.contact_duration
    if duration is None or e == 1:
        return e
    for i in m.disks:
        since = m.time - run.met[i]
        margin = float(abs(since - duration))
        if SAFE * (lateness(run, m) + UNIT * float(m.time - run.begun)) > margin:
            raise BeyondError("the contact duration")
        if since < duration:
            e = ONE
    return e


def sides_met(run: State, i: int, cluster: list[Meeting]) -> tuple[int, ...]:
    """The axes along which a disk meets sides of the domain: there its place is exact."""
    sides = [run.table.shapes[m.shape] for m in cluster if m.b < 0 and m.a == i]
    return tuple(0 if side.normal[1] == 0 else 1 for side in sides if isinstance(side, Line) and side.length2 is None)


def map_contact(
    run: State,
    m: Meeting,
    normal: Vector,
    before: dict[int, Vector],
    after: dict[int, Vector],
    pulls: dict[int, Vector],
    e: Decimal,
) -> None:
    """Let the deviations of a contact's disks go through it."""
    if isinstance(run.doubt, NoDoubt) or run.closing_rate(m, normal, before) == 0:
        return
    velocities = [(floats(before[i]), floats(after[i])) for i in m.disks]
    accelerations = [(floats(pulls[i]), floats(run.table.pull[i])) for i in m.disks]
    parts = [1.0] if m.b < 0 else [float(s) for s in shares(run.table.mass[m.a], run.table.mass[m.b])]
    with np.errstate(all="ignore"):  # what has grown so far ends the judging
        matrix = contact_map(floats(normal), run.bend(m), velocities, accelerations, parts, float(e))
    run.doubt.map(m.disks, matrix)


def turn_normal(
    run: State,
    m: Meeting,
    normal: Vector,
    states: dict[int, tuple[Vector, Vector]],
    instants: dict[int, float],
    e: Decimal,
) -> None:
    """Round the velocities of a contact as its normal is rounded, which places at a rounded time give.

    A deviation of a flight moves the contact along its flight; a rounding there moves the place alone, and turns the normal.
    instants: by disk, the rounding of the time of its flight.
    """
    aside, speed = 0.0, 0.0
    along = (abs(float(normal[1])), abs(float(normal[0])))
    for i in m.disks:
        on_clock = run.is_on_clock(i)
        for share, place, v, c in zip(along, *states[i], run.table.corner, strict=True):
            if not (is_float(place - c) and (v == 0 or on_clock)):
                aside += share * (last_bits(place - c) + abs(float(v)) * instants[i])
        speed += float(size(states[i][1]))
    parts = [1.0] if m.b < 0 else [float(s) for s in shares(run.table.mass[m.a], run.table.mass[m.b])]
    for i, share in zip(m.disks, parts, strict=True):
        sigma = share * (1.0 + float(e)) * speed * abs(run.bend(m)) * aside
        run.doubt.round(i, (0.0, 0.0, sigma, sigma))


def is_along(run: State, k: int, velocity: Vector) -> bool:
    """Whether a disk that rested on a line still moves along it, as after a contact with another one that rests there."""
    one = run.table.shapes[k]
    assert isinstance(one, Line)
    rate = abs(one.normal[0] * velocity[0] + one.normal[1] * velocity[1])
    return rate <= NONE * one.norm * (abs(velocity[0]) + abs(velocity[1]))


def parted_by_one(
    run: State, m: Meeting, normal: Vector, before: dict[int, Vector], e: Decimal
) -> tuple[dict[int, Vector], list[Decimal], bool]:
    """Velocities after a single contact."""
    rate = run.closing_rate(m, normal, before)
    nx, ny = normal
    q = (1 + e) * rate
    if m.b < 0:
        u, w = before[m.a]
        shape = run.table.shapes[m.shape]
        if isinstance(shape, Line):  # without the root in the normal's length
            mx, my = shape.normal
            q = (1 + e) * (mx * u + my * w) / (mx * mx + my * my)
            return {m.a: (u - q * mx, w - q * my)}, [ONE], True
        return {m.a: (u - q * nx, w - q * ny)}, [ONE], True
    share_a, share_b = shares(run.table.mass[m.a], run.table.mass[m.b])
    (ua, wa), (ub, wb) = before[m.a], before[m.b]
    return (
        {
            m.a: (ua - q * share_a * nx, wa - q * share_a * ny),
            m.b: (ub + q * share_b * nx, wb + q * share_b * ny),
        },
        [ONE],
        True,
    )


def without_doubles(run: State, cluster: list[Meeting]) -> list[Meeting]:
    """One contact of each disk with walls that continue each other in line."""
    kept: list[Meeting] = []
    for m in cluster:
        if not is_same(run, m, kept):
            kept.append(m)
    return kept


def names_at(run: State, m: Meeting, cluster: list[Meeting]) -> frozenset[str]:
    """The names that a log may give: of the wall, and of what continues it there."""
    shape = run.table.shapes[m.shape]
    names = set(names_of(shape))
    x, y, _, _ = run.flights[m.a].at(run.now)
    for k in run.kin(m.shape):
        other = run.table.shapes[k]
        if isinstance(shape, Line | Bow) and isinstance(other, Tip):
            foot = foot_distance(run, shape, other, (x, y))
            if foot <= 1e-6 * run.large:
                names |= other.names
    return frozenset(names)


def foot_distance(run: State, shape: Line | Bow, tip: Tip, place: Vector) -> float:
    """How far the foot of a disk on a wall is from an end of it."""
    px, py = place[0] - tip.place[0], place[1] - tip.place[1]
    if isinstance(shape, Line):
        return abs(float((shape.along[0] * px + shape.along[1] * py) / shape.norm))
    dx, dy = place[0] - shape.centre[0], place[1] - shape.centre[1]
    scale = shape.radius / root(dx * dx + dy * dy)
    return math.hypot(
        float(shape.centre[0] + dx * scale - tip.place[0]), float(shape.centre[1] + dy * scale - tip.place[1])
    )


def is_convex(run: State, i: int, cluster: list[Meeting], velocity: Vector) -> bool:
    """Whether a point that meets the very end of walls is outside a corner that they make: it is turned round
    there.

    Seen from the end the point comes from -v.  The walls that bound the sector which it comes from make a concave
    corner where that sector is narrower than half a turn.
    """
    x, y, _, _ = run.flights[i].at(run.now)
    tips = [
        shape
        for k in run.table.bonds[cluster[0].shape]
        if isinstance(shape := run.table.shapes[k], Tip)
        and math.hypot(float(shape.place[0] - x), float(shape.place[1] - y)) <= 1e-20 * run.large
    ]
    if not tips:
        return True
    u, w = floats(velocity)
    if (held := run.flights[i].held) is not None:  # it comes along a wall, on one side of it
        nx, ny = floats(run.table.shapes[held[0]].normal)
        aside = held[1] * ASIDE * math.hypot(u, w) / math.hypot(nx, ny)
        u, w = u - aside * nx, w - aside * ny
    back = math.atan2(-w, -u)
    arms = list(tips[0].arms)
    for side in run.table.shapes:
        if isinstance(side, Line) and side.length2 is None and across(side, tips[0].place) == 0:
            arms += [side.along, (-side.along[0], -side.along[1])]
    turns = sorted((math.atan2(float(ty), float(tx)) - back) % math.tau for tx, ty in arms)
    return turns[0] + math.tau - turns[-1] > math.pi + 1e-12


def map_cluster(
    run: State,
    cluster: list[Meeting],
    normals: list[Vector],
    es: list[Decimal],
    before: dict[int, Vector],
    after: dict[int, Vector],
    impulses: list[Decimal],
    pulls: dict[int, Vector],
) -> None:
    """The map of deviations that keep the tie: impulses with the same active contacts, normals that turn with the
    places.
    """
    disks = sorted(before)
    index = {i: 4 * k for k, i in enumerate(disks)}
    size = 4 * len(disks)
    active = [k for k, q in enumerate(impulses) if q != 0]
    if not active:
        return
    light = {i: float(lightness(run.table.mass[i])) for i in disks}
    v = np.array([[float(c) for c in before[i]] for i in disks]).ravel()
    rate = float(run.closing_rate(cluster[0], normals[0], before))
    late = np.zeros(size)
    n0 = np.array([float(c) for c in normals[0]])
    for i, s in zip(cluster[0].disks, (1.0, -1.0), strict=False):
        late[index[i] : index[i] + 2] = -s * n0 / rate
    base = np.array([[float(c) for c in normals[k]] for k in active])

    def change(ns: Any, velocity: Any) -> Any:
        rows = np.zeros((len(active), 2 * len(disks)))
        for r, k in enumerate(active):
            for i, s in zip(cluster[k].disks, (1.0, -1.0), strict=False):
                rows[r, index[i] // 2 : index[i] // 2 + 2] = s * ns[r]
        inverse = np.array([light[i] for i in disks for _ in range(2)])
        wanted = -np.array([1.0 + float(es[k]) for k in active]) * (rows @ velocity)
        q = np.linalg.lstsq((rows * inverse) @ rows.T, wanted, rcond=None)[0]
        return inverse * (rows.T @ q)

    matrix = np.eye(size)
    step = 1e-6
    scale = np.abs(v).max() or 1.0
    for column in range(size):
        unit = np.zeros(size)
        unit[column] = 1.0
        dt = float(late @ unit)
        dv = np.array([unit[index[i] + 2 + axis] for i in disks for axis in range(2)])
        dn = np.zeros_like(base)
        for r, k in enumerate(active):
            shift = np.zeros(2)
            for i, s in zip(cluster[k].disks, (1.0, -1.0), strict=False):
                shift += s * (unit[index[i] : index[i] + 2] + dt * np.array([float(c) for c in before[i]]))
            dn[r] = run.bend(cluster[k]) * (shift - base[r] * (base[r] @ shift))
        h = step / max(1.0, np.abs(dn).max(initial=0.0), np.abs(dv).max() / scale)
        new = dv + (change(base + h * dn, v + h * dv) - change(base - h * dn, v - h * dv)) / (2 * h)
        for k, i in enumerate(disks):
            gap = np.array([float(b - a) for b, a in zip(before[i], after[i], strict=True)])
            matrix[index[i] : index[i] + 2, column] = unit[index[i] : index[i] + 2] + gap * dt
            matrix[index[i] + 2 : index[i] + 4, column] = new[2 * k : 2 * k + 2]
    run.doubt.map(disks, matrix)


def _without_noise(velocity: Vector, before: Vector) -> Vector:
    """A velocity without what the digits of a round leave of a component that is 0."""
    least = NONE * (abs(before[0]) + abs(before[1]))
    return (ZERO if abs(velocity[0]) <= least else velocity[0], ZERO if abs(velocity[1]) <= least else velocity[1])


def _turned(velocity: Vector, e: Decimal) -> Vector:
    return -e * velocity[0], -e * velocity[1]


def _change(before: Vector, after: Vector) -> float:
    return math.hypot(float(after[0] - before[0]), float(after[1] - before[1]))

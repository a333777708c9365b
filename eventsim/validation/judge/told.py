"""Who met whom, from the turns of sampled paths: turns at one time of disks that are close explain each other."""

from __future__ import annotations

import math
from collections import defaultdict
from dataclasses import dataclass, field

import numpy as np

from eventsim.record.contacts import Key
from eventsim.record.events import Floats, Kind
from eventsim.validation.judge.flights import Flights, Turn
from eventsim.validation.judge.surroundings import Surroundings

NEAR = 0.1
"""In reaches: how far apart disks that meet may be at a sample, besides what they fly from one sample to the next."""

WEAK = 0.02
"""Of the strongest impulse of turns that are entangled: weaker ones are none."""

ALONG = 0.15
"""The sine of the angle between a turn and the line of centres, seen at samples, that one contact alone may have."""

ROUNDS = 200
"""Of the relaxation that shares entangled turns among contacts; they are few and it converges geometrically."""


@dataclass(frozen=True, slots=True)
class Met:
    """A contact that an engine made.

    key: (kind, a, b or wall).  time: when.  first, last: samples up to which and from which on both are free.  turns: of a and
    b, None for what did not turn.  alone: whether the turns are those of this contact alone, so that they tell its impulse.
    across: the part of what it gave that is not along the line of centres, or the normal of the wall; NaN where nobody knows.
    """

    key: Key
    time: float
    first: int
    last: int
    turns: tuple[Turn | None, Turn | None] = (None, None)
    alone: bool = False
    across: float = math.nan


@dataclass(slots=True)
class Read:
    """What the paths tell: contacts in order of time, turns with nothing near, and turns in groups that may share contacts."""

    met: list[Met] = field(default_factory=list)
    unexplained: list[Turn] = field(default_factory=list)
    groups: list[list[Turn]] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class Edge:
    """A contact that may explain turns: their places in the list (of a; of b or None), who, the unit normal from a on.

    at_turn: that normal where the two flights cross; None where it is not known.
    """

    turns: tuple[int, int | None]
    key: Key
    normal: tuple[float, float]
    swapped: bool = False
    at_turn: tuple[float, float] | None = None


def contacts_from(flights: Flights, around: Surroundings, mass: Floats) -> Read:
    """The contacts that turns tell of; mass: (n,), inf for immovable disks."""
    turns = sorted(flights.turns(), key=lambda turn: (turn.first, turn.disk))
    close = _close(flights, around, turns)
    crowded = {place for edge in close for place in edge.turns if place is not None}
    edges = [*(edge for edge in close if _is_apart(edge, turns)), *_walls(flights, around, turns)]
    explained = {place for edge in edges for place in edge.turns if place is not None}
    for place in range(len(turns)):
        if place not in explained:
            edges += _still(flights, around, turns, place)
    explained = {place for edge in edges for place in edge.turns if place is not None}
    found = Read(unexplained=[turns[place] for place in range(len(turns)) if place not in explained])
    for group in _entangled([edge.turns for edge in edges]):
        found.met += _shared([edges[number] for number in group], turns, mass, crowded)
    found.met.sort(key=lambda met: met.time)
    ties: list[tuple[int, int | None]] = [*(edge.turns for edge in close), *((place, None) for place in range(len(turns)))]
    for group in _entangled(ties):
        places = sorted({place for number in group for place in ties[number] if place is not None})
        found.groups.append([turns[place] for place in places])
    return found


def _span(turn: Turn, count: int) -> slice:
    """The samples of a turn, and one on both sides."""
    return slice(max(turn.first - 1, 0), min(turn.last + 2, count))


def is_beside_something(turn: Turn, flights: Flights, around: Surroundings, mass: Floats) -> bool:
    """Whether a disk may have met a wall, or an immovable disk, in a turn, besides what it has met."""
    span = slice(max(turn.first - 1, 0), turn.last + 2)
    lag = float(np.diff(flights.times[span]).sum())
    flown = lag * max(math.hypot(*turn.before), math.hypot(*(turn.before + turn.change)))
    radius = around.stage.radius
    margin = float(radius[turn.disk]) * (1.0 + NEAR) + flown
    places = flights.place[span, turn.disk]
    if any(around.to_wall(surface, place)[1] < margin for surface in around.surfaces for place in places):
        return True
    away = np.hypot(*around.apart(places[0], flights.place[span.start]).T) - radius * (1.0 + NEAR) - margin
    return bool(np.any(away[~np.isfinite(mass)] < 0.0))


def flown_at(flights: Flights, turn: Turn) -> float:
    """How far a disk flies from one sample to the next at a turn."""
    around = slice(max(turn.first - 1, 0), turn.last + 2)
    step = float(np.diff(flights.times[around]).max(initial=0.0))
    return step * float(max(math.hypot(*turn.before), math.hypot(*(turn.before + turn.change))))


def _close(flights: Flights, around: Surroundings, turns: list[Turn]) -> list[Edge]:
    """Two turns at one time, of disks that are close."""
    edges, count = [], len(flights.times)
    active: list[int] = []
    for place, turn in enumerate(turns):
        active = [other for other in active if turns[other].last >= turn.first + flights.told]
        for other in active:
            one = turns[other]
            if one.disk == turn.disk:
                continue
            i, j = (other, place) if one.disk < turn.disk else (place, other)
            a, b = turns[i].disk, turns[j].disk
            span = slice(max(one.first, turn.first) - 1, min(max(one.last, turn.last) + 2, count))
            span = slice(max(span.start, 0), span.stop)
            reach = float(around.stage.radius[a] + around.stage.radius[b])
            margin = NEAR * reach + flown_at(flights, one) + flown_at(flights, turn)
            if around.gap(a, b, flights.place[span, a], flights.place[span, b]) > margin:
                continue
            middle = (span.start + span.stop - 1) // 2
            d = around.apart(flights.place[middle, a], flights.place[middle, b])
            size = math.hypot(*d) or 1.0
            normal = (float(d[0]) / size, float(d[1]) / size)
            there = around.apart(turns[i].place, turns[j].place)
            size = math.hypot(*there)
            at_turn = (float(there[0]) / size, float(there[1]) / size) if size > 0.0 else None
            edges.append(Edge((i, j), (int(Kind.PAIR), a, b), normal, at_turn=at_turn))
        active.append(place)
    return edges


def _is_apart(edge: Edge, turns: list[Turn]) -> bool:
    """Whether one of two turns leads away from the other disk."""
    i, j = edge.turns
    normal = np.array(edge.normal)
    return float(turns[i].change @ normal) < 0.0 or (j is not None and float(turns[j].change @ normal) > 0.0)


def _walls(flights: Flights, around: Surroundings, turns: list[Turn]) -> list[Edge]:
    """A turn beside a wall, away from it."""
    edges, count = [], len(flights.times)
    for place, turn in enumerate(turns):
        radius = float(around.stage.radius[turn.disk])
        margin = radius * (1.0 + NEAR) + flown_at(flights, turn)
        best: dict[int, tuple[float, tuple[float, float], int]] = {}
        for surface in around.surfaces:
            for sample in range(*_span(turn, count).indices(count)):
                normal, distance = around.to_wall(surface, flights.place[sample, turn.disk])
                away = float(turn.change @ np.array(normal))
                if -margin < distance < margin and away > WEAK * math.hypot(*turn.change):
                    wall = around.wall_of(surface)
                    if wall not in best or away > best[wall][0]:
                        best[wall] = (away, normal, surface)
        for wall, (_, normal, surface) in best.items():
            (x, y), distance = around.to_wall(surface, turn.place)
            at_turn = (-x, -y) if math.isfinite(distance) else None
            edges.append(Edge((place, None), (int(Kind.WALL), turn.disk, wall), (-normal[0], -normal[1]), at_turn=at_turn))
    return edges


def _still(flights: Flights, around: Surroundings, turns: list[Turn], place: int) -> list[Edge]:
    """A disk close by that does not turn itself, as immovable and very heavy ones."""
    turn = turns[place]
    span = _span(turn, len(flights.times))
    radius, mine = around.stage.radius, flights.place[span, turn.disk]
    middle = (span.start + span.stop - 1) // 2
    d = around.apart(flights.place[middle, turn.disk], flights.place[middle])
    distance = np.hypot(d[:, 0], d[:, 1])
    away = -(d @ turn.change) / np.maximum(distance, 1e-300)
    near = distance < (radius + radius[turn.disk]) * (1.0 + NEAR) + 2.0 * flown_at(flights, turn)
    near &= away > 0.5 * math.hypot(*turn.change)
    near[turn.disk] = False
    for other in np.flatnonzero(near)[np.argsort(-away[near])].tolist():
        reach = float(radius[other] + radius[turn.disk])
        if around.gap(turn.disk, other, mine, flights.place[span, other]) < NEAR * reach + flown_at(flights, turn):
            a, b = min(turn.disk, other), max(turn.disk, other)
            normal = (float(d[other, 0] / distance[other]), float(d[other, 1] / distance[other]))
            return [Edge((place, None), (int(Kind.PAIR), a, b), normal, swapped=turn.disk != a)]
    return []


def _entangled(ties: list[tuple[int, int | None]]) -> list[list[int]]:
    """The numbers of ties of one or two turns, in groups that share turns."""
    leader: dict[int, int] = {}

    def lead(place: int) -> int:
        while leader.setdefault(place, place) != place:
            place = leader[place]
        return place

    for i, j in ties:
        if j is not None:
            leader[lead(j)] = lead(i)
        else:
            lead(i)
    groups: dict[int, list[int]] = defaultdict(list)
    for number, tie in enumerate(ties):
        groups[lead(tie[0])].append(number)
    return list(groups.values())


def _shared(group: list[Edge], turns: list[Turn], mass: Floats, crowded: set[int]) -> list[Met]:
    """The contacts of a group: the edge itself where it is alone; else those with impulses that explain the turns best.

    crowded: turns with another one beside them, which a wall alone does not explain.
    """
    if len(group) == 1:
        return [_met(group[0], turns, group[0].turns[1] is not None or group[0].turns[0] not in crowded)]
    strength = _impulses(group, turns, mass)
    strongest = max(strength)
    ranked = sorted(zip(strength, group, strict=True), key=lambda one: -one[0])
    best = {edge.key: edge for one, edge in reversed(ranked) if one > WEAK * strongest}
    kept = list(best.values())
    shared: dict[int, int] = defaultdict(int)
    for edge in kept:
        for place in edge.turns:
            if place is not None:
                shared[place] += 1
    return [_met(edge, turns, _is_alone(edge, shared, crowded)) for edge in kept]


def _is_alone(edge: Edge, shared: dict[int, int], crowded: set[int]) -> bool:
    """Whether the turns of a contact are shared with no other."""
    if edge.turns[1] is None and edge.turns[0] in crowded:
        return False
    return all(shared[place] == 1 for place in edge.turns if place is not None)


def _impulses(group: list[Edge], turns: list[Turn], mass: Floats) -> list[float]:
    """Impulses >= 0 along the normals that give the changes of the turns, by least squares (projected Gauss-Seidel)."""
    left = {place: turns[place].change.copy() for edge in group for place in edge.turns if place is not None}
    strength = [0.0] * len(group)

    def weights(edge: Edge) -> list[tuple[int, Floats]]:
        signs = (-1.0, 1.0)
        return [
            (place, sign * np.array(edge.normal) / (float(mass[turns[place].disk]) or 1.0))
            for place, sign in zip(edge.turns, signs, strict=True)
            if place is not None
        ]

    columns = [weights(edge) for edge in group]
    for _ in range(ROUNDS):
        for k, column in enumerate(columns):
            size = sum(float(w @ w) for _, w in column)
            gain = sum(float(w @ left[place]) for place, w in column) / size
            gain = max(gain, -strength[k])
            strength[k] += gain
            for place, w in column:
                left[place] -= gain * w
    return strength


def _met(edge: Edge, turns: list[Turn], alone: bool) -> Met:
    i, j = edge.turns
    one, other = turns[i], None if j is None else turns[j]
    both = [one] if other is None else [one, other]
    pair = (other, one) if edge.swapped else (one, other)
    time = sum(turn.time for turn in both) / len(both)
    along = all(_is_along(turn, edge.normal) and turn.is_short for turn in both)
    at_once = other is None or abs(one.time - other.time) <= one.slack + other.slack
    first, last = min(turn.first for turn in both), max(turn.last for turn in both)
    across = math.nan if edge.at_turn is None else max(_across(turn, edge.at_turn) for turn in both)
    return Met(edge.key, time, first, last, pair, alone and along and at_once, across)


def _is_along(turn: Turn, normal: tuple[float, float]) -> bool:
    """Whether a turn is along a line of centres: otherwise it is that of another contact as well."""
    return _across(turn, normal) <= ALONG


def _across(turn: Turn, normal: tuple[float, float]) -> float:
    """The sine of the angle between a turn and a normal."""
    size = math.hypot(*turn.change)
    return abs(float(turn.change[0] * normal[1] - turn.change[1] * normal[0])) / size if size > 0.0 else 0.0

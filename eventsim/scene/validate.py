"""The rules of a scene: which numbers it may hold, and which disks may be where."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from itertools import islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eventsim.letters import is_name
from eventsim.scene.disks import Disks, named_species
from eventsim.scene.domain import BOUNDARY_NAMES, Domain, Open, hard_sides
from eventsim.scene.manner import manner_problems
from eventsim.scene.names import DiskNames, SelectedNames
from eventsim.scene.numbers import (
    FASTEST,
    LENGTHS,
    LONGEST,
    RADII,
    SHORTEST,
    SLOWEST,
    SPEEDS,
    Point,
    is_length,
    is_place,
)
from eventsim.scene.overlaps import (
    ENOUGH,
    Found,
    boundary_overlaps,
    feature_overlaps,
    pair_overlaps,
)
from eventsim.scene.restitution import Restitution
from eventsim.scene.scale_rules import scale_problems
from eventsim.scene.walls import Wall, parts_of, wall_names
from eventsim.scene.walls.wall import MOST_PERIODS

WRITTEN_OUT: ContextVar[int] = ContextVar("WRITTEN_OUT", default=3)
"""Of many problems of one kind so many are written out; the rest are counted."""

LARGEST_SEED = 2**63 - 1

LIGHTEST = 1e-320
"""A mass that has a half."""

NO_DISKS = "disk: a scene needs at least one disk"
NO_SPECIES = "no disk is of the species"


def find_problems(
    disks: Disks, domain: Domain, walls: Sequence[Wall], gravity: Point | None, names: DiskNames, others: Sequence[str]
) -> list[str]:
    """Every rule that the parts of a scene break, one sentence each; many of one kind are counted.

    Args:
        disks, domain, walls, gravity: the parts; only types have been checked so far.
        names: how to call the disks.
        others: rules that its single numbers break (`scalar_problems`).
    """
    shapes = [*domain_problems(domain), *wall_problems(walls, domain)]
    problems = [*others, *shapes]
    if not len(disks):
        return [*problems, NO_DISKS]
    sound = np.ones(len(disks), dtype=np.bool_)
    problems += number_problems(disks, names, sound)
    problems += _point_wall_problems(disks, walls, gravity, names)
    problems += heat_problems(disks, domain, walls, names)
    problems += [] if problems else list(scale_problems(disks, domain, walls, gravity))
    # In a domain that is none, among walls that are none, a place would mean nothing.
    if not shapes:
        if sound.all():
            problems += _place_problems(disks, domain, walls, names)
        else:
            index = np.flatnonzero(sound)
            problems += _place_problems(disks.select(index), domain, walls, SelectedNames(names, index))
    return problems


@contextmanager
def all_written_out() -> Iterator[None]:
    """Write out every problem of a kind, up to ENOUGH, where scenes are made inside."""
    before = WRITTEN_OUT.set(ENOUGH)
    try:
        yield
    finally:
        WRITTEN_OUT.reset(before)


def touching_notes(disks: Disks, domain: Domain, walls: Sequence[Wall]) -> list[str]:
    """The overlaps that are so small that they count as touching, one sentence each."""
    pieces = parts_of(walls)
    pairs = pair_overlaps(disks, domain, pieces).touching()
    across = feature_overlaps(disks, domain, pieces).touching()
    sides = boundary_overlaps(disks, domain).touching()
    touch = "overlap by {:.3g}: touching, but for rounding"
    return [
        *_summary(pairs, "pairs like this", lambda i, j, d: f"disk[{i}] and disk[{j}] " + touch.format(d)),
        *_summary(across, "disks at walls", lambda i, w, d: f"disk[{i}] and wall {pieces[w].name} " + touch.format(d)),
        *_summary(
            sides,
            "disks at a side",
            lambda i, s, d: f"disk[{i}] and the {BOUNDARY_NAMES[s]} side " + touch.format(d),
        ),
    ]


def scalar_problems(given: Mapping[str, Any]) -> Iterator[str]:
    """Rules for the single numbers of a scene, by key, and its name."""
    name, gravity, restitution = given["name"], given["gravity"], given["restitution"]
    start, until, events = given["start_time"], given["until"], given["events"]
    if name is not None and not is_name(name):
        yield f"name = {name!r}: must be one line without control characters"
    if gravity is not None and not is_place(gravity):
        yield f"gravity = {list(gravity)}: must be two finite numbers, at most {LONGEST}"
    elif gravity is not None and 0.0 < max(map(abs, gravity)) < SHORTEST:
        yield f"gravity = {list(gravity)}: must be 0, or at least {SHORTEST} along an axis"
    if restitution is not None:
        yield from restitution.problems()
        if given["law"] is not None and restitution.laws:
            yield f"contact_law: has a restitution.{restitution.laws[0]} beside it: one law says what comes back"
    if given["tangential_restitution"] is not None:
        yield from given["tangential_restitution"].problems()
    for key in ("contact_duration", "equilibration"):
        if given[key] is not None and not 0.0 <= given[key] < math.inf:
            yield f"{key} = {given[key]}: must be a finite time, at least 0"
    if not math.isfinite(start):
        yield f"start_time = {start}: must be finite"
    elif until is not None and not start <= until < math.inf:
        yield f"until = {until}: must be finite and not before start_time = {start}"
    if events is not None and events < 0:
        yield f"events = {events}: must be at least 0"


def species_problems(restitution: Restitution | None, disks: Disks) -> Iterator[str]:
    """Rules for species that a restitution names."""
    if restitution is None or not restitution.pairs or not len(disks):
        return
    names, _ = named_species(disks)
    for a, b, _ in restitution.pairs:
        for name in dict.fromkeys((a, b)):
            if name not in names:
                yield f"restitution.pairs.{a}-{b}: {NO_SPECIES} {name} (there are {', '.join(names)})"


def chance_problems(domain: Domain, walls: Sequence[Wall], seed: int | None) -> Iterator[str]:
    """The rule that chance has a seed."""
    warm = any(one.temperature is not None for one in (*(side for _, side in domain.walls), *walls))
    if warm and seed is None:
        why = "where chance is used, a seed makes the run the same every time (a key of the scene: above the first table)"
        yield f"seed is missing: {why}"
    if seed is not None and not 0 <= seed <= LARGEST_SEED:
        yield f"seed = {seed}: must be a whole number from 0 to {LARGEST_SEED}"


def heat_problems(disks: Disks, domain: Domain, walls: Sequence[Wall], names: DiskNames) -> Iterator[str]:
    """The rule that walls heat what has a temperature."""
    warm = [f"domain.walls.{name}" for name, side in domain.walls if side.temperature is not None]
    warm += [f"wall[{i}]" for i, wall in enumerate(walls) if wall.temperature is not None]
    broken = np.flatnonzero(~(np.isfinite(disks.mass) & (disks.mass > 0.0))) if warm else ()
    for k in list(broken)[: WRITTEN_OUT.get()]:
        yield f"{warm[0]}.temperature: {names.disk(int(k))} has mass {disks.mass[k]}: only a finite mass above 0 can be heated"


def domain_problems(domain: Domain) -> Iterator[str]:
    """Rules for size and origin."""
    if isinstance(domain, Open):
        return
    if not all(map(is_length, domain.size)):
        yield f"domain.size = {list(domain.size)}: both lengths {LENGTHS}"
    for name, side in domain.walls:
        yield from (f"domain.walls.{name}{problem}" for problem in manner_problems(side.manner))
    if not is_place(domain.origin):
        yield f"domain.origin = {list(domain.origin)}: must be two finite numbers, at most {LONGEST}"


def wall_problems(walls: Sequence[Wall], domain: Domain) -> list[str]:
    """Every rule that the walls of a scene break, one sentence each."""
    problems = list(_wall_name_problems(walls, hard_sides(domain)))
    for i, wall in enumerate(walls):
        broken = list(wall.problems()) or list(_period_problems(wall, domain))
        problems += [f"wall[{i}]{key}" for key in broken]
    return problems


def _point_wall_problems(disks: Disks, walls: Sequence[Wall], gravity: Point | None, names: DiskNames) -> Iterator[str]:
    """Walls that only points can meet, along straight lines: what moves is a point, and nothing falls."""
    for i, wall in enumerate(walls):
        if not wall.for_points:
            continue
        if gravity is not None and any(gravity):
            yield f"wall[{i}]: gravity = {list(gravity)}: points that fall cannot meet this {wall.kind}; leave gravity out"
        moving = np.isfinite(disks.mass) | (disks.velocity != 0.0).any(axis=1)
        for k in np.flatnonzero(moving & (disks.radius > 0.0))[: WRITTEN_OUT.get()]:
            yield f"wall[{i}]: {names.disk(int(k))} has radius {disks.radius[k]}: only points (radius 0) meet this {wall.kind}"


def _wall_name_problems(walls: Sequence[Wall], sides: Sequence[str]) -> Iterator[str]:
    """Names are unique in the log, edges included, and fit into a line of it."""
    owner: dict[str, int] = {}
    for i, (wall, name) in enumerate(zip(walls, wall_names(walls), strict=True)):
        if not name.strip() or not is_name(name) or any(mark in name for mark in ',"'):
            rule = "must not be empty nor hold a comma, a quotation mark, a line end or a control character"
            yield f"wall[{i}].name = {name!r}: {rule}"
        elif name in sides:
            yield f"wall[{i}].name = {name!r}: {', '.join(sides[:-1])} and {sides[-1]} are the sides of the domain"
        taken = {name, *(str(part.name) for part in wall.parts(name))}
        for used in sorted(taken & owner.keys()):
            yield f"wall[{i}]: the name {used!r} is taken by wall[{owner[used]}]: names must be unique"
        owner |= dict.fromkeys(taken, i)


def _period_problems(wall: Wall, domain: Domain) -> Iterator[str]:
    """Rules of a wall in a domain that repeats."""
    if isinstance(domain, Open) or not is_place(domain.origin) or not all(map(is_length, domain.size)):
        return
    axes = [axis for axis in (0, 1) if domain.periodic[axis]]
    broken = [text for axis in axes for text in wall.period_problems(axis, domain.origin[axis], domain.size[axis])]
    yield from broken
    period = [domain.size[axis] if axis in axes else math.inf for axis in (0, 1)]
    over = wall.most_periods(period)
    if not broken and over > MOST_PERIODS:
        yield f": must not stretch over more than {MOST_PERIODS} periods, counted in x times in y, and does over {over:.0f}"
    yield from wall.image_problems(period)


def number_problems(disks: Disks, names: DiskNames, sound: NDArray[np.bool_]) -> list[str]:
    """Rules for the single numbers of each disk; marks in `sound` (N,) the disks that break one."""
    with np.errstate(invalid="ignore"):
        speed = np.abs(disks.velocity).max(axis=1)
        rules = {
            "position": (
                (np.abs(disks.position) <= LONGEST).all(axis=1),
                f"must be two finite numbers, at most {LONGEST}",
            ),
            "velocity": (
                (speed == 0.0) | ((speed >= SLOWEST) & (speed <= FASTEST)),
                SPEEDS,
            ),
            "radius": (
                (disks.radius == 0.0) | ((disks.radius >= SHORTEST) & (disks.radius <= LONGEST)),
                RADII,
            ),
            "mass": (
                (disks.mass == 0.0) | (disks.mass >= LIGHTEST),
                f"must be at least 0 (inf: cannot be deflected; 0: deflects nobody; no other below {LIGHTEST})",
            ),
        }
    problems: list[str] = []
    for key, (kept, rule) in rules.items():
        sound &= kept
        broken = np.flatnonzero(~kept)
        value = getattr(disks, key)
        problems += [f"{names.key(int(i), key)} = {value[i].tolist()}: {rule}" for i in broken[: _written(len(broken))]]
        problems += _uncounted(len(broken), f"disks whose {key} {rule}")
    return problems


def _place_problems(disks: Disks, domain: Domain, walls: Sequence[Wall], names: DiskNames) -> list[str]:
    """Rules for where disks are, among walls."""
    outside, problems = _periodic_problems(disks, domain, names)
    problems += _summary(
        boundary_overlaps(disks, domain).broken(),
        "disks that are outside",
        lambda i, side, depth: (
            f"{names.disk(i)} (center {_at(disks, i)}, radius {disks.radius[i]}) reaches {depth:.6g} beyond the"
            f" {BOUNDARY_NAMES[side]} side: must be inside the domain {_extent(domain)}"
        ),
    )
    problems += _room_problems(disks, domain, names)
    pieces = parts_of(walls)
    problems += _summary(
        feature_overlaps(disks, domain, pieces).broken(),
        "disks that are across a wall",
        lambda i, wall, depth: (
            f"{names.disk(i)} (center {_at(disks, i)}, radius {disks.radius[i]}) reaches {depth:.6g} "
            + (
                f"out of {pieces[wall].kind} {pieces[wall].name}: must be inside its container"
                + (" (a round post is a disk of mass inf)" if depth > 2.0 * disks.radius[i] else "")
                if pieces[wall].holds
                else f"across {pieces[wall].kind} {pieces[wall].name}: may touch a wall, not reach into it"
            )
        ),
    )
    if not outside.any():
        problems += _summary(
            pair_overlaps(disks, domain, pieces).broken(),
            "pairs of disks that overlap",
            lambda i, j, depth: (
                f"{names.disk(i)} and {names.disk(j)} overlap by {depth:.6g} (centers {_at(disks, i)} and"
                f" {_at(disks, j)}, radii {disks.radius[i]} and {disks.radius[j]}):"
                " disks may touch, not overlap"
            ),
        )
    return problems


def _room_problems(disks: Disks, domain: Domain, names: DiskNames) -> list[str]:
    """A rule for disks as wide as the domain between two hard walls: they may not move from one to the other."""
    problems: list[str] = []
    for axis, letter in enumerate("xy"):
        if isinstance(domain, Open) or domain.periodic[axis]:
            continue
        length = domain.size[axis]
        caught = np.flatnonzero((2.0 * disks.radius >= length) & (disks.velocity[:, axis] != 0.0))
        problems += [
            f"{names.disk(int(i))} is as wide as the domain, {length}, and has a velocity along {letter}: it would meet both"
            " walls at every instant; give it room, or no velocity along there"
            for i in caught[: _written(len(caught))]
        ]
        problems += _uncounted(len(caught), f"disks without room in {letter}")
    return problems


def _periodic_problems(disks: Disks, domain: Domain, names: DiskNames) -> tuple[NDArray[np.bool_], list[str]]:
    """Which disks have their centre outside of a period, and rules that only periodic directions have."""
    outside = np.zeros(len(disks), dtype=np.bool_)
    problems: list[str] = []
    for axis, letter in enumerate("xy"):
        if isinstance(domain, Open) or not domain.periodic[axis]:
            continue
        length = domain.size[axis]
        place = disks.position[:, axis] - domain.origin[axis]
        out = (place < 0.0) | (place >= length)
        outside |= out
        wide = np.flatnonzero(2.0 * disks.radius > length)
        problems += [
            f"{names.disk(int(i))}: center {_at(disks, int(i))}: {letter} must be at least {domain.origin[axis]}"
            f" and below {domain.origin[axis] + length} (the {domain.kind} domain repeats there)"
            for i in np.flatnonzero(out)[: _written(int(out.sum()))]
        ]
        problems += _uncounted(int(out.sum()), f"disks whose center is outside the domain in {letter}")
        problems += [
            f"{names.key(int(i), 'radius')} = {disks.radius[i]}: the diameter must be at most the period {length},"
            " or the disk overlaps its own image"
            for i in wide[: _written(len(wide))]
        ]
        problems += _uncounted(len(wide), "disks that are wider than the period")
    return outside, problems


def _summary(found: Found, kind: str, sentence: Callable[[int, int, float], str]) -> list[str]:
    """The first overlaps as sentences, the others counted."""
    columns = zip(found.disk.tolist(), found.other.tolist(), found.depth.tolist(), strict=True)
    written = [sentence(*overlap) for overlap in islice(columns, _written(len(found)))]
    return written + _uncounted(len(found), kind)


def _uncounted(count: int, kind: str) -> list[str]:
    """The line that counts what is not written out, if anything."""
    more = "at least " if count >= ENOUGH else ""
    left = count - _written(count)
    return [f"... and {more}{left} more {kind}"] if left else []


def _written(count: int) -> int:
    """How many of so many things are written out: a single one more is, so that those that are counted are several."""
    most = WRITTEN_OUT.get()
    return count if count <= most + 1 else most


def _at(disks: Disks, index: int) -> str:
    """Where a disk is."""
    x, y = disks.position[index].tolist()
    return f"({x}, {y})"


def _extent(domain: Domain) -> str:
    """The region of a domain that has sides, in words."""
    assert domain.size is not None
    (x, y), (width, height) = domain.origin, domain.size
    return f"[{x}, {x + width}] x [{y}, {y + height}]"

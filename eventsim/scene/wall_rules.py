"""The rules of walls: shapes that are shapes, and names that tell them apart."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from eventsim.letters import is_name
from eventsim.scene.domain import BOUNDARY_NAMES, Domain, Open
from eventsim.scene.numbers import is_length, is_place
from eventsim.scene.walls import Wall, wall_names


def wall_problems(walls: Sequence[Wall], domain: Domain) -> list[str]:
    """Every rule that the walls of a scene break, one sentence each."""
    problems = list(_name_problems(walls))
    for i, wall in enumerate(walls):
        broken = list(wall.problems()) or list(_period_problems(wall, domain))
        problems += [f"wall[{i}]{key}" for key in broken]
    return problems


def _name_problems(walls: Sequence[Wall]) -> Iterator[str]:
    """Names are unique in the log, edges included, and fit into a line of it."""
    owner: dict[str, int] = {}
    for i, (wall, name) in enumerate(zip(walls, wall_names(walls), strict=True)):
        if not name.strip() or not is_name(name) or any(mark in name for mark in ',"'):
            rule = "must not be empty nor hold a comma, a quotation mark, a line end or a control character"
            yield f"wall[{i}].name = {name!r}: {rule}"
        elif name in BOUNDARY_NAMES:
            yield f"wall[{i}].name = {name!r}: left, right, bottom and top are the sides of the domain"
        taken = {name, *(str(part.name) for part in wall.parts(name))}
        for used in sorted(taken & owner.keys()):
            yield f"wall[{i}]: the name {used!r} is taken by wall[{owner[used]}]: names must be unique"
        owner |= dict.fromkeys(taken, i)


def _period_problems(wall: Wall, domain: Domain) -> Iterator[str]:
    """Rules of a wall in a domain that repeats."""
    if isinstance(domain, Open) or not is_place(domain.origin) or not all(map(is_length, domain.size)):
        return
    for axis in (0, 1):
        if domain.periodic[axis]:
            yield from wall.period_problems(axis, domain.origin[axis], domain.size[axis])

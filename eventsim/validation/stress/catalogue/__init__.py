"""The catalogue: one file a family of hard scenes; ids C, F, P and T name them."""

from __future__ import annotations

import re

from eventsim.errors import EventsimError
from eventsim.validation.stress.case import Case
from eventsim.validation.stress.catalogue import (
    boundaries,
    clusters,
    corners,
    digits,
    grazes,
    long_runs,
    order,
    pileups,
    spells,
    steps,
    ties,
)


def _place(case: Case) -> tuple[str, int, str]:
    """Sort by letter, then number."""
    found = re.match(r"([a-z])(\d+)", case.name)
    assert found is not None
    return found[1], int(found[2]), case.name


CASES: dict[str, Case] = {
    case.name: case
    for case in sorted(
        (
            case
            for family in (
                grazes,
                clusters,
                digits,
                order,
                boundaries,
                pileups,
                long_runs,
                steps,
                corners,
                spells,
                ties,
            )
            for case in family.CASES
        ),
        key=_place,
    )
}
"""name -> case."""


def chosen(names: tuple[str, ...]) -> list[Case]:
    """The cases of these names, or whose names begin so (f22: all of F22); all of them for none.

    Raises EventsimError where a name fits none.
    """
    if not names:
        return list(CASES.values())
    found: dict[str, Case] = {}
    for name in names:
        wanted = name.lower()
        fits = [case for key, case in CASES.items() if key == wanted or key.startswith(f"{wanted}-")]
        if not fits:
            raise EventsimError(f"there is no scene {name!r} in the catalogue; eventsim stress --list names them")
        found |= {case.name: case for case in fits}
    return list(found.values())

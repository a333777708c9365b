"""A handful of scenes of each family, judged; `slow`: 500 of each."""

from __future__ import annotations

import pytest

from tests.oracle.command import survey
from tests.oracle.families import FAMILIES
from tests.oracle.judge import REFUSED, UNJUDGED, WRONG

KNOWN: dict[str, str] = {}
"""Families that are known to be wrong; who mends the fault takes the line out."""

FEW, SHORT = 6, 600
"""So many scenes of each family by default, and of these only such as have at most so many rows."""

MOST_REFUSED, MOST_UNJUDGED = 0.02, 0.05
"""Shares of scenes: refused where the oracle has an answer; not judged."""


def marked(known: dict[str, str]) -> list[object]:
    marks = {name: pytest.mark.xfail(reason=why, strict=True) for name, why in known.items()}
    return [pytest.param(name, marks=marks[name]) if name in marks else name for name in FAMILIES]


@pytest.mark.parametrize("family", marked(KNOWN))
def test_a_few_scenes_are_right(family: str) -> None:
    tally = survey(family, FEW, seed=7, engines=("reference",), most_rows=SHORT)
    assert tally.counts[WRONG] == tally.counts[REFUSED] == 0, "\n".join(tally.told)


@pytest.mark.slow
@pytest.mark.timeout(7200)
@pytest.mark.parametrize("family", marked(KNOWN))
def test_five_hundred_scenes_are_right_in_both_engines(family: str) -> None:
    tally = survey(family, 500, seed=11, engines=("reference", "fast"))
    told = "\n".join([tally.line(family), *tally.told])
    assert tally.counts[WRONG] == 0, told
    assert tally.counts[REFUSED] <= MOST_REFUSED * tally.scenes, told
    assert tally.counts[UNJUDGED] <= MOST_UNJUDGED * tally.scenes, told

"""Families of random scenes: each a function of a generator, made so that small scenes meet the hard corners often.

To add a family: a module here with `FAMILIES`, name -> function(rng) -> Case, and its line below.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from tests.oracle.families import (
    bows,
    chains,
    collapse,
    drops,
    gases,
    idle,
    kicks,
    meetings,
    mixtures,
    ovals,
    points,
    slopes,
    ties,
    wrapped,
)
from tests.oracle.families.case import Case

FAMILIES: Mapping[str, Callable[[np.random.Generator], Case]] = {
    **points.FAMILIES,
    **idle.FAMILIES,
    **drops.FAMILIES,
    **chains.FAMILIES,
    **bows.FAMILIES,
    **ovals.FAMILIES,
    **gases.FAMILIES,
    **mixtures.FAMILIES,
    **slopes.FAMILIES,
    **kicks.FAMILIES,
    **ties.FAMILIES,
    **meetings.FAMILIES,
    **collapse.FAMILIES,
    **wrapped.FAMILIES,
}


def case_of(family: str, seed: int, number: int) -> Case:
    """Scene `number` of a family for a seed; it does not depend on how many are asked for."""
    return FAMILIES[family](np.random.default_rng([seed, number]))

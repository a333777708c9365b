"""The bounds of contact times hold, and are not much too wide; `python -m tests.formulas.doubt_cases` tries more."""

import math
import statistics

from eventsim.formulas.doubt import contact_doubt
from tests.formulas.doubt_cases import tried


def test_bounds_hold_and_are_narrow():
    for wide, broken in tried(6000, seed=7).values():
        assert len(wide) > 400
        assert broken == []
        assert statistics.median(wide) < 50.0


def test_a_graze_has_no_bound():
    assert contact_doubt(1.0, 1e-9, 1.0, 0.0) == math.inf


def test_a_bound_falls_with_the_closing_speed():
    assert contact_doubt(1.0, 1.0, 0.0, 0.0) == 0.1 * contact_doubt(1.0, 0.1, 0.0, 0.0)

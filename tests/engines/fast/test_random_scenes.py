"""The fast engine does what the reference engine does, bit for bit, in a few scenes of each family that the oracle judges."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.oracle.command import is_same
from tests.oracle.families import FAMILIES, case_of
from tests.oracle.judge import observe

pytest.importorskip("numba")
pytestmark = pytest.mark.kernels

FEW, SHORT = 6, 60
"""Scenes of a family, and events of a scene."""

FEWER = {"P3-lone": 1}
"""Families whose scenes take long, with their scenes: of wraps there can be any number between two events."""


@pytest.mark.parametrize("family", FAMILIES)
def test_a_few_scenes_have_one_log(family: str) -> None:
    for number in range(FEWER.get(family, FEW)):
        case = case_of(family, 1, number)
        scene = replace(case.scene, events=min(case.scene.events or SHORT, SHORT))
        reference, fast = (observe(scene, engine, case.kicks) for engine in ("reference", "fast"))
        assert is_same(reference, fast), (number, scene)
        assert reference.reason == fast.reason, (number, scene)

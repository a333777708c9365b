"""The digest depends on the story alone."""

from __future__ import annotations

import hashlib
import struct
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from eventsim.record.digest import Digester, digest_of
from eventsim.record.events import COLUMNS, OFFSETS, ROW, blank_rows
from tests.record.logs import random_rows


@given(st.lists(st.integers(0, 60), max_size=5))
def test_the_cut_into_blocks_does_not_matter(cuts: list[int]) -> None:
    rows = random_rows(60)
    digester = Digester()
    edges = [0, *sorted(cuts), 60]
    for first, last in pairwise(edges):
        digester.update(rows[first:last])
    assert digester.hexdigest() == digest_of(rows)


def test_the_digest_is_that_of_the_documented_bytes() -> None:
    rows = random_rows(20)
    sha = hashlib.sha256()
    for row in rows:
        sha.update(struct.pack("<5q", *(int(row[name]) for name in ("kind", "a", "b", "wall", "epoch"))))
        for name in ("remainder", "xa", "ya", "xb", "yb", "vxa", "vya", "vxb", "vyb"):
            value = float(row[name])
            plain = 0.0 if value == 0.0 else value
            sha.update(bytes.fromhex("000000000000f87f") if value != value else struct.pack("<d", plain))
    assert digest_of(rows) == hashlib.sha256(sha.digest()).hexdigest()  # of the one chunk


def test_signs_of_zero_and_kinds_of_nan_do_not_matter() -> None:
    one, other = blank_rows(1), blank_rows(1)
    one["xa"], other["xa"] = 0.0, -0.0
    other["yb"] = -np.array([np.nan])
    assert digest_of(one) == digest_of(other)


@pytest.mark.parametrize("name", ["kind", "a", "b", "wall", "epoch", "remainder", "xa", "vyb"])
def test_every_column_of_the_story_counts(name: str) -> None:
    one, other = random_rows(5), random_rows(5)
    other[name][3] = other[name][3] + 1 if np.isfinite(other[name][3]) and abs(other[name][3]) < 1e9 else 0.5
    assert digest_of(one) != digest_of(other)


def test_rows_have_no_gaps() -> None:
    """So equal rows are equal bytes, and kernels can write them by whole cache lines."""
    assert sum(ROW[name].itemsize for name in COLUMNS) == ROW.itemsize == 128
    assert list(OFFSETS.values()) == sorted(OFFSETS.values())

"""Buffers come back, but none whose rows somebody still has."""

import pytest

pytest.importorskip("numba")

from eventsim.engines.fast.machine import MOST, Buffers


def test_a_buffer_is_used_again_once_its_rows_are_forgotten():
    buffers = Buffers()
    first = buffers.blank()
    held = first[:5]
    number = id(first)
    del first
    second = buffers.blank()
    assert id(second) != number
    assert held.base is not second
    del held
    assert id(buffers.blank()) == number


@pytest.mark.parametrize("look", ["view", "column", "bytes"])
def test_whoever_looks_at_rows_in_whatever_way_keeps_them(look):
    buffers = Buffers()
    buffer = buffers.blank()
    buffer["a"] = 7
    held = {"view": buffer[2:4]["a"], "column": buffer["a"], "bytes": memoryview(buffer.view("u1"))}[look]
    before = bytes(held)
    del buffer
    for _ in range(3):
        buffers.blank()["a"] = 8
    assert bytes(held) == before


def test_more_buffers_than_are_kept_can_be_had():
    buffers = Buffers()
    held = [buffers.blank() for _ in range(2 * MOST)]
    assert len({id(buffer) for buffer in held}) == 2 * MOST

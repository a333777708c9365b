"""Some messages of the generator: all are answered, nothing is left."""

import asyncio

import pytest

pytest.importorskip("aiohttp", reason="aiohttp is not installed (the extra live brings it)")

from tests.fuzz.messages import fuzz


def test_messages_at_all_borders_are_answered():
    found = asyncio.run(fuzz(150, seed=3, pages=2, stay=40))
    assert found["said"] == []
    assert found["worlds"] == 0

"""Some messages of the generator: all are answered, nothing is left."""

import asyncio

import pytest

pytest.importorskip("aiohttp", reason="aiohttp is not installed (the extra live brings it)")

from eventsim.live.messages import READERS
from tests.fuzz.messages import KINDS, fuzz


def test_every_kind_of_message_is_sent():
    assert set(KINDS) - {"broken"} == set(READERS)


def test_messages_at_all_borders_are_answered():
    found = asyncio.run(fuzz(60, seed=3, pages=2, stay=20))
    assert found["said"] == []
    assert found["worlds"] == 0

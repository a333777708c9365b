"""What tests of the live server share."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.live.running import live_server


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    """The address of a server for the tests of a module."""
    with live_server() as (found, _):
        yield found

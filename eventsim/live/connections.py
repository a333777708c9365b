"""Connections: none is kept that asks for nothing, whatever its client does."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import TypeAlias

from aiohttp import web
from aiohttp.typedefs import Middleware

Handler: TypeAlias = Callable[[web.Request], Awaitable[web.StreamResponse]]

IDLE_SECONDS = 10.0
"""A connection has so long to say what it wants, at first and after each answer."""

LOOK_SECONDS = 1.0
MOST = 512
"""Connections at a time; the oldest of those that ask for nothing makes room for a new one."""


class Connections:
    """Knows which connections are being answered, and closes the others in time."""

    def __init__(self) -> None:
        self._answered: set[asyncio.BaseTransport] = set()
        self._since: dict[asyncio.BaseTransport, float] = {}

    def middleware(self) -> Middleware:
        """Return what tells who is being answered."""

        @web.middleware
        async def answering(request: web.Request, handler: Handler) -> web.StreamResponse:
            transport = request.transport
            if transport is None:
                raise web.HTTPBadRequest
            self._answered.add(transport)
            try:
                return await handler(request)
            finally:
                self._answered.discard(transport)
                self._since.pop(transport, None)

        return answering

    async def watch(self, server: web.Server) -> None:
        """Close what has been idle for too long, until cancelled."""
        clock = asyncio.get_running_loop().time
        while True:
            await asyncio.sleep(LOOK_SECONDS)
            now = clock()
            open_ = [handler.transport for handler in server.connections if handler.transport is not None]  # the oldest first
            self._since = {each: self._since.get(each, now) for each in open_ if each not in self._answered}
            oldest = sorted(self._since, key=self._since.__getitem__)
            surplus = oldest[: max(len(open_) - MOST, 0)]
            for transport in [*surplus, *(each for each in oldest if now - self._since[each] > IDLE_SECONDS)]:
                if isinstance(transport, asyncio.WriteTransport):
                    transport.abort()

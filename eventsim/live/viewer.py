"""A viewer: one connection of a page, which sees a world through its own window of time."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Mapping

from aiohttp import WSMsgType, web

from eventsim.errors import EventsimError, SceneError
from eventsim.live.messages import (
    AddDisk,
    AddWall,
    Control,
    Join,
    Message,
    Move,
    Open,
    Resize,
    Shown,
    Throw,
    read_message,
)
from eventsim.live.packets import packet, rows_packet
from eventsim.live.world import World

MOST_ROWS = 8192
"""Rows in a packet (half a megabyte): a page must not freeze while it takes one up."""

LONGEST_WAIT = 60.0
"""A page may wait for so many seconds of what it shows, at its speed or at a time unit a second."""


class Viewer:
    """A page that looks at a world.

    time: what it shows, counted from the start of the run. events: the rows until then. speed: the scene time that it
    plays per second. worlds: all that are open, by id.
    """

    def __init__(self, socket: web.WebSocketResponse, world: World, worlds: Mapping[str, World]) -> None:
        self.time, self.events, self.speed = 0.0, 0, 0.0
        self.world = world
        self._socket = socket
        self._worlds = worlds
        self._news = asyncio.Event()
        self._controls: list[Control] = []
        self._begin = False
        self._done = 0
        self._cut: tuple[int, float] | None = None
        self._sent: list[tuple[int, float, str | None]] = []
        world.viewers.add(self)

    def begin(self, speed: float) -> None:
        """Show the world's scene from its start."""
        self.time, self.events, self.speed = 0.0, 0, speed
        self._begin, self._cut = True, None

    def cut(self, count: int, time: float) -> None:
        """Take back all but the first `count` rows: the world goes on differently from this time."""
        self.time, self.events = min(self.time, time), min(self.events, count)
        if self._sent:
            self._sent[0] = (min(self._sent[0][0], count), time, None)
            self._cut = (count, time)

    def control(self, message: Control) -> None:
        """Hear what another page did to the time."""
        self._controls = [message]

    def wake(self) -> None:
        """Look whether there is something to send."""
        self._news.set()

    async def serve(self) -> None:
        """Answer the page until it closes the connection."""
        sending = asyncio.create_task(self._send_ahead())
        try:
            async for message in self._socket:
                if message.type is WSMsgType.TEXT:
                    await self._answer(message.data)
                elif message.type is WSMsgType.BINARY:
                    await self._send(packet("error", text="a message must be text"))
        except ConnectionError:
            pass  # the page has gone, which is how every view ends
        finally:
            sending.cancel()
            self.world.leave(self)

    async def _answer(self, text: str) -> None:
        try:
            message = read_message(text)
        except EventsimError as error:
            await self._send(packet("error", text=str(error)))
            return
        try:
            await self._follow(message)
        except SceneError as error:
            await self._send(packet("error", text="\n".join(error.problems)))
        except EventsimError as error:
            await self._send(packet("error", text=str(error)))
        except ConnectionError:
            raise
        except Exception:
            logging.getLogger(__name__).exception("a message could not be followed")
            await self._send(packet("error", text="the server failed at this; its terminal tells how"))
        if not isinstance(message, Shown | Control):
            self._done += 1
            self.wake()

    async def _follow(self, message: Message) -> None:
        """Do what a message asks for."""
        if isinstance(message, Shown):
            if message.edition != self.world.edition or not self.world.tracks:
                return  # said before the page had heard of what is open now
            # What a page says that it shows, or waits for, must not send the engine far ahead.
            track = self.world.tracks[0]
            self.speed = message.speed
            self.time = min(message.time, track.horizon + LONGEST_WAIT * max(self.speed, 1.0))
            self.events = min(message.events, track.count)
            self.world.wake()
        elif isinstance(message, Control):
            for other in self.world.viewers - {self}:
                other.control(message)
                other.wake()
        elif isinstance(message, Open):
            await self.world.open(message)
        elif isinstance(message, Throw):
            await self.world.throw(message)
        elif isinstance(message, Move):
            await self.world.move(message)
        elif isinstance(message, AddDisk):
            await self.world.add_disk(message)
        elif isinstance(message, AddWall):
            await self.world.add_wall(message)
        elif isinstance(message, Resize):
            await self.world.resize(message)
        else:
            self._join(message)

    def _join(self, message: Join) -> None:
        """Look at another world, at the time that its other viewers see."""
        world = self._worlds.get(message.world)
        if world is None or world.scene is None:
            raise EventsimError("that world is gone: it lives as long as somebody looks at it")
        others = max(world.viewers - {self}, key=lambda viewer: viewer.time, default=None)
        world.viewers.add(self)
        if world is not self.world:  # who joins its own world begins it anew; left by all it would be gone
            self.world.leave(self)
            self.world = world
        self.begin(world.speed)
        if others is not None:
            self._controls = [Control(others.time, others.speed or world.speed, 1, False)]
        self.wake()

    async def _send_ahead(self) -> None:
        """Send whatever the page does not have yet, in order; sleep while there is nothing."""
        while not self._socket.closed:
            self._news.clear()
            block = await self._next()
            try:
                if block is None:
                    await self._news.wait()
                else:
                    await self._send(block)
            except ConnectionError:
                return

    async def _next(self) -> bytes | None:
        """Return the next packet, None where the page has everything."""
        world = self.world
        async with world.busy:
            if self._begin:
                self._begin, self._sent = False, [(0, -1.0, None)] * len(world.tracks)
                return world.opened
            if self._cut is not None:
                (count, time), self._cut = self._cut, None
                return packet("cut", count=count, time=time)
            if self._done:
                self._done -= 1
                return packet("done")
            for k, track in enumerate(world.tracks[: len(self._sent)]):
                have = self._sent[k]
                end = min(track.count, have[0] + MOST_ROWS)
                whole = end == track.count
                horizon = track.horizon if whole else track.time_of(end - 1)
                now = (end, horizon, track.ended if whole else None)
                if now != have:
                    self._sent[k] = now
                    return rows_packet(k, track.rows(have[0], end), horizon, now[2])
            if self._controls:
                heard = self._controls.pop()
                return packet(
                    "control", time=heard.time, speed=heard.speed, direction=heard.direction, playing=heard.playing
                )
        return None

    async def _send(self, block: bytes) -> None:
        """Send a packet; waits while the page is slow to take up what it was sent before."""
        if not self._socket.closed:
            await self._socket.send_bytes(block)

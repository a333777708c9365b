"""A server of the live view in this process, and connections to it."""

import asyncio
import gc
from contextlib import asynccontextmanager

import pytest

import eventsim as es
from tests.live.running import Client

aiohttp = pytest.importorskip("aiohttp", reason="aiohttp is not installed (the extra live brings it)")

from aiohttp.test_utils import TestServer  # noqa: E402

from eventsim.live.server import application  # noqa: E402
from eventsim.live.world import World  # noqa: E402


@asynccontextmanager
async def serving(given=None):
    """Yield connect(), which opens a Client, and the HTTP session with the address of the server."""
    server = TestServer(application(given), host="127.0.0.1")
    await server.start_server()
    try:
        async with aiohttp.ClientSession() as session:

            async def connect():
                socket = await session.ws_connect(server.make_url("/socket"), max_msg_size=0)
                client = Client(socket)
                await client.hear("hello")
                return client

            yield connect, session, str(server.make_url("/"))
    finally:
        await server.close()


def worlds_alive():
    """All worlds in this process; by their types, because a proxy whose object is gone cannot even be asked for its class."""
    return [thing for thing in gc.get_objects() if type(thing) is World]


def run(story, given=None):
    async def told():
        async with serving(given) as parts:
            await asyncio.wait_for(story(*parts), 60)

    asyncio.run(told())


async def log_of(session, address, world, tmp_path):
    async with session.get(f"{address}worlds/{world}/log.npz") as answer:
        path = tmp_path / "log.npz"
        path.write_bytes(await answer.read())
    return es.load_log(path)

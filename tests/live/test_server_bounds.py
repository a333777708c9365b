"""What the server refuses, and bounds: garbage, strangers, pages that do not read, events without end."""

import asyncio
import gc
import json
import signal
import sys
import time

import pytest

import eventsim as es
from tests.live.running import live_server, menu
from tests.live.serving import run, worlds_alive

aiohttp = pytest.importorskip("aiohttp", reason="aiohttp is not installed (the extra live brings it)")

from eventsim.live.server import MOST_BYTES  # noqa: E402
from eventsim.live.world import LEAD_SECONDS  # noqa: E402

ROUND_AND_ROUND = f"""
domain = {{kind = "periodic", size = [1, 1]}}
disk = [{{position = [0.5, 0.5], radius = 0.1}}]
wall = [{{kind = "polyline", points = {[[0.1, 0.9 * k] for k in range(50)]}}}]
"""


def test_a_page_that_does_not_read_holds_up_nobody_and_fills_no_memory(monkeypatch):
    monkeypatch.setattr(sys.modules["eventsim.live.world"], "LEAD_EVENTS", 3000)

    async def story(connect, session, address):
        lazy, quick = await connect(), await connect()
        await lazy.tell(menu(count=200, speed=3000))
        await lazy.hear("opened")
        await lazy.tell({"type": "shown", "edition": 1, "time": 1e6, "events": 0, "speed": 1.0})
        for k in range(3):
            await quick.tell(menu(seed=k))
            await quick.hear("opened")
            await quick.hear("rows", horizon=LEAD_SECONDS)
        worlds = worlds_alive()
        assert max(world.count for world in worlds) <= 3000 + 200

    run(story)


def test_garbage_is_answered_and_the_connection_lives():
    async def story(connect, session, address):
        client = await connect()
        garbage = [
            "",
            "{",
            "null",
            "[[[",
            '{"type": 5}',
            '{"type": "throw", "time": "x"}',
            "\x00" * 1000,
            "9" * 100_000,
        ]
        for k in range(400):
            await client.tell(garbage[k % len(garbage)])
        for _ in range(400):
            assert (await client.hear("error", most=1))["text"]
        await client.tell({"type": "throw", "time": 0, "disk": 0, "velocity": [0, 0]})
        assert "no scene" in (await client.hear("error"))["text"]
        await client.tell({"type": "open", "scene": "given", "rate": None})
        assert "without a scene" in (await client.hear("error"))["text"]
        await client.tell({"type": "open", "scene": "gallery", "name": "gasp", "parameters": {}, "rate": None})
        assert "did you mean 'gas'" in (await client.hear("error"))["text"]
        await client.tell({"type": "open", "scene": "gallery", "name": "gas", "parameters": {"n": 10**7}, "rate": None})
        assert "at most" in (await client.hear("error"))["text"]
        await client.tell({"type": "open", "scene": "gallery", "name": "break", "parameters": {}, "rate": None})
        assert (await client.hear("opened"))["title"] == es.gallery("break").name
        await client.tell({"type": "throw", "time": 0, "disk": 99, "velocity": [0, 0]})
        assert "disk 99 does not exist; there are 16" in (await client.hear("error"))["text"]
        await client.socket.send_bytes(b"\x00\x01")
        assert "must be text" in (await client.hear("error"))["text"]

    run(story)


def test_an_oversized_message_ends_its_connection_alone():
    async def story(connect, session, address):
        client, other = await connect(), await connect()
        await client.tell("x" * (MOST_BYTES + 1))
        ended = await asyncio.wait_for(client.socket.receive(), 10)
        assert (ended.type, ended.data) == (aiohttp.WSMsgType.CLOSE, aiohttp.WSCloseCode.MESSAGE_TOO_BIG)
        await other.tell(menu())
        await other.hear("opened")

    run(story)


def test_pages_from_elsewhere_are_refused():
    async def story(connect, session, address):
        for path in ("socket", "", "live.js"):
            port = int(address.rstrip("/").rpartition(":")[2])
            for headers in (
                {"Origin": "http://evil.example"},
                {"Host": "evil.example"},
                {"Origin": "null"},
                {"Host": f"127.0.0.1:{port + 1}"},  # the port that counts is the one that is bound
                {"Sec-Fetch-Site": "cross-site"},
                {"Sec-Fetch-Site": "same-site"},
            ):
                async with session.get(address + path, headers=headers) as answer:
                    assert answer.status == 403
                    assert "this machine" in await answer.text()
        async with session.get(address, headers={"Origin": address.rstrip("/")}) as answer:
            assert answer.status == 200
            assert "default-src 'none'" in answer.headers["Content-Security-Policy"]
            assert "frame-ancestors 'none'" in answer.headers["Content-Security-Policy"]
            assert answer.headers["Referrer-Policy"] == "no-referrer"
        async with session.get(address, headers={"Sec-Fetch-Site": "none"}) as answer:
            assert answer.status == 200
        async with session.get(address + "../server.py") as answer:
            assert answer.status == 404

    run(story)


def test_events_that_are_kept_are_bounded(monkeypatch):
    monkeypatch.setattr(sys.modules["eventsim.live.world"], "MOST_EVENTS", 300)

    async def story(connect, session, address):
        client = await connect()
        await client.tell(menu(speed=2000))
        await client.hear("opened")
        for _ in range(50):
            rows = await client.hear("rows")
            if rows["ended"] is not None:
                break
        assert "as many as are kept" in rows["ended"]

    run(story)


def test_a_page_that_joins_its_own_world_stays_in_it():
    """The world was given up as left by all, and its page with it."""

    async def story(connect, session, address):
        client = await connect()
        await client.tell(menu())
        world = (await client.hear("opened"))["world"]
        for _ in range(2):
            await client.tell({"type": "join", "world": world})
            assert (await client.hear("opened"))["world"] == world
        await client.tell({"type": "throw", "time": 0.0, "disk": 0, "velocity": [1.0, 0.0]})
        await client.hear("cut")
        assert len(worlds_alive()) == 1
        await client.socket.close()
        await asyncio.sleep(0.5)
        gc.collect()
        assert worlds_alive() == []

    run(story)


def test_the_future_is_not_asked_for():
    """A throw at time 1e15 simulated without bound, and went on after the page had left."""

    async def story(connect, session, address):
        client = await connect()
        await client.tell({"type": "shown", "edition": 0, "time": 1e15, "events": 0, "speed": 1.0})  # of nothing yet
        await client.tell(menu())
        opened = await client.hear("opened")
        for message in (
            {"type": "throw", "disk": 0, "velocity": [1.0, 0.0]},
            {"type": "move", "disk": 0, "position": [1.0, 1.0]},
            {"type": "resize", "size": [300.0, 300.0]},
        ):
            await client.tell({**message, "time": 1e15})
            assert "is not simulated yet" in (await client.hear("error"))["text"]
        shown = {"type": "shown", "edition": opened["edition"], "time": 1e15, "events": 2**53, "speed": 1.0}
        await client.tell(shown)
        await asyncio.sleep(0.5)
        await client.tell({"type": "throw", "time": 1000.0, "disk": 0, "velocity": [1.0, 0.0]})
        assert "is not simulated yet" in (await client.hear("error", most=2000))["text"]

    run(story)


@pytest.mark.parametrize(
    ("message", "words"),
    [
        ({"scene": "gallery", "name": "gas", "parameters": {"name": "break"}}, "no parameter 'name'"),
        ({"scene": "gallery", "name": "gas", "parameters": {"n": 1e9}}, "at most 5000 disks"),
        ({"scene": "text", "text": '[domain]\nkind = "open"\n[[gas]]\ncount = 1e9\nradius = 0.1'}, "at most 5000 disks"),
        ({"scene": "text", "text": "a = " + "1" * 5000}, "too many digits"),
        ({"scene": "text", "text": "a" + ".a" * 500 + " = 1"}, "nested too deeply"),
        ({"scene": "text", "text": ROUND_AND_ROUND}, "at most 1000 walls, edges and images counted, and there are 4508"),
    ],
)
def test_a_scene_that_breaks_bounds_by_another_way_is_refused(message, words):
    async def story(connect, session, address):
        client = await connect()
        await client.tell({"type": "open", "rate": None, **message})
        assert words in (await client.hear("error"))["text"]

    run(story)


def test_the_address_has_a_token_and_ctrl_c_ends_the_server_whatever_it_computes():
    gas = 'count = 4000\npacking_fraction = 0.5\narrangement = "random"\nseed = 1'
    text = f'[domain]\nkind = "box"\nsize = [1, 1]\n[[gas]]\n{gas}'

    async def ask(address):
        async with aiohttp.ClientSession() as session:
            host, _, token = address.rstrip("/").rpartition("/")
            assert len(token) > 20
            for path in ("/", "/socket", "/live.js"):
                async with session.get(host + path) as answer:
                    assert answer.status == 404
                    assert "open the whole address that eventsim live has printed" in await answer.text()
            socket = await session.ws_connect(address + "socket")
            await socket.send_str(json.dumps({"type": "open", "rate": None, "scene": "text", "text": text}))
            await asyncio.sleep(0.5)

    with live_server() as (address, process):
        asyncio.run(ask(address))
        began = time.monotonic()
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=30) == 0
        assert time.monotonic() - began < 10.0  # two seconds on a machine of its own

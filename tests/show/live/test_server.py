"""The server: streams, bounds, refusals; what one page does must not trouble the others."""

import asyncio
import gc
import json
import sys
from contextlib import asynccontextmanager

import numpy as np
import pytest

import eventsim as es
from eventsim.record.replay import Replay
from tests.show.live.running import Client, menu

aiohttp = pytest.importorskip("aiohttp", reason="aiohttp is not installed (the extra live brings it)")

from aiohttp.test_utils import TestServer  # noqa: E402

from eventsim.show.live.server import MOST_BYTES, application  # noqa: E402
from eventsim.show.live.world import LEAD_SECONDS, World  # noqa: E402


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


def test_the_server_stays_a_bounded_time_ahead():
    async def story(connect, session, address):
        client = await connect()
        await client.tell(menu())
        opened = await client.hear("opened")
        horizon = 0.0
        while horizon < LEAD_SECONDS:
            horizon = (await client.hear("rows"))["horizon"]
        assert horizon == LEAD_SECONDS
        shown = {"type": "shown", "edition": opened["edition"], "events": 0, "speed": 1.0}
        await client.tell({**shown, "time": 1.0, "edition": opened["edition"] + 1})  # of another scene: not heeded
        await client.tell({**shown, "time": 0.5})
        while horizon < LEAD_SECONDS + 0.5:
            horizon = (await client.hear("rows"))["horizon"]
        assert horizon == LEAD_SECONDS + 0.5
        with pytest.raises(TimeoutError):
            await asyncio.wait_for(client.socket.receive(), 0.3)

    run(story)


def test_scene_and_log_can_be_downloaded_and_a_throw_is_a_kick_in_it(tmp_path):
    async def story(connect, session, address):
        client = await connect()
        await client.tell(menu(count=20, radii="different"))
        world = (await client.hear("opened"))["world"]
        await client.tell({"type": "throw", "time": 0.75, "disk": 4, "velocity": [900.0, -100.0]})
        cut = await client.hear("cut")
        assert cut["time"] == 0.75
        await client.hear("rows", horizon=LEAD_SECONDS)
        async with session.get(f"{address}worlds/{world}/scene.toml") as answer:
            path = tmp_path / "scene.toml"
            path.write_text(await answer.text())
        simulation = es.Simulation(es.load_scene(path))
        simulation.advance_to(0.75)
        assert len(simulation.log) == cut["count"]
        simulation.set_velocity(4, (900.0, -100.0))
        simulation.advance_to(LEAD_SECONDS)
        log = await log_of(session, address, world, tmp_path)
        assert log.digest() == simulation.log.digest()
        assert (await session.get(f"{address}worlds/{world}/log.doc")).status == 404
        assert (await session.get(f"{address}worlds/nobody/log.csv")).status == 404

    run(story)


def test_moving_a_disk_and_resizing_begin_anew_from_what_is_shown(tmp_path):
    async def story(connect, session, address):
        client = await connect()
        await client.tell(menu(count=20, packing=0.02))
        first = await client.hear("opened")
        await client.hear("rows", horizon=LEAD_SECONDS)
        replay = Replay(await log_of(session, address, first["world"], tmp_path))
        state = replay.state_at(1.0)
        await client.tell({"type": "move", "time": 1.0, "disk": 0, "position": state.position[1].tolist()})
        assert "overlap" in (await client.hear("error"))["text"]
        await client.tell({"type": "resize", "time": 1.0, "size": [100.0, 700.0]})
        second = await client.hear("opened")
        right = (state.position[:, 0] + replay.log.scene.disks.radius).max()
        assert (second["why"], second["startTime"]) == ("resize", 1.0)
        assert second["stage"]["size"] == [pytest.approx(right), 700.0]  # the wall waits outside of the disks
        log = await log_of(session, address, second["world"], tmp_path)
        np.testing.assert_array_equal(log.scene.disks.position, state.position)
        np.testing.assert_array_equal(log.scene.disks.velocity, state.velocity)
        await client.tell({"type": "move", "time": 0.0, "disk": 0, "position": [50.0, 680.0]})
        third = await client.hear("opened")
        assert (third["why"], third["startTime"]) == ("move", 1.0)

    run(story)


def test_two_pages_look_at_one_world():
    async def story(connect, session, address):
        first, second = await connect(), await connect()
        await first.tell(menu())
        opened = await first.hear("opened")
        await first.hear("rows", horizon=LEAD_SECONDS)
        await second.tell({"type": "join", "world": opened["world"]})
        assert (await second.hear("opened"))["world"] == opened["world"]
        await second.hear("rows", horizon=LEAD_SECONDS)
        await second.tell({"type": "throw", "time": 1.0, "disk": 0, "velocity": [0.0, 0.0]})
        for client in (first, second):
            assert (await client.hear("cut"))["time"] == 1.0
        await first.tell({"type": "control", "time": 1.0, "speed": 2.0, "direction": -1, "playing": True})
        heard = await second.hear("control", direction=-1)
        assert (heard["time"], heard["speed"], heard["playing"]) == (1.0, 2.0, True)
        await first.socket.close()
        await second.tell({"type": "throw", "time": 1.5, "disk": 0, "velocity": [1.0, 0.0]})
        await second.hear("cut")
        await second.tell({"type": "join", "world": "gone"})
        assert "gone" in (await second.hear("error"))["text"]

    run(story)


def test_twenty_pages_at_once_and_nothing_is_left_of_them():
    async def story(connect, session, address):
        async def visit(k):
            client = await connect()
            await client.tell(menu(count=30 + k, seed=k))
            await client.hear("opened")
            await client.hear("rows", horizon=LEAD_SECONDS)
            await client.socket.close()

        await asyncio.gather(*(visit(k) for k in range(20)))
        for _ in range(50):  # freed at once, not when the collector of cycles comes by
            if not worlds_alive():
                return
            await asyncio.sleep(0.1)
        raise AssertionError("worlds that nobody looks at are still there")

    run(story)


def test_a_page_that_does_not_read_holds_up_nobody_and_fills_no_memory(monkeypatch):
    monkeypatch.setattr(sys.modules["eventsim.show.live.world"], "LEAD_EVENTS", 3000)

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
            for headers in ({"Origin": "http://evil.example"}, {"Host": "evil.example"}, {"Origin": "null"}):
                async with session.get(address + path, headers=headers) as answer:
                    assert answer.status == 403
                    assert "this machine" in await answer.text()
        async with session.get(address, headers={"Origin": address.rstrip("/")}) as answer:
            assert answer.status == 200
            assert "default-src 'none'" in answer.headers["Content-Security-Policy"]
        async with session.get(address + "../server.py") as answer:
            assert answer.status == 404

    run(story)


def test_the_scene_of_the_command_line_is_offered():
    async def story(connect, session, address):
        socket = await session.ws_connect(address + "socket")
        client = Client(socket)
        hello = await client.hear("hello")
        assert hello["given"] == es.gallery("break").name
        assert {entry["name"] for entry in hello["gallery"]} >= {"gas", "galperin"}
        await client.tell({"type": "open", "scene": "given", "rate": None})
        assert (await client.hear("opened"))["scene"]["count"] == 16

    run(story, es.gallery("break"))


def test_a_scene_that_stops_says_why():
    async def story(connect, session, address):
        client = await connect()
        parameters = {"restitution": 0.05}
        await client.tell(
            {"type": "open", "scene": "gallery", "name": "collapse", "parameters": parameters, "rate": None}
        )
        await client.hear("opened")
        for _ in range(50):
            rows = await client.hear("rows")
            if rows["ended"] is not None:
                break
        assert "stopped by" in rows["ended"]

    run(story)


def test_events_that_are_kept_are_bounded(monkeypatch):
    monkeypatch.setattr(sys.modules["eventsim.show.live.world"], "MOST_EVENTS", 300)

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


def test_a_comparison_that_cannot_be_is_a_notice():
    async def story(connect, session, address):
        client = await connect()
        await client.tell({**menu(restitution=0.5), "rate": 60})
        opened = await client.hear("opened")
        assert opened["tracks"] == 1
        assert "elastic" in opened["notice"]
        await client.tell({"type": "open", "scene": "text", "text": json.dumps("x"), "rate": None})
        assert "TOML" in (await client.hear("error"))["text"]

    run(story)

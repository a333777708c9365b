"""The server: streams, worlds and their pages; what one page does must not trouble the others."""

import asyncio
import json

import numpy as np
import pytest

import eventsim as es
from eventsim.replay.replay import Replay
from eventsim.scene.roughness import TangentialRestitution
from tests.live.running import Client, menu
from tests.live.serving import log_of, run, worlds_alive

pytest.importorskip("aiohttp", reason="aiohttp is not installed (the extra live brings it)")

from eventsim.live.world import LEAD_SECONDS


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


def test_walls_keep_what_they_do_in_a_box_of_another_size(tmp_path):
    async def story(connect, session, address):
        client = await connect()
        await client.tell(menu(temperature=4000.0, shaking=30.0, roughness=0.5))
        assert "walls heat, by chance, at kT = 4000" in (await client.hear("opened"))["settings"]
        await client.tell({"type": "resize", "time": 0.0, "size": [900.0, 700.0]})
        opened = await client.hear("opened")
        assert "walls heat, by chance, at kT = 4000; walls shake at 30" in opened["settings"]
        log = await log_of(session, address, opened["world"], tmp_path)
        assert log.scene.domain.size == (900.0, 700.0)
        assert log.scene.tangential_restitution == TangentialRestitution(0.5, 0.5)
        spins = log.scene.disks.spins()
        await client.tell({"type": "disk", "time": 0.0, "position": [890.0, 690.0], "radius": 3.0})
        opened = await client.hear("opened")
        log = await log_of(session, address, opened["world"], tmp_path)
        assert log.scene.disks.spins().tolist() == [*spins, 0.0]

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

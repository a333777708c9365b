"""Connections: half requests are closed, other addresses are served only if asked for, and Ctrl-C ends all of them."""

import asyncio
import contextlib
import json
import signal
import socket
import time

import pytest

from tests.live.running import live_server, menu

aiohttp = pytest.importorskip("aiohttp", reason="aiohttp is not installed (the extra live brings it)")

from eventsim.live import connections, server  # noqa: E402


@contextlib.asynccontextmanager
async def served(**options):
    """Yield the address of a server with all that guards it."""
    told = asyncio.get_running_loop().create_future()
    task = asyncio.create_task(server.serve(None, 0, told.set_result, **options))
    try:
        yield await asyncio.wait_for(told, 10)
    finally:
        task.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await task


def port_of(address):
    return int(address.split("/")[2].rpartition(":")[2])


@pytest.mark.parametrize("said", [b"", b"GET / HTTP/1.1\r\nHost:", b"GET /x HTTP/1.1\r\nHost: localhost\r\n\r\n"])
def test_a_connection_that_asks_for_nothing_is_closed(monkeypatch, said):
    monkeypatch.setattr(connections, "IDLE_SECONDS", 0.3)
    monkeypatch.setattr(connections, "LOOK_SECONDS", 0.1)

    async def story():
        async with served() as address:
            readers = []
            for _ in range(20):
                reader, writer = await asyncio.open_connection("127.0.0.1", port_of(address))
                writer.write(said)
                readers.append((reader, writer))
            async with aiohttp.ClientSession() as session, session.ws_connect(address + "socket") as page:
                await page.receive_bytes()
                with contextlib.suppress(ConnectionError):
                    for reader, _ in readers:
                        await asyncio.wait_for(reader.read(), 10)
                await page.send_str(json.dumps(menu()))  # who is being answered stays
                assert (await page.receive()).type is aiohttp.WSMsgType.BINARY
            for _, writer in readers:
                writer.close()

    asyncio.run(story())


def test_the_oldest_idle_connection_makes_room(monkeypatch):
    monkeypatch.setattr(connections, "MOST", 5)
    monkeypatch.setattr(connections, "LOOK_SECONDS", 0.1)

    async def story():
        async with served() as address:
            opened = [await asyncio.open_connection("127.0.0.1", port_of(address)) for _ in range(9)]
            with contextlib.suppress(ConnectionError):
                await asyncio.wait_for(opened[0][0].read(), 10)
            async with aiohttp.ClientSession() as session, session.get(address) as answer:
                assert answer.status == 200
            for _, writer in opened:
                writer.close()

    asyncio.run(story())


def test_another_address_is_served_by_its_own_names_alone():
    async def story():
        async with served(host="127.0.0.2") as address, aiohttp.ClientSession() as session:
            assert address.startswith("http://127.0.0.2:")
            port = port_of(address)
            for host, status in ((f"127.0.0.2:{port}", 200), (f"127.0.0.1:{port}", 403), (f"evil.example:{port}", 403)):
                async with session.get(address, headers={"Host": host}) as answer:
                    assert answer.status == status, host
            async with session.get(f"http://127.0.0.2:{port}/") as answer:
                assert answer.status == 404  # nothing without the token

    asyncio.run(story())


def test_an_address_that_this_machine_does_not_have_is_refused_in_a_sentence():
    with pytest.raises(server.EventsimError, match=r"192\.0\.2\.1, port 0 cannot be used .*--host"):
        asyncio.run(server.serve(None, 0, lambda address: None, "192.0.2.1"))


def test_the_address_for_a_classroom_is_one_that_others_can_type():
    told = server._told("0.0.0.0")
    assert told != "0.0.0.0"
    socket.inet_aton(told)


def test_ctrl_c_ends_a_server_whose_clients_do_not_let_go():
    """Half requests, a page that reads nothing, and one that asks for more and more."""

    async def hold(address, stop):
        port = port_of(address)
        halves = [await asyncio.open_connection("127.0.0.1", port) for _ in range(20)]
        for _, writer in halves:
            writer.write(b"GET / HTTP/1.1\r\nHost:")
        async with aiohttp.ClientSession() as session:
            lazy = await session.ws_connect(address + "socket")
            busy = await session.ws_connect(address + "socket")
            await lazy.send_str(json.dumps(menu(count=400, speed=5000)))
            for seed in range(5):
                await busy.send_str(json.dumps(menu(count=400, seed=seed)))
            stop()
            with contextlib.suppress(ConnectionError, TimeoutError):
                await asyncio.wait_for(busy.receive(), 0.5)
            await asyncio.sleep(3.0)

    with live_server() as (address, process):
        began = []

        def stop():
            began.append(time.monotonic())
            process.send_signal(signal.SIGINT)

        asyncio.run(hold(address, stop))
        assert process.wait(timeout=30) == 0
        assert time.monotonic() - began[0] < 12.0  # two seconds, and three of this test, on a machine of its own

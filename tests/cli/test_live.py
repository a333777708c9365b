"""`eventsim live` before anything is served."""

import asyncio
import signal
import socket
import sys

import pytest

from tests.live.running import live_server


def test_a_port_that_is_taken_is_a_sentence(eventsim):
    pytest.importorskip("aiohttp", reason="aiohttp is not installed (the extra live brings it)")
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        found = eventsim("live", "--port", str(port), "--no-browser")
    assert found.exit_code == 2
    assert f"port {port} cannot be used" in found.stderr
    assert "--port" in found.stderr


def test_without_aiohttp_it_says_what_to_install(eventsim, monkeypatch):
    monkeypatch.setitem(sys.modules, "aiohttp", None)
    for name in [name for name in sys.modules if name.startswith("eventsim.live")]:
        monkeypatch.delitem(sys.modules, name)
    found = eventsim("live", "--no-browser")
    assert found.exit_code == 2
    assert "pip install 'eventsim-disks[live]'" in found.stderr


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--set", "n=5"], "name one"),
        (["nowhere.toml"], "nowhere.toml"),
        (["gas", "--set", "n=-5"], "count"),
        (["--port", "70000"], "--port"),
    ],
)
def test_bad_usage_serves_nothing(eventsim, arguments, says):
    found = eventsim("live", "--no-browser", *arguments)
    assert found.exit_code == 2
    assert says in found.stderr


def test_ctrl_c_ends_it_while_a_page_is_connected():
    aiohttp = pytest.importorskip("aiohttp", reason="aiohttp is not installed (the extra live brings it)")

    async def connected(address, process):
        async with aiohttp.ClientSession() as session, session.ws_connect(f"{address}socket") as page:
            await page.receive()
            process.send_signal(signal.SIGINT)
            await asyncio.to_thread(process.wait, 10)

    with live_server() as (address, process):
        asyncio.run(connected(address, process))
        assert process.returncode == 0

"""The server: the page, its socket and its downloads, for this machine alone unless its user says otherwise."""

from __future__ import annotations

import asyncio
import secrets
import tempfile
from collections.abc import Callable
from importlib.resources import files
from ipaddress import ip_address
from pathlib import Path
from socket import AF_INET, AF_INET6, SOCK_DGRAM, gethostname, socket

from aiohttp import web

from eventsim import __version__
from eventsim.errors import EventsimError
from eventsim.live.connections import IDLE_SECONDS, Connections, Handler
from eventsim.live.packets import packet
from eventsim.live.viewer import Viewer
from eventsim.live.world import World
from eventsim.scene import Scene
from eventsim.scene.files import scene_to_toml
from eventsim.scene.gallery import describe, names
from eventsim.suffixes import LOGS

HOST = "127.0.0.1"

MOST_VIEWERS = 64
MOST_BYTES = 1 << 20
"""Of a message: a scene file of some thousand disks. A longer one ends the connection, with a reason."""

WRITE_SECONDS = 60.0
"""How long a client may take for a block of a download."""

ALL_EVENTS = 10_000_000
"""Events that all worlds together keep (1.3 GB)."""

HEARTBEAT = 20.0
"""Seconds between two questions whether a page is still there."""

PAGE = {"/": ("live/page", "live.html", "text/html")} | {
    f"/{name}": (folder, name, kind)
    for folder, name, kind in (
        ("live/page", "live.css", "text/css"),
        ("show/player", "player.css", "text/css"),
        ("show/player", "world.js", "text/javascript"),
        ("show/player", "drawing.js", "text/javascript"),
        ("show/player", "player.js", "text/javascript"),
        ("show/player", "load.js", "text/javascript"),
        ("live/page", "link.js", "text/javascript"),
        ("live/page", "menu.js", "text/javascript"),
        ("live/page", "readouts.js", "text/javascript"),
        ("live/page", "series.js", "text/javascript"),
        ("live/page", "matching.js", "text/javascript"),
        ("live/page", "comparison.js", "text/javascript"),
        ("live/page", "hand.js", "text/javascript"),
        ("live/page", "live.js", "text/javascript"),
        ("live/page", "start.js", "text/javascript"),
    )
}
"""What is served under which name: folder, file and type."""

NOT_HERE = "404: nothing is here: open the whole address that eventsim live has printed, with all that follows the port"

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src data:; connect-src 'self'; "
    "frame-ancestors 'none'; base-uri 'none'; form-action 'none'"
)
"""The page talks to this server and to nobody else, and stands in no other page. Source: W3C, Content Security Policy Level 3."""

HEADERS = {
    "Content-Security-Policy": POLICY,
    "Cache-Control": "no-store",
    "Referrer-Policy": "no-referrer",  # nobody else learns the address
    "X-Content-Type-Options": "nosniff",
}

OWN = ("same-origin", "none")
"""What browsers say of requests of the page itself, and of an address that was typed. Source: W3C, Fetch Metadata."""


class House:
    """All worlds that are open, and the scene that the server was started with."""

    def __init__(self, given: Scene | None, prefix: str) -> None:
        self.given = given
        self._prefix = prefix
        self.worlds: dict[str, World] = {}
        self.viewers: set[Viewer] = set()

    def room(self) -> int:
        """Return for how many more events there is memory."""
        return ALL_EVENTS - sum(world.count for world in self.worlds.values())

    async def page(self, request: web.Request) -> web.StreamResponse:
        """Serve a part of the page."""
        folder, name, kind = PAGE[request.path.removeprefix(self._prefix)]
        text = files("eventsim").joinpath(folder, name).read_text(encoding="utf-8")
        return web.Response(text=text, content_type=kind, headers=HEADERS)

    async def socket(self, request: web.Request) -> web.StreamResponse:
        """Serve a page that looks at a world: its own, until it joins another."""
        if len(self.viewers) >= MOST_VIEWERS:
            raise web.HTTPServiceUnavailable(text=f"{MOST_VIEWERS} pages are connected, as many as there may be")
        socket = web.WebSocketResponse(max_msg_size=MOST_BYTES, heartbeat=HEARTBEAT, compress=False)
        await socket.prepare(request)
        world = World(self.given, self.room, self._forget)
        self.worlds[world.id] = world
        viewer = Viewer(socket, world, self.worlds)
        self.viewers.add(viewer)
        try:
            await socket.send_bytes(self._hello())
            await viewer.serve()
        finally:
            self.viewers.discard(viewer)
        return socket

    async def scene_file(self, request: web.Request) -> web.StreamResponse:
        """Serve the start of a world as a scene file."""
        scene = self._world(request).scene
        if scene is None:
            raise web.HTTPNotFound(text="this world has no scene yet")
        text = await asyncio.to_thread(scene_to_toml, scene)
        return web.Response(text=text, content_type="application/toml", headers=_attachment("scene.toml"))

    async def log_file(self, request: web.Request) -> web.StreamResponse:
        """Serve the log of a world, as far as it is simulated."""
        suffix = "." + request.match_info["suffix"]
        if suffix not in LOGS:
            raise web.HTTPNotFound(text=f"there is no log in the format {suffix}; there are {', '.join(LOGS)}")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, f"log{suffix}")
            try:
                await self._world(request).log_to(str(path))
            except EventsimError as error:
                raise web.HTTPNotFound(text=str(error)) from None
            response = web.StreamResponse(headers=_attachment(path.name))
            response.content_length = path.stat().st_size
            response.content_type = "application/octet-stream"
            await response.prepare(request)
            with path.open("rb") as file:
                while block := file.read(MOST_BYTES):
                    await asyncio.wait_for(response.write(block), WRITE_SECONDS)
            await response.write_eof()
            return response

    def _world(self, request: web.Request) -> World:
        world = self.worlds.get(request.match_info["world"])
        if world is None:
            raise web.HTTPNotFound(text="that world is gone: it lives as long as somebody looks at it")
        return world

    def _forget(self, world: World) -> None:
        del self.worlds[world.id]

    def _hello(self) -> bytes:
        """Return the first packet: what a page can choose from."""
        entries = [describe(name) for name in names()]
        gallery = [{"name": e.name, "title": e.title, "about": e.about, "parameters": e.parameters} for e in entries]
        given = None if self.given is None else self.given.called
        return packet("hello", version=__version__, gallery=gallery, given=given)


def application(
    given: Scene | None = None, token: str = "", connections: Connections | None = None
) -> web.Application:
    """Return the server's application.

    Args:
        given: the scene that a page begins with, None: what the menu says.
        token: what all addresses begin with, so that only who was told it finds anything.
        connections: who closes those that ask for nothing.
    """
    prefix = f"/{token}" if token else ""
    house = House(given, prefix)
    told = [] if connections is None else [connections.middleware()]
    app = web.Application(middlewares=[*told, refuse_foreigners])
    app.add_routes([web.get(prefix + path, house.page) for path in PAGE])
    app.router.add_get(prefix + "/socket", house.socket)
    app.router.add_get(prefix + "/worlds/{world}/scene.toml", house.scene_file)
    app.router.add_get(prefix + "/worlds/{world}/log.{suffix}", house.log_file)
    return app


@web.middleware
async def refuse_foreigners(request: web.Request, handler: Handler) -> web.StreamResponse:
    """Refuse requests that pages of other origins make, and names of this machine that others may have given it."""
    assert request.transport is not None
    address, port = request.transport.get_extra_info("sockname")[:2]  # not what the request says of itself
    known = {_in_address(address), *(("localhost",) if ip_address(address).is_loopback else (gethostname().lower(),))}
    here = {f"{name}:{port}" for name in known} | (known if port == 80 else set())
    origin = request.headers.get("Origin")
    foreign = origin is not None and origin.lower().removeprefix("http://") not in here
    if request.host.lower() not in here or foreign or request.headers.get("Sec-Fetch-Site", "none") not in OWN:
        raise web.HTTPForbidden(
            text="this server is for its own page on this machine; a page from elsewhere is refused"
        )
    try:
        return await handler(request)
    except web.HTTPNotFound as missing:
        if missing.text != web.HTTPNotFound().text:  # why is told already
            raise
        raise web.HTTPNotFound(text=NOT_HERE) from None


async def serve(given: Scene | None, port: int, ready: Callable[[str], None], host: str = HOST) -> None:
    """Serve until cancelled; ready(address) is called once the page can be opened.

    Args:
        given: see `application`.
        port: 0 takes any that is free.
        ready: who hears of the address.
        host: an address of this machine, at which others may reach it; 0.0.0.0 stands for all of them.

    Raises:
        EventsimError: where the port is taken, or the address is none of this machine.
    """
    token, connections = secrets.token_urlsafe(16), Connections()
    application_ = application(given, token, connections)
    runner = web.AppRunner(application_, access_log=None, shutdown_timeout=0.5, keepalive_timeout=IDLE_SECONDS)
    await runner.setup()
    watching = None
    try:
        try:
            site = web.TCPSite(runner, host, port)
            await site.start()
        except OSError as error:
            why = error.strerror or error
            raise EventsimError(f"{host}, port {port} cannot be used ({why}): see --port and --host") from None
        assert runner.server is not None
        watching = asyncio.create_task(connections.watch(runner.server))
        ready(f"http://{_in_address(_told(host))}:{runner.addresses[0][1]}/{token}/")
        await asyncio.Event().wait()
    finally:
        if watching is not None:
            watching.cancel()
        await runner.cleanup()


def _in_address(host: str) -> str:
    """How a numerical address stands in one of a page."""
    return f"[{host}]" if ":" in host else host


def _told(host: str) -> str:
    """The address to tell for one that is listened at: of all addresses the one by which this machine reaches others."""
    if not ip_address(host).is_unspecified:
        return host
    there = ("203.0.113.1", 9) if ip_address(host).version == 4 else ("2001:db8::1", 9)  # nobody's; nothing is sent
    with socket(AF_INET if ip_address(host).version == 4 else AF_INET6, SOCK_DGRAM) as asked:
        try:
            asked.connect(there)
        except OSError:
            return HOST
        return str(asked.getsockname()[0])


def _attachment(name: str) -> dict[str, str]:
    return {"Content-Disposition": f'attachment; filename="{name}"'}

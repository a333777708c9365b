"""`eventsim live`: the view in the browser."""

from __future__ import annotations

import asyncio
import os
import threading
from collections.abc import Coroutine
from ipaddress import ip_address
from typing import Any

import click

from eventsim.cli.options import json_option, quiet_option, scene_options
from eventsim.cli.output import DONE, say, say_data
from eventsim.errors import EventsimError

HOST, PORT = "127.0.0.1", 8642

PATIENCE = 1.5
"""Seconds that a server which was ended has to take leave."""


@click.command()
@scene_options(required=False)
@click.option(
    "--port",
    type=click.IntRange(0, 65535),
    default=PORT,
    show_default=True,
    help="Port on this machine; 0: any that is free.",
)
@click.option(
    "--host",
    default=HOST,
    show_default=True,
    metavar="ADDRESS",
    help="Listen at this address of the machine (0.0.0.0: at all), for a classroom: who is told the page's address can use it.",
)
@click.option("--no-browser", is_flag=True, help="Only print the address; open no browser.")
@json_option
@quiet_option
def command(
    scene: str | None,
    settings: tuple[str, ...],
    seed: int | None,
    port: int,
    host: str,
    no_browser: bool,
    as_json: bool,
    quiet: bool,
) -> None:
    """Open the live view in the browser: disks that a menu, a built-in scene or SCENE begins with.

    The page plays, pauses, reverses, steps from event to event; while it is paused, disks can be thrown and moved. It
    measures what it shows, compares it with a per-frame engine side by side, and downloads scene and log. The server
    simulates a few seconds ahead and sends events; the page draws what lies between them, exactly. It listens on
    127.0.0.1 alone unless --host says otherwise, and ends with Ctrl-C. What the keys until and events of a scene say is
    not heeded: it goes on. It plays as movies do: the span to until in 10 seconds; a scene without until so that a
    disk of usual speed crosses the picture in 5, and the menu's disks one time unit a second. The page tells the rate.

    \b
    Examples:
      eventsim live
      eventsim live break
      eventsim live my.toml --set restitution=0.9 --port 9000 --no-browser
      eventsim live --host 0.0.0.0 --no-browser      for a classroom; what is sent is not encrypted

    \b
    Keys of --json:
      scene, address           as typed (null without); where the page is: printed once it can be opened

    Exit codes: 0 ended by Ctrl-C; 2 bad usage, scene or file, a port that is taken, or aiohttp is missing.
    """
    import webbrowser

    from eventsim.cli.source import chosen_scene
    from eventsim.cli.words import as_json_text

    if scene is None and (settings or seed is not None):
        raise click.UsageError("--set and --seed shape a scene: name one")
    if not _is_address(host):
        raise click.UsageError(f"--host {host}: must be an address in numbers, such as 192.168.0.10 or 0.0.0.0")
    chosen = None if scene is None else chosen_scene(scene, settings, seed)
    try:
        from eventsim.live.server import serve
    except ModuleNotFoundError as error:
        if error.name is None or error.name.partition(".")[0] != "aiohttp":
            raise
        raise EventsimError("the live view needs aiohttp: pip install 'eventsim-disks[live]'") from None

    def tell(address: str) -> None:
        if as_json:
            say_data(as_json_text({"scene": scene, "address": address}))
        elif not quiet:
            say(f"the live view is at {address} (Ctrl-C ends it)")
        if not no_browser:
            webbrowser.open(address)

    try:
        asyncio.run(_served(serve(chosen, port, tell, host)))
    except KeyboardInterrupt:
        say("", err=True)  # after the ^C that the terminal shows


def _is_address(text: str) -> bool:
    try:
        ip_address(text)
    except ValueError:
        return False
    return True


async def _served(server: Coroutine[Any, Any, None]) -> None:
    """Serve; once that is over the process ends within a moment, whatever a thread of it is still computing."""
    try:
        await server
    except asyncio.CancelledError:
        end = threading.Timer(PATIENCE, os._exit, (DONE,))
        end.daemon = True
        end.start()
        raise

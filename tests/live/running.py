"""A live server of its own process, and a page or a bare connection that talks to it."""

from __future__ import annotations

import asyncio
import json
import struct
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

MENU = {
    "width": 800, "height": 500, "count": 50, "masses": "equal", "radii": "equal", "packing": 0.2, "speed": 300,
    "gravity": 0, "restitution": 1, "temperature": 0, "shaking": 0, "roughness": -1, "seed": 1,
}  # fmt: skip


@contextmanager
def live_server(*arguments: str, port: int = 0) -> Iterator[tuple[str, subprocess.Popen[str]]]:
    """Yield the address of `eventsim live` and its process, which is killed in the end."""
    command = [sys.executable, "-m", "eventsim", "live", "--json", "--no-browser", "--port", str(port), *arguments]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        text = ""
        while not text.rstrip().endswith("}"):
            line = process.stdout.readline()
            assert line, "the server ended before it said where it is"
            text += line
        yield json.loads(text)["address"], process
    finally:
        process.kill()
        process.wait()


def menu(**changes):
    return {"type": "open", "scene": "menu", "menu": {**MENU, **changes}, "rate": None}


def header_of(block: bytes):
    (length,) = struct.unpack_from("<I", block)
    return json.loads(block[4 : 4 + length])


class Client:
    """A bare connection that keeps what it hears; patience: seconds within which something comes."""

    patience = 20

    def __init__(self, socket):
        self.socket = socket

    async def tell(self, message):
        await self.socket.send_str(message if isinstance(message, str) else json.dumps(message))

    async def hear(self, kind, most=200, **wanted):
        """Return the header of the next packet of a kind, with these fields, among the next `most` packets."""
        for _ in range(most):
            message = await asyncio.wait_for(self.socket.receive(), self.patience)
            assert isinstance(message.data, bytes), message
            header = header_of(message.data)
            if header["type"] == kind and all(header[key] == value for key, value in wanted.items()):
                return header
        raise AssertionError(f"no {kind} among {most} packets")

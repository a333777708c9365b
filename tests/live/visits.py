"""Opens worlds of a live server and leaves them again, for minutes, and looks at the memory that it holds.

    python -m tests.live.visits [--minutes M] [--seed S]

Each visit opens a world of its own, with disks, forces and sometimes an engine beside it, watches, throws a disk and leaves.  The
first WARM visits let the server import and compile what it needs, and its threads take their share of memory; what it holds then
it may hold in the end, and `MORE` MB.
"""

from __future__ import annotations

import argparse
import asyncio
import random
import sys
import time
from pathlib import Path

import aiohttp

from tests.live.running import Client, live_server, menu

WARM = 200
MORE = 30


def megabytes(process: int) -> int:
    """What a process holds."""
    return int(Path(f"/proc/{process}/statm").read_text().split()[1]) * 4096 >> 20


async def visit(session: aiohttp.ClientSession, address: str, chance: random.Random) -> None:
    """Open a world, watch it for a moment, throw a disk, leave."""
    async with session.ws_connect(address + "socket", max_msg_size=0) as socket:
        client = Client(socket)
        client.patience = 900  # on a busy machine that compiles
        await client.hear("hello")
        changes = {"count": chance.choice([20, 200, 800]), "seed": chance.randrange(1000), "gravity": chance.choice([0, 100])}
        await client.tell({**menu(**changes), "rate": chance.choice([None, None, 60])})
        opened = await client.hear("opened")
        await client.hear("rows")
        shown = {"type": "shown", "edition": opened["edition"], "time": 0.5, "events": 0, "speed": 1.0}
        await client.tell(shown)
        await client.tell({"type": "throw", "time": 0.1, "disk": 0, "velocity": [100.0, 50.0]})
        await asyncio.sleep(chance.uniform(0.0, 0.5))


async def visits(address: str, process: int, minutes: float, seed: int) -> list[int]:
    """The memory after the first WARM visits, then after each minute."""
    chance, count, held = random.Random(seed), 0, []
    async with aiohttp.ClientSession() as session:
        while len(held) <= minutes:
            await visit(session, address, chance)
            count += 1
            if count == WARM:
                began = time.monotonic()
            if count >= WARM and time.monotonic() - began >= 60.0 * len(held):
                await asyncio.sleep(2.0)
                held.append(megabytes(process))
                print(f"minute {len(held) - 1}: {count} visits, {held[-1]} MB", flush=True)
    return held


def main() -> int:
    """Visit, and print what the server holds."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=30.0)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    with live_server() as (address, process):
        held = asyncio.run(visits(address, process.pid, asked.minutes, asked.seed))
    print(f"seed {asked.seed}: {held[0]} MB after {WARM} visits, {held[-1]} MB after {asked.minutes:g} minutes more")
    return 1 if held[-1] > held[0] + MORE else 0


if __name__ == "__main__":
    sys.exit(main())

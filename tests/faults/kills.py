"""Kills runs, sweeps and live servers at random moments, and looks at what is left.

    python -m tests.faults.kills [--kills N] [--seed S]

Two thirds of the kills go to runs of each format, full and compact, with checkpoints (`tests.cli.test_interrupts`); the others
to sweeps with two workers, and to live servers that a page looks at.  What must hold each time: files under their names are
whole; what is left in the making can be read, and tells the beginning; what goes on ends as if never killed; no process stays.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import multiprocessing
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import eventsim as es
from eventsim.suffixes import LOGS
from eventsim.sweep import sweep
from tests.cli.test_interrupts import children_of, is_alive, kill_again_and_again
from tests.live.running import live_server, menu
from tests.sweep.test_sweep import GRID, make


def swept(path: Path) -> None:
    """A sweep of four runs by two workers; it goes on with what its journal has."""
    sweep(make, GRID, events=400, replicas=2, engine="reference", out=path, workers=2)


def kill_sweeps(place: Path, kills: int, seed: int) -> tuple[int, int]:
    """Kill a sweep so often; how many kills left a journal of some runs, and how many times it came to its end in between."""
    chance = np.random.default_rng(seed)
    context = multiprocessing.get_context("forkserver")
    whole, table = place / "whole.csv", place / "table.csv"
    began = time.monotonic()
    first = context.Process(target=swept, args=(whole,))
    first.start()
    first.join()
    longest, killed, begun, ended = 1.5 * (time.monotonic() - began), 0, 0, 0
    while killed < kills:
        child = context.Process(target=swept, args=(table,))
        began = time.monotonic()
        child.start()
        child.join(chance.uniform(0.0, longest))
        alive, workers = child.is_alive(), children_of(child.pid or 0)
        child.kill()
        child.join()
        killed += alive
        until = time.monotonic() + 30.0
        while any(map(is_alive, workers)):
            assert time.monotonic() < until, "workers outlive their sweep"
            time.sleep(0.05)
        if not alive:
            assert child.exitcode == 0
            longest = max(longest, 1.2 * (time.monotonic() - began))
            ended += 1
        journal = place / "table.csv.journal"
        begun += alive and journal.exists() and len(journal.read_bytes().splitlines()) > 1
        if table.exists():
            assert table.read_bytes() == whole.read_bytes(), "the table is another one"
            table.unlink()
    swept(table)
    assert table.read_bytes() == whole.read_bytes(), "what goes on is another table"
    return begun, ended


def kill_servers(kills: int, seed: int) -> None:
    """Kill live servers that simulate for a page: a page hears of it at once, and a new server takes the port."""
    import aiohttp

    chance = np.random.default_rng(seed)

    async def look(address: str, kill: Callable[[], None]) -> None:
        async with aiohttp.ClientSession() as session, session.ws_connect(address + "socket") as page:
            await page.send_str(json.dumps(menu(count=100)))
            await page.receive()
            await asyncio.sleep(float(chance.uniform(0.0, 0.5)))
            kill()
            async with asyncio.timeout(20):
                while (await page.receive()).type is aiohttp.WSMsgType.BINARY:
                    pass

    port = 0
    for _ in range(kills):
        with live_server(port=port) as (address, process):
            port = int(address.split("/")[2].rpartition(":")[2])
            asyncio.run(look(address, process.kill))


def main() -> int:
    """Kill, and print what was killed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kills", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    cases = [(suffix, compact) for suffix in LOGS for compact in (False, True)]
    runs, sweeps = asked.kills * 2 // 3 // len(cases), asked.kills // 5
    for number, (suffix, compact) in enumerate(cases):
        with tempfile.TemporaryDirectory() as folder:
            kill_again_and_again(Path(folder), suffix, compact, "reference", runs, asked.seed + number)
        print(f"{'compact' if compact else 'full'} {suffix}: {runs} kills, the same log", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        begun, ended = kill_sweeps(Path(folder), sweeps, asked.seed)
    print(f"sweeps: {sweeps} kills, {begun} with runs in the journal, {ended} ends in between, the same table", flush=True)
    servers = asked.kills - runs * len(cases) - sweeps
    kill_servers(servers, asked.seed)
    print(f"live servers: {servers} kills, each told to its page", flush=True)
    print(f"seed {asked.seed}, {asked.kills} kills, eventsim {es.__version__}: all as it must be")
    return 0


if __name__ == "__main__":
    sys.exit(main())

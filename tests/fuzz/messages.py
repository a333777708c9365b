"""Sends messages to the live server as a page could, and as none would, by a generator that knows their fields.

    python -m tests.fuzz.messages [--messages N] [--seed S] [--pages P]

Pages come and go, open scenes, throw, move and resize at all numbers that stand at a border.  Right is: every message is answered
(`opened`, `done` or a sentence) in time, and no exception reaches the log.  After each ROUND of messages all pages leave: then
the worlds are gone, and the memory levels off once what is loaded and compiled on demand has been asked for.
"""

from __future__ import annotations

import argparse
import asyncio
import gc
import json
import logging
import random
import sys
from collections import Counter
from pathlib import Path
from time import monotonic
from typing import Any

from eventsim.live.messages import OPPONENTS
from tests.live.running import MENU, header_of
from tests.live.serving import serving, worlds_alive

PATIENCE = 300.0
"""Seconds within which a message is answered on a busy machine, where the first comparison compiles its engine."""

ROUND = 2000
"""Messages after which all pages leave, and the memory is looked at."""

MORE = 30
"""MB that the second half of the rounds may hold more than the second quarter."""

BORDERS = (
    0, 1, -1, 0.5, 1e-9, 5e-324, -5e-324, 1e-300, 50.0, 1e4, 1e15, -1e15, 1.0000001e15, 1e308, 2**31, 2**53, 2**53 + 1, 10**30,
    True, None, "1", "", [], {}, [1, 2], "\ud800", float("nan"), float("inf"),
)  # fmt: skip
NAMES = (
    "gas",
    "break",
    "bounce",
    "sinai",
    "galperin",
    "collapse",
    "jar",
    "periodic-fluid",
    "newton-cradle",
    "tie",
    "cellar",
    "",
)
KINDS = {
    "shown": 45, "throw": 20, "move": 10, "resize": 8, "control": 8, "disk": 4, "wall": 4, "open": 4, "join": 2, "broken": 3,
}  # fmt: skip
BOX = '[domain]\nkind = "box"\nsize = [4, 4]\n'
TEXTS = (
    '[domain]\nkind = "open"\n'
    "[[disk]]\nposition = [0, 0]\nradius = 1\nvelocity = [1e300, 0]\n[[disk]]\nposition = [9, 0]\nradius = 1",
    f'{BOX}[[gas]]\ncount = 60\npacking_fraction = 0.4\narrangement = "random"\nseed = 1\nspeed = 1e-300',
    f"gravity = [0, -1]\nrestitution = 0.5\n{BOX}[[disk]]\nposition = [2, 2]\nradius = 0.5",
    '[domain]\nkind = "periodic"\nsize = [1, 1]\n[[disk]]\nposition = [0.5, 0.5]\nradius = 0.1\nvelocity = [1e9, 1e-9]',
    "[domain",
    "disks_file = [{path = '/etc/passwd'}]",
    "",
)


class Generator:
    """Messages, from a seed."""

    def __init__(self, seed: int) -> None:
        self.chance = random.Random(seed)

    def message(self, edition: int, time: float, world: str) -> tuple[str, bool]:
        """A message, and whether it asks for an answer; edition, time, world: what the page has been shown."""
        kind = self.chance.choices(list(KINDS), list(KINDS.values()))[0]
        made: dict[str, Any] = {"type": kind, **getattr(self, f"_{kind}")(edition, time, world)}
        if self.chance.random() < 0.15:
            key = self.chance.choice([key for key in made if key != "type"] or ["type"])
            made[key] = self.chance.choice(BORDERS)
        if self.chance.random() < 0.02:
            made["further"] = 1
        return json.dumps(made), kind not in ("shown", "control")

    def _number(self, usual: float) -> float:
        """Often a usual number, else one at a border."""
        return self.chance.choice([usual, usual, usual * self.chance.random(), *BORDERS[:16]])

    def _when(self, time: float) -> float:
        return self.chance.choice([time, time, time * self.chance.random(), 0.0, 2.0 * time, self._number(time)])

    def _shown(self, edition: int, time: float, world: str) -> dict[str, Any]:
        when = self._when(time + 0.05)
        return {"edition": edition, "time": when, "events": self.chance.choice([0, 100, 2**53]), "speed": self._number(1.0)}

    def _throw(self, edition: int, time: float, world: str) -> dict[str, Any]:
        velocity = [self._number(100.0), self._number(-100.0)]
        return {"time": self._when(time), "disk": self.chance.choice([0, 1, 7, 49, 5000]), "velocity": velocity}

    def _move(self, edition: int, time: float, world: str) -> dict[str, Any]:
        place = [self._number(400.0), self._number(250.0)]
        return {"time": self._when(time), "disk": self.chance.choice([0, 1, 7, 49]), "position": place}

    def _disk(self, edition: int, time: float, world: str) -> dict[str, Any]:
        place = [self._number(400.0), self._number(250.0)]
        return {"time": self._when(time), "position": place, "radius": self._number(10.0)}

    def _wall(self, edition: int, time: float, world: str) -> dict[str, Any]:
        start, end = ([self._number(800.0), self._number(500.0)] for _ in range(2))
        return {"time": self._when(time), "start": start, "end": end}

    def _resize(self, edition: int, time: float, world: str) -> dict[str, Any]:
        return {"time": self._when(time), "size": [self._number(800.0), self._number(500.0)]}

    def _control(self, edition: int, time: float, world: str) -> dict[str, Any]:
        direction, playing = self.chance.choice([1, -1, 0]), self.chance.choice([True, False])
        return {"time": self._when(time), "speed": self._number(1.0), "direction": direction, "playing": playing}

    def _open(self, edition: int, time: float, world: str) -> dict[str, Any]:
        beside: dict[str, Any] = {"rate": self.chance.choice([None, None, 60, self._number(60)])}
        if self.chance.random() < 0.5:
            beside["opponent"] = self.chance.choice([*OPPONENTS, "fast", 1])
        scene = self.chance.choice(["menu", "gallery", "text", "given"])
        if scene == "menu":
            menu = {**MENU, "count": self.chance.choice([1, 30, 80]), "seed": self.chance.randrange(9)}
            menu[self.chance.choice(list(menu))] = self.chance.choice([*BORDERS, *menu.values()])
            return {"scene": scene, "menu": menu, **beside}
        if scene == "gallery":
            parameters = {self.chance.choice(["n", "seed", "mass_ratio", "name", "radius"]): self._number(16)}
            chosen = self.chance.choice([{}, parameters])
            return {"scene": scene, "name": self.chance.choice(NAMES), "parameters": chosen, **beside}
        if scene == "text":
            return {"scene": scene, "text": self.chance.choice(TEXTS), **beside}
        return {"scene": scene, **beside}

    def _join(self, edition: int, time: float, world: str) -> dict[str, Any]:
        return {"world": self.chance.choice([world, "nobody", "x" * 200])}

    def _broken(self, edition: int, time: float, world: str) -> dict[str, Any]:
        return {"type": self.chance.choice(["", "opens", 5, None])}


class Page:
    """A connection that takes up what it is sent, and counts it."""

    def __init__(self, socket: Any) -> None:
        self.socket, self.edition, self.time, self.world = socket, 0, 0.0, "nobody"
        self.heard: Counter[str] = Counter()
        self._news = asyncio.Event()
        self._task = asyncio.create_task(self._take_up())

    async def _take_up(self) -> None:
        async for message in self.socket:
            header = header_of(message.data)
            self.heard[header["type"]] += 1
            if header["type"] == "opened":
                self.edition, self.world, self.time = header["edition"], header["world"], 0.0
            elif header["type"] == "rows":
                self.time = max(header["horizon"], 0.0)
            elif header["type"] == "cut":
                self.time = min(self.time, header["time"])
            elif header["type"] == "error" and "the server failed" in header["text"]:
                raise AssertionError(header["text"])
            self._news.set()

    async def ask(self, text: str, answered: bool) -> None:
        """Send a message; wait until it is answered, if it is one that is."""
        answers = self.heard["done"] + self.heard["error"]
        await self.socket.send_str(text)
        async with asyncio.timeout(PATIENCE):
            while answered and self.heard["done"] + self.heard["error"] == answers:
                self._news.clear()
                await self._news.wait()

    async def leave(self) -> None:
        await self.socket.close()
        await self._task


class Alarm(logging.Handler):
    """Keeps what the server logs: nothing, if all is well."""

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.said: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.said.append(self.format(record))


async def fuzz(messages: int, seed: int, pages: int, stay: int = 400) -> dict[str, Any]:
    """Send so many messages, in turn from some pages, of which each leaves after `stay` messages; what came of it."""
    generator, alarm, heard = Generator(seed), Alarm(), Counter[str]()
    logging.getLogger().addHandler(alarm)
    slowest, slow, held, worlds = 0.0, "", list[int](), 0
    try:
        async with serving() as (connect, _, _address):
            open_ = [Page((await connect()).socket) for _ in range(pages)]
            for number in range(messages):
                place = number % pages
                if number and number % ROUND == 0:
                    for page in open_:
                        heard += page.heard
                        await page.leave()
                    worlds += await left_alone(held)
                    print(f"{number} messages: {held[-1]} MB", flush=True)
                    open_ = [Page((await connect()).socket) for _ in range(pages)]
                if number // pages % stay == stay - 1 - place:
                    heard += open_[place].heard
                    await open_[place].leave()
                    open_[place] = Page((await connect()).socket)
                page = open_[place]
                text, answered = generator.message(page.edition, page.time, generator.chance.choice(open_).world)
                began = monotonic()
                try:
                    await page.ask(text, answered)
                except TimeoutError:
                    alarm.said.append(f"no answer within {PATIENCE:g} s: {text[:300]}")
                    return {"said": alarm.said, "after": number}
                if monotonic() - began > slowest:
                    slowest, slow = monotonic() - began, text[:200]
            for page in open_:
                heard += page.heard
                await page.leave()
            worlds += await left_alone(held)
    finally:
        logging.getLogger().removeHandler(alarm)
    return {
        "said": alarm.said,
        "heard": dict(heard),
        "worlds": worlds,
        "held": held,
        "slowest": (round(slowest, 2), slow),
    }


async def left_alone(held: list[int]) -> int:
    """Note what the process holds when all pages have left; how many worlds are there all the same."""
    await asyncio.sleep(0.5)
    gc.collect()
    held.append(megabytes())
    return len(worlds_alive())


def grows(held: list[int]) -> bool:
    """Whether the memory goes on to grow after half of the rounds."""
    quarter = len(held) // 4
    return quarter > 0 and max(held[2 * quarter :]) > max(held[quarter : 2 * quarter]) + MORE


def megabytes() -> int:
    """What this process holds now."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * 4096 >> 20


def main() -> int:
    """Send, and print what came of it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--messages", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--pages", type=int, default=3)
    asked = parser.parse_args()
    found = asyncio.run(fuzz(asked.messages, asked.seed, asked.pages))
    for name, value in found.items():
        print(f"{name}: {value}")
    return 1 if found["said"] or found["worlds"] or grows(found["held"]) else 0


if __name__ == "__main__":
    sys.exit(main())

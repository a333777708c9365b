"""Messages: what a page may say to the server, read from JSON and checked."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from eventsim.errors import EventsimError
from eventsim.formulas.rough import PERFECTLY_ROUGH, SMOOTH
from eventsim.live.menu import Menu
from eventsim.live.source import MOST_DISKS, BuiltIn, Source, Text

FARTHEST = 1e15
"""Bound on every number a page sends: farther or faster is a mistake, and squares stay finite."""

RATES = (1.0, 10_000.0)
"""Steps per second of the other engine in a comparison."""

OPPONENTS = ("frames", "stepped", "penalty", "pymunk")
"""The engines to compare with; the first where a page names none."""


class MessageError(EventsimError):
    """A message that does not fit; the connection lives on."""


@dataclass(frozen=True, slots=True)
class Open:
    """Begin with a scene; source None: the one the server was started with. rate: steps per second of the engine beside it,
    None without; opponent: which."""

    source: Source | None
    rate: float | None
    opponent: str = OPPONENTS[0]


@dataclass(frozen=True, slots=True)
class Join:
    """Look at a world that another page has opened."""

    world: str


@dataclass(frozen=True, slots=True)
class Shown:
    """How far a page has come: its time, the events until then, and the scene time it plays per second; edition: of the
    opened scene that it speaks of."""

    edition: int
    time: float
    events: int
    speed: float


@dataclass(frozen=True, slots=True)
class Throw:
    """Give a disk a velocity, at a time that is shown."""

    time: float
    disk: int
    velocity: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Move:
    """Put a disk elsewhere (its centre, on the scene's axes): a new start from the state at a time."""

    time: float
    disk: int
    position: tuple[float, float]


@dataclass(frozen=True, slots=True)
class AddDisk:
    """Put one more disk of mass 1, at rest, into the scene: a new start from the state at a time."""

    time: float
    position: tuple[float, float]
    radius: float


@dataclass(frozen=True, slots=True)
class AddWall:
    """Put a straight wall into the scene: a new start from the state at a time."""

    time: float
    start: tuple[float, float]
    end: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Resize:
    """Give the box another size: a new start from the state at a time."""

    time: float
    size: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Control:
    """What a page does to the time, told to the others who look at the same world."""

    time: float
    speed: float
    direction: int
    playing: bool


Message: TypeAlias = Open | Join | Shown | Throw | Move | AddDisk | AddWall | Resize | Control


def read_message(text: str) -> Message:
    """Return the message of a text; raise MessageError with what is wrong and which rule it breaks."""
    try:
        data = json.loads(text, parse_constant=_no_number)
    except (ValueError, RecursionError):
        raise MessageError("a message must be JSON") from None
    if not isinstance(data, dict):
        raise MessageError("a message must be a JSON object")
    kind = data.pop("type", None)
    read = READERS.get(kind) if isinstance(kind, str) else None
    if read is None:
        raise MessageError(f"there is no message of type {_quoted(kind)}; there are {', '.join(READERS)}")
    fields = Fields(kind, data)
    message = read(fields)
    fields.demand_empty()
    return message


class Fields:
    """The fields of a message, taken out one by one; what is left in the end is unknown."""

    def __init__(self, kind: str, data: Mapping[str, Any]) -> None:
        self.kind = kind
        self.data = dict(data)

    def number(self, key: str, low: float = -FARTHEST, high: float = FARTHEST) -> float:
        """Take a number."""
        value = self._take(key)
        if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
            raise self._wrong(key, value, f"must be a number from {low:g} to {high:g}")
        return float(value)

    def whole(self, key: str, low: int, high: int) -> int:
        """Take a whole number."""
        value = self._take(key)
        if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
            raise self._wrong(key, value, f"must be a whole number from {low} to {high}")
        return value

    def pair(self, key: str, low: float = -FARTHEST, high: float = FARTHEST) -> tuple[float, float]:
        """Take two numbers."""
        value = self._take(key)
        if not isinstance(value, list) or len(value) != 2:
            raise self._wrong(key, value, "must be two numbers [x, y]")
        x, y = (Fields(self.kind, {key: part}).number(key, low, high) for part in value)
        return x, y

    def text(self, key: str, most: int) -> str:
        """Take a text of at most so many characters."""
        value = self._take(key)
        if not isinstance(value, str) or len(value) > most:
            raise self._wrong(key, value, f"must be a text of at most {most} characters")
        return value

    def choice(self, key: str, *allowed: object) -> Any:
        """Take one of a few values."""
        value = self._take(key)
        if not any(value == other and type(value) is type(other) for other in allowed):
            raise self._wrong(key, value, f"must be one of {', '.join(map(str, allowed))}")
        return value

    def table(self, key: str) -> Fields:
        """Take a table of further fields."""
        value = self._take(key)
        if not isinstance(value, dict):
            raise self._wrong(key, value, "must be a table")
        return Fields(f"{self.kind}.{key}", value)

    def demand_empty(self) -> None:
        """Raise where fields are left."""
        if self.data:
            raise MessageError(f"{self.kind}: there is no field {_quoted(min(self.data))} in such a message")

    def _take(self, key: str) -> Any:
        if key not in self.data:
            raise MessageError(f"{self.kind}: the field {key!r} is missing")
        return self.data.pop(key)

    def _wrong(self, key: str, value: object, rule: str) -> MessageError:
        return MessageError(f"{self.kind}: {key} = {_quoted(value)}: {rule}")


def _open(fields: Fields) -> Open:
    kind = fields.choice("scene", "menu", "gallery", "text", "given")
    source: Source | None = None
    if kind == "menu":
        source = _menu(fields.table("menu"))
    elif kind == "gallery":
        name, parameters = fields.text("name", 100), fields.table("parameters")
        for key, value in parameters.data.items():
            if not isinstance(value, bool | int | float | str) or (isinstance(value, str) and len(value) > 100):
                raise MessageError(f"open.parameters: {_quoted(key)} = {_quoted(value)}: must be a number or a word")
        source = BuiltIn(name, parameters.data)
    elif kind == "text":
        source = Text(fields.text("text", 1_000_000))
    rate = None if fields.data.get("rate", 0) is None else fields.number("rate", *RATES)
    fields.data.pop("rate", None)
    opponent = fields.choice("opponent", *OPPONENTS) if "opponent" in fields.data else OPPONENTS[0]
    return Open(source, rate, opponent)


def _menu(fields: Fields) -> Menu:
    menu = Menu(
        width=fields.number("width", 50.0, 10_000.0),
        height=fields.number("height", 50.0, 10_000.0),
        count=fields.whole("count", 1, MOST_DISKS),
        masses=fields.choice("masses", "equal", "different"),
        radii=fields.choice("radii", "equal", "different"),
        packing=fields.number("packing", 1e-4, 0.85),
        speed=fields.number("speed", 0.0, 10_000.0),
        gravity=fields.number("gravity", -10_000.0, 10_000.0),
        restitution=fields.number("restitution", 0.0, 1.0),
        temperature=fields.number("temperature", 0.0, 1e8),
        shaking=fields.number("shaking", 0.0, 10_000.0),
        roughness=fields.number("roughness", SMOOTH, PERFECTLY_ROUGH),
        seed=fields.whole("seed", 0, 2**31 - 1),
    )
    fields.demand_empty()
    return menu


def _shown(fields: Fields) -> Shown:
    return Shown(
        edition=fields.whole("edition", 0, 2**53),
        time=fields.number("time", 0.0),
        events=fields.whole("events", 0, 2**53),
        speed=fields.number("speed", 0.0),
    )


def _throw(fields: Fields) -> Throw:
    return Throw(fields.number("time", 0.0), fields.whole("disk", 0, MOST_DISKS), fields.pair("velocity"))


def _move(fields: Fields) -> Move:
    return Move(fields.number("time", 0.0), fields.whole("disk", 0, MOST_DISKS), fields.pair("position"))


def _disk(fields: Fields) -> AddDisk:
    return AddDisk(fields.number("time", 0.0), fields.pair("position"), fields.number("radius", 0.0))


def _wall(fields: Fields) -> AddWall:
    return AddWall(fields.number("time", 0.0), fields.pair("start"), fields.pair("end"))


def _resize(fields: Fields) -> Resize:
    return Resize(fields.number("time", 0.0), fields.pair("size", 1.0, 10_000.0))


def _control(fields: Fields) -> Control:
    return Control(
        time=fields.number("time", 0.0),
        speed=fields.number("speed", 0.0),
        direction=fields.choice("direction", 1, -1),
        playing=fields.choice("playing", True, False),
    )


READERS: dict[str, Callable[[Fields], Message]] = {
    "open": _open,
    "join": lambda fields: Join(fields.text("world", 100)),
    "shown": _shown,
    "throw": _throw,
    "move": _move,
    "disk": _disk,
    "wall": _wall,
    "resize": _resize,
    "control": _control,
}


def _no_number(constant: str) -> float:
    raise ValueError(constant)


def _quoted(value: object) -> str:
    """The value as it is, but short: a page may have sent a megabyte."""
    if isinstance(value, float) and not math.isfinite(value):
        return "a number beyond all bounds"
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."

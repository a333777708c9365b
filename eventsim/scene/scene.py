"""A scene: everything that is given before time passes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from os import PathLike
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from eventsim.errors import SceneError
from eventsim.meant import NamesMeant
from eventsim.notebook import html_table
from eventsim.scene.disks import Disks
from eventsim.scene.domain import DOMAINS, Domain
from eventsim.scene.names import DiskNames, plural
from eventsim.scene.numbers import Point, number, optional_number, optional_whole, point
from eventsim.scene.own_law import OwnLaw, own_law
from eventsim.scene.restitution import Restitution, as_restitution
from eventsim.scene.roughness import TangentialRestitution, as_tangential, roughness_problems
from eventsim.scene.validate import chance_problems, find_problems, scalar_problems, species_problems, touching_notes
from eventsim.scene.walls import WALLS, Wall

UNNAMED = "a scene without a name"


@dataclass(frozen=True, slots=True, init=False, repr=False)
class Scene(NamesMeant):
    """Disks in a domain with walls, and the rules of their motion; valid once it exists.

    Attributes:
        disks: the N disks at the start.
        domain: Box, Periodic, Channel or Open.
        walls: walls inside the domain.
        gravity: acceleration (x, y), length / time^2; None without.
        restitution: None where every contact is elastic.
        tangential_restitution: of rough disks; None where disks have no spin.
        law: a law of contacts of the user's own; None without.
        seed: of the chance at walls that heat; None without.
        contact_duration: time; a contact within it after a disk's previous one is elastic; None without.
        equilibration: time from the start that measurements leave out; None: they find out.
        until: stop time on the scene's clock, or None.
        events: number of events to stop after, or None.
        start_time: what the clock shows at the start.
        name: what the scene is called, or None. A file without this key gives its own name. Scenes that differ in it alone
            are equal.

    >>> import eventsim as es
    >>> disks = es.Disks(position=[(0.5, 0.5), (1.5, 0.5)], velocity=[(1, 0), (0, 0)], radius=0.1, mass=[1, 2])
    >>> es.Scene(disks, es.Box((2, 1)), gravity=(0, -1), until=3)
    Scene(2 disks, domain: box 2 x 1, gravity: (0.0, -1.0), until: 3.0)
    """

    disks: Disks
    domain: Domain
    walls: tuple[Wall, ...]
    gravity: Point | None
    restitution: Restitution | None
    tangential_restitution: TangentialRestitution | None
    contact_duration: float | None
    equilibration: float | None
    until: float | None
    events: int | None
    start_time: float
    name: str | None = field(compare=False)
    law: OwnLaw | None
    seed: int | None

    def __init__(
        self,
        disks: Disks,
        domain: Domain,
        walls: Sequence[Wall] = (),
        gravity: Sequence[float] | NDArray[Any] | None = None,
        restitution: Restitution | Mapping[str, Any] | float | None = None,
        contact_duration: float | None = None,
        until: float | None = None,
        events: int | None = None,
        start_time: float = 0.0,
        name: str | None = None,
        equilibration: float | None = None,
        law: Callable[..., float] | OwnLaw | None = None,
        seed: int | None = None,
        *,
        tangential_restitution: TangentialRestitution | Mapping[str, float] | float | None = None,
        names: DiskNames | None = None,
    ) -> None:
        """The scene with these parts; a restitution may be one number, a mapping or a Restitution, a law a function.

        `names` says how messages call the disks, by index if None; it is not kept.

        Raises:
            SceneError: with every rule that is broken, each naming the disks or the key, value and rule.
        """
        _demand_types(disks, domain, walls, name)
        pull = None if gravity is None else point(gravity, "gravity")
        given: dict[str, Any] = {
            "disks": disks,
            "domain": domain,
            "walls": tuple(walls),
            "gravity": None if pull == (0.0, 0.0) else pull,
            "restitution": as_restitution(restitution),
            "tangential_restitution": as_tangential(tangential_restitution),
            "contact_duration": optional_number(contact_duration, "contact_duration"),
            "equilibration": optional_number(equilibration, "equilibration"),
            "until": optional_number(until, "until"),
            "events": optional_whole(events, "events"),
            "start_time": number(start_time, "start_time"),
            "name": name,
            "law": own_law(law),
            "seed": optional_whole(seed, "seed"),
        }
        for key, value in given.items():
            object.__setattr__(self, key, value)
        names = names or DiskNames()
        scalars = [*scalar_problems(given), *species_problems(self.restitution, disks)]
        scalars += chance_problems(domain, self.walls, self.seed)
        scalars += roughness_problems(disks, self.tangential_restitution, names)
        problems = find_problems(disks, domain, self.walls, self.gravity, names, scalars)
        if problems:
            raise SceneError(problems)


    def begun_at(self, time: float, disks: Disks, domain: Domain | None = None) -> Scene:
        """Return the scene with another start; it does not say when to stop.

        Args:
            time: on the scene's clock.
            disks: those that it begins with.
            domain: where; None: its own.

        Raises:
            SceneError: where these disks break a rule.
        """
        return replace(
            self, disks=disks, domain=domain or self.domain, start_time=time, until=None, events=None, equilibration=None
        )

    def save(self, path: str | PathLike[str]) -> None:
        """Write the scene to `path`, .toml or .json, every disk listed; `load_scene` gives back every bit.

        Of a law of your own the file holds the text, which is not run: `dataclasses.replace(scene, law=function)` puts it back.

        Raises:
            SceneError: for another suffix, or where it cannot be written.
        """
        from eventsim.scene.writing import save_scene  # only who saves pays for it

        save_scene(self, Path(path))

    @property
    def called(self) -> str:
        """How all that is written or drawn calls the scene."""
        return self.name or UNNAMED

    def __repr__(self) -> str:
        return f"Scene({', '.join(f'{key}: {value}' if key else value for key, value in self._facts())})"

    def _repr_html_(self) -> str:
        return html_table(self.called, (), [(key or "disks", value) for key, value in self._facts()])

    def _facts(self) -> Iterator[tuple[str, str]]:
        """What there is to say in short, by key."""
        if self.name is not None:
            yield "name", self.name
        yield "", plural(len(self.disks), "disk")
        size = self.domain.size
        yield "domain", self.domain.kind if size is None else f"{self.domain.kind} {size[0]:g} x {size[1]:g}"
        if self.walls:
            yield "walls", str(len(self.walls))
        for key in ("gravity", "restitution", "tangential_restitution", "contact_duration", "equilibration", "until", "events"):
            value = getattr(self, key)
            if value is not None:
                yield key, str(value)
        if self.law is not None:
            yield "law", self.law.name


def _demand_types(disks: object, domain: object, walls: Sequence[object], name: object) -> None:
    """Raise if a part is not what its place is for, as when code passes a size for a domain."""
    problems: list[str] = []
    if not isinstance(disks, Disks):
        problems.append(f"disks = {disks!r}: must be Disks(position, velocity, radius, mass)")
    if not isinstance(domain, tuple(DOMAINS.values())):
        problems.append(f"domain = {domain!r}: must be a Box, Periodic, Channel or Open")
    if not isinstance(walls, list | tuple):
        problems.append(f"walls = {walls!r}: must be a sequence of walls")
    else:
        kinds = ", ".join(kind.__name__ for kind in WALLS.values())
        strange = [(i, wall) for i, wall in enumerate(walls) if not isinstance(wall, tuple(WALLS.values()))]
        problems += [f"wall[{i}] = {wall!r}: must be one of {kinds}" for i, wall in strange]
        called = [(i, getattr(wall, "name", None)) for i, wall in enumerate(walls)]
        problems += [
            f"wall[{i}].name = {name!r}: must be a text"
            for i, name in called
            if not isinstance(name, str | None)
        ]
    if name is not None and not isinstance(name, str):
        problems.append(f"name = {name!r}: must be a text")
    if problems:
        raise SceneError(problems)


def touching_by_rounding(scene: Scene) -> list[str]:
    """The overlaps of a scene that are so small that they count as touching, one sentence each."""
    return touching_notes(scene.disks, scene.domain, scene.walls)


def difference(one: Scene, other: Scene) -> str:
    """The first key in which `other` is not like `one`; O(N)."""
    for item in fields(Scene):
        mine, theirs = getattr(one, item.name), getattr(other, item.name)
        if mine == theirs or not item.compare:
            continue
        if item.name != "disks":
            return f"its {item.name} is {mine!r}, not {theirs!r}"
        if len(mine) != len(theirs):
            return f"it has {len(mine)} disks, not {len(theirs)}"
        return "its disks begin elsewhere, or are others"
    return "none"

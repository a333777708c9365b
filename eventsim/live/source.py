"""Sources: which scene a page wants to see, and what is needed to make it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Protocol

from eventsim.errors import EventsimError, SceneError
from eventsim.scene import Scene
from eventsim.scene.files import scene_from_dict, tables_of_toml, with_lines
from eventsim.scene.gallery import Value, gallery
from eventsim.scene.surfaces import count_with_images
from eventsim.scene.walls import parts_of

MOST_DISKS = 5000
"""Disks in a live view; more are for files and movies."""

MOST_SHAPES = 1000
"""Walls, their edges and their images in a periodic domain counted: the first look of all disks at all of them must not take
minutes."""

ABOUT_COUNTS = ("n", "n_small", "n_large")
"""Parameters of built-in scenes that count disks."""


class Source(Protocol):
    """Something a scene is made from; pace: the scene time that a second of playing shows, None: as suits the scene."""

    @property
    def pace(self) -> float | None:
        """Scene time per second of playing, where that is known."""

    def scene(self) -> Scene:
        """Return the scene; raise SceneError where it breaks a rule."""


@dataclass(frozen=True, slots=True)
class BuiltIn:
    """A scene of the gallery."""

    name: str
    parameters: dict[str, Value]
    pace: ClassVar[None] = None

    def scene(self) -> Scene:
        """Return the scene with these parameters."""
        for name in ABOUT_COUNTS:
            demand_few(self.parameters.get(name, 0), name)
        if "name" in self.parameters:
            raise SceneError(f"{self.name}: a built-in scene has no parameter 'name'")
        return gallery(self.name, **self.parameters)


@dataclass(frozen=True, slots=True)
class Text:
    """The text of a scene file in TOML."""

    text: str
    pace: ClassVar[None] = None

    def scene(self) -> Scene:
        """Return the scene; other files it names are not read."""
        try:
            data = tables_of_toml(self.text)
        except SceneError as error:
            raise SceneError(f"this {error}") from None
        if "disks_file" in data:
            raise SceneError("disks_file: the live view reads no other files; start it with eventsim live SCENE")
        gases = data.get("gas")
        for gas in gases if isinstance(gases, list) else ():
            if isinstance(gas, dict):
                demand_few(gas.get("count", 0), "gas.count")
        try:
            return scene_from_dict(data)
        except SceneError as error:
            raise with_lines(error, self.text, data) from None


def demand_small(scene: Scene) -> None:
    """Raise where a scene is too large for a live view."""
    demand_few(len(scene.disks), "disks")
    reach = float(scene.disks.radius.max(initial=0.0))
    shapes = count_with_images(scene.walls, reach, scene.domain.origin, scene.domain.period)
    if shapes > MOST_SHAPES:
        images = " and images" if shapes > len(parts_of(scene.walls)) else ""
        raise EventsimError(f"a live view has at most {MOST_SHAPES} walls, edges{images} counted, and there are {shapes}")


def demand_few(count: object, what: str) -> None:
    """Raise where a live view is asked for too many disks."""
    if isinstance(count, int | float) and not count <= MOST_DISKS:
        raise EventsimError(f"{what} = {count}: a live view has at most {MOST_DISKS} disks")

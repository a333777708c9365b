"""The menu: a gas in a box as large as the browser's window, from a few numbers.

Lengths are the pixels of the window, times are seconds, the lightest disk has mass 1 (all disks where masses are equal).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from eventsim.formulas.rough import SMOOTH
from eventsim.scene import Scene
from eventsim.scene.domain import BOUNDARY_NAMES
from eventsim.scene.files import scene_from_dict

MASSES = (1.0, 2.0, 4.0, 8.0, 16.0)
RADII = (0.6, 0.8, 1.0, 1.2, 1.4)
"""Different masses and radii are those of five species, equally many of each; the heavier is the larger where both differ."""

DENSEST_RANDOM = 0.5
"""The packing fraction up to which disks find random places; denser ones stand on a hexagonal lattice."""

CONTACT_DURATION, RESTING_DURATION = 1e-3, 0.02
"""Seconds, without and with gravity: contacts of a disk that follow each other faster are elastic, so that inelastic disks do
not collapse. Under gravity they come to rest like this: they hop less than a pixel, and a heap has few events."""


@dataclass(frozen=True, slots=True)
class Menu:
    """What the page's menu says.

    width, height: of the box, pixels. count: disks. masses, radii: "equal" or "different". packing: fraction of the
    box that disks cover. speed: of each at the start, pixels / s. gravity: downwards, pixels / s^2.
    temperature: at which walls are kept, kT in pixels^2 / s^2 of mass 1, 0: they only throw back. shaking: of the floor,
    pixels / s; it does not heat then. roughness: tangential restitution, -1: smooth disks that do not spin.
    pace: a second of the scene lasts a second.
    """

    width: float
    height: float
    count: int = 50
    masses: str = "equal"
    radii: str = "equal"
    packing: float = 0.15
    speed: float = 150.0
    gravity: float = 0.0
    restitution: float = 1.0
    temperature: float = 0.0
    shaking: float = 0.0
    roughness: float = SMOOTH
    seed: int = 1
    pace: ClassVar[float] = 1.0

    def scene(self) -> Scene:
        """Return the scene; raise SceneError where the disks do not fit."""
        tables = [table for table in self._gas_tables() if table["count"]]
        data: dict[str, object] = {
            "name": "disks in a box",
            "domain": {"kind": "box", "size": [self.width, self.height], "walls": self._walls()},
            # The larger species first: the smaller ones find a place between them.
            "gas": tables[::-1],
        }
        if self.gravity:
            data["gravity"] = [0.0, -self.gravity]
        if self.restitution < 1.0:
            data |= {
                "restitution": self.restitution,
                "contact_duration": RESTING_DURATION if self.gravity else CONTACT_DURATION,
            }
        if self.temperature:
            data["seed"] = self.seed
        if self.roughness > SMOOTH:
            data["tangential_restitution"] = self.roughness
        return scene_from_dict(data, seed=self.seed)

    def _walls(self) -> dict[str, dict[str, float]]:
        """What the sides of the box do besides throwing back."""
        warm = {side: {"temperature": self.temperature} for side in BOUNDARY_NAMES if self.temperature}
        return warm | ({"bottom": {"shaking": self.shaking}} if self.shaking else {})

    def _gas_tables(self) -> list[dict[str, object]]:
        species = len(MASSES) if "different" in (self.masses, self.radii) else 1
        masses = MASSES[:species] if self.masses == "different" else (1.0,) * species
        radii = RADII[:species] if self.radii == "different" else (1.0,) * species
        counts = [self.count * (k + 1) // species - self.count * k // species for k in range(species)]
        covered = math.pi * sum(count * radius**2 for count, radius in zip(counts, radii, strict=True))
        unit = math.sqrt(self.packing * self.width * self.height / covered)
        arrangement = "random" if self.packing <= DENSEST_RANDOM else "hexagonal"
        return [
            {
                "count": count,
                "radius": unit * radius,
                "mass": mass,
                "speed": self.speed,
                "arrangement": arrangement,
            }
            for count, radius, mass in zip(counts, radii, masses, strict=True)
        ]

"""The law of contacts that a scene has: from its own keys, and from those of its walls."""

from __future__ import annotations

from collections.abc import Sequence

from eventsim.formulas.laws import Law, law_of
from eventsim.scene.domain import Domain, hard_sides
from eventsim.scene.manner import Manner, Side
from eventsim.scene.restitution import Restitution
from eventsim.scene.scene import Scene
from eventsim.scene.walls import Wall


def law_of_scene(scene: Scene) -> Law:
    """Return the law of a scene's contacts."""
    own = manners_of(scene.domain, scene.walls)
    if all(one.restitution is None for one in own):
        return law_of(scene.restitution, scene.contact_duration)
    usual = scene.restitution or Restitution()
    walls = tuple(usual.wall if one.restitution is None else one.restitution for one in own)
    return law_of(usual, scene.contact_duration, walls)


def manners_of(domain: Domain, walls: Sequence[Wall]) -> tuple[Manner, ...]:
    """Return how each wall treats what meets it, by its number in the log; the edges of a chain are alike."""
    sides = dict(domain.walls)
    return (
        *(sides.get(name, Side()) for name in hard_sides(domain)),
        *(wall for wall in walls for _ in wall.parts("")),
    )

"""The law of contacts that a scene has: from its own keys, and from those of its walls."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from eventsim.formulas.laws import Law, Treatment, law_of
from eventsim.formulas.rough import Roughness
from eventsim.scene.disks import named_species
from eventsim.scene.domain import Domain, hard_sides
from eventsim.scene.manner import Manner, Side
from eventsim.scene.restitution import Restitution
from eventsim.scene.scene import Scene
from eventsim.scene.walls import Wall


def law_of_scene(scene: Scene) -> Law:
    """Return the law of a scene's contacts."""
    manners, usual = manners_of(scene.domain, scene.walls), scene.restitution
    own = any(one.restitution is not None for one in manners)
    if own:
        usual = usual or Restitution()
    tangential = scene.tangential_restitution
    done = tuple(treatment_of(one) for one in manners)
    law = law_of(usual, scene.contact_duration, scene.law)
    return replace(
        law,
        walls=tuple(law.wall if one.restitution is None else one.restitution for one in manners) if own else None,
        pairs=_shares_of_species(scene, usual) if usual is not None and usual.pairs else None,
        treatments=done if any(one != Treatment() for one in done) else None,
        rough=None if tangential is None else Roughness(tangential.pair, tangential.wall),
    )


def treatment_of(manner: Manner) -> Treatment:
    """Return what a wall does besides throwing back."""
    return Treatment(manner.temperature, manner.velocity or 0.0, manner.shaking or 0.0)


def _shares_of_species(scene: Scene, usual: Restitution) -> tuple[tuple[float, ...], ...]:
    """Return the restitution of each two species, by their numbers."""
    names, _ = named_species(scene.disks)
    given = {pair: share for a, b, share in usual.pairs for pair in ((a, b), (b, a))}
    return tuple(tuple(given.get((a, b), usual.pair) for b in names) for a in names)


def manners_of(domain: Domain, walls: Sequence[Wall]) -> tuple[Manner, ...]:
    """Return how each wall treats what meets it, by its number in the log; the edges of a chain are alike."""
    sides = dict(domain.walls)
    return (
        *(sides.get(name, Side()) for name in hard_sides(domain)),
        *(wall for wall in walls for _ in wall.parts("")),
    )

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
    done = tuple(treatment_of(one) for one in manners_of(scene.domain, scene.walls))
    law = _law_without(scene)
    return replace(law, treatments=done) if any(one != Treatment() for one in done) else law


def treatment_of(manner: Manner) -> Treatment:
    """Return what a wall does besides throwing back."""
    return Treatment(manner.temperature, manner.velocity or 0.0, manner.shaking or 0.0)


def _law_without(scene: Scene) -> Law:
    """Return the law of contacts as if no wall did anything but throw back."""
    own, usual = manners_of(scene.domain, scene.walls), scene.restitution
    walls = None
    if any(one.restitution is not None for one in own):
        usual = usual or Restitution()
        walls = tuple(usual.wall if one.restitution is None else one.restitution for one in own)
    tangential = scene.tangential_restitution
    rough = None if tangential is None else Roughness(tangential.pair, tangential.wall)
    if usual is None or not usual.pairs:
        return law_of(usual, scene.contact_duration, walls, rough=rough, own=scene.law)
    names, _ = named_species(scene.disks)
    given = {pair: share for a, b, share in usual.pairs for pair in ((a, b), (b, a))}
    pairs = tuple(tuple(given.get((a, b), usual.pair) for b in names) for a in names)
    return law_of(usual, scene.contact_duration, walls, pairs, rough, scene.law)


def manners_of(domain: Domain, walls: Sequence[Wall]) -> tuple[Manner, ...]:
    """Return how each wall treats what meets it, by its number in the log; the edges of a chain are alike."""
    sides = dict(domain.walls)
    return (
        *(sides.get(name, Side()) for name in hard_sides(domain)),
        *(wall for wall in walls for _ in wall.parts("")),
    )

"""Random scenes for each law of contacts: what keys ask for it, and disks among walls that meet under it."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

import eventsim as es
from eventsim.record.events import Rows
from eventsim.scene.domain import hard_sides
from eventsim.scene.restitution import Restitution
from tests.engines.scenes import lattice_gas

Keys = Callable[[np.random.Generator], dict[str, Any]]


def own(restitution: float, approach: float, since: float, mass: float) -> float:
    """A law that looks at all that it may."""
    return restitution / (1.0 + 0.25 * approach) if since > 0.125 or mass > 2.0 else 1.0


def _shares(rng: np.random.Generator) -> dict[str, float]:
    return {"pair": float(rng.choice([1.0, 0.9, 0.5])), "wall": float(rng.choice([1.0, 0.8]))}


LAWS: dict[str, Keys] = {
    "restitution": lambda rng: {"restitution": Restitution(**_shares(rng))},
    "time of contact": lambda rng: {"restitution": Restitution(**_shares(rng)), "contact_duration": 1e-2},
    "walls of their own": lambda rng: {
        "restitution": Restitution(**_shares(rng)),
        "sides": {"bottom": {"restitution": float(rng.choice([0.5, 1.0]))}, "top": {"restitution": 0.75}},
        "own": {"restitution": float(rng.choice([0.25, 0.9]))},
    },
    "species": lambda rng: {
        "restitution": Restitution(0.9, 1.0, pairs={"a-a": float(rng.choice([0.5, 1.0])), "a-b": 0.75}),
        "species": ["a", "b", "b", "c"] * 3,
    },
    "walls that shake": lambda rng: {
        "restitution": Restitution(**_shares(rng)),
        "sides": {"bottom": {"shaking": float(rng.choice([0.0, 0.5]))}, "left": {"shaking": 0.25, "restitution": 0.5}},
        "own": {"shaking": float(rng.choice([0.125, 1.0]))},
    },
    "walls that shake and look at speeds": lambda rng: {
        "restitution": Restitution(0.9, 0.8, yield_speed=0.5),
        "sides": {"bottom": {"shaking": 0.25}, "top": {"shaking": 0.5}},
        "own": {"shaking": 1.0},
    },
    "walls that heat": lambda rng: {
        "seed": int(rng.integers(2**40)),
        "sides": {"bottom": {"temperature": 2.0}, "top": {"temperature": 0.5, "velocity": 1.5}},
        "own": {"temperature": 1.0, "velocity": float(rng.choice([0.0, -1.0]))},
    },
    "walls that heat and take": lambda rng: {
        "seed": int(rng.integers(2**40)),
        "restitution": Restitution(**_shares(rng)),
        "sides": {"left": {"temperature": 2.0}, "bottom": {"shaking": 0.5}, "top": {"restitution": 0.5}},
        "own": {"temperature": 1.0},
    },
    "of the user's own": lambda rng: {"restitution": Restitution(**_shares(rng)), "law": own},
    "rough, where walls shake and heat and slide": lambda rng: {
        "seed": int(rng.integers(2**40)),
        "tangential_restitution": {"pair": 0.5, "wall": float(rng.uniform(-1.0, 1.0))},
        "sides": {"bottom": {"temperature": 2.0, "velocity": 0.5}, "top": {"velocity": 1.5}, "left": {"shaking": 0.25}},
        "own": {"velocity": -1.0},
    },
    "rough": lambda rng: {
        "restitution": float(rng.choice([1.0, 0.9])),
        "tangential_restitution": {"pair": float(rng.choice([-0.5, 0.5, 1.0])), "wall": float(rng.choice([0.0, 1.0]))},
    },
    "rough between smooth walls": lambda rng: {
        "restitution": Restitution(**_shares(rng)),
        "tangential_restitution": {"pair": float(rng.uniform(-1.0, 1.0))},
        "contact_duration": (None, 1e-2)[int(rng.integers(2))],
    },
    "rough walls": lambda rng: {
        "restitution": {"pair": 0.9},
        "tangential_restitution": {"wall": float(rng.uniform(-1.0, 1.0))},
    },
    "yielding": lambda rng: {"restitution": Restitution(**_shares(rng), yield_speed=float(rng.choice([0.25, 1.0])))},
    "yielding, kept if soon": lambda rng: {
        "restitution": Restitution(0.9, 0.8, yield_speed=0.5),
        "contact_duration": float(rng.choice([1e-3, 1e-1])),
    },
}
"""The keys of a scene that ask for a law, from a generator; sides, own: those of the domain's sides, and of walls; species."""


def _has(keys: dict[str, Any]) -> tuple[Any, ...]:
    """Of keys that not all scenes of a law have: whether pairs, and walls, take energy, and whether contacts last."""
    restitution = keys.get("restitution")
    if isinstance(restitution, Restitution):
        restitution = restitution.pair == 1.0, restitution.wall == 1.0
    elif isinstance(restitution, float):
        restitution = restitution == 1.0
    return repr(restitution), keys.get("contact_duration") is None


def random_scene(seed: int, law: str, kinds: int | None = None) -> es.Scene:
    """Return twelve disks on a lattice, with masses, walls, gravity and a domain that the seed chooses.

    kinds: of how many kinds, each of which is compiled, scenes with other seeds are; None: of any.
    """
    rng, kind = np.random.default_rng(seed), seed if kinds is None else seed % kinds
    choice = np.random.default_rng(kind)
    domain = (es.Box, es.Channel, es.Periodic)[kind % 3]
    masses = ((1.0,), (1.0, 3.0), (1.0, 2.0, np.inf, 0.0))[int(choice.integers(2 if "heat" in law else 3))]
    gravity = (0.0, -0.5) if choice.random() < 0.3 else None
    gas = lattice_gas(12, 0.1, domain, seed=seed, radii=(0.5, 0.25), masses=masses)
    pitch = gas.domain.size[0] / 4.0
    corners = [(pitch, pitch), (1.2 * pitch, 1.1 * pitch), (1.0 * pitch, 1.25 * pitch)]
    wanted = _has(LAWS[law](np.random.default_rng(kind)))
    while _has(keys := LAWS[law](rng)) != wanted:
        pass
    own, sides, species = keys.pop("own", {}), keys.pop("sides", {}), keys.pop("species", None)
    spin = moment = None
    mass = gas.disks.mass
    if "tangential_restitution" in keys:
        spin, moment, mass = rng.normal(size=12), rng.uniform(0.1, 1.0, 12), np.where(mass == 0.0, 5.0, mass)
    disks = es.Disks(gas.disks.position, gas.disks.velocity, gas.disks.radius, mass, species, spin, moment)
    walls: list[es.Segment | es.Arc] = [es.Segment(*corners[:2], **own)] if choice.random() < 0.5 else []
    walls = [es.Arc(*corners, **own)] if choice.random() < 0.3 else walls
    hard = {name: side for name, side in sides.items() if name in hard_sides(gas.domain)}
    return es.Scene(disks, domain(gas.domain.size, walls=hard), walls, gravity=gravity, **keys)


def by_chance(law: str) -> bool:
    """Whether what a contact does under a law depends on the labels of disks: chance is drawn by disk."""
    return "heat" in law


def relabelled(scene: es.Scene, order: Sequence[int]) -> es.Scene:
    """Return the scene whose disk k is disk order[k] of another."""
    return dataclasses.replace(scene, disks=scene.disks.select(np.asarray(order)))


def told(rows: Rows, names: Sequence[int]) -> list[tuple[Any, ...]]:
    """What rows tell with disk k called names[k]: in the order of time, and whichever disk of a pair comes first.

    Event numbers and joints are left out: those of one instant follow the labels.
    """
    of_a, of_b = ([name for name in rows.dtype.names if name.endswith(end) and len(name) > 1] for end in ("a", "b"))
    found = []
    for row in rows:
        sides = [(int(names[row["a"]]), *(float(row[name]) + 0.0 for name in of_a))]
        if row["b"] >= 0:
            sides.append((int(names[row["b"]]), *(float(row[name]) + 0.0 for name in of_b)))
        found.append((int(row["epoch"]), float(row["remainder"]), int(row["kind"]), int(row["wall"]), *sorted(sides)))
    return sorted(found)

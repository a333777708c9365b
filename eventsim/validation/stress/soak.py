"""Soak: random scenes near every degenerate surface (touching, grazing, ties, extreme ratios), engine against engine."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Hashable, Iterator
from dataclasses import dataclass
from functools import partial
from time import process_time
from typing import NamedTuple

import numpy as np

from eventsim.engines import engine_named
from eventsim.errors import SceneError
from eventsim.formulas.doubt import latest_tie
from eventsim.runner.loop import run_scene
from eventsim.runner.options import RunOptions, stop_of
from eventsim.runner.outcome import Outcome
from eventsim.scene import Box, Channel, Disks, Domain, Open, Periodic, Scene
from eventsim.scene.stage import stage_of
from eventsim.validation.stress.workers import Silence, answers

EVENTS, UNTIL = 80, 50.0
"""Where a run of the soak stops; a scene without contacts at its time."""

LIMIT = 5.0
"""Seconds for one run, of computing and without compiling; a longer one has hung."""

PATIENCE = 180.0
"""Seconds of computing beyond it after which a run is ended from outside: kernels for a scene may have to be compiled."""

MOST_DISKS, TRIES = 7, 40


@dataclass(frozen=True, slots=True)
class Finding:
    """What is wrong with a seed."""

    seed: int
    engine: str
    sentence: str


class Family(NamedTuple):
    """What all disks of a random scene share, and most of what decides which kernels it needs."""

    domain: Domain
    radii: tuple[float, float]
    masses: tuple[float, float]
    gravity: tuple[float, float] | None
    restitution: float | None
    duration: float | None


def random_scene(seed: int) -> Scene:
    """A few disks whose places, speeds, radii and masses are multiples of each other, moved by an ulp or not at all."""
    rng = np.random.default_rng(seed)
    family, side = _random_family(rng)
    found: list[tuple[list[float], list[float], float, float]] = []
    wanted = int(rng.integers(2, MOST_DISKS + 1))
    scene: Scene | None = None
    for _ in range(TRIES):
        place = rng.integers(1, int(4 * side), size=2) / 4.0
        if rng.random() < 0.3:
            place = np.nextafter(place, place + rng.choice([-1.0, 1.0], size=2))
        velocity = rng.integers(-4, 5, size=2) / 4.0
        kind = rng.integers(2)
        new = (place.tolist(), velocity.tolist(), family.radii[kind], family.masses[rng.integers(2)])
        position, speed, radius, mass = zip(*found, new, strict=True)
        try:
            scene = Scene(
                Disks(position, speed, radius, mass),
                family.domain,
                gravity=family.gravity,
                restitution=family.restitution,
                contact_duration=family.duration,
                until=UNTIL,
                events=EVENTS,
            )
        except SceneError:
            continue
        found.append(new)
        if len(found) == wanted:
            break
    return scene if scene is not None else random_scene(seed + 2**32)


def _random_family(rng: np.random.Generator) -> tuple[Family, float]:
    """What the disks share, and the side of the square that their centres are in."""
    side = float(rng.choice([4.0, 6.0, 8.0]))
    domain: Domain = (Box((side, side)), Periodic((side, side)), Channel((side, side)), Open())[rng.integers(4)]
    radii = rng.choice([(0.5, 0.5), (0.5, 0.25), (0.5, 0.0), (1.0, 2.0**-20)])
    masses = rng.choice([(1.0, 1.0), (1.0, 3.0), (1.0, 1e12), (1.0, math.inf), (1.0, 0.0)])
    gravity = (0.0, -1.0) if rng.random() < 0.2 else None
    restitution = float(rng.choice([0.5, 0.9])) if rng.random() < 0.3 else None
    duration = 1e-3 if restitution is not None and rng.random() < 0.7 else None
    return Family(domain, tuple(radii.tolist()), tuple(masses.tolist()), gravity, restitution, duration), side


def soak(seeds: range, engines: tuple[str, ...], workers: int = 1) -> Iterator[Finding | None]:
    """For each seed what is wrong, or None: a hang, a number that is none, a clock that steps back, engines that disagree.

    workers: processes at a time.  Seeds whose scenes share kernels have a process to themselves, so that each kernel is compiled,
    or loaded, once and its memory is given back; seeds come in the order of their answers.
    """
    work = partial(finding_of, engines=engines)
    for seed, answer in answers(work, by_kernels(seeds), workers, LIMIT + PATIENCE):
        yield Finding(seed, " or ".join(engines), str(answer)) if isinstance(answer, Silence) else answer


def by_kernels(seeds: range) -> list[list[int]]:
    """The seeds in groups whose scenes share most of their kernels, the largest first."""
    groups: dict[Hashable, list[int]] = defaultdict(list)
    for seed in seeds:
        family, _ = _random_family(np.random.default_rng(seed))
        groups[type(family.domain), family.gravity, family.restitution is None, family.duration].append(seed)
    return sorted(groups.values(), key=len, reverse=True)


def finding_of(seed: int, engines: tuple[str, ...]) -> Finding | None:
    """What is wrong with a seed, if anything."""
    scene = random_scene(seed)
    first: Outcome | None = None
    for engine in engines:
        began = process_time()
        try:
            run = run_scene(engine_named(engine), scene, stop_of(scene, None, None), RunOptions(log=True))
        except Exception as failure:
            # An engine that fails is a finding; the other seeds are still to be looked at.
            return Finding(seed, engine, f"failed: {type(failure).__name__}: {failure}")
        # The processor's clock does not see that other programs are at work, the elapsed time not that kernels were compiled.
        seconds = min(process_time() - began, run.elapsed_s)
        sentence = _fault(run)
        if sentence is None and seconds > LIMIT:
            sentence = f"took {seconds:.1f} s"
        if sentence is None and first is not None:
            sentence = _difference(first, run)
        if sentence is not None:
            return Finding(seed, engine, sentence)
        first = first or run
    return None


def _fault(run: Outcome) -> str | None:
    """What is wrong with a run by itself."""
    assert run.recorded is not None
    time = run.recorded.rows["time"]
    if not (np.isfinite(run.state.position).all() and np.isfinite(run.state.velocity).all()):
        return "a position or a velocity is not a number"
    # Contacts so near to each other are taken in their exact order, so a logged time may step back by so much.
    back, latest = float(np.max(-np.diff(time), initial=0.0)), float(np.max(time, initial=1.0))
    if back > latest_tie(latest, stage_of(run.scene).tie_screen) - latest + math.ulp(latest):
        return f"the clock steps back by {back:.2g}"
    if run.residuals.max_overlap > OVERLAP:
        return f"an overlap of {run.residuals.max_overlap:.2g} reaches at a contact"
    return None


OVERLAP = 2.0**-24
"""In reaches: an ulp of the coordinates, 8, against the smallest reach, 2**-19, and 2**5 of them for flights between."""


def _difference(one: Outcome, other: Outcome) -> str | None:
    """Where two engines part."""
    if one.digest != other.digest:
        return (
            f"another log than {one.engine}: {other.counters.events} events, not {one.counters.events}, or other bits"
        )
    if one.stopped != other.stopped and {one.stopped, other.stopped} - {"until", "quiet", "events"}:
        return f"stopped by {other.stopped}, not {one.stopped}"
    return None

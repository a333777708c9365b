"""The order of contacts: ties, races, causality, labels, mirror images, cells."""

from __future__ import annotations

import numpy as np

from eventsim.engines.base import Stop
from eventsim.engines.reference import ReferenceOptions
from eventsim.engines.reference.loop import ReferenceSession
from eventsim.scene import Box, Disks, Open, Periodic, Scene
from eventsim.scene.stage import stage_of
from eventsim.validation.stress.case import Bench, Case, off
from eventsim.validation.stress.catalogue.scenes import lattice_gas, on_plane, relabelled, with_disks

ULP = 2.0**-52

LAST_TIMES = 40
"""Events among which the widest gap is looked for."""


def onto_heavy(eps: float) -> Scene:
    """Two disks fly onto a heavy one from both sides; the one at the right comes later by eps, which its coordinate, 1, takes."""
    place = [[0.0, 0.0], [0.5, 0.0], [1.0 + eps, 0.0]]
    return on_plane(place, [[1.0, 0.0], [0.0, 0.0], [-1.0, 0.0]], 0.125, [1.0, 3.0, 1.0])


def _causality(bench: Bench) -> float:
    worst = 0.0
    for size in (2.0**-20, 2.0**-40, 2.0**-50, 2.0**-52):
        for eps, after in ((size, [-0.5, -0.25, 1.25]), (-size, [-1.25, 0.25, 0.5])):
            worst = max(worst, off(bench.run(onto_heavy(eps), until=10.0).state.velocity[:, 0], after))
    return worst


def _two_pairs(bench: Bench) -> float:
    position = [[-2.0, 0.0], [2.0, 0.0], [-2.0, 7.0], [2.0, 7.25]]
    scene = on_plane(position, [[1.0, 0.0], [-1.0, 0.0], [1.0, 0.0], [-1.0, 0.0]])
    base = bench.run(scene, until=4.0).state
    worst = off(base.velocity[:2], [[-1.0, 0.0], [1.0, 0.0]])
    for order in ([1, 0, 3, 2], [2, 3, 0, 1], [3, 0, 1, 2]):
        other = bench.run(relabelled(scene, order), until=4.0).state
        worst = max(worst, off(other.velocity, base.velocity[order]), off(other.position, base.position[order]))
    return worst


def _against_all_pairs(bench: Bench, scene: Scene, events: int) -> float:
    """The difference from a run that tries every pair, cells and shortcuts left out, after about so many events.

    It is looked at where events are far apart: at the time of one, rounding would decide whether it has happened.
    """
    first = ReferenceSession(stage_of(scene), options=ReferenceOptions(grid=None))
    first.advance(Stop(events=events), 10**9)
    times = first.take_rows()["time"][-LAST_TIMES:]
    widest = int(np.argmax(np.diff(times)))
    time = float(times[widest] + times[widest + 1]) / 2.0
    session = ReferenceSession(stage_of(scene), keep_rows=False, options=ReferenceOptions(grid=None))
    session.advance(Stop(until=time), 10**9)
    motion = session.motion()
    run = bench.run(scene, until=time)
    return off(run.state.velocity, np.column_stack([motion.vx, motion.vy]))


def _cell_ties(bench: Bench) -> float:
    """Disks that move along the diagonals of a grid of cells, and meet on its edges."""
    sites = np.array([(i, j) for i in range(8) for j in range(8)], float)
    signs = np.random.default_rng(2).choice([-1.0, 1.0], size=(64, 2))
    disks = Disks(2.0 * sites + 1.0, signs, 0.5)
    worst = 0.0
    for domain in (Box((16.0, 16.0)), Periodic((16.0, 16.0))):
        worst = max(worst, _against_all_pairs(bench, Scene(disks, domain), 300))
    return worst


def _races(bench: Bench) -> float:
    return _against_all_pairs(bench, lattice_gas(40, 0.4, quantum=0.25, seed=6), 300)


def _mirror(bench: Bench) -> float:
    scene = lattice_gas(30, 0.5, Open, seed=9)
    disks = scene.disks
    base = bench.run(scene, until=3.0).state
    mirrored = Disks(disks.position * [-1.0, 1.0], disks.velocity * [-1.0, 1.0], disks.radius, disks.mass)
    other = bench.run(with_disks(scene, mirrored), until=3.0).state
    return off(other.velocity * [-1.0, 1.0], base.velocity)


def _labels(bench: Bench) -> float:
    """Axes exchanged, and labels, in an open scene and in a box."""
    worst = 0.0
    for domain in (Open, Box):
        scene = lattice_gas(30, 0.5, domain, seed=9)
        disks = scene.disks
        base = bench.run(scene, until=3.0).state.velocity
        swapped = Disks(disks.position[:, ::-1], disks.velocity[:, ::-1], disks.radius, disks.mass)
        order = np.random.default_rng(1).permutation(len(disks))
        one = bench.run(with_disks(scene, swapped), until=3.0).state.velocity[:, ::-1]
        two = bench.run(relabelled(scene, order), until=3.0).state.velocity
        worst = max(worst, off(one, base), off(two, base[order]))
    return worst


def three_disks(seed: int) -> Scene:
    """Three disks on the plane that fly towards one place, more or less."""
    rng = np.random.default_rng(seed)
    angle = rng.uniform(0.0, 2.0 * np.pi) + np.array([0.0, 2.0, 4.0]) + rng.uniform(-0.3, 0.3, 3)
    place = rng.uniform(1.0, 3.0, (3, 1)) * np.column_stack([np.cos(angle), np.sin(angle)])
    return on_plane(place, -place * rng.uniform(0.5, 2.0, (3, 1)) + rng.normal(scale=0.2, size=(3, 2)))


def _three_disks(bench: Bench) -> float:
    """Contacts beyond four, in twenty random scenes."""
    worst = 0.0
    for seed in range(20):
        run = bench.run(three_disks(seed), until=60.0)
        worst = max(worst, run.counters.pair_contacts - 4.0)
    return worst


CASES = (
    Case(
        "f7-causality",
        "two disks onto a heavy one; who is first decides",
        "Two contacts a few bits apart in time: the outcome is not continuous.",
        "Closed form; the sign of eps decides, down to 2^-52.",
        0.0,
        "Quarters: the exchanges of velocities are exact.",
        _causality,
    ),
    Case(
        "f8-two-pairs",
        "two pairs meet at the same time, apart from each other",
        "The order in memory decides whether the second is seen.",
        "Independent of labels, bit for bit.",
        0.0,
        "Invariance.",
        _two_pairs,
    ),
    Case(
        "f30-cell-ties",
        "contacts and wall hits exactly on the edges of cells",
        "Two cells are entered at once, or a contact is looked for in the wrong one.",
        "The run that tries all pairs.",
        0.0,
        "The contact time does not depend on cells.",
        _cell_ties,
    ),
    Case(
        "f31-races",
        "quantised velocities: many ties, many stale predictions",
        "A contact that has been overtaken by another one is resolved all the same, or a tie is lost.",
        "The run that tries all pairs, 300 events.",
        1e-6,
        "2^(-53 + .053 n) after n events of 40 disks, and 2^16 for chance; float engines have one log, a proof has no rounding.",
        _races,
    ),
    Case(
        "f32-labels",
        "axes exchanged, disks relabelled",
        "Formulas that prefer an axis, and orders in memory, break the symmetry of the scene.",
        "The mapped velocities, bit for bit.",
        0.0,
        "Every formula is symmetric.",
        _labels,
    ),
    Case(
        "f32-mirror",
        "mirrored in the open plane",
        "As above.",
        "The mirrored velocities.",
        1e-10,
        "Coordinates count from the other corner: an ulp of 8, doubled about ten times by chaos, and 2^6 for chance.",
        _mirror,
    ),
    Case(
        "f38-three-disks",
        "three equal disks on the plane",
        "Lost or doubled contacts.",
        "At most four contacts (Murphy & Cohen 1993, doi:10.1007/BF01049961).",
        0.0,
        "A count.",
        _three_disks,
    ),
)

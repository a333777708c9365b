"""Beside other people's engines: PyPI's `billiards` in contacts per second, pymunk in simulated seconds per second.

    python -m tests.benchmarks.peers [--repeats 5] [--csv FILE]

The gas: equal disks with kT = 1 in the unit box between hard walls, after ten contacts of each disk.  All engines get the same
disks, take turns, and are timed by the CPU time of the process; pymunk steps by 1/1000 with its defaults and calls nobody back.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable
from time import process_time

import eventsim as es
from eventsim.engines import ENGINES
from eventsim.engines.base import Stop
from eventsim.scene.files import scene_from_dict
from eventsim.scene.stage import stage_of
from tests.benchmarks.table import Table, arguments

COLUMNS = ("peer", "n", "eta", "unit", "peer_rate", "fast_rate", "ratio")
STEP = 1e-3
PEER_CONTACTS, OWN_CONTACTS = 1000, 1_000_000
"""The fast engine gets more work than `billiards`, so that both can be timed."""

PEER_SECONDS, OWN_SECONDS = 0.5, 20.0
"""Simulated seconds of pymunk and of the fast engine."""

Timed = Callable[[], float]
"""Does a piece of work; the rate."""


def gas(n: int, eta: float) -> es.Scene:
    """The gas, settled."""
    arrangement = "random" if eta < 0.5 else "compressed"
    table = {"count": n, "packing_fraction": eta, "temperature": 1.0, "seed": 1, "arrangement": arrangement}
    scene = scene_from_dict({"domain": {"kind": "box", "size": [1.0, 1.0]}, "gas": [table]})
    state = es.simulate(scene, events=5 * n, engine="fast").state
    return es.Scene(es.Disks(state.position, state.velocity, scene.disks.radius), scene.domain)


def own_contacts(scene: es.Scene) -> Timed:
    """Contacts per second of the fast engine, walls included."""
    session = ENGINES["fast"].open(stage_of(scene), keep_rows=False)

    def timed() -> float:
        stop = Stop(events=session.counters.events + OWN_CONTACTS)
        begun = process_time()
        while session.advance(stop, 1 << 20) is None:
            pass
        return OWN_CONTACTS / (process_time() - begun)

    return timed


def billiards_contacts(scene: es.Scene) -> Timed:
    """The same of `billiards`."""
    from billiards import Billiard, InfiniteWall

    corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    walls = [InfiniteWall(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
    world = Billiard(walls)
    for place, velocity, radius in zip(scene.disks.position, scene.disks.velocity, scene.disks.radius, strict=True):
        world.add_ball(place, velocity, float(radius))
    span = 0.0

    def timed() -> float:
        nonlocal span
        if not span:  # how long it takes to have so many contacts
            run = es.simulate(scene, events=PEER_CONTACTS, engine="fast")
            span = run.time
        begun = process_time()
        contacts = len(world.evolve(world.time + span))
        return contacts / (process_time() - begun)

    return timed


def own_seconds(scene: es.Scene) -> Timed:
    """Simulated seconds per second of the fast engine."""
    session = ENGINES["fast"].open(stage_of(scene), keep_rows=False)
    until = 0.0

    def timed() -> float:
        nonlocal until
        until += OWN_SECONDS
        begun = process_time()
        while session.advance(Stop(until=until), 1 << 20) is None:
            pass
        return OWN_SECONDS / (process_time() - begun)

    return timed


def pymunk_seconds(scene: es.Scene) -> Timed:
    """The same of pymunk."""
    import pymunk

    space = pymunk.Space()
    for place, velocity, radius in zip(scene.disks.position, scene.disks.velocity, scene.disks.radius, strict=True):
        body = pymunk.Body(1.0, math.inf)
        body.position, body.velocity = tuple(place), tuple(velocity)
        circle = pymunk.Circle(body, float(radius))
        circle.elasticity, circle.friction = 1.0, 0.0
        space.add(body, circle)
    corners = [(-1.0, -1.0), (2.0, -1.0), (2.0, 2.0), (-1.0, 2.0)]
    for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
        wall = pymunk.Segment(space.static_body, a, b, 1.0)
        wall.elasticity, wall.friction = 1.0, 0.0
        space.add(wall)

    def timed() -> float:
        begun = process_time()
        for _ in range(round(PEER_SECONDS / STEP)):
            space.step(STEP)
        return PEER_SECONDS / (process_time() - begun)

    return timed


def pymunk_contacts(scene: es.Scene) -> tuple[int, Timed]:
    """How many contacts the gas has in the time that pymunk simulates in a turn, and those per second."""
    seconds = pymunk_seconds(scene)
    per_second = OWN_CONTACTS / (es.simulate(scene, events=OWN_CONTACTS, engine="fast").time - scene.start_time)
    return round(PEER_SECONDS * per_second), lambda: per_second * seconds()


def compare(
    peer: str, n: int, eta: float, unit: str, peer_rate: Timed, own_rate: Timed, repeats: int
) -> dict[str, object]:
    """A row of the table."""
    own_rate()  # loads the kernels
    found = [(peer_rate(), own_rate()) for _ in range(repeats)]
    theirs, ours = (statistics.median(rates) for rates in zip(*found, strict=True))
    row = (peer, n, eta, unit, float(f"{theirs:.4g}"), float(f"{ours:.4g}"), round(ours / theirs, 1))
    return dict(zip(COLUMNS, row, strict=True))


def main() -> None:
    parser = arguments(__doc__)
    parser.add_argument("--repeats", type=int, default=5)
    chosen = parser.parse_args()
    table = Table(COLUMNS, 18)
    for eta in (0.1, 0.3):
        scene = gas(250, eta)
        pace = billiards_contacts(scene), own_contacts(scene)
        table.add(compare("billiards", 250, eta, "contacts/s", *pace, chosen.repeats))
    for eta in (0.1, 0.3):
        for n in (100, 250, 500):
            scene = gas(n, eta)
            pace = pymunk_seconds(scene), own_seconds(scene)
            table.add(compare("pymunk", n, eta, "simulated s/s", *pace, chosen.repeats))
    table.write(chosen.csv)


if __name__ == "__main__":
    main()

"""What breadth costs: rates of scenes with more than a plain gas, beside it; in turn, medians, ratios within the run.

    python -m tests.benchmarks.breadth [--n 10000] [--eta 0.4] [--scenes walls gravity ...] [--csv FILE]

The plain gas is that of `rates`.  All have one packing fraction; velocities are those of equal temperature.  Rates count all
contacts, those with walls as well, per second of processor time.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable
from time import process_time

import numpy as np

import eventsim as es
from eventsim.engines.base import Stop
from eventsim.engines.fast.session import FastSession
from eventsim.scene.stage import stage_of
from tests.benchmarks.rates import lattice_gas
from tests.benchmarks.table import Table, arguments, whole

COLUMNS = ("scene", "n", "contacts", "rate_median", "of_plain", "crossings", "stale", "bytes_per_disk", "compile_s")
BUDGET = 1 << 40


def in_box(scene: es.Scene, **rules: object) -> es.Scene:
    """The same disks between hard walls."""
    width, height = (length + 1.0 for length in scene.domain.size)
    d = scene.disks
    return es.Scene(es.Disks(d.position + 0.5, d.velocity, d.radius, d.mass), es.Box((width, height)), **rules)


def polydisperse(n: int, eta: float) -> es.Scene:
    """Radii from 1/6 to 1/2, equally spread, places exchanged at random."""
    share = np.random.default_rng(2).uniform(1.0 / 3.0, 1.0, n)
    scene = lattice_gas(n, eta / float(np.mean(share**2)))
    return es.Scene(
        es.Disks(scene.disks.position, scene.disks.velocity, 0.5 * np.resize(share, len(scene.disks))), scene.domain
    )


def with_large(scene: es.Scene, radii: np.ndarray, seed: int = 3) -> es.Scene:
    """The gas with large disks in random places instead of those that were there, of the same mass density and temperature."""
    rng = np.random.default_rng(seed)
    size = np.array(scene.domain.size)
    position, radius = np.empty((0, 2)), np.empty(0)
    for r in np.sort(radii)[::-1]:
        for place in rng.uniform(r, size - r, (200, 2)):
            if np.all(np.sum((position - place) ** 2, axis=1) > (radius + r) ** 2):
                position, radius = np.vstack([position, place]), np.append(radius, r)
                break
    d = scene.disks
    free = np.all((d.position > 0.5) & (d.position < size - 0.5), axis=1)
    for place, r in zip(position, radius, strict=True):
        free &= np.sum((d.position - place) ** 2, axis=1) > (r + 0.5) ** 2
    velocity = rng.normal(size=position.shape) * (0.5 / radius)[:, None]
    disks = es.Disks(
        np.vstack([d.position[free], position]),
        np.vstack([d.velocity[free], velocity]),
        np.append(d.radius[free], radius),
        np.append(np.ones(free.sum()), (radius / 0.5) ** 2),
    )
    return es.Scene(disks, scene.domain)


def power_law(n: int, eta: float) -> es.Scene:
    """A quarter of the area in disks of 1.5 to 60 times the usual radius, numbers as r**-3: equal areas in each octave."""
    scene = lattice_gas(n, eta)
    rng, wanted = np.random.default_rng(4), 0.25 * eta * math.prod(scene.domain.size)
    radii = 0.75 / np.sqrt(1.0 - rng.random(n) * (1.0 - (0.75 / 30.0) ** 2))
    return with_large(scene, radii[np.cumsum(math.pi * radii**2) < wanted])


SCENES: dict[str, Callable[[int, float], es.Scene]] = {
    "plain": lattice_gas,
    "walls": lambda n, eta: in_box(lattice_gas(n, eta)),
    "gravity": lambda n, eta: in_box(lattice_gas(n, eta), gravity=(0.0, -1.0 / math.sqrt(n))),
    "polydisperse 1:3": polydisperse,
    "one large, 100 r": lambda n, eta: with_large(lattice_gas(n, eta), np.array([50.0])),
    "power law 1:60": power_law,
}


def measure(
    n: int, eta: float, names: list[str], contacts: int, repeats: int, warm_up: float
) -> list[dict[str, object]]:
    """The rows of the table."""
    sessions = {name: FastSession(stage_of(SCENES[name](n, eta)), keep_rows=False) for name in names}

    def rate(session: FastSession, number: int) -> float:
        began = process_time()
        session.advance(Stop(events=session.counters.events + number), BUDGET)
        return number / (process_time() - began)

    for session in sessions.values():
        rate(session, int(warm_up * n) + 1)
    found: dict[str, list[float]] = {name: [] for name in names}
    for _ in range(repeats):
        for name, session in sessions.items():
            found[name].append(rate(session, contacts))
    rows = []
    for name, session in sessions.items():
        counters = session.counters
        ratio = statistics.median(one / plain for one, plain in zip(found[name], found["plain"], strict=True))
        rows.append(
            {
                "scene": name,
                "n": session.stage.n,
                "contacts": contacts,
                "rate_median": round(statistics.median(found[name])),
                "of_plain": round(ratio, 3),
                "crossings": round(counters.crossings / counters.events, 2),
                "stale": round(counters.stale / counters.events, 2),
                "bytes_per_disk": session.memory // session.stage.n,
                "compile_s": round(session.compile_s, 1),
            }
        )
    return rows


def main() -> None:
    parser = arguments(__doc__)
    parser.add_argument("--n", type=whole, nargs="+", default=[10_000])
    parser.add_argument("--eta", type=float, default=0.4)
    parser.add_argument(
        "--scenes", nargs="+", choices=[name for name in SCENES if name != "plain"], default=list(SCENES)[1:]
    )
    parser.add_argument("--contacts", type=whole, default=300_000)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--warm-up", type=float, default=5.0, help="contacts per disk before the clock starts")
    chosen = parser.parse_args()
    table = Table(COLUMNS, 16)
    for n in chosen.n:
        for row in measure(n, chosen.eta, ["plain", *chosen.scenes], chosen.contacts, chosen.repeats, chosen.warm_up):
            table.add({**row, "eta": chosen.eta})
    table.write(chosen.csv)


if __name__ == "__main__":
    main()

"""The trust line beside the truth: at which event each says that a place is off by a thousandth of a reach.

    python -m tests.measure.trust_table [--scenes 50] [--seed 0]

The scenes are generic: 8 to 24 disks of one or two kinds in a box, a torus, a channel or a round wall, some with a post, some
that fall.  The truth is the certified run.
"""

from __future__ import annotations

import argparse
import math

import numpy as np

import eventsim as es
from eventsim.measure.trust import HELD, TrustLine, smallest_reach

ROWS_PER_DISK = 45
"""Enough for every one of these scenes to lose its digits."""


def generic_scene(seed):
    """A scene of the table."""
    rng = np.random.default_rng(seed)
    n, fraction = int(rng.integers(8, 25)), float(rng.uniform(0.1, 0.4))
    radius = math.sqrt(fraction / (n * math.pi))
    kind = ("box", "periodic", "channel", "circle", "post")[seed % 5]
    walls = [es.Circle((0.5, 0.5), 0.5)] if kind == "circle" else []
    domain = {"periodic": es.Periodic, "channel": es.Channel}.get(kind, es.Box)((1.0, 1.0))
    gravity = (0.0, -1.0) if seed % 10 == 0 else None
    radii = radius * np.where(np.arange(n) % 2, 1.0, rng.uniform(0.6, 1.0))
    position, masses = [], radii**2
    if kind == "post":
        masses[0] = math.inf
    while len(position) < n:
        k = len(position)
        place = rng.uniform(radii[k] * 1.01, 1.0 - radii[k] * 1.01, size=2)
        inside = kind != "circle" or math.dist(place, (0.5, 0.5)) < 0.5 - radii[k]
        if inside and all(math.dist(place, p) > r + radii[k] for p, r in zip(position, radii, strict=False)):
            position.append(place)
    velocity = rng.normal(size=(n, 2))
    velocity[np.isinf(masses)] = 0.0
    return es.Scene(
        es.Disks(position, velocity, radii, masses), domain, walls, gravity=gravity, events=ROWS_PER_DISK * n
    )


def truth(scene, rows):
    """(event, time) of the first row that is off by more than is said to hold, or that the certified run does not have."""
    proven = es.simulate(scene, engine="certified", log=True).log.rows
    length = smallest_reach(scene)
    for k, (row, sure) in enumerate(zip(rows, proven, strict=False)):
        same = all(row[name] == sure[name] for name in ("kind", "a", "b", "wall"))
        places = [("xa", "ya")] + ([("xb", "yb")] if row["b"] >= 0 else [])
        off = max(math.hypot(row[x] - sure[x], row[y] - sure[y]) for x, y in places) if same else math.inf
        if off > HELD * length:
            return k, float(row["time"])
    return None, None


def compared(seed):
    """(trust, true event, true time) of a scene."""
    scene = generic_scene(seed)
    rows = es.simulate(scene, engine="reference", log=True).log.rows
    line = TrustLine(scene)
    line.write(rows)
    return line.found(), *truth(scene, rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", type=int, default=50)
    parser.add_argument("--seed", type=int, default=0)
    chosen = parser.parse_args()
    ratios = []
    print("seed  event  true event       time  true time  ratio")
    for seed in range(chosen.seed, chosen.seed + chosen.scenes):
        line, event, time = compared(seed)
        if line.event is None or event is None:
            print(f"{seed:4}  {line.event}  {event}  {line.reason or ''}", flush=True)
            continue
        ratios.append((line.event + 1) / (event + 1))
        print(f"{seed:4} {line.event:6} {event:11} {line.time:10.4f} {time:10.4f} {ratios[-1]:6.3f}", flush=True)
    mean = math.exp(np.mean(np.log(ratios)))
    print(f"{len(ratios)} scenes: geometric mean of the ratio {mean:.3f}, from {min(ratios):.3f} to {max(ratios):.3f}")


if __name__ == "__main__":
    main()

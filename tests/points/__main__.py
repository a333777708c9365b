"""How many points end on the wrong side of a wall: `python -m tests.points --aims 10000 --kicks 2000 --floors 200`."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Callable

import numpy as np

from tests.points.families import AIMS, Verdict, dropped
from tests.points.kicks import kicked
from tests.points.scenes import Generator


def count(name: str, judge: Callable[[Generator, str], Verdict], scenes: int, seed: int, engine: str) -> int:
    """Judge so many scenes; print what was found; how many were wrong."""
    words: Counter[str] = Counter()
    wrong = []
    for k in range(scenes):
        verdict = judge(np.random.default_rng([seed, k]), engine)
        words["wrong" if verdict.wrong else "refused" if verdict.refused else "right"] += 1
        words["exact hits"] += verdict.exact
        words["at rest between two walls"] += verdict.held
        if verdict.wrong:
            wrong.append(f"{k}: {verdict.wrong}")
        if verdict.refused:
            words[f"refused: {verdict.refused}"] += 1
    print(f"{name}: {scenes} scenes, seed {seed}, {engine}: {dict(words)}", *wrong[:5], sep="\n    ", flush=True)
    return len(wrong)


def main() -> None:
    """Judge as many scenes as are asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("aims", "kicks", "floors"):
        parser.add_argument(f"--{name}", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--engine", default="reference")
    parser.add_argument("--family", choices=list(AIMS))
    chosen = parser.parse_args()
    families = {chosen.family: AIMS[chosen.family]} if chosen.family else AIMS
    wrong = 0
    for name, judge in families.items():
        if chosen.aims:
            wrong += count(name, judge, -(-chosen.aims // len(families)), chosen.seed, chosen.engine)
    if chosen.kicks:
        wrong += count("kicks", kicked, chosen.kicks, chosen.seed, chosen.engine)
    if chosen.floors:
        wrong += count("floors", dropped, chosen.floors, chosen.seed, chosen.engine)
    raise SystemExit(min(wrong, 1))


if __name__ == "__main__":
    main()

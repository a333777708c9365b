"""python -m tests.oracle --family NAME --scenes N --seed S [--engine reference|fast|both]: random scenes, judged.

With --scene FILE [FILE ...]: these scenes instead.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

import eventsim as es
from tests.oracle.digits import TooFewDigitsError
from tests.oracle.families import FAMILIES, case_of
from tests.oracle.families.case import Case
from tests.oracle.judge import (
    REFUSED,
    RIGHT,
    STOPS,
    UNJUDGED,
    WRONG,
    Seen,
    Verdict,
    judge,
    observe,
)
from tests.oracle.loop import story
from tests.oracle.story import Story
from tests.oracle.table import table_of

ENGINES = {"reference": ("reference",), "fast": ("fast",), "both": ("reference", "fast")}

SPARE = 100
"""So many rows more than an engine is asked for: it may end a series of bounces before the oracle does."""

WHOLE_ROUNDS, MOST_ROWS = (400,), 600
"""Digits and rows to which a scene is followed where it must be told to its end."""

LONGEST = 20_000
"""Rows after which the scene of a file is stopped, where it does not say how many."""

LOOSE = 1e-3
"""What is right for contacts that floats do not determine, where they must be told all the same: their order, roughly when."""

WORDS = (RIGHT, REFUSED, WRONG, UNJUDGED)

BY_GRAVITY = (RIGHT, UNJUDGED, REFUSED, WRONG)
"""The same, the worst last."""

POINT = 2.0**-42
"""A radius below this part of the scene's size may count as 0 at walls: what scenes promise."""


@dataclass
class Tally:
    """What came of the scenes of a family."""

    counts: dict[str, int] = field(default_factory=lambda: dict.fromkeys(WORDS, 0))
    judged: list[int] = field(default_factory=list)
    total: list[int] = field(default_factory=list)
    told: list[str] = field(default_factory=list)

    @property
    def scenes(self) -> int:
        """How many."""
        return sum(self.counts.values())

    def line(self, family: str) -> str:
        """One line of the table."""
        c = self.counts
        share = 100.0 * c[UNJUDGED] / max(1, self.scenes)
        median = statistics.median(self.judged) if self.judged else 0
        rows = statistics.median(self.total) if self.total else 0
        return (
            f"{family:16} {self.scenes:6} {c[RIGHT]:6} {c[REFUSED]:8} {c[WRONG]:13} {c[UNJUDGED]:11}"
            f" {share:5.1f} % {median:11g} {rows:9g}"
        )


HEAD = (
    f"{'family':16} {'scenes':>6} {'right':>6} {'refused':>8} {'silent wrong':>13} {'not judged':>11}"
    f" {'':7} {'rows judged':>11} {'of (med.)':>9}"
)


def verdict_of(case: Case, engines: Sequence[str]) -> Verdict:
    """The oracle's verdict on one case: the worst that it gives to one of the engines."""
    try:
        told, *as_points = (
            story(scene, events=case.scene.events + SPARE, kicks=case.kicks)
            for scene in (case.scene, *_with_points(case.scene))
        )
        whole = whole_story(case) if case.to_the_end else None
    except (ArithmeticError, AssertionError, NotImplementedError) as error:
        return Verdict(UNJUDGED, f"the oracle failed: {error!r}", -1, 0, 0)
    verdicts: list[Verdict] = []
    seen: list[Seen] = []
    for engine in engines:
        try:
            one = observe(case.scene, engine, case.kicks)
        except es.EventsimError as error:
            verdicts.append(Verdict(REFUSED, str(error), -1, 0, 0))
            continue
        seen.append(one)
        if len(seen) == 2 and is_same(*seen):
            break  # as it was judged
        verdict = min((judge(one_told, one, case.close) for one_told in (told, *as_points)), key=_gravity)
        if verdict.word != WRONG and case.inside is not None:
            verdict = _kept_inside(case.inside, one, verdict)
        if whole is not None and verdict.word in (RIGHT, UNJUDGED) and one.stopped not in STOPS:
            verdict = _at_the_end(_as_sure_as(told, whole), one, verdict)
        verdicts.append(verdict)
    if len(verdicts) == 2 and len(seen) == 2:
        verdicts.append(Verdict(WRONG, "the engines differ", -1, 0, 0))
    return max(verdicts, key=_gravity)


def _gravity(verdict: Verdict) -> int:
    return BY_GRAVITY.index(verdict.word)


def _with_points(scene: Any) -> list[Any]:
    """The scene with disks below the digits as points, which is as right, if there are any and walls for which they are."""
    radius = scene.disks.radius
    tiny = (radius > 0) & (radius <= POINT * table_of(scene).largest)
    if not (scene.walls and tiny.any()):
        return []
    disks = scene.disks
    return [replace(scene, disks=es.Disks(disks.position, disks.velocity, np.where(tiny, 0.0, radius), disks.mass))]


def is_same(one: Seen, other: Seen) -> bool:
    """Whether two engines did the same, bit for bit."""
    if one.stopped != other.stopped or len(one.rows) != len(other.rows) or one.time != other.time:
        return False
    ends = ((one.position, other.position), (one.velocity, other.velocity))
    return all(mine is theirs or np.array_equal(mine, theirs) for mine, theirs in ends) and all(
        np.array_equal(one.rows[name], other.rows[name], equal_nan=one.rows[name].dtype.kind == "f")
        for name in one.rows.dtype.names
    )


def whole_story(case: Case) -> Story | None:
    """All contacts of a scene, whether floats determine them or not; None where they are too many or their digits too."""
    try:
        return story(case.scene, events=MOST_ROWS, rounds=WHOLE_ROUNDS, judged=False)
    except TooFewDigitsError:
        return None


def _as_sure_as(told: Story, whole: Story) -> Story:
    """All contacts of a scene, those that floats determine with how far these may be from them."""
    for row, known in zip(whole.rows, told.rows, strict=False):
        row.time_error = known.time_error
        for part, sure in zip(row.parts, known.parts, strict=True):
            part.place_error, part.velocity_error = sure.place_error, sure.velocity_error
    return whole


def _at_the_end(whole: Story, seen: Seen, verdict: Verdict) -> Verdict:
    """Whether a run that went on to its end told all contacts, also those that floats do not determine, and no others."""
    if whole.ending == "events":
        return verdict
    if whole.ending == "collapse":
        return Verdict(
            WRONG, f"went on behind a collapse at {float(whole.time):.9g}", -1, verdict.judged, verdict.total
        )
    last = judge(whole, seen, LOOSE)
    if last.word == WRONG:
        return Verdict(
            WRONG,
            f"a tail of rounding; true: {len(whole.rows)} rows; {last.why}",
            last.row,
            verdict.judged,
            verdict.total,
        )
    return verdict


def _kept_inside(inside: Any, seen: Seen, verdict: Verdict) -> Verdict:
    """Whether all disks stayed where they may be, also where floats do not determine the run."""
    cx, cy = seen.corner
    for number, row in enumerate(seen.rows):
        for name in "ab":
            if row[name] >= 0 and not inside(float(row[f"x{name}"]) + cx, float(row[f"y{name}"]) + cy):
                return Verdict(
                    WRONG, f"disk {row[name]} is on the other side of a wall", number, verdict.judged, verdict.total
                )
    if seen.stopped in ("until", "quiet"):
        for i, (x, y) in enumerate(seen.position.tolist()):
            if not inside(x, y):
                return Verdict(
                    WRONG, f"disk {i} ends on the other side of a wall", len(seen.rows), verdict.judged, verdict.total
                )
    return verdict


def survey(
    family: str, scenes: int, seed: int, engines: Sequence[str], first: int = 0, most_rows: int | None = None
) -> Tally:
    """Judge the scenes of a family; most_rows: leave out those that may have more."""
    tally = Tally()
    for number in range(first, first + scenes):
        case = case_of(family, seed, number)
        if most_rows is not None and case.scene.events > most_rows:
            continue
        verdict = verdict_of(case, engines)
        tally.counts[verdict.word] += 1
        tally.judged.append(verdict.judged)
        tally.total.append(verdict.total)
        if verdict.word != RIGHT:
            at = f" row {verdict.row}" if verdict.row >= 0 else ""
            tally.told.append(f"{verdict.word:8} --seed {seed} --first {number}{at}: {verdict.why}")
    return tally


def judge_files(paths: Sequence[str], engines: Sequence[str], shown: bool) -> int:
    """Judge the scenes of files, a line for each; 1 where an answer was wrong without a word."""
    wrong = 0
    for path in paths:
        scene = es.load_scene(path)
        case = Case(scene if scene.events is not None else replace(scene, events=LONGEST))
        if shown:
            show(case)
        verdict = verdict_of(case, engines)
        wrong += verdict.word == WRONG
        at = f" row {verdict.row}:" if verdict.row >= 0 else ""
        print(f"{verdict.word:8} {verdict.judged} of {verdict.total} rows judged, {path}:{at} {verdict.why}", flush=True)
    return 1 if wrong else 0


def main(arguments: Sequence[str] | None = None) -> int:
    """Judge families and print the table; 1 where an answer was wrong without a word."""
    parser = argparse.ArgumentParser(prog="python -m tests.oracle", description=__doc__)
    parser.add_argument(
        "--family", action="append", help="a name of --list, or the beginning of several; all by default"
    )
    parser.add_argument("--scene", nargs="+", metavar="FILE", help="judge the scenes of these files, and no family")
    parser.add_argument("--scenes", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--first", type=int, default=0, help="number of the first scene: to repeat one, with --scenes 1"
    )
    parser.add_argument("--engine", choices=ENGINES, default="both")
    parser.add_argument("--list", action="store_true", help="name the families")
    parser.add_argument("--quiet", action="store_true", help="no lines on single scenes")
    parser.add_argument("--show", action="store_true", help="write each scene as TOML, and what the oracle tells of it")
    wishes = parser.parse_args(arguments)
    if wishes.list:
        for name, make in FAMILIES.items():
            print(f"{name:16} {(make.__doc__ or '').splitlines()[0]}")
        return 0
    if wishes.scene:
        return judge_files(wishes.scene, ENGINES[wishes.engine], wishes.show)
    chosen = [name for name in FAMILIES if not wishes.family or any(name.startswith(f) for f in wishes.family)]
    if not chosen:
        parser.error(f"no family is called {wishes.family}; see --list")
    wrong = 0
    lines = []
    for name in chosen:
        if wishes.show:
            for number in range(wishes.first, wishes.first + wishes.scenes):
                show(case_of(name, wishes.seed, number))
        begun = time.perf_counter()
        tally = survey(name, wishes.scenes, wishes.seed, ENGINES[wishes.engine], wishes.first)
        if not wishes.quiet:
            print(*tally.told, sep="\n")
        lines.append(f"{tally.line(name)}   {time.perf_counter() - begun:.0f} s")
        wrong += tally.counts[WRONG]
        print(HEAD, lines[-1], sep="\n", flush=True)
    if len(lines) > 1:
        print("", HEAD, *lines, sep="\n")
    return 1 if wrong else 0


def show(case: Case) -> None:
    """Print a case and the oracle's rows."""
    from eventsim.scene.files import scene_to_dict

    print(scene_to_dict(case.scene))
    print(*case.kicks, sep="\n")
    told = story(case.scene, kicks=case.kicks)
    for number, row in enumerate(told.rows):
        walls, idle = "/".join(sorted(row.walls)), " idle" if row.idle else ""
        print(f"{number:4} {row.kind:5} t = {float(row.time):.15g} +- {row.time_error:.1g} {walls}{idle}")
        for part in row.parts:
            (x, y), (u, w) = part.place, part.velocity
            place, velocity = f"({float(x):.15g}, {float(y):.15g})", f"({float(u):.15g}, {float(w):.15g})"
            print(
                f"     {part.disk:3} at {place} +- {part.place_error:.1g}, velocity {velocity} +- {part.velocity_error:.1g}"
            )
    print(told.ending, told.why, float(told.time))


if __name__ == "__main__":
    sys.exit(main())

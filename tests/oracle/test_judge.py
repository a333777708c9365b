"""The judge finds what is wrong with a log: each test damages the rows of a right run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import eventsim as es
from tests.oracle.judge import REFUSED, RIGHT, WRONG, Seen, judge, observe
from tests.oracle.loop import story
from tests.oracle.story import Story


@pytest.fixture(scope="module")
def gas() -> tuple[Story, Seen]:
    rng = np.random.default_rng(4)
    places = [(1.0 + 2.0 * i, 1.0 + 2.0 * j) for i in range(3) for j in range(2)]
    scene = es.Scene(es.Disks(places, rng.normal(0, 1, (6, 2)), 0.4), es.Box((6.0, 4.0)), until=3.0)
    return story(scene), observe(scene, "reference")


def changed(seen: Seen, change: Callable[[Any], Any]) -> Seen:
    rows = change(seen.rows.copy())
    return replace(seen, rows=rows)


def set_to(column: str, number: int, by: float) -> Callable[[Any], Any]:
    def change(rows: Any) -> Any:
        rows[column][number] += by
        return rows

    return change


def swapped(rows: Any) -> Any:
    """Two rows of one disk in the other order."""
    for first in range(len(rows)):
        for second in range(first + 1, len(rows)):
            mine = {rows["a"][first], rows["b"][first]} - {-1}
            if mine & ({rows["a"][second], rows["b"][second]} - {-1}):
                rows[[first, second]] = rows[[second, first]]
                return rows
    raise AssertionError("no disk has two rows")


def test_an_undamaged_run_is_right(gas: tuple[Story, Seen]) -> None:
    told, seen = gas
    verdict = judge(told, seen)
    assert verdict.word == RIGHT, verdict
    assert verdict.judged == len(seen.rows) > 10


@pytest.mark.parametrize(
    "change",
    [
        pytest.param(set_to("vxa", 3, 1e-6), id="a velocity"),
        pytest.param(set_to("ya", 5, 1e-6), id="a place"),
        pytest.param(set_to("remainder", 4, 1e-6), id="a time"),
        pytest.param(lambda rows: np.delete(rows, 4), id="a row is missing"),
        pytest.param(lambda rows: rows[:-2], id="the last rows are missing"),
        pytest.param(lambda rows: np.insert(rows, 4, rows[4]), id="a row stands twice"),
        pytest.param(swapped, id="the order of a disk"),
    ],
)
def test_a_damaged_log_is_wrong(gas: tuple[Story, Seen], change: Callable[[Any], Any]) -> None:
    told, seen = gas
    assert judge(told, changed(seen, change)).word == WRONG


def test_another_state_at_the_end_is_wrong(gas: tuple[Story, Seen]) -> None:
    told, seen = gas
    assert judge(told, replace(seen, position=seen.position + 1e-6)).word == WRONG


def test_another_word_for_the_end_is_wrong(gas: tuple[Story, Seen]) -> None:
    told, seen = gas
    assert judge(told, replace(seen, stopped="quiet")).word == WRONG


def test_a_stop_with_a_reason_is_a_refusal_where_the_oracle_goes_on(gas: tuple[Story, Seen]) -> None:
    told, seen = gas
    early = replace(seen, rows=seen.rows[:5], stopped="digits", time=float(seen.rows["time"][4]))
    assert judge(told, early).word == REFUSED


def test_a_stop_is_right_only_behind_the_last_contact_that_floats_determine() -> None:
    """Four contacts before its stop a run knows the next flight to one part in thousands, however short that is."""
    disks = es.Disks([(1.0, 0.0), (3.0, 0.0)], [(0.0, 0.0), (-1.0, 0.0)], 0.5)
    wall = es.Segment((-0.5, -9.0), (-0.5, 9.0))
    scene = es.Scene(disks, es.Open(), [wall], restitution=0.1, until=1e3, events=200)
    told, seen = story(scene), observe(scene, "reference")
    assert (seen.stopped, judge(told, seen).word) == ("collapse", RIGHT)
    early = replace(seen, rows=seen.rows[:-4], time=float(seen.rows["time"][-5]))
    assert seen.time - early.time < 1e-8
    assert judge(told, early).word == REFUSED


@pytest.mark.parametrize("word", ["digits", "events"])
def test_a_run_that_misses_a_contact_is_wrong_whatever_it_stops_by(gas: tuple[Story, Seen], word: str) -> None:
    told, seen = gas
    assert judge(told, replace(seen, rows=seen.rows[:-1], stopped=word)).word == WRONG


def test_what_floats_do_not_determine_is_not_judged() -> None:
    """A wall of posts beside a fast small disk: after a few contacts its order is a matter of last bits, and is not judged."""
    rng = np.random.default_rng(1)
    places = [(0.5 + i, 0.5 + j) for i in range(3) for j in range(3)] + [(1.0, 1.0)]
    masses = [np.inf] * 9 + [1.0]
    velocities = np.concatenate([np.zeros((9, 2)), rng.normal(0, 1, (1, 2))])
    scene = es.Scene(es.Disks(places, velocities, [0.3] * 9 + [0.05], masses), es.Periodic((3.0, 3.0)), events=200)
    told, seen = story(scene), observe(scene, "reference")
    assert told.ending == "beyond"
    verdict = judge(told, seen)
    assert verdict.word != WRONG
    assert 10 < verdict.judged < 60


TINY = 2.0**-20


def test_a_place_behind_a_wrap_between_two_floats_is_not_exact() -> None:
    """A disk begins anew at a wrap, whose time is no float, so that its next contact, which would be head-on, is not quite."""
    position = [(0.75, 2.75), (1.0, 1.5), (np.nextafter(2.25, 3.0), np.nextafter(3.25, 3.0)), (2.75, 3.5), (1.0, 2.75)]
    velocity = [(-0.75, -0.5), (0.5, 0.5), (0.75, 0.75), (-0.75, 0.5), (-0.25, 0.0)]
    scene = es.Scene(es.Disks(position, velocity, TINY, [1.0, 3.0, 1.0, 3.0, 3.0]), es.Channel((4.0, 4.0)), until=50.0)
    verdict = judge(story(scene), observe(scene, "reference"))
    assert (verdict.word, verdict.judged) == (RIGHT, 26)


def test_nobody_knows_what_a_disk_meets_that_may_be_anywhere() -> None:
    """The second contact of two tiny disks turns by a seventh part of a right angle with the last bit of a place."""
    position = [(np.nextafter(2.0, 1.0), np.nextafter(1.0, 2.0)), (1.5, 0.25), (np.nextafter(0.5, 1.0), np.nextafter(3.0, 2.0))]
    velocity = [(0.5, -0.5), (-1.0, -0.25), (-0.25, 0.5)]
    scene = es.Scene(es.Disks(position, velocity, TINY, [np.inf, np.inf, 1.0]), es.Periodic((4.0, 4.0)), until=50.0)
    told = story(scene)
    assert (told.ending, len(told.rows)) == ("beyond", 2)
    assert judge(told, observe(scene, "reference")).word == RIGHT

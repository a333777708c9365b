"""Replay of logs written by hand, and of the pieces it is made of."""

from __future__ import annotations

import math
from typing import Never

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eventsim.engines.base import Stop
from eventsim.engines.reference.loop import ReferenceSession
from eventsim.engines.turnover import crossing_delays
from eventsim.errors import LogError
from eventsim.formulas.clock import clock_time
from eventsim.formulas.crossing import crossing_delay
from eventsim.record import Ending, Kind
from eventsim.record.events import blank_rows
from eventsim.replay.clock_windows import Windows
from eventsim.replay.flight import fly, start_flights
from eventsim.replay.log import EventLog
from eventsim.replay.replay import Replay
from eventsim.replay.runs import Runs
from eventsim.scene import Box, Disks, Domain, Open, Periodic, Scene
from eventsim.scene.numbers import SLOWEST
from eventsim.scene.stage import Stage, stage_of
from tests.record.logs import provenance


def one_disk(domain: Domain, velocity: tuple[float, float]) -> Scene:
    return Scene(Disks([(1.0, 1.0)], [velocity], radius=0.5), domain)


def empty_log(scene: Scene, ending: Ending | None) -> EventLog:
    stage = stage_of(scene)
    return EventLog(
        provenance(scene, ending=ending, epoch_length=stage.epoch_length, wall_names=stage.wall_names), blank_rows(0)
    )


def wall_log(compact: bool = False, start_time: float = 0.0) -> EventLog:
    """A disk of radius 1/2 between walls at 0 and 4, hit at t = 5/4 (right) and 17/4 (left), until 6."""
    disk = Disks([(11.0, 1.0)], [(2.0, 0.0)], radius=0.5)
    scene = Scene(disk, Box((4.0, 2.0), origin=(10.0, 0.0)), start_time=start_time)
    rows = blank_rows(2)
    rows["event"], rows["kind"], rows["wall"] = [0, 1], Kind.WALL, [1, 0]
    rows["remainder"] = [1.25, 2.75]
    rows["xa"], rows["ya"] = [3.5, 0.5], 1.0
    rows["vxa"], rows["vya"] = [-2.0, 2.0], 0.0
    if compact:
        for name in ("xa", "ya", "vxa", "vya"):
            rows[name] = np.nan
    stage = stage_of(scene)
    return EventLog(
        provenance(scene, compact=compact, ending=Ending(0, 4.0, "until"), epoch_length=stage.epoch_length), rows
    )


@pytest.mark.parametrize("compact", [False, True])
def test_a_disk_between_two_walls_is_found_at_every_time(compact: bool) -> None:
    replay = Replay(wall_log(compact))
    for time, x, speed in [(0, 11, 2), (1, 13, 2), (1.25, 13.5, -2), (2, 12, -2), (2.75, 10.5, 2), (4, 13, 2)]:
        state = replay.state_at(time)
        assert (state.time, state.position.tolist(), state.velocity.tolist()) == (time, [[x, 1.0]], [[speed, 0.0]])


def test_at_the_time_of_an_event_the_state_is_that_after_it() -> None:
    replay = Replay(wall_log())
    assert replay.state_at(math.nextafter(1.25, 0.0)).velocity[0, 0] == 2.0
    assert replay.state_at(1.25).velocity[0, 0] == -2.0
    assert replay.state_after(0).velocity[0, 0] == -2.0


def test_a_late_clock_changes_only_the_time_that_is_shown() -> None:
    late = Replay(wall_log(start_time=1e6))
    early = Replay(wall_log())
    for time in (0.0, 1.0, 1.25, 3.875):
        assert late.state_at(1e6 + time).position.tolist() == early.state_at(time).position.tolist()
    assert late.final().time == 1e6 + 4.0


@pytest.mark.parametrize("time", [-0.5, 4.5, math.inf, math.nan])
def test_times_outside_the_run_are_refused(time: float) -> None:
    with pytest.raises(LogError, match="there is no state at time"):
        Replay(wall_log()).state_at(time)


def test_after_a_quiet_end_the_disks_fly_on() -> None:
    scene = one_disk(Open(), (1.0, -2.0))
    replay = Replay(empty_log(scene, Ending(0, 0.0, "quiet")))
    assert replay.state_at(2.0**60).position.tolist() == [[1.0 + 2.0**60, 1.0 - 2.0**61]]


def test_a_compact_log_that_does_not_fit_its_scene_says_so() -> None:
    log = wall_log(compact=True)
    rows = log.rows.copy()
    rows["remainder"][1] = 2.8125
    with pytest.raises(LogError, match="does not fit its scene at event 1"):
        EventLog(log.provenance, rows).expand()


def test_a_kick_without_its_velocity_says_so() -> None:
    log = wall_log(compact=True)
    rows = log.rows[:1].copy()
    rows["kind"], rows["wall"], rows["remainder"] = Kind.KICK, -1, 0.5
    with pytest.raises(LogError, match="not in the metadata"):
        EventLog(log.provenance, rows).expand()


def test_an_epoch_at_which_no_window_begins_says_so() -> None:
    log = wall_log()
    rows = log.rows.copy()
    rows["epoch"][1] = 3
    with pytest.raises(LogError, match="no window of the clock begins at epoch 3"):
        Replay(EventLog(log.provenance, rows))


def test_a_periodic_flight_wraps_exactly_and_turns_its_clock_over() -> None:
    scene = one_disk(Periodic((4.0, 2.0)), (2.0, -1.0))
    windows, end = windows_without_rows(stage_of(scene)), 400.0
    window, remainder = windows.place(end)
    replay = Replay(empty_log(scene, Ending(windows.start[window], remainder, "until")))
    for time in np.linspace(0.0, end, 21).tolist():
        state = replay.state_at(time)
        assert state.position.tolist() == [[(1.0 + 2.0 * time) % 4.0, (1.0 - time) % 2.0]]  # all dyadic, hence exact
    assert len(replay.windows.start) > 2


def windows_without_rows(stage: Stage) -> Windows:
    def nobody(*_: object) -> Never:
        raise AssertionError("there are no rows")

    return Windows(stage, Runs([]), nobody)


numbers = st.floats(-8.0, 8.0)
pulls = st.floats(-0.5, 0.5).map(lambda g: g if abs(g) > 1e-150 else 0.0)  # what a scene takes for a gravity
speeds = numbers.map(lambda v: v if abs(v) > SLOWEST else 0.0)


@given(x=numbers, v=numbers, g=st.one_of(st.none(), numbers), target=st.sampled_from([0.0, 4.0]))
def test_crossings_of_many_are_those_of_one(x: float, v: float, g: float | None, target: float) -> None:
    for side in (1.0, -1.0):
        pull = None if g is None else np.array([g])
        many = crossing_delays(np.array([x]), np.array([v]), pull, target, side)
        assert many[0] == crossing_delay(x, v, g, target, side)


@settings(max_examples=20, deadline=None)  # under gravity a flight may wrap thousands of times
@given(
    places=st.lists(st.tuples(st.floats(0.0, 3.5), st.floats(0.0, 1.5), speeds, speeds), min_size=1, max_size=4),
    gravity=st.one_of(st.none(), st.tuples(pulls, pulls)),
    window=st.integers(0, 1),
    share=st.floats(0.0, 0.99),
)
def test_many_fly_as_in_the_engine(
    places: list[tuple[float, float, float, float]],
    gravity: tuple[float, float] | None,
    window: int,
    share: float,
) -> None:
    table = np.array(places)
    scene = Scene(Disks(table[:, :2], table[:, 2:], radius=0.0, mass=0.0), Periodic((4.0, 2.0)), gravity=gravity)
    stage = stage_of(scene)
    windows = windows_without_rows(stage)
    place = windows.place((33.0 * window + share * (8.0 if window else 32.0)) * stage.epoch_length)
    flights = start_flights(stage)
    fly(flights, stage, windows, *place)
    session = ReferenceSession(stage)
    time = clock_time(windows.start[place[0]], place[1], stage.epoch_length)
    while session.advance(Stop(time), 1 << 20) is None:
        pass
    motion = session.motion()
    for mine, theirs in ((flights.x, motion.x), (flights.y, motion.y), (flights.vx, motion.vx), (flights.vy, motion.vy)):
        assert mine.tolist() == theirs.tolist()

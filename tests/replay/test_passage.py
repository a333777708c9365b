"""Logs that are gone through block by block: the same states and flights, in memory that their length does not change."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import eventsim as es
from eventsim.errors import LogError
from eventsim.replay.flight_table import flight_table
from eventsim.replay.log import EventLog
from eventsim.replay.passage import Passage
from eventsim.replay.replay import Replay
from tests.engines.scenes import lattice_gas


class Cut(EventLog):
    """A log whose blocks are short."""

    length = 7

    def blocks(self):
        yield from (self.rows[first : first + self.length] for first in range(0, len(self), self.length))


GALLERY = ("periodic-fluid", "funnel", "sculpture", "tie", "corridor", "break")


@cache
def log_of(name: str) -> EventLog:
    """A run with wraps, turnovers, walls, gravity, rest, or idle windows and kicks (and without an end)."""
    if name == "gas":
        return es.simulate(lattice_gas(9, 0.3), events=400, engine="reference", log=True).log
    if name != "kicks":
        return es.simulate(es.gallery(name), events=150, engine="reference", log=True).log
    disks = es.Disks([(0.2, 0.5), (0.7, 0.6)], [(0.1, 0.03), (0.0, 0.0)], 0.05)
    sim = es.Simulation(es.Scene(disks, es.Periodic((1.0, 1.0))))
    for time in (0.5, 2e3, 5e3, 5e3 + 1.0):
        sim.advance_to(time)
        sim.set_velocity(1, (0.25, 0.125 * time % 1.0))
    sim.advance_to(6e3)
    return sim.log


NAMES = (*GALLERY, "bounce", "gas", "kicks")


@pytest.mark.parametrize("name", NAMES)
def test_a_passage_gives_the_bits_of_a_replay(name: str) -> None:
    log = log_of(name)
    replay, passage = Replay(log), Passage(Cut(log.provenance, log.rows))
    assert passage.span == replay.span
    begin, end = replay.span
    times = np.sort(np.concatenate([np.linspace(begin, end, 20), log.time[::9], log.time[-3:], [begin, end]]))
    for moment, time in zip(passage.moments(times), times.tolist(), strict=True):
        right = replay.state_at(time)
        assert moment.state.position.tobytes() == right.position.tobytes()
        assert moment.state.velocity.tobytes() == right.velocity.tobytes()
        assert np.array_equal(moment.pull, replay.acceleration_at(time))
    assert passage.final().position.tobytes() == replay.final().position.tobytes()


@pytest.mark.parametrize("name", NAMES)
def test_flights_do_not_depend_on_how_a_log_is_cut(name: str) -> None:
    log = log_of(name)
    whole, cut = flight_table(Replay(log)), flight_table(Passage(Cut(log.provenance, log.rows)))
    for column in whole.__slots__:
        assert np.array_equal(getattr(whole, column), getattr(cut, column)), column


def test_a_passage_goes_forwards_and_not_beyond_the_end() -> None:
    passage = Passage(log_of("break"))
    with pytest.raises(LogError, match="order of time"):
        list(passage.states([0.2, 0.1]))
    with pytest.raises(LogError, match="the log ends at"):
        list(passage.states([0.1, 1e9]))
    assert list(passage.states([])) == []

"""The engine `auto`: what it begins with, and when it changes its mind."""

import math

import pytest

import eventsim as es
from eventsim.engines import auto
from eventsim.engines.auto import COLD, LARGE, SURE, AutoSession, contact_rate, first_engine, reference_seconds
from eventsim.engines.base import Stop
from eventsim.engines.reference import AutoOptions
from eventsim.scene.stage import stage_of
from tests.engines.scenes import lattice_gas

GAS = stage_of(lattice_gas(100, 0.3, es.Periodic))
FORESEEN = reference_seconds(GAS, Stop(events=10**6)) / 10**6
"""Seconds of an event, nearly."""


@pytest.fixture
def warm(monkeypatch):
    """Whether compiled kernels are on disk, for the tests to say: a list whose last item counts."""
    says = [False]
    monkeypatch.setattr(auto, "has_compiler", lambda: True)
    monkeypatch.setattr(auto, "may_warm", lambda: False)
    monkeypatch.setattr(auto, "_is_warm", lambda *asked: says[-1])
    return says


@pytest.mark.parametrize(
    ("seconds", "is_warm", "engine"),
    [
        (0.5 * SURE, True, "reference"),
        (1.5 * SURE, True, "fast"),
        (1.5 * SURE, False, "reference"),
        (2.0 * COLD, False, "reference"),  # what it compiles for is measured, not foreseen
    ],
)
def test_a_job_begins_with_the_engine_that_will_have_done_it_first(warm, seconds, is_warm, engine):
    warm.append(is_warm)
    assert first_engine(GAS, Stop(events=int(seconds / FORESEEN))) == engine


def test_a_time_to_stop_at_is_a_job_as_long_as_its_contacts(warm):
    warm.append(True)
    rate = contact_rate(GAS)
    for seconds, engine in ((0.5 * SURE, "reference"), (2.0 * SURE, "fast")):
        stop = Stop(until=seconds / FORESEEN / rate)
        assert math.isclose(reference_seconds(GAS, stop), seconds, rel_tol=0.01)
        assert first_engine(GAS, stop) == engine
        assert first_engine(GAS, Stop(stop.until, 10)) == "reference"


def test_the_rate_of_contacts_is_known_within_a_fifth():
    scene = lattice_gas(400, 0.3, es.Periodic)
    begun = es.simulate(scene, events=2000).time
    ended = es.simulate(scene, events=6000).time
    assert contact_rate(stage_of(scene)) == pytest.approx(4000 / (ended - begun), rel=0.2)


def test_nothing_is_foreseen_on_the_open_plane_or_without_a_stop(warm):
    warm.append(True)
    open_plane = stage_of(lattice_gas(100, 0.3, es.Open))
    assert contact_rate(open_plane) is None
    for stage, stop in ((open_plane, Stop(until=1e9)), (GAS, Stop())):
        assert first_engine(stage, stop) == "reference"


def test_many_disks_are_for_the_fast_engine_where_there_is_one(warm, monkeypatch):
    stage = stage_of(lattice_gas(LARGE, 0.3, es.Periodic))
    assert first_engine(stage, Stop(events=1)) == "fast"
    monkeypatch.setattr(auto, "has_compiler", lambda: False)
    assert first_engine(stage, Stop(events=1)) == "reference"


def test_options_are_those_of_the_reference_engine_and_keep_it(warm):
    warm.append(True)
    session = AutoSession(GAS, options=AutoOptions(check=True))
    session.advance(Stop(events=10**9), 5)
    assert session.at_work == "reference"


def test_a_run_that_goes_on_from_a_checkpoint_counts_only_its_own_events(warm):
    """It had come far before, so that what is left is little beside that, but not beside what this session has done."""
    first = AutoSession(GAS, keep_rows=False)
    first.advance(Stop(events=1000), 10**9)
    second = AutoSession(GAS, keep_rows=False)
    second.restore(first.snapshot())
    second.counters.copy_from(first.counters)
    second.advance(Stop(events=1100), 64)
    done = second.counters.events - 1000
    assert second._share_left(Stop(events=1100)) == (100 - done) / done


def test_a_law_that_cannot_be_compiled_keeps_the_reference_engine(warm, monkeypatch, capsys):
    def mine(restitution, approach):
        return 0.9 * restitution

    def refused(law):
        raise es.EventsimError("the law cannot be compiled")

    monkeypatch.setattr("eventsim.engines.fast.rules.law_in_kernels", refused)
    disks = es.Disks([(1.0, 1.0), (3.0, 1.0)], [(1.0, 0.0), (0.0, 0.0)], 0.5)
    stage = stage_of(es.Scene(disks, es.Box((4.0, 2.0)), law=mine))
    for name in ("PATIENCE", "SAMPLE", "WARM", "SURE"):
        monkeypatch.setattr(auto, name, 0.0)
    for is_warm in (True, False):  # the fast engine would have been the first one, or the second
        warm.append(is_warm)
        session = AutoSession(stage)
        session.advance(Stop(events=100), 5)
        session.advance(Stop(events=100), 5)
        assert session.at_work == "reference"
        assert "the law cannot be compiled: so does this run" in capsys.readouterr().err


def test_kernels_are_not_compiled_for_what_is_nearly_done(warm, monkeypatch):
    for name in ("PATIENCE", "SAMPLE", "WARM"):
        monkeypatch.setattr(auto, name, 0.0)
    monkeypatch.setattr(auto, "COLD", math.inf)
    session = AutoSession(GAS)
    for _ in range(3):
        session.advance(Stop(until=1e3), 5)
    assert session.at_work == "reference"
    assert session._share_left(Stop(until=1e3)) > 1.0
    assert session._share_left(Stop()) == 0.0

"""A track: pieces, and going back, change no bit."""

import math
import sys

import numpy as np
import pytest

import eventsim as es
from eventsim.live.track import Track
from eventsim.record.events import Kind
from eventsim.replay.replay import Replay


def advanced(track, time):
    while track.horizon < time and track.ended is None:
        track.advance(time)
    return track


def test_pieces_give_the_log_of_one_run():
    scene = es.gallery("gas", n=50)
    track = advanced(Track(scene, "reference"), 0.4)
    whole = es.simulate(scene, until=0.4, log=True, engine="reference").log
    assert track.log().digest() == whole.digest()
    assert track.rows(0, track.count).tobytes() == whole.rows.tobytes()
    assert track.rows(100, 103).tobytes() == whole.rows[100:103].tobytes()


def test_going_back_and_on_again_changes_no_bit(monkeypatch):
    monkeypatch.setattr(sys.modules["eventsim.live.track"], "MARK_EVENTS", 50)
    monkeypatch.setattr(sys.modules["eventsim.live.track"], "MARK_EVENTS_PER_DISK", 0)
    monkeypatch.setattr(sys.modules["eventsim.live.track"], "MOST_MARKS", 8)
    scene = es.gallery("gas", n=50)
    track = Track(scene, "reference")
    while track.horizon < 0.4:
        track.advance(0.4, 40)
    before = track.log()
    replay = Replay(before)
    for moment in (0.31, 0.05, 0.2, 0.0):
        state = track.rewind(moment)
        assert state.time == moment
        np.testing.assert_array_equal(state.position, replay.state_at(moment).position)
        assert track.count == (before.time <= moment).sum()
        advanced(track, 0.4)
        assert track.log().digest() == before.digest()
        assert track.rows(0, track.count).tobytes() == before.rows.tobytes()


def test_a_kick_is_kept_when_going_back_to_a_later_time():
    scene = es.gallery("gas", n=20)
    track = advanced(Track(scene, "reference"), 0.3)
    track.rewind(0.1)
    track.kick(3, (2.0, 1.0))
    kicked = track.count
    advanced(track, 0.3)
    log = track.log()
    track.rewind(0.1)
    assert track.count == kicked
    advanced(track, 0.3)
    assert track.log().digest() == log.digest()
    assert (Replay(log).state_at(0.1).velocity[3] == (2.0, 1.0)).all()


def test_a_collapse_ends_a_track_and_keeps_what_happened():
    track = Track(es.gallery("collapse", restitution=0.05), "reference")
    for _ in range(1000):
        if track.ended is not None:
            break
        track.advance(100.0)
    assert track.ended is not None
    assert track.count > 0
    assert track.horizon == pytest.approx(track.time_of(track.count - 1))
    assert len(track.log()) == track.count


def falling(walls=()):
    """Two disks that drop onto the floor, or one of them onto a wall; little is lost at a bounce."""
    disks = es.Disks([[0.5, 1.1], [20.0, 3.0]], [[0.0, 0.0], [0.01, 0.0]], 0.1, mass=[1.0, 2.0])
    return es.Scene(disks, es.Box((40.0, 5.0)), walls, gravity=(0.0, -1.0), restitution=0.95)


def test_a_track_goes_on_when_its_disks_have_come_to_rest():
    track = Track(falling(), "reference")
    advanced(track, 200.0)
    assert (track.ended, track.horizon) == (None, 200.0)
    kinds = track.log().kind
    assert (kinds == Kind.REST).sum() == 2
    track.rewind(150.0)
    track.kick(0, (0.0, 1.0))
    advanced(track, 200.0)
    assert (track.ended, track.horizon) == (None, 200.0)


def test_a_track_with_a_drop_onto_a_vertex_ends_with_a_reason_at_its_zeno_time():
    peak = es.Polygon([(0.5, 0.5), (0.2, 0.2), (0.8, 0.2)])
    scene = es.Scene(es.Disks([[0.5, 1.6]], radius=0.1), es.Box((5.0, 5.0)), [peak], gravity=(0.0, -1.0), restitution=0.95)
    track = advanced(Track(scene, "reference"), 200.0)
    assert "collapse" in track.ended
    assert track.horizon == pytest.approx(math.sqrt(2.0) * 1.95 / 0.05, rel=1e-6)

"""Which times a movie shows, and what there is to be seen."""

import numpy as np
import pytest

from eventsim.errors import EventsimError
from eventsim.replay.passage import Passage
from eventsim.replay.replay import Replay
from eventsim.show.frames import energy_of, frame_timing, frames_at, moments


def test_a_duration_spreads_the_frames_from_beginning_to_end():
    timing = frame_timing((2.0, 6.0), 30.0, duration=2.0)
    assert len(timing.times) == 60
    assert (timing.times[0], timing.times[-1], timing.speed) == (2.0, 6.0, 2.0)


def test_a_speed_spaces_the_frames_and_keeps_the_last():
    timing = frame_timing((0.0, 1.0), 10.0, speed=0.5)
    np.testing.assert_allclose(timing.times, np.arange(21) * 0.05, rtol=1e-15)


def test_the_moments_of_a_strip_include_both_ends():
    assert moments((0.0, 4.0), 5, begin=2.0).tolist() == [2.0, 2.5, 3.0, 3.5, 4.0]


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ({"speed": 1.0, "duration": 1.0}, "exclude"),
        ({"speed": 0.0}, "speed = 0.0"),
        ({"duration": float("nan")}, "duration = nan"),
        ({"begin": -1.0}, r"begin \(--from\) = -1.0"),
        ({"end": 5.0}, r"end \(--to\) = 5.0"),
        ({"begin": 3.0, "end": 2.0}, "before the end"),
        ({"speed": 1e-9}, "frames"),
    ],
)
def test_options_that_do_not_fit_are_explained(options, expected):
    with pytest.raises(EventsimError, match=expected):
        frame_timing((0.0, 4.0), 30.0, **options)


def test_frames_show_the_state_and_count_contacts(broken):
    replay = Replay(broken)
    times = np.linspace(*replay.span, 7)
    for frame in frames_at(Passage(replay.log), times, 0.1):
        state = replay.state_at(frame.state.time)
        assert np.array_equal(frame.state.position, state.position)
        before = broken.time <= state.time
        assert frame.events == before.sum()
        pairs = before & (broken.b >= 0)
        assert frame.contacts.sum() == before.sum() + pairs.sum()
        lit = np.union1d(*(column[before & (broken.time > state.time - 0.1)] for column in (broken.a, broken.b)))
        assert np.array_equal(np.flatnonzero(frame.glow), lit[lit >= 0])
        assert frame.energy == pytest.approx(energy_of(broken, replay.state_at(0.0)), rel=1e-14)  # elastic

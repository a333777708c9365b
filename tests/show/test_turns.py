"""A spoke turns with its disk: in pictures, and in what the player is told."""

from itertools import pairwise

import numpy as np
import pytest

import eventsim as es
from eventsim.replay.passage import Passage
from eventsim.scene.gallery import gallery
from eventsim.show.frames import frames_at
from eventsim.show.player.pack import packed


@pytest.fixture(scope="module")
def run():
    scene = gallery("rough", n=25, spin=3.0)
    return es.simulate(scene, events=300, engine="reference", log=True)


def turned(run, until):
    """By how much each disk has turned: its spin, for as long as that lasts, event by event."""
    times = np.array([0.0, *run.log.time[run.log.time <= until], until])
    return sum(run.state_at(begin).spin * (end - begin) for begin, end in pairwise(times))


def test_the_angle_of_a_spoke_is_the_integral_of_the_spin(run):
    times = np.linspace(0.0, run.time, 6)
    for frame in frames_at(Passage(run.log), times, 0.1):
        assert frame.angle == pytest.approx(turned(run, frame.state.time), abs=1e-11)


def test_disks_without_spin_have_no_spoke():
    smooth = es.simulate(gallery("two-disks"), events=3, engine="reference", log=True)
    (frame,) = frames_at(Passage(smooth.log), np.array([1.0]), 0.1)
    assert frame.angle is None
    assert "spin" not in {column["name"] for column in packed(smooth.log)[0]["columns"]}


def test_the_player_is_told_spins(run):
    names = [column["name"] for column in packed(run.log)[0]["columns"]]
    assert [name for name in names if "spin" in name] == ["spin", "spin_a", "spin_b"]


def test_a_spoke_is_drawn(run, tmp_path):
    from matplotlib.image import imread

    run.animate(tmp_path / "spokes.png", moments=2)
    told = es.Scene(es.Disks(run.scene.disks.position, run.scene.disks.velocity, run.scene.disks.radius), run.scene.domain)
    es.simulate(told, until=run.time, engine="reference", log=True).animate(tmp_path / "plain.png", moments=2)
    # at the start both have the same disks in the same places
    one, other = imread(tmp_path / "spokes.png"), imread(tmp_path / "plain.png")
    assert one.shape == other.shape
    half = one.shape[1] // 2
    assert (np.abs(one - other).max(axis=2)[:, :half] > 0.1).sum() > 25 * 3

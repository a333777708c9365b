"""Files that other programs of the field read."""

import numpy as np
import pytest

import eventsim as es
from eventsim.record.events import State
from eventsim.replay.replay import Replay
from eventsim.replay.states import write_states


@pytest.fixture(scope="module")
def told():
    """A scene of two species and three of its states."""
    scene = es.gallery("mixture", n_small=8, n_large=2)
    replay = Replay(es.simulate(scene, events=50, engine="reference", log=True).log)
    begin, end = replay.span
    return scene, [replay.state_at(time) for time in (begin, 0.5 * end, end)]


def frames_of(text):
    """(comment, rows) of each frame of an XYZ file."""
    lines = text.splitlines()
    while lines:
        count = int(lines[0])
        yield lines[1], [line.split() for line in lines[2 : 2 + count]]
        lines = lines[2 + count :]


def test_xyz_holds_every_bit(told, tmp_path):
    scene, states = told
    write_states(tmp_path / "a.xyz", scene, states)
    frames = list(frames_of((tmp_path / "a.xyz").read_text()))
    assert len(frames) == 3
    for (comment, rows), state in zip(frames, states, strict=True):
        numbers = np.array([[float(word) for word in row[1:]] for row in rows])
        assert numbers[:, :2].tolist() == state.position.tolist()
        assert numbers[:, 3:5].tolist() == state.velocity.tolist()
        assert numbers[:, 6].tolist() == scene.disks.radius.tolist()
        assert float(comment.split("Time=")[1]) == state.time
        assert "Properties=species:S:1:pos:R:3:velo:R:3:radius:R:1:mass:R:1" in comment
    assert {row[0] for row in frames[0][1]} == {"D0", "D1"}


def test_gsd_is_read_back_by_its_library(told, tmp_path):
    gsd = pytest.importorskip("gsd.hoomd")
    scene, states = told
    write_states(tmp_path / "a.gsd", scene, states)
    with gsd.open(str(tmp_path / "a.gsd")) as file:
        assert len(file) == 3
        for frame, state in zip(file, states, strict=True):
            size = np.array(scene.domain.size)
            centred = state.position - np.array(scene.domain.origin) - 0.5 * size
            assert frame.particles.position[:, :2].tolist() == centred.astype(np.float32).tolist()
            assert frame.particles.diameter.tolist() == (2.0 * scene.disks.radius).astype(np.float32).tolist()
            assert frame.configuration.dimensions == 2
            assert frame.log["time"] == [state.time]


def test_the_open_plane_gets_a_cell_that_holds_everyone(tmp_path):
    scene = es.Scene(es.Disks([[-3.0, 1.0], [4.0, 9.0]], radius=0.5), es.Open())
    write_states(tmp_path / "a.xyz", scene, [State(0.0, scene.disks.position, scene.disks.velocity)])
    comment, _ = next(frames_of((tmp_path / "a.xyz").read_text()))
    assert 'Lattice="8.0 0.0 0.0 0.0 9.0 0.0 0.0 0.0 1.0" Origin="-3.5 0.5 0.0"' in comment
    assert 'pbc="F F F"' in comment

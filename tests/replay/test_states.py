"""Files of states hold every bit, and a scene can start from them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from eventsim.errors import EventsimError
from eventsim.record import State
from eventsim.replay.states import STATE_COLUMNS, write_states
from eventsim.scene import Box, Disks, Scene
from eventsim.scene.files import scene_from_dict

SCENE = Scene(Disks([(1.0, 1.0), (3.0, 1.0)], radius=[0.1, 0.3], mass=[1.0, np.inf]), Box((4.0, 2.0)))
STATES = [
    State(t, np.array([[0.1 + t, 1 / 3], [2.0, 1.0]]), np.array([[-0.0, 1e-75], [1e-9, 0.0]])) for t in (0.0, 0.5)
]


@pytest.mark.parametrize("suffix", [".csv", ".npz"])
def test_states_come_back_bit_for_bit(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"states{suffix}"
    write_states(path, SCENE, STATES)
    if suffix == ".csv":
        header, *lines = path.read_text().splitlines()
        values = np.array([[float(word) for word in line.split(",")] for line in lines])
        columns = dict(zip(header.split(","), values.T, strict=True))
    else:
        with np.load(path, allow_pickle=False) as arrays:
            columns = {name: arrays[name] for name in arrays}
    assert tuple(columns) == STATE_COLUMNS
    position = np.column_stack([columns["x"], columns["y"]])
    velocity = np.column_stack([columns["vx"], columns["vy"]])
    assert position.tobytes() == np.concatenate([state.position for state in STATES]).tobytes()
    assert velocity.tobytes() == np.concatenate([state.velocity for state in STATES]).tobytes()
    assert columns["time"].tolist() == [0.0, 0.0, 0.5, 0.5]
    assert columns["disk"].tolist() == [0, 1, 0, 1]
    assert columns["radius"].tolist() == [0.1, 0.3] * 2
    assert columns["mass"].tolist() == [1.0, np.inf] * 2
    assert [file.name for file in tmp_path.iterdir()] == [path.name]


@pytest.mark.parametrize("suffix", [".csv", ".npz"])
def test_a_scene_starts_from_a_file_of_one_state(tmp_path: Path, suffix: str) -> None:
    write_states(tmp_path / f"start{suffix}", SCENE, STATES[1:])
    data = {"domain": {"kind": "box", "size": [4.0, 2.0]}, "disks_file": [{"path": f"start{suffix}"}]}
    scene = scene_from_dict(data, base_dir=tmp_path)
    assert scene.disks == Disks(STATES[1].position, STATES[1].velocity, SCENE.disks.radius, SCENE.disks.mass)


@pytest.mark.parametrize("name", ["states.txt", "nowhere/states.csv"])
def test_states_that_cannot_be_written_say_why(tmp_path: Path, name: str) -> None:
    with pytest.raises(EventsimError, match="states"):
        write_states(tmp_path / name, SCENE, STATES)

"""Files that other programs of the field read."""

import importlib.util
import warnings

import numpy as np
import pytest

import eventsim as es
from eventsim.readers import read_samples
from eventsim.record.events import State
from eventsim.replay.images import images_of, unwrapped
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
        assert "Properties=species:S:1:pos:R:3:velo:R:3:radius:R:1:mass:R:1:masses:R:1" in comment
    assert {row[0] for row in frames[0][1]} == {"Ar", "Kr"}


def test_ase_reads_xyz(told, tmp_path):
    ase = pytest.importorskip("ase.io")
    scene, states = told
    write_states(tmp_path / "a.xyz", scene, states)
    frames = ase.read(tmp_path / "a.xyz", index=":", format="extxyz")
    assert len(frames) == 3
    for frame, state in zip(frames, states, strict=True):
        assert frame.positions[:, :2].tolist() == state.position.tolist()
        assert frame.arrays["velo"][:, :2].tolist() == state.velocity.tolist()
        assert frame.get_masses().tolist() == scene.disks.mass.tolist()
        assert frame.arrays["radius"].tolist() == scene.disks.radius.tolist()
        assert frame.cell.lengths()[:2].tolist() == list(scene.domain.size)
        assert frame.pbc.tolist() == [*scene.domain.periodic, False]
        assert frame.info["Time"] == state.time


def walk(until=8.0):
    """Disks that go round a torus, one of them often: states, their images, and the places that go on."""
    disks = es.Disks([[-0.5, 0.5], [1.7, 1.5], [0.5, 2.2]], [[2.0, 0.3], [-1.0, 0.8], [0.1, -1.7]], [0.2, 0.3, 0.1], [1, 2, 1])
    scene = es.Scene(disks, es.Periodic((3.0, 2.5), (-1.0, 0.0)))
    replay = Replay(es.simulate(scene, until=until, engine="reference", log=True).log)
    states = [replay.state_at(until * k / 200) for k in range(201)]
    return scene, replay, states, images_of(replay, states)


def test_places_that_go_on_make_no_jumps():
    _, replay, states, images = walk()
    going = np.array([state.position for state in unwrapped(replay, states, images)])
    steps = np.abs(np.diff(going, axis=0))
    assert steps.max() < 0.2  # the fastest disk has a speed below 5, and a step is 0.04
    assert np.abs(np.diff([state.position for state in states], axis=0)).max() > 2.0
    assert np.abs(images).max() == 2
    assert not images[0].any()
    some = [states[0], states[77], states[77], states[200]]
    assert images_of(replay, some).tolist() == images[[0, 77, 77, 200]].tolist()


def test_without_a_period_there_are_no_images(told):
    scene, states = told
    replay = Replay(es.simulate(scene, events=50, engine="reference", log=True).log)
    assert not images_of(replay, states).any()


def test_images_are_in_gsd_and_dumps(tmp_path):
    scene, replay, states, images = walk()
    going = np.array([state.position for state in unwrapped(replay, states, images)])
    kinds = [".dump", ".lammpstrj"]
    if importlib.util.find_spec("gsd"):
        kinds.append(".gsd")
    for kind in kinds:
        write_states(tmp_path / f"a{kind}", scene, states, images)
        samples = read_samples(tmp_path / f"a{kind}").placed(scene.domain.origin)
        assert samples.times.tolist() == [state.time for state in states]
        assert np.abs(samples.position - going).max() <= (1e-14 if kind != ".gsd" else 1e-5)
        assert np.abs(samples.velocity - [state.velocity for state in states]).max() <= (0.0 if kind != ".gsd" else 1e-6)
        assert np.allclose(samples.mass, scene.disks.mass)


def test_mdanalysis_and_ase_read_dumps(tmp_path):
    scene, _, states, images = walk()
    write_states(tmp_path / "a.lammpstrj", scene, states, images)
    if importlib.util.find_spec("ase"):
        import ase.io

        frames = ase.io.read(tmp_path / "a.lammpstrj", index=":", format="lammps-dump-text")
        assert len(frames) == len(states)
        assert frames[0].cell.lengths()[:2].tolist() == pytest.approx(list(scene.domain.size))
    mda = pytest.importorskip("MDAnalysis")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        frames = mda.coordinates.LAMMPS.DumpReader(str(tmp_path / "a.lammpstrj"), unwrap_images=False)
        places = np.array([frame.positions[:, :2].copy() for frame in frames])
    shifted = np.array([state.position for state in states]) - np.array(scene.domain.origin)  # it shifts the box to (0, 0)
    assert np.abs(places - shifted).max() < 1e-5  # single precision


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

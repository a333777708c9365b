"""A scene that begins where another program stopped: tables with defaults, extended XYZ, GSD, LAMMPS data and dumps."""

import importlib.util

import numpy as np
import pytest

import eventsim as es
from eventsim.errors import SceneError
from eventsim.record.events import State
from eventsim.replay.states import write_states
from eventsim.scene.files import scene_from_dict

DOMAIN = {"kind": "periodic", "size": [4.0, 3.0], "origin": [-2.0, 0.0]}
DISKS = es.Disks([[-1.5, 0.5], [1.25, 2.5]], [[0.5, -0.25], [0.0, 1.0]], [0.25, 0.5], [1.0, 3.0])
SCENE = es.Scene(DISKS, es.Periodic((4.0, 3.0), (-2.0, 0.0)))

DATA = """LAMMPS data file

2 atoms
2 atom types

-2.0 2.0 xlo xhi
0.0 3.0 ylo yhi
-0.5 0.5 zlo zhi

Masses

1 1.0
2 3.0

Atoms # atomic

2 2 1.25 2.5 0.0 0 0 0
1 1 2.5 0.5 0.0 -1 0 0

Velocities

1 0.5 -0.25 0.0
2 0.0 1.0 0.0
"""
SPHERES = """two of them

2 atoms
-2.0 2.0 xlo xhi
0.0 3.0 ylo yhi

Atoms # sphere

1 1 0.5 1.0 -1.5 0.5 0.0
2 1 1.0 2.0 1.25 2.5 0.0
"""
DUMP = """ITEM: TIMESTEP
0
ITEM: NUMBER OF ATOMS
2
ITEM: BOX BOUNDS pp pp pp
-2.0 2.0
0.0 3.0
-0.5 0.5
ITEM: ATOMS id type xs ys vx vy diameter
2 1 0.8125 0.8333333333333333 0 1 1.0
1 1 0.125 0.16666666666666666 0.5 -0.25 0.5
"""


def start(folder, name, domain=DOMAIN, **keys):
    return scene_from_dict({"domain": domain, "disks_file": [{"path": name, **keys}]}, folder)


def test_what_a_table_lacks_has_the_defaults_of_a_disk(tmp_path):
    (tmp_path / "a.csv").write_text("x,y,radius\n0,1,0.5\n-1,2,0.25\n")
    disks = start(tmp_path, "a.csv").disks
    assert (disks.velocity.tolist(), disks.mass.tolist()) == ([[0.0, 0.0]] * 2, [1.0, 1.0])
    np.savez(tmp_path / "a.npz", x=[0.0, -1.0], y=[1.0, 2.0], radius=[0.5, 0.25])
    assert start(tmp_path, "a.npz").disks == disks
    (tmp_path / "b.csv").write_text("x,y\n0,1\n-1,2\n")
    assert start(tmp_path, "b.csv", radius=0.125, mass=2.0).disks.radius.tolist() == [0.125, 0.125]
    assert start(tmp_path, "b.csv", radius=0.125, mass=2.0).disks.mass.tolist() == [2.0, 2.0]


@pytest.mark.parametrize("suffix", [".xyz", ".gsd", ".dump", ".lammpstrj", ".csv", ".npz"])
def test_what_eventsim_writes_is_a_start(tmp_path, suffix):
    if suffix == ".gsd":
        pytest.importorskip("gsd")
    write_states(tmp_path / f"a{suffix}", SCENE, [State(1.0, DISKS.position, DISKS.velocity)])
    assert start(tmp_path, f"a{suffix}") == SCENE  # all of these numbers are short


def test_a_frame_is_chosen(tmp_path):
    states = [State(float(k), DISKS.position + 0.125 * k, DISKS.velocity) for k in range(3)]
    write_states(tmp_path / "a.xyz", SCENE, states)
    assert start(tmp_path, "a.xyz", frame=-1).disks.position.tolist() == states[2].position.tolist()
    assert start(tmp_path, "a.xyz", frame=1).disks.position.tolist() == states[1].position.tolist()


def test_lammps_files_are_starts(tmp_path):
    (tmp_path / "a.data").write_text(DATA)
    assert start(tmp_path, "a.data", radius=0.25).disks == es.Disks(DISKS.position, DISKS.velocity, 0.25, DISKS.mass)
    (tmp_path / "b.lmp").write_text(SPHERES)
    spheres = start(tmp_path, "b.lmp").disks
    assert spheres.radius.tolist() == [0.25, 0.5]
    assert spheres.mass.tolist() == pytest.approx([np.pi / 48, np.pi / 3], rel=1e-15)  # density pi d^3 / 6
    (tmp_path / "c.dump").write_text(DUMP)
    dumped = start(tmp_path, "c.dump", mass=2.0).disks
    assert np.allclose(dumped.position, DISKS.position, rtol=0.0, atol=1e-15)
    assert (dumped.velocity.tolist(), dumped.radius.tolist()) == (DISKS.velocity.tolist(), DISKS.radius.tolist())
    assert dumped.mass.tolist() == [2.0, 2.0]


@pytest.mark.skipif(importlib.util.find_spec("ase") is None, reason="needs ase")
@pytest.mark.parametrize(("name", "form"), [("a.xyz", "extxyz"), ("a.data", "lammps-data")])
def test_what_ase_writes_is_a_start(tmp_path, name, form):
    import ase
    import ase.io

    places = np.column_stack([DISKS.position + np.array([2.0, 0.0]), np.zeros(2)])
    atoms = ase.Atoms("ArKr", positions=places, cell=[4.0, 3.0, 1.0], pbc=[True, True, False])
    ase.io.write(tmp_path / name, atoms, format=form)
    domain = {"kind": "periodic", "size": [4.0, 3.0]}
    disks = start(tmp_path, name, domain, radius=0.25).disks
    assert np.allclose(disks.position, places[:, :2], rtol=0.0, atol=1e-8)  # it writes eight digits


@pytest.mark.parametrize(
    ("name", "text", "keys", "said"),
    [
        ("a.csv", "x,y,radius,vx\n0,1,1,0\n", {}, "lacks vy"),
        ("a.csv", "x,y,radius\n0,1,1\n", {"frame": 0}, "a table has no frames"),
        ("a.xyz", "1\n\nAr 0 1 0\n", {}, "tells no radius: say radius"),
        ("a.xyz", "1\n\nAr 0 1 0\n1\n\nAr 0 1 0\n", {"radius": 0.5}, "holds 2 frames; one start needs one"),
        ("a.xyz", "1\n\nAr 0 1 0\n", {"radius": 0.5, "frame": 1}, "frame = 1: must be from -1 to 0"),
        ("a.xyz", "1\n\nAr 0 nan 0\n", {"radius": 0.5}, "positions must be finite"),
        ("a.data", DATA.replace("# atomic", "# bond"), {"radius": 0.5}, "Atoms of the style bond"),
        ("a.data", DATA.replace("2 atoms", "3 atoms"), {"radius": 0.5}, "2 atoms follow, and 3 are announced"),
        ("a.data", DATA.replace("2.5 0.0 0 0 0", "2.5 0.5 0 0 0"), {"radius": 0.5}, "z = 0"),
        ("a.data", DATA.replace("2 0.0 1.0 0.0", ""), {"radius": 0.5}, "Velocities are of other atoms"),
        ("a.data", DATA.replace("2 3.0\n", ""), {"radius": 0.5}, "Masses lack a type"),
        ("a.data", "nothing\n", {"radius": 0.5}, "has no section Atoms"),
        ("a.dump", DUMP.replace("xs ys", "p q"), {}, "must have x and y"),
        ("a.dump", DUMP.replace("BOUNDS pp", "BOUNDS xy xz yz pp"), {}, "the box is tilted"),
        ("a.dump", DUMP.replace("ATOMS\n2", "ATOMS\n3"), {}, "announces 3 atoms"),
        ("a.dump", DUMP.replace("ITEM: TIMESTEP", "STEP"), {}, "must be an ITEM of a dump"),
        ("a.dump", DUMP.replace("0.5 -0.25", "0.5 ?"), {}, "vy must be numbers"),
    ],
)
def test_what_is_no_start_is_told_with_the_file(tmp_path, name, text, keys, said):
    (tmp_path / name).write_text(text)
    with pytest.raises(SceneError) as raised:
        start(tmp_path, name, **keys)
    assert said in str(raised.value)
    assert name in str(raised.value)


def test_a_box_of_another_size_is_refused(tmp_path):
    pytest.importorskip("gsd")
    write_states(tmp_path / "a.gsd", SCENE, [State(1.0, DISKS.position, DISKS.velocity)])
    with pytest.raises(SceneError, match="has the box"):
        start(tmp_path, "a.gsd", {**DOMAIN, "size": [4.0, 4.0]})

"""Positions at times that others wrote: every format gives the same numbers, and what is none is told in a sentence."""

import numpy as np
import pytest

import eventsim as es
from eventsim.readers import read_samples
from eventsim.readers.contacts import read_contacts
from eventsim.replay.states import write_states
from tests.validate.judge.files import FORMATS, write

TIMES = np.array([0.0, 0.25, 1.0])
PLACES = np.random.default_rng(1).uniform(0.1, 2.9, (3, 4, 2))
SPEEDS = np.random.default_rng(2).normal(size=(3, 4, 2))
NEEDS = {"parquet": "pyarrow", "gsd": "gsd"}


@pytest.mark.parametrize("kind", FORMATS)
def test_every_format_gives_the_same_positions(kind, tmp_path):
    if kind in NEEDS:
        pytest.importorskip(NEEDS[kind])
    samples = read_samples(write(tmp_path / f"motion.{kind}", kind, TIMES, PLACES, SPEEDS)).placed((0.0, 0.0))
    assert samples.times.tolist() == TIMES.tolist()
    exact = kind != "gsd"  # single precision
    assert np.allclose(samples.position, PLACES, rtol=0.0, atol=1e-15 if exact else 4 * samples.step)
    assert (samples.step > 0.0) == (not exact)
    if kind in ("csv", "npz", "parquet"):
        assert np.array_equal(samples.velocity, SPEEDS)


@pytest.mark.parametrize("mark", [";", "\t", ", "])
def test_other_separators_and_a_byte_order_mark_are_understood(mark, tmp_path):
    rows = ["time,disk,x,y", "0,0,1.5,1", "1,0,2.5,1"]
    (tmp_path / "a.csv").write_text("\n".join(rows).replace(",", mark), encoding="utf-8-sig")
    assert read_samples(tmp_path / "a.csv").position.tolist() == [[[1.5, 1.0]], [[2.5, 1.0]]]


@pytest.mark.parametrize("suffix", [".csv", ".npz", ".xyz", ".gsd"])
def test_what_eventsim_writes_is_read_back(suffix, tmp_path):
    if suffix == ".gsd":
        pytest.importorskip("gsd")
    run = es.simulate(es.gallery("two-disks", mass_ratio=3.0), until=2.0, log=True)
    states = [run.state_at(time) for time in (0.0, 1.0, 2.0)]
    write_states(tmp_path / f"states{suffix}", run.scene, states)
    samples = read_samples(tmp_path / f"states{suffix}").placed(run.scene.domain.origin)
    assert samples.times.tolist() == [0.0, 1.0, 2.0]
    assert np.allclose(samples.position, [state.position for state in states], atol=8 * samples.step)
    assert np.allclose(samples.velocity, [state.velocity for state in states], atol=1e-6)
    assert np.allclose(samples.radius, run.scene.disks.radius, rtol=1e-6)
    assert np.allclose(samples.mass, run.scene.disks.mass, rtol=1e-6)


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("a.csv", "time,disk,x\n0,0,1\n", "positions are time, disk, x, y"),
        ("a.csv", "time,disk,x,y\n0,0,1,1\n0,1,2,2\n1,0,1,1\n", "holds 2 disks at the time 0 and 1 at 1"),
        ("a.csv", "time,disk,x,y\n0,0,1,1\n1,1,1,1\n", "must name the same 1 disks at each time"),
        ("a.csv", "time,disk,x,y\n0,0,one,1\n", "row 0: x = 'one': must be a number"),
        ("a.csv", "time,disk,x,y\n0,0,nan,1\n1,0,1,1\n", "positions must be finite"),
        ("a.csv", "x0,y0\n0,0\n1,1\n", "tells no time: say the time between frames"),
        ("a.csv", "time,disk,x,y\n0,0,1\n", "row 0 has 3 values under 4 names"),
        ("a.csv", "", "has no header"),
        ("a.csv", "time;disk;x;y\n0;0;1,5;1\n", "x = '1,5': must be a number, with a decimal point"),
        ("a.xyz", "2\ntime=0\nAr 0 0 0\n", "line 1: announces 2 disks, and 1 lines follow"),
        ("a.xyz", "1\n\nAr 0 0 0\n1\n\nAr 0 0 0\n", "frame 0 tells no time"),
        ("a.xyz", "one\n", "must be a number of disks"),
        ("a.npz", "no archive", "is not an npz file with arrays of numbers"),
        ("a.txt", "", "positions at times are read from .csv, .npz, .parquet, .xyz, .gsd"),
        ("a.gsd", "no gsd", "is not a whole gsd file"),
    ],
)
def test_what_is_no_motion_is_told_with_the_file(name, text, said, tmp_path):
    if name.endswith("gsd"):
        pytest.importorskip("gsd")
    (tmp_path / name).write_text(text)
    with pytest.raises(es.EventsimError) as raised:
        read_samples(tmp_path / name)
    assert said in str(raised.value)
    assert name in str(raised.value)


LYING = {
    "of no length": ({"time": TIMES, "x": np.array(1.0), "y": np.array(1.0)}, "columns must be equally long"),
    "of other lengths": ({"time": TIMES, "x": np.arange(5.0), "y": np.arange(5.0)}, "columns must be equally long"),
    "complex": ({"time": TIMES, "position": PLACES + 1j}, "position has values of the type complex128"),
    "dates": ({"time": TIMES.astype("M8[s]"), "position": PLACES}, "time has values of the type datetime64"),
    "truths": ({"time": TIMES, "position": PLACES > 1.0}, "position has values of the type bool"),
    "twice": ({"time": TIMES, "position": PLACES, "Position": PLACES + 1.0}, "more than one column position"),
    "two clocks": ({"time": TIMES, "t": TIMES, "position": PLACES}, "more than one column time"),
    "radii of others": ({"time": TIMES, "position": PLACES, "radius": np.ones(7)}, "radius (7,) of 4 disks"),
    "mass of nothing": ({"time": TIMES, "position": PLACES, "mass": np.full(4, np.nan)}, "mass of disk 0"),
}


@pytest.mark.parametrize(("arrays", "said"), LYING.values(), ids=LYING)
def test_columns_that_fit_nothing_are_not_guessed(arrays, said, tmp_path):
    """Imaginary parts, rows beyond the times and the first of two columns were dropped without a word."""
    np.savez(tmp_path / "a.npz", **arrays)
    with pytest.raises(es.EventsimError) as raised:
        read_samples(tmp_path / "a.npz")
    assert said in str(raised.value)
    assert "a.npz" in str(raised.value)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.csv", "time,disk,x,y\n0,0," + "1" * 200_000 + ",1\n"),
        ("a.xyz", "1\nProperties=pos:R:\u00b2 time=0\n1 2 3\n"),
        ("a.xyz", "9" * 6000 + "\n"),
    ],
)
def test_what_breaks_a_parser_is_told_in_a_line(name, text, tmp_path):
    """csv.Error, ValueError: whatever is raised over a file is one error."""
    (tmp_path / name).write_text(text, encoding="utf-8")
    with pytest.raises(es.EventsimError, match=name) as raised:
        read_samples(tmp_path / name)
    assert len(str(raised.value)) < 500


@pytest.mark.parametrize(
    ("names", "rows", "said"),
    [("id x y", "1 0 0\n1 1 1\n", "an id is there twice"), ("id x y x", "1 0 0 5\n2 1 1 5\n", "a column twice")],
)
def test_a_dump_that_tells_something_twice_is_refused(names, rows, said, tmp_path):
    head = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 3\n0 3\n0 1\n"
    (tmp_path / "a.dump").write_text(f"{head}ITEM: ATOMS {names}\n{rows}")
    with pytest.raises(es.EventsimError, match=said):
        read_samples(tmp_path / "a.dump", 0.1, 1)


@pytest.mark.parametrize(("time", "rows"), [(TIMES, 5), (TIMES + np.nan, 3)])
def test_contacts_of_columns_that_do_not_fit_are_refused(time, rows, tmp_path):
    np.savez(tmp_path / "a.npz", time=time, a=np.zeros(rows), b=np.ones(rows))
    with pytest.raises(es.EventsimError, match=r"a\.npz: (columns must be equally long|row 0: time = nan)"):
        read_contacts(tmp_path / "a.npz", 2)


def test_a_small_file_that_stands_for_more_than_the_memory_is_refused(tmp_path, monkeypatch):
    np.savez_compressed(tmp_path / "a.npz", time=TIMES, position=np.zeros((3, 10_000, 2)))
    assert read_samples(tmp_path / "a.npz").n == 10_000
    monkeypatch.setattr("eventsim.reading.MOST_HELD", 100_000)
    with pytest.raises(es.EventsimError, match=r"a\.npz: .*have more than 100000 bytes"):
        read_samples(tmp_path / "a.npz")


def test_frames_without_times_are_a_step_apart(tmp_path):
    (tmp_path / "a.xyz").write_text("1\n\nAr 0 0 0\n1\n\nAr 1 0 0\n")
    assert read_samples(tmp_path / "a.xyz", dt=0.5).times.tolist() == [0.0, 0.5]
    (tmp_path / "a.csv").write_text("frame,id,x,y\n0,0,1,2\n2,0,3,4\n")
    assert read_samples(tmp_path / "a.csv", dt=0.5).times.tolist() == [0.0, 1.0]
    with pytest.raises(es.EventsimError, match=r"lacks a column time \(or frame, .*--dt\)"):
        read_samples(tmp_path / "a.csv")


def test_contacts_are_read_from_a_table_and_from_a_log(tmp_path):
    (tmp_path / "a.csv").write_text("time,a,b,wall\n2.0,3,1,\n1.0,0,-1,left\n3,2,,top\n")
    told = read_contacts(tmp_path / "a.csv", 4)
    assert told.time.tolist() == [1.0, 2.0, 3.0]
    assert list(zip(told.a.tolist(), told.b.tolist(), told.wall, strict=True)) == [(0, -1, "left"), (1, 3, ""), (2, -1, "top")]
    run = es.simulate(es.gallery("bounce"), log=True)
    run.log.save(tmp_path / "bounce.csv")
    told = read_contacts(tmp_path / "bounce.csv", 1)
    assert told.time.tolist() == run.log.time[run.log.kinds == "wall"].tolist()
    assert set(told.wall) == {"bottom"}
    with pytest.raises(es.EventsimError, match="a = 3: names no disk"):
        read_contacts(tmp_path / "a.csv", 3)

"""Reading a log or a checkpoint opens no other file, executes nothing and believes no length that the file does not have."""

from __future__ import annotations

import io
import json
import os
import shutil
import struct
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest

import eventsim as es
from eventsim.reading import Npz
from eventsim.record.files import open_sink
from eventsim.scene import disks_file
from eventsim.scene.files import scene_from_dict
from eventsim.simulation import resume
from eventsim.sweep import load_table
from tests.record.logs import provenance, random_log, random_rows

TABLES = {
    "a file of disks": {"disks_file": [{"path": "other.npz"}]},
    "a file that never ends": {"disks_file": [{"path": "/dev/zero"}]},
    "the name of a journal's disks": {"disks_file": [{"path": "disks.npz"}]},
    "a gas": {"gas": [{"count": 5, "radius": 0.1, "seed": 1}]},
}


def rewritten(path: Path, change) -> None:
    """Replace the metadata of a .npz file by what `change` makes of them."""
    with np.load(path) as archive:
        arrays = {name: archive[name] for name in archive.files}
    data = json.loads(arrays["eventsim"].tobytes())
    change(data)
    arrays["eventsim"] = np.frombuffer(json.dumps(data).encode(), np.uint8)
    with path.open("wb") as file:
        np.savez(file, **arrays)


@pytest.mark.parametrize("tables", TABLES.values(), ids=TABLES)
def test_a_scene_in_a_log_names_no_file_and_makes_no_gas(tmp_path, tables):
    path = tmp_path / "log.csv"
    random_log(20).save(path)
    head, _, rows = path.read_text().partition("\n")
    data = json.loads(head[2:])
    del data["scene"]["disk"]
    data["scene"] |= tables
    path.write_text(f"# {json.dumps(data)}\n{rows}")
    with pytest.raises(es.LogError, match=r"(disks_file|gas): a log lists its disks"):
        es.load_log(path)


@pytest.mark.parametrize("tables", TABLES.values(), ids=TABLES)
def test_a_scene_in_a_checkpoint_names_no_file_and_makes_no_gas(tmp_path, tables):
    path = tmp_path / "run.checkpoint"
    es.simulate(es.gallery("two-disks"), events=5, checkpoint=path)
    rewritten(path, lambda data: data["provenance"]["scene"].update(tables))
    with pytest.raises(es.CheckpointError, match="a log lists its disks"):
        resume(path)


def test_the_journal_of_a_log_reads_its_own_disks_and_no_others(tmp_path):
    sink = open_sink(tmp_path / "log.npz", provenance())
    sink.write(random_rows(10))
    sink.leave()
    assert len(es.load_log(sink.part)) == 10
    metadata = sink.part / "eventsim"
    shutil.copy(sink.part / "disks.npz", tmp_path / "other.npz")
    metadata.write_text(metadata.read_text().replace("disks.npz", "../other.npz"))
    with pytest.raises(es.LogError, match="disks_file: a log lists its disks"):
        es.load_log(sink.part)


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such files")
@pytest.mark.parametrize("name", ["/dev/zero", "pipe.csv", "pipe.npz"])
def test_disks_come_from_ordinary_files_only(tmp_path, name):
    os.mkfifo(tmp_path / "pipe.csv")
    os.mkfifo(tmp_path / "pipe.npz")
    with pytest.raises(es.SceneError, match="not an ordinary file"):
        scene_from_dict({"domain": {"kind": "open"}, "disks_file": [{"path": name}]}, tmp_path)


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such files")
@pytest.mark.parametrize("name", ["pipe.toml", "pipe.json"])
def test_scenes_come_from_ordinary_files_only(tmp_path, name):
    """A pipe that nobody writes to was waited for."""
    os.mkfifo(tmp_path / name)
    with pytest.raises(es.SceneError, match="not an ordinary file"):
        es.load_scene(tmp_path / name)


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such files")
def test_tables_come_from_ordinary_files_only(tmp_path):
    os.mkfifo(tmp_path / "table.csv")
    with pytest.raises(es.EventsimError, match="not an ordinary file"):
        load_table(tmp_path / "table.csv")


def test_a_file_of_disks_beyond_all_measure_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(disks_file, "MOST_BYTES", 1000)
    (tmp_path / "large.csv").write_text("x,y,vx,vy,radius,mass\n" + "0,0,0,0,0,1\n" * 100)
    with pytest.raises(es.SceneError, match=r"large\.csv: has 1222 bytes; at most 1000 are read"):
        disks_file.read_disks_file(tmp_path / "large.csv")


def claiming(name: str, claimed: int, data: bytes, packed: bool) -> bytes:
    """An .npz with one array that claims so many numbers, in its header and, where it is packed, in the archive too."""
    head = io.BytesIO()
    np.lib.format.write_array_header_1_0(head, {"descr": "|u1", "fortran_order": False, "shape": (claimed,)})
    target = io.BytesIO()
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED if packed else zipfile.ZIP_STORED) as archive:
        archive.writestr(f"{name}.npy", head.getvalue() + data)
    whole = bytearray(target.getvalue())
    if packed:  # the size in the directory of the archive
        struct.pack_into("<I", whole, whole.index(b"PK\x01\x02") + 24, len(head.getvalue()) + claimed)
    return bytes(whole)


@pytest.mark.parametrize("packed", [False, True])
@pytest.mark.parametrize("name", ["log.npz", "run.checkpoint"])
def test_no_length_is_believed_that_the_file_does_not_have(tmp_path, name, packed):
    (tmp_path / name).write_bytes(claiming("eventsim", 4_000_000_000, b"{}", packed))
    with pytest.raises(es.EventsimError, match=name):
        (es.load_log if name.endswith("npz") else resume)(tmp_path / name)


def test_an_array_that_claims_more_numbers_than_it_has_is_refused_before_any_memory_is_taken(tmp_path):
    (tmp_path / "disks.npz").write_bytes(claiming("x", 4_000_000_000, b"{}", False))
    with (tmp_path / "disks.npz").open("rb") as file, pytest.raises(ValueError, match="not as long as it says"):
        Npz(file).read("x")


def test_an_array_whose_name_was_damaged_is_not_taken_for_a_missing_one(tmp_path):
    """Disks got the mass that they have where a file tells none."""
    path = tmp_path / "disks.npz"
    disks_file.write_disks_file(path, es.gallery("two-disks").disks)
    whole = path.read_bytes()
    place = whole.rindex(b"mass.npy")  # in the directory of the archive
    path.write_bytes(whole[:place] + b"masr.npy" + whole[place + 8 :])
    with pytest.raises(es.SceneError, match=r"disks\.npz: is not an npz file"):
        disks_file.read_disks_file(path)


@pytest.mark.parametrize("dtype", [complex, "M8[s]", bool])
def test_what_is_no_number_is_not_taken_for_one(tmp_path, dtype):
    """The imaginary part of a place was dropped."""
    random_log(5).save(tmp_path / "log.npz")
    for name, column, read in (("log.npz", "xa", es.load_log), ("disks.npz", "x", disks_file.read_disks_file)):
        if name == "disks.npz":
            disks_file.write_disks_file(tmp_path / name, es.gallery("two-disks").disks)
        with np.load(tmp_path / name) as archive:
            arrays = {key: archive[key] for key in archive.files}
        np.savez(tmp_path / name, **(arrays | {column: np.zeros(len(arrays[column])).astype(dtype)}))
        with pytest.raises(es.EventsimError, match="are no numbers"):
            read(tmp_path / name)


def test_an_object_in_a_log_is_not_unpickled(tmp_path):
    random_log(5).save(tmp_path / "log.npz")
    with np.load(tmp_path / "log.npz") as archive:
        arrays = {name: archive[name] for name in archive.files}
    arrays["xa"] = np.array([print] * 5, dtype=object)
    np.savez(tmp_path / "log.npz", **arrays)
    with pytest.raises(es.LogError, match="pickled objects"):
        es.load_log(tmp_path / "log.npz")

"""Format 2 of logs: the scene is vouched for, and what was changed since is refused; format 1 is read with a note."""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import eventsim as es
from eventsim.errors import LogError, LogWarning
from eventsim.record.digest import CHUNK, Digester, StoredDigester, digest_of
from eventsim.record.events import COLUMNS
from eventsim.record.files import open_log
from eventsim.record.provenance import BITS
from eventsim.replay.audit import audit
from eventsim.replay.log import stream_log
from eventsim.replay.replay import Replay
from eventsim.suffixes import LOGS
from tests.record.logs import random_rows


def table() -> es.Scene:
    """Three disks and a wall on the open plane."""
    disks = es.Disks([(1.0, 1.0), (4.0, 1.25), (6.0, 4.0)], [(1.0, 0.0), (0.0, 0.0), (-0.5, -1.0)], 0.5, [1.0, 2.0, 1.0])
    return es.Scene(disks, es.Open(), walls=(es.Segment((-1.0, -2.0), (8.0, -2.0), name="floor"),), name="table")


def rewritten(path: Path, change: Callable[[dict[str, Any]], None]) -> None:
    """Change the metadata of a log file, and leave its rows."""
    if path.suffix == ".npz":
        with np.load(path) as arrays:
            kept = dict(arrays)
        data = json.loads(kept["eventsim"].tobytes())
        change(data)
        kept["eventsim"] = np.frombuffer(json.dumps(data).encode(), np.uint8)
        np.savez(path, **kept)
    elif path.suffix == ".parquet":
        pq = pytest.importorskip("pyarrow.parquet")
        found = pq.read_table(path)
        data = json.loads(found.schema.metadata[b"eventsim"])
        change(data)
        pq.write_table(found.replace_schema_metadata({"eventsim": json.dumps(data)}), path)
    else:
        head, rows = path.read_text().split("\n", 1)
        prefix = "# " if path.suffix == ".csv" else ""
        data = json.loads(head.removeprefix(prefix))
        change(data)
        path.write_text(f"{prefix}{json.dumps(data)}\n{rows}")


EDITS: dict[str, Callable[[dict[str, Any]], Any]] = {
    "mass": lambda data: data["scene"]["disk"][1].update(mass=2.5),
    "radius": lambda data: data["scene"]["disk"][2].update(radius=0.25),
    "start": lambda data: data["scene"]["disk"][2].update(position=[6.5, 4.0]),
    "wall": lambda data: data["scene"]["wall"][0].update(end=[9.0, -2.0]),
    "corner": lambda data: data.update(corner=[1.0, 0.0]),
    "clock": lambda data: data.update(epoch_length=2.0 * data["epoch_length"]),
}


OTHER_EDITS: dict[str, Callable[[dict[str, Any]], Any]] = {
    "reason": lambda data: data["ending"].update(reason="quiet"),
    "end": lambda data: data["ending"].update(remainder=data["ending"]["remainder"] / 2.0),
    "version": lambda data: data.update(version="0.9.0"),
    "kicks": lambda data: data.update(kicks=[[1, 0.5, 0.0]]),
}


@pytest.mark.parametrize("suffix", LOGS)
@pytest.mark.parametrize("compact", [False, True])
def test_a_log_whose_scene_was_changed_is_refused_by_every_reader(tmp_path: Path, suffix: str, compact: bool) -> None:
    whole = tmp_path / f"whole{suffix}"
    es.simulate(table(), until=6.0, engine="reference", log=whole, compact=compact)
    assert audit(whole).rows == 2
    path = tmp_path / f"log{suffix}"
    for edit in EDITS.values():
        path.write_bytes(whole.read_bytes())
        rewritten(path, edit)
        for read in (es.load_log, stream_log, open_log, audit):
            with pytest.raises(LogError, match=r"log\..*its scene is not the one of its run"):
                read(path)
    for edit in OTHER_EDITS.values():
        path.write_bytes(whole.read_bytes())
        rewritten(path, edit)
        with pytest.raises(LogError, match=r"log\..*its metadata are not those that its run wrote"):
            es.load_log(path)
    path.write_bytes(whole.read_bytes())
    rewritten(path, lambda data: data.update(command="another word"))
    assert es.load_log(path).digest() == es.load_log(whole).digest()


@pytest.mark.parametrize("suffix", [".csv.part", ".npz.part"])
def test_a_log_that_grows_vouches_for_its_scene(tmp_path: Path, suffix: str) -> None:
    from eventsim.record.files import open_sink

    log = es.simulate(table(), until=6.0, engine="reference", log=True).log
    sink = open_sink(tmp_path / f"log{suffix.removesuffix('.part')}", log.provenance)
    sink.write(log.rows)
    sink.leave()
    part = tmp_path / f"log{suffix}"
    assert es.load_log(part).scene == log.scene
    head = part / "eventsim" if part.is_dir() else part
    head.write_bytes(head.read_bytes().replace(b'"name": "table"', b'"name": "chair"', 1))
    with pytest.raises(LogError, match="its scene is not the one of its run"):
        es.load_log(part)


@pytest.mark.parametrize("suffix", LOGS)
def test_a_log_vouches_for_the_species_of_its_disks(tmp_path: Path, suffix: str) -> None:
    path, scene = tmp_path / f"log{suffix}", table()
    named = replace(scene, disks=replace(scene.disks, species=["a", "b", "a"]))
    es.simulate(named, until=6.0, engine="reference", log=path)
    assert es.load_log(path).scene == named
    rewritten(path, lambda data: data["scene"]["disk"][1].update(species="c"))
    with pytest.raises(LogError, match="its scene is not the one of its run"):
        es.load_log(path)


@pytest.mark.parametrize("name", COLUMNS)
def test_every_column_that_a_file_has_is_vouched_for(name: str) -> None:
    one, other = random_rows(5), random_rows(5)
    other[name][3] = other[name][3] + 1 if np.isfinite(other[name][3]) and abs(other[name][3]) < 1e9 else 0.5
    sums = []
    for rows in (one, other):
        digester = StoredDigester(COLUMNS)
        digester.update(rows)
        sums.append(digester.hexdigest())
    assert sums[0] != sums[1]


def test_a_digest_goes_on_from_where_it_had_come() -> None:
    rows = random_rows(CHUNK + 3000)
    for cut in (0, 1, CHUNK - 1, CHUNK, CHUNK + 2049):
        begun, later = Digester(), Digester()
        begun.update(rows[:cut])
        later.go_on(begun.progress())
        later.update(rows[cut:])
        assert later.hexdigest() == digest_of(rows)


def test_a_log_of_format_1_is_read_with_a_note(tmp_path: Path) -> None:
    """Its places are counted from the least starting coordinates, wherever the corner is now."""
    path, scene = tmp_path / "log.csv", table()
    es.simulate(scene, until=6.0, engine="reference", log=path)
    log = es.load_log(path)
    assert log.provenance.corner == (0.0, 0.0)
    rows = log.rows.copy()
    for name in ("xa", "ya", "xb", "yb"):
        rows[name] -= 1.0
    es.EventLog(log.provenance, rows).save(path)

    def aged(data: dict[str, Any]) -> None:
        data["format"] = 1
        for key in ("bits", "corner", "scene_digest", "metadata_digest"):
            del data[key]
        data["ending"]["digest"] = "0" * 64
        del data["ending"]["stored"]

    rewritten(path, aged)
    with pytest.warns(LogWarning, match="format 1 does not vouch for its scene"):
        old = es.load_log(path)
    assert old.provenance.bits == 1
    assert old.provenance.corner == (1.0, 1.0)
    for time in (0.5, 3.0, 6.0):
        assert Replay(old).state_at(time).position == pytest.approx(Replay(log).state_at(time).position, abs=1e-14)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LogWarning)
        assert any("format 1" in note for note in audit(path).notes)


def test_a_format_that_nobody_knows_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    es.simulate(table(), until=2.0, engine="reference", log=path)
    rewritten(path, lambda data: data.update(format=3))
    with pytest.raises(LogError, match="log format 3; this version of eventsim reads the formats 1 and 2"):
        es.load_log(path)


def test_a_compact_log_of_other_rules_says_so() -> None:
    log = es.simulate(table(), until=6.0, engine="reference", log=True).log
    rows = log.rows.copy()
    rows["remainder"][1] *= 1.0 + 1e-15
    provenance = replace(log.provenance, compact=True, bits=BITS + 1, version="9.9")
    with pytest.raises(LogError, match=rf"made by version 9.9 under other rules \(bits {BITS + 1}, here {BITS}\)"):
        es.EventLog(provenance, rows).expand()

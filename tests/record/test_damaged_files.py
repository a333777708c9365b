"""Files that are no logs, or no longer: cut off, changed, misnamed; each is told."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from eventsim.errors import LogError, LogWarning
from eventsim.record.files import open_sink
from eventsim.run import load_log
from eventsim.scene.gallery import gallery
from eventsim.simulation import simulate
from eventsim.suffixes import LOGS
from tests.record.logs import provenance, random_log


@pytest.mark.parametrize("suffix", LOGS)
@pytest.mark.parametrize(
    "content", [b"", b"hello\n", b"\x00\xff\xfe\x80" * 40, b"# {}\n", b"{}\n", b"PK\x03\x04", b"PAR1"]
)
def test_what_is_no_log_is_refused_with_a_sentence(tmp_path: Path, suffix: str, content: bytes) -> None:
    path = tmp_path / f"log{suffix}"
    path.write_bytes(content)
    with pytest.raises(LogError, match=r"log\."):
        load_log(path)


def test_a_changed_number_in_a_log_is_told(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    run = simulate(gallery("two-disks"), log=path)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ending = load_log(path).provenance.ending
    assert ending is not None
    assert ending.digest == run.digest
    path.write_text(path.read_text().replace(",pair,0,1,,4.0,", ",pair,0,1,,4.25,", 1))
    with pytest.warns(LogWarning, match=r"log\.csv is not what its run wrote"):
        load_log(path)


@pytest.mark.filterwarnings("ignore::eventsim.errors.LogWarning")
def test_a_changed_number_in_a_compact_log_does_not_replay(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    simulate(gallery("two-disks"), log=path, compact=True)
    path.write_text(path.read_text().replace(",0,22.5\n", ",0,22.25\n", 1))
    with pytest.raises(LogError, match="does not fit its scene at event 7"):
        load_log(path).expand()


@pytest.mark.parametrize("suffix", LOGS)
@pytest.mark.parametrize("named", LOGS)
def test_a_log_under_another_suffix_is_told_by_its_looks(tmp_path: Path, suffix: str, named: str) -> None:
    random_log(20).save(tmp_path / f"log{suffix}")
    (tmp_path / f"log{suffix}").rename(tmp_path / f"other{named}")
    if suffix == named:
        assert len(load_log(tmp_path / f"other{named}")) == 20
        return
    with pytest.raises(LogError, match=f"other{named}: not a {named} file; it looks like a {suffix} file"):
        load_log(tmp_path / f"other{named}")


@pytest.mark.parametrize("suffix", LOGS)
@pytest.mark.parametrize("share", [0.05, 0.5, 0.9, 0.999])
def test_a_log_that_was_cut_off_is_refused(tmp_path: Path, suffix: str, share: float) -> None:
    random_log(200).save(tmp_path / f"log{suffix}")
    whole = (tmp_path / f"log{suffix}").read_bytes()
    (tmp_path / f"log{suffix}").write_bytes(whole[: int(share * len(whole))])
    with pytest.raises(LogError):
        load_log(tmp_path / f"log{suffix}")


def test_a_log_cut_at_the_end_of_a_line_is_refused(tmp_path: Path) -> None:
    random_log(20).save(tmp_path / "log.csv")
    lines = (tmp_path / "log.csv").read_bytes().splitlines(keepends=True)
    (tmp_path / "log.csv").write_bytes(b"".join(lines[:-3]))
    with pytest.raises(LogError, match="holds 17 rows where 20 were written"):
        load_log(tmp_path / "log.csv")


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("pair", "pear", "line .*kind 'pear' is unknown"),
        ("pair,0,3", "pair,0,9", "column b names no disk"),
        ("pair,0,3", "pair,0.5,3", "line "),
        ("pair,0,3", "pair,0", "line .*values were expected"),
        ("pair,0,3", "pair,0,99999999999", "line .*too large"),
        ("\n0,", "\n1,", "row 0: events are not numbered"),
        ("event,time", "event,tim", "columns are not those"),
        ('"format": 2', '"format": 3', "format 3; this version of eventsim reads the formats 1 and 2"),
        ('"epoch_length": 1.0', '"epoch_length": 0.3', "not a power of two"),
        ('"radius": 1', '"radius": -1', "scene inside the log"),
    ],
)
def test_a_damaged_log_is_refused_with_the_place(tmp_path: Path, old: str, new: str, words: str) -> None:
    random_log(200).save(tmp_path / "log.csv")
    text = (tmp_path / "log.csv").read_text()
    assert old in text
    (tmp_path / "log.csv").write_text(text.replace(old, new, 1))
    with pytest.raises(LogError, match=words):
        load_log(tmp_path / "log.csv")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda line: "[" + line + "]", "one object was expected"),
        (lambda line: line + ", " + line, "one object was expected"),
        (lambda line: re.sub(r'"a": \d', '"a": "x"', line), "a whole number was expected"),
        (lambda line: line.replace('"a": ', '"b": '), "the key 'a' is missing"),
    ],
)
def test_a_line_that_is_no_row_is_refused_with_its_number(tmp_path: Path, change: Callable[[str], str], words: str) -> None:
    path = tmp_path / "log.jsonl"
    random_log(20).save(path)
    lines = path.read_text().splitlines()
    lines[5] = change(lines[5])
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(LogError, match=rf"log.jsonl: line 6: not a row of an event log \({words}"):
        load_log(path)


def test_tables_that_are_no_logs_are_refused_with_what_they_lack(tmp_path: Path) -> None:
    log = random_log(20)
    log.save(tmp_path / "log.npz")
    with np.load(tmp_path / "log.npz") as arrays:
        kept = dict(arrays)
    np.savez(tmp_path / "short.npz", **{**kept, "a": kept["a"][:-1]})
    with pytest.raises(LogError, match=r"short.npz: not an event log: its columns differ in length"):
        load_log(tmp_path / "short.npz")
    del kept["eventsim"]
    np.savez(tmp_path / "other.npz", **kept)
    with pytest.raises(LogError, match=r"other.npz: not an event log: there is no array named eventsim"):
        load_log(tmp_path / "other.npz")
    parquet = pytest.importorskip("eventsim.record.files.parquet")
    parquet.write_plain_table(tmp_path / "other.parquet", {"a": [1, 2, 3], "b": [1, "x", None]}, {"made": "by hand"})
    assert parquet.pq.read_table(tmp_path / "other.parquet").to_pydict() == {"a": [1, 2, 3], "b": ["1", "x", None]}
    with pytest.raises(LogError, match=r"other.parquet: not an event log: its metadata have no key eventsim"):
        load_log(tmp_path / "other.parquet")


def test_what_others_wrote_is_not_replaced_by_a_log(tmp_path: Path) -> None:
    (tmp_path / "mine.csv").write_text("a,b\n1,2\n")
    with pytest.raises(LogError, match=r"mine.csv: holds no event log that a new one may replace; name another file"):
        open_sink(tmp_path / "mine.csv", provenance())
    assert (tmp_path / "mine.csv").read_text() == "a,b\n1,2\n"
    with pytest.raises(LogError, match=r"ramp.toml is a scene; eventsim run .*ramp.toml --log .*ramp.csv writes its log"):
        load_log(tmp_path / "ramp.toml")


@pytest.mark.parametrize("name", ["log", "log.txt", "log.csv.gz"])
def test_an_unknown_suffix_names_the_known_ones(tmp_path: Path, name: str) -> None:
    with pytest.raises(LogError, match=r"\.csv, \.jsonl, \.npz, \.parquet"):
        open_sink(tmp_path / name, provenance())
    with pytest.raises(LogError, match=r"\.csv, \.jsonl, \.npz, \.parquet"):
        load_log(tmp_path / name)


def test_a_missing_file_or_directory_is_named(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="no such file"):
        load_log(tmp_path / "log.csv")
    with pytest.raises(LogError, match="does not exist"):
        open_sink(tmp_path / "nowhere" / "log.csv", provenance())
    (tmp_path / "folder.csv").mkdir()
    with pytest.raises(LogError, match="directory"):
        open_sink(tmp_path / "folder.csv", provenance())
    with pytest.raises(LogError, match="not a file"):
        load_log(tmp_path / "folder.csv")

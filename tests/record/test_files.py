"""Files carry every bit of a log, and refuse what is no log with a sentence."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas
import pyarrow.parquet
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eventsim.errors import LogError, LogWarning
from eventsim.record import Ending, EventLog, load_log
from eventsim.record.events import COLUMNS, COMPACT_COLUMNS, ROW
from eventsim.record.files import SUFFIXES, Mark, continued_sink, open_sink, rows_so_far
from eventsim.scene.gallery import gallery
from eventsim.simulation import simulate
from tests.record.logs import FLOATS, any_float, provenance, random_log, random_rows, scene

TEXT = (".csv", ".jsonl")


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("count", [0, 1, 500])
def test_a_log_comes_back_from_its_file_bit_for_bit(tmp_path: Path, suffix: str, count: int) -> None:
    log = random_log(count)
    log.save(tmp_path / f"log{suffix}")
    again = load_log(tmp_path / f"log{suffix}")
    assert again.rows.tobytes() == log.rows.tobytes()
    assert again.provenance == log.provenance
    assert [path.name for path in tmp_path.iterdir()] == [f"log{suffix}"]


def test_the_digest_survives_the_way_through_all_formats(tmp_path: Path) -> None:
    log = random_log(300)
    digests = {log.digest()}
    for suffix in (".csv", ".jsonl", ".npz", ".parquet", ".csv"):
        log.save(tmp_path / f"log{suffix}")
        log = load_log(tmp_path / f"log{suffix}")
        digests.add(log.digest())
    assert len(digests) == 1


@pytest.mark.parametrize("suffix", SUFFIXES)
@settings(max_examples=25, deadline=None)
@given(values=st.lists(st.tuples(any_float, any_float, st.floats(0, 1e300)), min_size=1, max_size=5))
def test_any_float_round_trips(
    tmp_path_factory: pytest.TempPathFactory, suffix: str, values: list[tuple[float, float, float]]
) -> None:
    rows = random_rows(len(values))
    for row, (place, speed, remainder) in zip(rows, values, strict=True):
        row["xa"], row["vya"], row["remainder"], row["time"] = place, speed, remainder, place
    path = tmp_path_factory.mktemp("log") / f"log{suffix}"
    EventLog(provenance(), rows).save(path)
    assert load_log(path).rows.tobytes() == rows.tobytes()


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_the_blocks_of_a_stream_do_not_show_in_the_file(tmp_path: Path, suffix: str) -> None:
    rows = random_rows(100)
    for name, cuts in (("one", [100]), ("many", [0, 1, 7, 8, 60, 100])):
        sink = open_sink(tmp_path / f"{name}{suffix}", provenance())
        for first, last in zip([0, *cuts], [*cuts, 100], strict=True):
            sink.write(rows[first:last])
        sink.close(provenance().ending)
    assert (tmp_path / f"one{suffix}").read_bytes() == (tmp_path / f"many{suffix}").read_bytes()


@pytest.mark.skipif(sys.platform == "win32", reason="there the second run fails by itself")
@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_second_run_that_writes_the_same_log_is_refused(tmp_path: Path, suffix: str) -> None:
    log = random_log(20)
    path = tmp_path / f"log{suffix}"
    first = open_sink(path, provenance())
    first.write(log.rows)
    with pytest.raises(LogError, match=f"log{suffix}.part: another run is writing this log"):
        open_sink(path, provenance())
    first.close()
    assert load_log(path).rows.tobytes() == log.rows.tobytes()
    left = open_sink(path, provenance())
    left.write(log.rows)
    left.leave()  # what a run leaves is nobody's
    log.save(path)
    assert [file.name for file in tmp_path.iterdir()] == [path.name]


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_file_appears_only_when_it_is_whole(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"log{suffix}"
    path.write_text("what was there before")
    sink = open_sink(path, provenance())
    sink.write(random_rows(10))
    assert path.read_text() == "what was there before"
    sink.abandon()
    assert [file.name for file in tmp_path.iterdir()] == [path.name]
    assert path.read_text() == "what was there before"


@pytest.mark.parametrize("suffix", TEXT)
def test_a_growing_text_log_can_be_read_up_to_its_last_whole_line(tmp_path: Path, suffix: str) -> None:
    rows = random_rows(10)
    sink = open_sink(tmp_path / f"log{suffix}", provenance())
    sink.write(rows)
    part = tmp_path / f"log{suffix}.part"
    assert load_log(part).rows.tobytes() == rows.tobytes()
    cut = tmp_path / f"cut{suffix}.part"
    cut.write_bytes(part.read_bytes()[:-20])
    assert load_log(cut).rows.tobytes() == rows[:9].tobytes()
    assert load_log(cut).provenance.ending is None
    sink.abandon()


@pytest.mark.parametrize("suffix", [".npz", ".parquet"])
def test_a_growing_binary_log_can_be_read_up_to_its_last_whole_row(tmp_path: Path, suffix: str) -> None:
    rows = random_rows(10)
    sink = open_sink(tmp_path / f"log{suffix}", provenance())
    sink.write(rows)
    part = tmp_path / f"log{suffix}.part"
    assert load_log(part).rows.tobytes() == rows.tobytes()
    with (part / "remainder").open("r+b") as column:
        column.truncate(9 * 8 - 3)
    assert load_log(part).rows.tobytes() == rows[:8].tobytes()
    assert load_log(part).provenance.ending is None
    with pytest.raises(LogError, match=r"no such file; .*\.part is there"):
        load_log(tmp_path / f"log{suffix}")
    sink.abandon()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("compact", [False, True])
@pytest.mark.parametrize("ended", ["killed", "closed"])
@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_log_that_is_continued_is_the_same_file_as_one_written_at_once(
    tmp_path: Path, suffix: str, ended: str, compact: bool
) -> None:
    log = random_log(300)
    log.save(tmp_path / f"once{suffix}", compact=compact)
    whole = load_log(tmp_path / f"once{suffix}")
    path = tmp_path / f"log{suffix}"
    kept = replace(log.provenance, kicks=(), ending=None, rows=None)
    for rows in (0, 1, 117, 300):
        written = log.rows[: max(rows, 200)]
        sink = open_sink(path, replace(log.provenance, kicks=()), compact)
        sink.write(written[:rows])
        mark = sink.sync()
        sink.write(written[rows:])
        if ended == "killed":
            sink.leave()
        else:
            sink.close(Ending(1, 0.5, "interrupted"))
        sink = continued_sink(path, kept, compact, mark)
        if not compact:  # random rows do not follow from their scene, so they cannot be expanded
            assert b"".join(block.tobytes() for block in rows_so_far(sink)) == log.rows[:rows].tobytes()
        sink.write(log.rows[rows:])
        sink.close(whole.provenance.ending)
        assert load_log(path).rows.tobytes() == whole.rows.tobytes()
        assert load_log(path).provenance == whole.provenance
        if suffix not in TEXT:  # there the room for so many kicks was made at another time
            assert path.read_bytes() == (tmp_path / f"once{suffix}").read_bytes()


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_what_is_not_the_log_of_a_run_is_not_continued(tmp_path: Path, suffix: str) -> None:
    path, log = tmp_path / f"log{suffix}", random_log(20)
    with pytest.raises(LogError, match="neither this log nor"):
        continued_sink(path, log.provenance, False, Mark(5, ()))
    log.save(path)
    with pytest.raises(LogError, match="holds 20 rows of 21"):
        continued_sink(path, log.provenance, False, Mark(21, ()))
    with pytest.raises(LogError, match="not the log of the run"):
        continued_sink(path, provenance(scene(5)), False, Mark(5, ()))
    sink = open_sink(path, log.provenance)
    sink.write(log.rows[:4])
    sink.leave()
    with pytest.raises(LogError, match=r"holds 4 .*holds 20 rows of 21"):
        continued_sink(path, log.provenance, False, Mark(21, ()))
    assert load_log(path).rows.tobytes() == log.rows.tobytes()


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_vanished_directory_is_noticed_with_the_next_rows(tmp_path: Path, suffix: str) -> None:
    place = tmp_path / "place"
    place.mkdir()
    sink = open_sink(place / f"log{suffix}", provenance())
    sink.write(random_rows(10))
    shutil.rmtree(place)
    with pytest.raises(LogError, match="directory has vanished"):
        sink.write(random_rows(10))
    sink.leave()


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_compact_log_keeps_what_cannot_be_computed(tmp_path: Path, suffix: str) -> None:
    log = random_log(200)
    log.save(tmp_path / f"log{suffix}", compact=True)
    again = load_log(tmp_path / f"log{suffix}")
    assert again.compact
    assert again.provenance.kicks == log.provenance.kicks
    assert len(again.provenance.kicks) > 50  # more than the blanks of a text file hold
    for name in COLUMNS:
        if name in COMPACT_COLUMNS:
            assert np.array_equal(again.rows[name], log.rows[name])
    again.save(tmp_path / f"again{suffix}", compact=True)
    assert load_log(tmp_path / f"again{suffix}").provenance == again.provenance


def test_a_csv_log_is_a_table_for_pandas(tmp_path: Path) -> None:
    log = random_log(50)
    log.save(tmp_path / "log.csv")
    table = pandas.read_csv(tmp_path / "log.csv", comment="#")
    assert tuple(table.columns) == COLUMNS
    assert table["kind"].tolist() == log.kinds.tolist()
    assert table["wall"].fillna("").tolist() == log.wall_name.tolist()
    assert np.array_equal(table["event"], log.event)


@pytest.mark.parametrize("name", ["a#b", 'a "b"', "slope"])
def test_odd_names_of_walls_come_back(tmp_path: Path, name: str) -> None:
    rows = random_rows(20)
    names = (name, "right", "bottom", "top")
    for suffix in SUFFIXES:
        EventLog(provenance(wall_names=names), rows).save(tmp_path / f"log{suffix}")
        again = load_log(tmp_path / f"log{suffix}")
        assert np.array_equal(again.wall, rows["wall"])
        assert again.provenance.wall_names == names
    table = pandas.read_csv(tmp_path / "log.csv", comment="#")
    assert name in table["wall"].tolist()


def test_jsonl_begins_with_scene_and_format_and_has_one_object_per_row(tmp_path: Path) -> None:
    log = random_log(20)
    log.save(tmp_path / "log.jsonl")
    head, *rows = (json.loads(line) for line in (tmp_path / "log.jsonl").read_text().splitlines())
    assert list(head)[:2] == ["scene", "format"]
    assert head["format"] == 1
    assert [row["event"] for row in rows] == list(range(20))
    assert all(tuple(row) == COLUMNS for row in rows)
    assert [row["xb"] is None for row in rows] == np.isnan(log.xb).tolist()


def test_parquet_and_npz_hold_the_columns_by_their_names(tmp_path: Path) -> None:
    log = random_log(20)
    log.save(tmp_path / "log.parquet")
    log.save(tmp_path / "log.npz")
    table = pandas.read_parquet(tmp_path / "log.parquet")
    assert tuple(table.columns) == COLUMNS
    assert table["kind"].tolist() == log.kinds.tolist()
    assert b"eventsim" in pyarrow.parquet.read_schema(tmp_path / "log.parquet").metadata
    with np.load(tmp_path / "log.npz", allow_pickle=False) as arrays:
        assert set(arrays) == {"eventsim", *COLUMNS}
        assert arrays["wall"].tolist() == log.wall_name.tolist()
        assert all(arrays[name].dtype == ROW[name] for name in FLOATS)


@pytest.mark.parametrize("suffix", SUFFIXES)
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


def test_a_changed_number_in_a_compact_log_does_not_replay(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    simulate(gallery("two-disks"), log=path, compact=True)
    path.write_text(path.read_text().replace(",0,22.5\n", ",0,22.25\n", 1))
    with pytest.raises(LogError, match="does not fit its scene at event 7"):
        load_log(path).expand()


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("named", SUFFIXES)
def test_a_log_under_another_suffix_is_told_by_its_looks(tmp_path: Path, suffix: str, named: str) -> None:
    random_log(20).save(tmp_path / f"log{suffix}")
    (tmp_path / f"log{suffix}").rename(tmp_path / f"other{named}")
    if suffix == named:
        assert len(load_log(tmp_path / f"other{named}")) == 20
        return
    with pytest.raises(LogError, match=f"other{named}: not a {named} file; it looks like a {suffix} file"):
        load_log(tmp_path / f"other{named}")


@pytest.mark.parametrize("suffix", SUFFIXES)
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
        ("pair,0,3", "pair,0,99999999999", "line .*too large"),
        ("\n0,", "\n1,", "row 0: events are not numbered"),
        ("event,time", "event,tim", "columns are not those"),
        ('"format": 1', '"format": 2', "format 2; this version of eventsim reads format 1"),
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


def test_without_pyarrow_parquet_says_what_to_install() -> None:
    script = (
        "import sys; sys.modules['pyarrow'] = None\n"
        "from eventsim.record import load_log\nfrom eventsim.errors import LogError\n"
        "try:\n    load_log(sys.argv[1])\nexcept LogError as error:\n    print(error)\n"
    )
    done = subprocess.run([sys.executable, "-c", script, __file__], capture_output=True, text=True, check=False)
    assert "use one of" in done.stdout
    script = script.replace("load_log(sys.argv[1])", "import eventsim.record.files.parquet")
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert done.stdout.strip() == "parquet logs need pyarrow: install eventsim-disks[parquet]"


@pytest.mark.parametrize("suffix", [".csv", ".jsonl"])
def test_a_byte_order_mark_and_other_line_ends_do_no_harm(tmp_path, suffix):
    import eventsim as es

    path = tmp_path / f"log{suffix}"
    run = es.simulate(es.gallery("two-disks"), log=path)
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes().replace(b"\n", b"\r\n"))
    assert es.load_log(path).digest() == run.digest

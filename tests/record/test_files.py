"""Files carry every bit of a log, and refuse what is no log with a sentence."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas
import pyarrow.parquet
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eventsim.errors import LogError
from eventsim.record.events import COLUMNS, COMPACT_COLUMNS, ROW
from eventsim.record.files import csv, open_sink
from eventsim.replay.log import EventLog
from eventsim.run import load_log
from eventsim.suffixes import LOGS
from tests.record.logs import FLOATS, any_float, provenance, random_log, random_rows


@pytest.mark.parametrize("suffix", LOGS)
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


@pytest.mark.parametrize("suffix", LOGS)
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


@pytest.mark.parametrize("suffix", LOGS)
def test_the_blocks_of_a_stream_do_not_show_in_the_file(tmp_path: Path, suffix: str) -> None:
    rows = random_rows(100)
    for name, cuts in (("one", [100]), ("many", [0, 1, 7, 8, 60, 100])):
        sink = open_sink(tmp_path / f"{name}{suffix}", provenance())
        for first, last in zip([0, *cuts], [*cuts, 100], strict=True):
            sink.write(rows[first:last])
        sink.close(provenance().ending)
    assert (tmp_path / f"one{suffix}").read_bytes() == (tmp_path / f"many{suffix}").read_bytes()


@pytest.mark.parametrize("suffix", LOGS)
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


@pytest.mark.parametrize("suffix", LOGS)
def test_an_infinite_impulse_comes_back(tmp_path: Path, suffix: str) -> None:
    rows = random_rows(6)
    rows["impulse"] = [np.inf, -np.inf, 1.0, np.nan, 0.0, np.inf]
    EventLog(provenance(), rows).save(tmp_path / f"log{suffix}")
    assert load_log(tmp_path / f"log{suffix}").rows.tobytes() == rows.tobytes()


def test_a_long_parquet_log_has_groups_of_rows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("eventsim.record.files.parquet.GROUP", 64)
    log = random_log(200)
    log.save(tmp_path / "log.parquet")
    groups = pyarrow.parquet.ParquetFile(tmp_path / "log.parquet").metadata
    assert [groups.row_group(k).num_rows for k in range(groups.num_row_groups)] == [64, 64, 64, 8]
    assert load_log(tmp_path / "log.parquet").rows.tobytes() == log.rows.tobytes()


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
    for suffix in LOGS:
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
    assert head["format"] == 2
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


def test_without_pyarrow_parquet_says_what_to_install() -> None:
    script = (
        "import sys; sys.modules['pyarrow'] = None\n"
        "from eventsim.run import load_log\nfrom eventsim.errors import LogError\n"
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


@pytest.mark.parametrize("names", [("left", "floor", "a b", "ü"), ("nan", "inf", "-1", "null"), ('say "x"', "# a", "b", "c")])
def test_a_long_csv_is_read_as_a_short_one(tmp_path, monkeypatch, names):
    """Many lines are read by pyarrow, few by Python: the same bits, and the same sentence about a bad line."""
    monkeypatch.setattr(csv, "MANY_LINES", 10)
    log = random_log(500)
    rows = log.rows.copy()
    rows["impulse"][:6] = [np.nan, np.inf, -np.inf, -0.0, 5e-324, 1.7976931348623157e308]
    EventLog(replace(log.provenance, wall_names=names), rows).save(tmp_path / "log.csv")
    many = load_log(tmp_path / "log.csv")
    monkeypatch.setattr(csv, "MANY_LINES", 10**9)
    few = load_log(tmp_path / "log.csv")
    assert many.rows.tobytes() == few.rows.tobytes() == rows.tobytes()
    text = (tmp_path / "log.csv").read_text()
    said = []
    for limit in (10, 10**9):
        monkeypatch.setattr(csv, "MANY_LINES", limit)
        for old, new in ((",0,", ",0.5,"), (",0,", ",,"), (",0,", ",1_0,"), (",-1,", ",99999999999,"), ("pair", "pear")):
            place = text.rindex(old, 0, -3000)
            (tmp_path / "log.csv").write_text(text[:place] + new + text[place + len(old) :])
            with pytest.raises(LogError) as caught:
                load_log(tmp_path / "log.csv")
            said.append(str(caught.value))
    assert said[:5] == said[5:]

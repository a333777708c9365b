"""Log files that grow: what can be read of them, who may go on with them, when they are whole."""

from __future__ import annotations

import shutil
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from eventsim.errors import LogError, LogWarning
from eventsim.record import Ending
from eventsim.record.files import Mark, claim, continued_sink, open_log, open_sink
from eventsim.record.files.journal import ROOM
from eventsim.run import load_log
from eventsim.suffixes import LOGS
from tests.record.logs import provenance, random_log, random_rows, scene

TEXT = (".csv", ".jsonl")

NOT_CLOSED = ".* was not closed, so nothing tells whether its rows were changed"


@pytest.mark.parametrize("suffix", LOGS)
def test_whoever_reads_a_log_that_grows_is_told_that_nothing_vouches_for_its_rows(tmp_path: Path, suffix: str) -> None:
    sink = open_sink(tmp_path / f"log{suffix}", provenance())
    sink.write(random_rows(10))
    sink.leave()
    with pytest.warns(LogWarning, match=NOT_CLOSED):
        load_log(sink.part)


@pytest.mark.skipif(sys.platform == "win32", reason="there the second run fails by itself")
@pytest.mark.parametrize("suffix", LOGS)
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


@pytest.mark.parametrize("suffix", LOGS)
def test_a_file_appears_only_when_it_is_whole(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"log{suffix}"
    earlier = open_sink(path, provenance())
    earlier.write(random_rows(3))
    earlier.close()
    before = path.read_bytes()
    sink = open_sink(path, provenance())
    sink.write(random_rows(10))
    assert path.read_bytes() == before
    sink.abandon()
    assert [file.name for file in tmp_path.iterdir()] == [path.name]
    assert path.read_bytes() == before


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
        column.truncate(ROOM + 9 * 8 - 3)
    assert load_log(part).rows.tobytes() == rows[:8].tobytes()
    assert load_log(part).provenance.ending is None
    with pytest.raises(LogError, match=r"no such file; .*\.part is there"):
        load_log(tmp_path / f"log{suffix}")
    sink.abandon()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("compact", [False, True])
@pytest.mark.parametrize("ended", ["killed", "closed"])
@pytest.mark.parametrize("suffix", LOGS)
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
            assert b"".join(block.tobytes() for block in open_log(sink.part)[1]) == log.rows[:rows].tobytes()
        sink.write(log.rows[rows:])
        sink.close(whole.provenance.ending)
        assert load_log(path).rows.tobytes() == whole.rows.tobytes()
        assert load_log(path).provenance == whole.provenance
        if suffix not in TEXT:  # there the room for so many kicks was made at another time
            assert path.read_bytes() == (tmp_path / f"once{suffix}").read_bytes()


@pytest.mark.parametrize("suffix", [".npz", ".parquet"])
def test_a_log_stays_as_it_is_though_its_journal_was_left_over_and_is_continued(tmp_path: Path, suffix: str) -> None:
    log = random_log(300)
    path = tmp_path / f"log{suffix}"
    kept = replace(log.provenance, kicks=(), ending=None, rows=None)
    sink = open_sink(path, kept)
    sink.write(log.rows[:150])
    mark = sink.sync()
    sink.write(log.rows[150:200])
    sink._discard = lambda: None  # the run is killed before it comes to that
    sink.close(Ending(1, 0.5, "interrupted"))
    bytes_of_log = path.read_bytes()
    assert load_log(path).rows.tobytes() == load_log(sink.part).rows.tobytes() == log.rows[:200].tobytes()
    sink = continued_sink(path, kept, False, mark)
    sink.write(log.rows[150:])
    assert path.read_bytes() == bytes_of_log
    log.save(tmp_path / f"once{suffix}")
    sink.close(load_log(tmp_path / f"once{suffix}").provenance.ending)
    assert path.read_bytes() == (tmp_path / f"once{suffix}").read_bytes()


@pytest.mark.parametrize("suffix", LOGS)
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


@pytest.mark.parametrize("suffix", LOGS)
def test_a_run_that_had_come_to_no_row_begins_anew_where_its_log_is_gone(tmp_path: Path, suffix: str) -> None:
    log = random_log(20)
    sink = continued_sink(tmp_path / f"log{suffix}", log.provenance, False, Mark(0, ()))
    sink.write(log.rows)
    sink.close(log.provenance.ending)
    sink.leave()  # of what is whole nothing is lost
    assert load_log(tmp_path / f"log{suffix}").rows.tobytes() == log.rows.tobytes()


@pytest.mark.parametrize("suffix", TEXT)
def test_a_part_without_its_scene_is_not_continued(tmp_path: Path, suffix: str) -> None:
    (tmp_path / f"log{suffix}.part").write_text("no scene\n" * 9)
    with pytest.raises(LogError, match=r"log.*part: not an event log: the first line does not hold its scene"):
        continued_sink(tmp_path / f"log{suffix}", provenance(), False, Mark(5, ()))


def test_a_part_that_is_a_directory_gives_way_to_a_text_log(tmp_path: Path) -> None:
    (tmp_path / "log.csv.part").mkdir()
    log = random_log(5)
    log.save(tmp_path / "log.csv")
    assert load_log(tmp_path / "log.csv").rows.tobytes() == log.rows.tobytes()


@pytest.mark.parametrize("suffix", LOGS)
def test_what_was_written_before_a_disk_is_full_can_be_read(
    tmp_path: Path, suffix: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    log = random_log(20)
    sink = open_sink(tmp_path / f"log{suffix}", log.provenance)
    sink.write(log.rows)
    with monkeypatch.context() as patched:
        patched.setattr("os.replace", full)
        with pytest.raises(LogError, match=r"written \(No space left on device\); .*\.part keeps what was written before"):
            sink.close(log.provenance.ending)
    sink.leave()
    assert load_log(tmp_path / f"log{suffix}.part").rows.tobytes() == log.rows.tobytes()


@pytest.mark.skipif(sys.platform == "win32", reason="there an open file keeps its name")
def test_a_claim_outlives_that_its_file_is_removed_meanwhile(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, lock, tries = tmp_path / "log.csv.lock", claim._lock, []

    def removed(descriptor: int) -> bool:
        if not tries:
            path.unlink()  # whoever had the claim before ends just now
        tries.append(descriptor)
        return lock(descriptor)

    monkeypatch.setattr(claim, "_lock", removed)
    mine = claim.Claim(path)
    mine.take(make=True)
    assert len(tries) == 2
    assert path.exists()
    with pytest.raises(LogError, match="another run is writing this log"):
        claim.Claim(path)
    mine.remove()
    mine.remove()  # there is nothing left to remove
    assert not path.exists()


@pytest.mark.parametrize("suffix", LOGS)
def test_a_vanished_directory_is_noticed_with_the_next_rows(tmp_path: Path, suffix: str) -> None:
    place = tmp_path / "place"
    place.mkdir()
    sink = open_sink(place / f"log{suffix}", provenance())
    sink.write(random_rows(10))
    shutil.rmtree(place)
    with pytest.raises(LogError, match="directory has vanished"):
        sink.write(random_rows(10))
    sink.leave()

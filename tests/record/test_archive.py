"""The archive: whatever blocks its entries come in, they are the same bytes, and zipfile reads them."""

import zipfile

import numpy as np
import pytest

from eventsim.record.files.archive import PIECE, Deflated, Stored, write_archive
from eventsim.record.files.counting import PAGE, Counting

CODES = {
    "constant": np.zeros(5 * PIECE + 3, np.int64),
    "changing": np.arange(3 * PIECE, dtype=np.int64) // 1000 % 3,
    "changing back": np.repeat([0, 2, 0, 0, 1], PIECE).astype(np.int64),
    "empty": np.zeros(0, np.int64),
}
LABELS = np.array(["pair", "wall", ""])


def written(folder, codes, labels, block):
    folder.mkdir()
    entries = Deflated("d", folder / "d", labels), Stored("s", folder / "s")
    (folder / "s").write_bytes(codes.tobytes())
    for first in range(0, len(codes), block):
        for entry in entries:
            entry.write(codes[first : first + block])
    for entry in entries:
        entry.finish(b"the head")
    write_archive(folder / "whole", entries)
    return folder / "whole"


@pytest.mark.parametrize("codes", CODES.values(), ids=CODES)
@pytest.mark.parametrize("labels", [None, LABELS], ids=["numbers", "labels"])
def test_entries_are_whole_and_do_not_tell_in_which_blocks_they_came(tmp_path, codes, labels):
    whole = written(tmp_path / "a", codes, labels, 1000)
    assert whole.read_bytes() == written(tmp_path / "b", codes, labels, 2 * PIECE + 1).read_bytes()
    with zipfile.ZipFile(whole) as archive:
        assert archive.testzip() is None
        assert archive.read("s") == b"the head" + codes.tobytes()
        assert archive.read("d") == b"the head" + (codes if labels is None else labels[codes]).tobytes()


@pytest.mark.parametrize("count", [0, 1000])
def test_an_archive_grows_from_the_file_of_an_entry_wherever_that_comes(tmp_path, count):
    codes, room = np.arange(count), 512
    (tmp_path / "base").write_bytes(b"?" * room + codes.tobytes())
    entries = Deflated("d", tmp_path / "d"), Stored("base", tmp_path / "base", room)
    for entry in entries:
        entry.write(codes)
        entry.finish(b"the head")
    write_archive(tmp_path / "base", entries)
    with zipfile.ZipFile(tmp_path / "base") as archive:
        assert archive.testzip() is None
        assert archive.namelist() == ["d", "base"]
        assert archive.read("base") == archive.read("d") == b"the head" + codes.tobytes()


@pytest.mark.parametrize("count", [0, 1, PAGE - 1, PAGE, 300 * PAGE + 7])
def test_numbers_of_rows_are_read_back_whatever_blocks_they_came_in(tmp_path, count):
    found = []
    for block in (1, PAGE - 1, count + 1) if count < 10 * PAGE else (10 * PAGE + 1, count):
        entry = Counting("n", tmp_path / "n")
        for first in range(0, count, block):
            entry.write(np.arange(first, min(first + block, count)))
        entry.finish(b"the head")
        write_archive(tmp_path / "whole", [entry])
        with zipfile.ZipFile(tmp_path / "whole") as archive:
            assert archive.testzip() is None
            assert archive.read("n") == b"the head" + np.arange(count, dtype="<i8").tobytes()
        found.append((tmp_path / "whole").read_bytes())
    assert len(set(found)) == 1
    assert len(found[0]) < 3 * count + 1000

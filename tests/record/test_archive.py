"""The archive: whatever blocks its entries come in, they are the same bytes, and zipfile reads them."""

import zipfile

import numpy as np
import pytest

from eventsim.record.files.archive import PIECE, Deflated, Stored, write_archive

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

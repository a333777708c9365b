"""A flipped bit anywhere in a file is refused, told, or changes nothing; it never ends in a traceback."""

from __future__ import annotations

import pytest

import eventsim as es
from eventsim.scene.disks_file import read_disks_file
from eventsim.simulation import resume
from tests.fuzz.flips import flips, is_silent, targets


def test_no_flip_of_a_bit_raises_anything_but_an_error_of_ours(tmp_path):
    found = list(flips(targets(tmp_path), 480, seed=5))
    assert [flip for flip in found if flip.outcome == "raised"] == []
    assert sum(flip.outcome == "refused" for flip in found) > 300
    assert list(filter(is_silent, found)) == []
    assert {flip.outcome for flip in found if flip.target == "run.checkpoint"} == {"refused", "same"}


@pytest.mark.parametrize(
    ("name", "read"), [("full.npz", es.load_log), ("run.checkpoint", resume), ("disks.npz", read_disks_file)]
)
def test_a_header_that_breaks_the_parser_of_python_is_refused(tmp_path, name, read):
    """It raised tokenize.TokenError, which is none of the errors of numpy or zipfile."""
    path = targets(tmp_path)[name].file
    whole = path.read_bytes()
    path.write_bytes(whole.replace(b"{'descr': ", b"{'descr'(("))
    with pytest.raises(es.EventsimError, match=name):
        read(path)

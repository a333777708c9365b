"""Files that are written at the end of a run appear whole, whoever else writes them."""

import pytest

from eventsim.errors import EventsimError
from eventsim.record.files.atomic import atomic_write


def test_two_runs_that_write_one_file_do_not_mix(tmp_path):
    path = tmp_path / "end.csv"
    with atomic_write(path) as one, atomic_write(path) as other:
        one.write_text("one")
        other.write_text("other")
        assert not path.exists()
    assert path.read_text() == "one"  # the outer one is renamed last
    assert [file.name for file in tmp_path.iterdir()] == ["end.csv"]


def test_what_cannot_be_written_leaves_nothing_behind(tmp_path):
    with pytest.raises(EventsimError, match="cannot be written"), atomic_write(tmp_path / "none" / "end.csv") as part:
        part.write_text("text")
    with pytest.raises(KeyboardInterrupt), atomic_write(tmp_path / "end.csv") as part:
        interrupted(part)
    assert list(tmp_path.iterdir()) == []


def interrupted(part):
    part.write_text("text")
    raise KeyboardInterrupt

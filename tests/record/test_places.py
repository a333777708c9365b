"""What is written goes to ordinary files: a name that none can have, or that of a pipe, is refused in a sentence."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import eventsim as es
from eventsim.record.files.runs import RUN
from eventsim.show.figures.write import write_figure
from tests.fuzz.flips import growing

NAMES = {
    "with a zero byte": "a\0b",
    "too long": "a" * 250,
    "too long a way": "a/" * 3000 + "b",
    "half of a letter": "a\ud800",
    "below a file": f"{__file__}/a",
    "a circle of links": "loop",
    "a pipe": "pipe",
}


def run() -> es.Run:
    return es.simulate(es.gallery("two-disks"), until=1.0, engine="reference", log=True)


WRITERS: dict[str, Callable[[str], object]] = {
    ".csv": lambda name: es.simulate(es.gallery("two-disks"), until=1.0, engine="reference", log=name),
    ".npz": lambda name: run().log.save(name),
    ".checkpoint": lambda name: es.simulate(es.gallery("two-disks"), until=1.0, engine="reference", checkpoint=name),
    ".html": lambda name: run().animate(name),
    ".png": lambda name: write_figure(run().log, "speeds", Path(name)),
}


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such names")
@pytest.mark.parametrize("suffix", WRITERS)
def test_a_name_that_no_file_can_have_is_refused(suffix: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """OSError and ValueError came; links in a circle and pipes were replaced by files."""
    monkeypatch.chdir(tmp_path)
    os.symlink(f"loop{suffix}", f"loop{suffix}")
    os.mkfifo(f"pipe{suffix}")
    before = sorted(os.listdir())
    for name in NAMES.values():
        with pytest.raises(es.EventsimError):
            WRITERS[suffix](name + suffix)
    assert sorted(os.listdir()) == before
    if suffix in (".csv", ".npz"):
        with pytest.raises(es.LogError, match="too long"):
            es.load_log("a" * 300 + suffix)


@pytest.mark.parametrize("code", [99, -7])
@pytest.mark.parametrize("column", ["kind", "wall"])
def test_a_log_that_grows_names_no_wall_and_no_kind_that_there_is_not(column: str, code: int, tmp_path: Path) -> None:
    """An IndexError came much later."""
    es.simulate(es.gallery("two-disks"), events=5, engine="reference", log=tmp_path / "log.npz")
    part = growing(tmp_path / "part.npz", tmp_path / "log.npz")
    runs = np.fromfile(part / "runs", RUN)
    runs[column] = code
    runs.tofile(part / "runs")
    with pytest.raises(es.LogError, match="is none of"):
        es.load_log(part)

"""Long logs stay in their file while they are looked at."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import eventsim as es
from eventsim.errors import EventsimError
from eventsim.kinds import TITLES
from eventsim.replay.filed import FiledLog, open_filed
from eventsim.show.figures.marks import Marks
from eventsim.show.figures.write import write_figure
from eventsim.show.player import pack
from eventsim.suffixes import LOGS
from tests import long_log


@pytest.mark.parametrize("suffix", LOGS)
def test_a_log_in_its_file_gives_the_same_picture(suffix: str, tmp_path: Path, fluid: es.EventLog) -> None:
    fluid.save(tmp_path / f"log{suffix}")
    filed = open_filed(tmp_path / f"log{suffix}")
    assert isinstance(filed, FiledLog)
    assert len(filed) == len(fluid)
    for name, log in (("held", fluid), ("filed", filed)):
        write_figure(log, "residuals", tmp_path / f"{name}.png")
    assert (tmp_path / "filed.png").read_bytes() == (tmp_path / "held.png").read_bytes()


def test_many_marks_are_drawn_by_the_cells_that_they_are_in() -> None:
    chance = np.random.default_rng(1)
    marks = Marks((0.0, 2.0), (-0.5, 2.5), rows=3)
    where = chance.uniform(0.0, 2.0, 300_000), chance.integers(0, 2, 300_000)
    for part in range(3):
        marks.add(*(axis[part * 100_000 : (part + 1) * 100_000] for axis in where))
    x, y = marks.drawn()
    assert marks.count == 300_000
    assert set(y.tolist()) == {0.0, 1.0}
    assert len(x) == 2 * 4096
    assert 0.0 < x.min() < x.max() < 2.0


def test_a_page_refuses_more_events_than_it_holds(fluid: es.EventLog, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pack, "MOST_PLAYED", 10)
    with pytest.raises(EventsimError, match=r"a page plays at most 10 events"):
        pack.packed(fluid)


@pytest.mark.slow
@pytest.mark.parametrize("suffix", [".npz", ".parquet"])
def test_three_million_rows_are_looked_at_within_400_megabytes(suffix: str, tmp_path: Path) -> None:
    """All of them would be 384 MB, and as much again while they are read."""
    path = str(tmp_path / f"log{suffix}")
    long_log.write(Path(path), millions=3)
    assert long_log.megabytes("state", path, "--frames", "5", "--out", str(tmp_path / "s.csv")) < 400
    assert long_log.megabytes("animate", path, "--out", str(tmp_path / "s.png"), "--trails") < 400
    for kind in set(TITLES) - {"boundary"}:  # that one is of billiards
        assert long_log.megabytes("figure", path, "--kind", kind, "--out", str(tmp_path / "f.png")) < 400, kind

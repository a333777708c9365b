"""The soak, at a size that takes a second."""

import csv

import eventsim as es
from tests.benchmarks.soak import LOOKS, draw, soak, verdict


def test_a_short_soak_is_sound_and_charted(tmp_path):
    looks = soak(es.gallery("periodic-fluid", n=36, packing_fraction=0.4), "reference", 4000, tmp_path / "soak.csv")
    with (tmp_path / "soak.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(looks) > LOOKS
    assert [int(row["events"]) for row in rows] == [look.events for look in looks]
    assert looks[-1].events == 4000
    assert max(abs(look.energy) for look in looks) < 1e-13  # 4000 roundings of 2^-53, at worst all one way
    assert "4,000 contacts" in verdict(looks)[0]
    draw(looks, "soak", tmp_path / "soak.png")
    assert (tmp_path / "soak.png").stat().st_size > 10_000

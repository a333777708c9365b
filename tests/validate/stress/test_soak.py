"""Random scenes near every degenerate surface: nothing hangs, steps back or is no number, and the engines agree."""

import json

import pytest
from click.testing import CliRunner

from eventsim.cli import main
from eventsim.engines import ENGINES
from eventsim.engines.base import Stop
from eventsim.validate.stress.soak import Finding, random_scene, soak


def test_the_reference_engine_survives_a_small_soak():
    assert [found for found in soak(range(1000, 1060), ("reference",)) if found is not None] == []


def test_invariants_hold_event_by_event():
    for seed in range(2000, 2010):
        ENGINES["reference"].run(random_scene(seed), Stop(until=20.0, events=30), check=True)


def test_a_seed_gives_one_scene():
    one, other = random_scene(5), random_scene(5)
    assert one.disks.position.tolist() == other.disks.position.tolist()
    assert one.disks.velocity.tolist() == other.disks.velocity.tolist()


@pytest.mark.slow
def test_the_engines_agree_on_random_scenes():
    pytest.importorskip("numba")
    assert [found for found in soak(range(300), ("reference", "fast")) if found is not None] == []


def test_an_interrupted_soak_tells_what_it_found_so_far(monkeypatch):
    def broken_off(seeds, engines):
        yield None
        yield Finding(seeds[1], engines[0], "took 6.0 s")
        raise KeyboardInterrupt

    monkeypatch.setattr("eventsim.validate.stress.soak.soak", broken_off)
    result = CliRunner().invoke(main, ["stress", "--soak", "50", "--seed", "7", "--engine", "reference", "--json"])
    assert result.exit_code == 130
    told = json.loads(result.stdout)
    assert (told["soak"], told["findings"]) == (2, [{"seed": 8, "engine": "reference", "sentence": "took 6.0 s"}])


def test_the_command_tells_what_it_found():
    result = CliRunner().invoke(main, ["stress", "--soak", "5", "--seed", "7", "--engine", "reference", "--json"])
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout) == {"soak": 5, "seed": 7, "engines": ["reference"], "findings": [], "faults": 0}

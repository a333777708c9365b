"""Random scenes near every degenerate surface: nothing hangs, steps back or is no number, and the engines agree."""

import json
import signal

import pytest
from click.testing import CliRunner

from eventsim.cli import main
from eventsim.engines.base import Stop
from eventsim.run import ENGINES
from eventsim.validation.stress.soak import Finding, by_kernels, finding_of, random_scene, soak


def test_the_reference_engine_survives_a_small_soak():
    findings = [finding_of(seed, ("reference",)) for seed in range(1000, 1060)]
    assert findings == [None] * 60


def test_invariants_hold_event_by_event():
    for seed in range(2000, 2010):
        ENGINES["reference"].run(random_scene(seed), Stop(until=20.0, events=30), check=True)


def test_a_seed_gives_one_scene():
    one, other = random_scene(5), random_scene(5)
    assert one.disks.position.tolist() == other.disks.position.tolist()
    assert one.disks.velocity.tolist() == other.disks.velocity.tolist()


@pytest.mark.slow
@pytest.mark.timeout(900)  # some ten versions of the kernels may have to be compiled
@pytest.mark.parametrize("group", [0, 8, 16])
def test_the_engines_agree_on_random_scenes(group):
    """Of the groups that share kernels one of each size: all of them are what the command is for."""
    pytest.importorskip("numba")
    seeds = by_kernels(range(3000))[group][:100]
    assert [finding_of(seed, ("reference", "fast")) for seed in seeds] == [None] * len(seeds)


@pytest.mark.slow
def test_the_engines_agree_on_a_seed_that_once_parted_them():
    """On a torus, with an immovable disk: the rows were as many, their order or their bits were not the same."""
    pytest.importorskip("numba")
    assert finding_of(8072, ("reference", "fast")) is None


def test_a_soak_has_an_answer_for_every_seed():
    assert list(soak(range(3000, 3012), ("reference",), workers=2)) == [None] * 12


def test_seeds_whose_scenes_share_kernels_are_together():
    seeds = range(200)
    groups = by_kernels(seeds)
    assert sorted(seed for group in groups for seed in group) == list(seeds)
    kinds = [{shared(random_scene(seed)) for seed in group} for group in groups]
    assert [len(kind) for kind in kinds] == [1] * len(groups) == [1] * len(set.union(*kinds))


def shared(scene):
    return type(scene.domain), scene.gravity, scene.restitution is None, scene.contact_duration


def test_an_engine_that_fails_is_a_finding(monkeypatch):
    def broken(*_args, **_options):
        raise ZeroDivisionError("division by zero")

    monkeypatch.setattr("eventsim.validation.stress.soak.run_scene", broken)
    assert finding_of(3, ("reference",)) == Finding(3, "reference", "failed: ZeroDivisionError: division by zero")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_soak_tells_what_it_found_so_far(monkeypatch, number):
    def broken_off(seeds, engines, workers):
        yield None
        yield Finding(seeds[1], engines[0], "took 6.0 s")
        signal.raise_signal(number)
        yield None

    monkeypatch.setattr("eventsim.validation.stress.soak.soak", broken_off)
    result = CliRunner().invoke(main, ["stress", "--soak", "50", "--seed", "7", "--engine", "reference", "--json"])
    assert result.exit_code == 130
    told = json.loads(result.stdout)
    assert (told["soak"], told["findings"]) == (2, [{"seed": 8, "engine": "reference", "sentence": "took 6.0 s"}])


def test_the_command_tells_what_it_found():
    result = CliRunner().invoke(main, ["stress", "--soak", "5", "--seed", "7", "--engine", "reference", "--json"])
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout) == {"soak": 5, "seed": 7, "engines": ["reference"], "findings": [], "faults": 0}

"""Structure along a run, against closed forms, theory and a plain count."""

import math

import numpy as np
import pytest

import eventsim as es
from eventsim.measure import study
from eventsim.measure.studies import structure
from eventsim.replay.passage import Passage

freud = pytest.importorskip("freud")


def fluid_log(n, fraction, events, engine="reference", **stop):
    scene = es.gallery("periodic-fluid", n=n, packing_fraction=fraction, seed=4)
    return es.simulate(scene, log=True, trust=False, engine=engine, **({"events": events} | stop)).log


@pytest.fixture
def few(monkeypatch):
    """Some states are enough to look at."""
    monkeypatch.setattr(structure, "FEWEST", 16)
    monkeypatch.setattr(structure, "MOST", 16)


@pytest.fixture(scope="module")
def log():
    return fluid_log(64, 0.4, 1_500)


def test_pairs_and_waves_are_those_of_a_plain_count(log, monkeypatch):
    monkeypatch.setattr(structure, "FEWEST", 3)
    monkeypatch.setattr(structure, "MOST", 3)
    found = study(log, "structure", discard=0.0)
    size, radius = np.array(log.scene.domain.size), float(log.scene.disks.radius[0])
    passage = Passage(log)
    states = list(passage.states([passage.span[1] * share for share in (1 / 6, 3 / 6, 5 / 6)]))
    edges = 2.0 * radius * (1.0 + 0.01 * np.arange(301))
    counts, waves = np.zeros(300), []
    for state in states:
        apart = state.position[:, None] - state.position
        apart -= size * np.round(apart / size)
        distance = np.hypot(*apart.T)[np.triu_indices(64, 1)]
        counts += np.histogram(np.maximum(distance, edges[0]), edges)[0]
        waves.append(np.abs(np.exp(2j * math.pi * state.position[:, 0] / size[0]).sum()) ** 2 / 64)
    g = counts / 3 * size.prod() / (0.5 * 64 * 63 * math.pi * np.diff(edges**2))
    told = np.array(found.tables["g"]["g"])
    assert np.abs(told - g[: len(told)]).max() < 1e-9 * g.max()
    looker = structure._Looker(freud, structure.ensemble_of(log.scene), np.arange(64))
    first = np.flatnonzero(np.isclose(looker._k, 2.0 * math.pi / size[0]))
    sampled = looker._structure_factor(states[0].position - log.scene.domain.origin)
    assert np.abs(sampled[first] - waves[0]).min() < 1e-9


def test_a_crystal_is_ordered_and_a_fluid_is_not(log, few):
    crystal = es.gallery("periodic-fluid", n=64, packing_fraction=0.85, seed=1)
    found = study(es.simulate(crystal, events=300, engine="reference", log=True, trust=False).log, "structure")
    assert found["psi_6"].value > 0.9 > 2.0 * study(log, "structure", discard=0.5 * float(log.time[-1]))["psi_6"].value
    assert found["sixfold"].value > 0.95
    assert found["coordination"].value == pytest.approx(6.0, abs=0.3)


def test_contact_value_and_compressibility_stand_beside_theory(log, few):
    found = study(log, "structure", discard=0.2 * float(log.time[-1]))
    g = found["g_contact"]
    assert "Kolafa" in g.source
    assert abs(g.value - g.theory) < 4.0 * g.error
    assert found["S_0"].theory == pytest.approx(0.6**3 / 1.4, rel=0.05)  # scaled particle theory
    assert found["psi_6_susceptibility"].error > 0.0


def test_each_pair_of_species_has_its_own_distribution(few):
    scene = es.gallery("mixture")
    periodic = es.Scene(scene.disks, es.Periodic(scene.domain.size, origin=scene.domain.origin))
    log = es.simulate(periodic, events=400, engine="reference", log=True, trust=False).log
    found = study(log, "structure")
    assert {name for name in found.tables["g"] if name.startswith("g_") and "error" not in name} == {"g_0_0", "g_0_1", "g_1_1"}
    assert all(value >= 0.0 for value in found.tables["g"]["g_0_1"])
    assert "Jenkins" in found["g_contact_0_1"].source


def test_without_a_periodic_domain_or_freud_there_is_a_word(monkeypatch):
    box = es.simulate(es.gallery("gas", n=12), events=40, engine="reference", log=True).log
    assert "periodic" in study(box, "structure")["psi_6"].doubt

    def missing():
        raise es.EventsimError("structure is measured by freud")

    monkeypatch.setattr(structure, "_freud", missing)
    with pytest.raises(es.EventsimError, match="freud"):
        study(box, "structure")


@pytest.mark.slow
@pytest.mark.timeout(1500)
@pytest.mark.parametrize("fraction", [0.3, 0.5])
def test_contact_value_and_long_waves_of_a_fluid(fraction):
    log = fluid_log(4_096, fraction, 3_000_000, engine="auto")
    found = study(log, "structure", discard=0.1 * float(log.time[-1]))
    for name, most in (("g_contact", 0.01), ("S_0", 0.05)):
        one = found[name]
        print(fraction, name, one.value, one.error, one.theory)
        assert abs(one.value - one.theory) < 3.0 * one.error
        assert one.error < most * one.value
    assert abs(found["g_contact"].value / found["g_contact"].theory - 1.0) < 0.01

"""What a Python user tries: equality, slips that get a sentence, names that other libraries use, scenes from dicts."""

from dataclasses import replace

import numpy as np
import pytest

import eventsim as es

TABLES = {
    "until": 1.0,
    "domain": {"kind": "box", "size": [2.0, 2.0]},
    "gas": [{"count": 5, "radius": 0.1, "temperature": 1.0, "seed": 3}],
}


def new_run(**more):
    return es.simulate(es.gallery("gas", n=9), events=60, engine="reference", log=True, **more)


@pytest.fixture(scope="module")
def run():
    return new_run(measure=True)


@pytest.fixture(scope="module")
def other():
    return es.simulate(es.gallery("gas", n=9, seed=5), events=60, engine="reference", log=True, measure=True)


def test_what_two_equal_runs_give_is_equal(run, other):
    again = new_run(measure=True)
    for mine, its, third in (
        (run, again, other),
        (run.state, again.state, other.state),
        (run.log, again.log, other.log),
        (run.log[3:9], again.log[3:9], other.log[3:9]),
        (run.measures, again.measures, other.measures),
    ):
        assert mine == mine
        assert mine == its
        assert mine != third
        assert mine != 3
    assert len({run.state, again.state, other.state}) == 2
    assert len({run.log, again.log, other.log}) == 2


def test_a_log_from_a_file_is_equal_to_that_of_its_run(run, tmp_path):
    run.log.save(tmp_path / "a.csv")
    run.log.save(tmp_path / "b.npz", compact=True)
    assert es.load_log(tmp_path / "a.csv") == run.log == es.load_log(tmp_path / "b.npz")


def test_states_at_other_times_or_with_another_speed_are_others(run):
    state = run.state
    assert state != replace(state, time=state.time + 1.0)
    faster = state.velocity.copy()
    faster[0, 0] += 1.0
    assert state != replace(state, velocity=faster)


SLIPS = [
    (lambda run: es.Scene(run.scene.disks, run.scene.domain, restitution={"pairs": 0.9}), "restitution.pairs = 0.9: must be"),
    (lambda run: es.Box((1, 1), walls=[1]), r"domain.walls = \[1\]: must be"),
    (lambda run: es.Box((1, 1), walls=4), "domain.walls = 4: must be"),
    (lambda run: run.animate("b.gif", size=200), r"size = 200: must be two numbers of pixels"),
    (lambda run: run.animate("b.gif", begin="x"), "begin = 'x': must be a number"),
    (lambda run: run.animate("b.gif", begin=1e9), r"begin \(--from\) = 1000000000.0: the log tells"),
    (lambda run: run.animate("b.png", moments="3"), "moments = '3': must be a whole number"),
    (lambda run: run.animate(3), "path = 3: must be the path"),
    (lambda run: run.log.measure("x"), "discard = 'x': must be a number"),
    (lambda run: run.plot(["speeds"]), r"there is no figure \['speeds'\]"),
    (lambda run: es.validate(run.scene, step=5, dt=0.1, until=1.0), "step = 5: must be a function"),
    (lambda run: es.load_scene(TABLES, seed="a"), "seed = 'a': must be a whole number"),
    (lambda run: es.load_scene("gas"), r"gas: no such file; the built-in scene is gallery\('gas'\)"),
    (lambda run: es.load_scene("break"), r"the built-in scene is gallery\('break'\)"),
    (lambda run: es.load_scene("two-disks"), r"the built-in scene is gallery\('two-disks'\)"),
    (lambda run: np.array(run.log), "log.rows is a structured one"),
    (lambda run: run.log[1.5], "an array of numbers"),
    (lambda run: run.log["time"], "it is a column, log.time"),
    (lambda run: new_run().measures, r"simulate\(..., measure=True\), or run.log.measure\(\)"),
]


@pytest.mark.parametrize(("slip", "told"), SLIPS)
def test_slips_get_a_sentence(run, slip, told, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(es.EventsimError, match=told):
        slip(run)


NAMES = [
    (lambda run: run.measure, "run.log.measure()"),
    (lambda run: run.measures.pressure, "measures.keys()"),
    (lambda run: run.measures.temperature, "measures['temperature']"),
    (lambda run: run.log.times, "log.time"),
    (lambda run: run.state.positions, "state.position"),
    (lambda run: run.state.temperature, "run.log.measure()"),
    (lambda run: es.Simulation(run.scene).plot, "sim.log.plot"),
    (lambda run: es.Gas, "load_scene({"),
    (lambda run: es.Interrupt, "from eventsim.runner.options import Interrupt"),
    (lambda run: es.Kind, "from eventsim.record.events import Kind"),
]


@pytest.mark.parametrize(("ask", "told"), NAMES)
def test_names_of_others_are_answered_with_those_here(run, ask, told):
    with pytest.raises(AttributeError) as error:
        ask(run)
    assert told in str(error.value)


def test_rows_are_chosen_by_a_mask_or_by_numbers(run):
    pairs = run.log[run.log.kinds == "pair"]
    assert set(pairs.kinds) == {"pair"}
    assert len(pairs) == np.count_nonzero(run.log.kinds == "pair")
    assert run.log[[3, 1]].event.tolist() == [3, 1]
    with pytest.raises(IndexError, match="there are no such rows"):
        run.log[[3, 1000]]


def test_a_scene_is_made_of_a_dict_with_the_tables_of_a_file(tmp_path):
    scene = es.load_scene(TABLES, overrides=["gas.0.count=7", "restitution=0.9"])
    assert len(scene.disks) == 7
    (tmp_path / "same.json").write_text(__import__("json").dumps(TABLES))
    assert replace(es.load_scene(tmp_path / "same.json"), name=None) == es.load_scene(TABLES)
    assert es.load_scene(TABLES, seed=1) != es.load_scene(TABLES, seed=2)

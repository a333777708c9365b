"""What Python users have in hand: short words for objects, tables, figures as axes, data frames, streamed simulations."""

import copy
import doctest
import importlib
import json
import os
import pickle
import subprocess
import sys
import warnings
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import eventsim as es
from eventsim.measure import Measures

PLAIN = """
import eventsim as es
scene = es.Scene(es.Disks([(0.5, 0.5), (1.5, 0.5)], [(1, 0), (0, 0)], 0.1), es.Box((2, 1)))
run = es.simulate(scene, until=4.0, log="run.csv")
run = es.simulate(scene, until=4.0, log=True, measure=True)
assert len(es.load_log("run.csv")) == len(run.log) > 0
assert len(run.measures.keys()) > 5
scene.save("scene.json")
sim = es.Simulation(es.gallery("gas", n=20))
sim.advance_to(0.1)
"""


def test_simulating_needs_numpy_and_sortedcontainers_alone(tmp_path):
    packages = tmp_path / "packages"  # an environment with nothing else
    packages.mkdir()
    for name in ("numpy", "numpy.libs", "sortedcontainers"):
        for place in map(Path, sys.path):
            if (place / name).is_dir():
                (packages / name).symlink_to(place / name)
                break
    program = [sys.executable, "-S", "-c", PLAIN]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(packages), str(Path(__file__).parents[1])])}
    done = subprocess.run(
        program, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0, done.stderr


@pytest.fixture(scope="module")
def run():
    return es.simulate(es.gallery("gas", n=20), events=200, engine="reference", log=True, measure=True)


def test_objects_say_in_a_line_what_they_are(run):
    sim = es.Simulation(run.scene, engine="reference")
    for thing in (run, run.scene, run.scene.disks, run.state, run.log, run.log[3], run.log[3:9], run.measures, sim):
        assert len(repr(thing)) < 160
        assert "\n" not in repr(thing)
        assert " at 0x" not in repr(thing)


def test_objects_are_tables_in_notebooks(run):
    for thing in (run.scene, run.scene.disks, run.state, run.log, run.measures):
        shown = thing._repr_html_()
        assert shown.startswith("<table>")
        assert len(shown) < 20_000
    named = es.Scene(run.scene.disks, run.scene.domain, name="<b>")
    assert "&lt;b&gt;" in named._repr_html_()
    assert "<b>" not in named._repr_html_()


def test_rows_are_on_the_scenes_axes():
    scene = es.Scene(es.Disks([(-7, 1), (-5, 1)], [(1, 0), (0, 0)], 0.25), es.Box((4, 2), (-8, 0)))
    log = es.simulate(scene, events=2, engine="reference", log=True).log
    first = log[0]
    assert (first.kind, first.a, first.b, first.wall, first.xa, first.ya) == ("pair", 0, 1, "", -5.5, 1.0)
    assert log.xa[0] == 2.5  # as it is stored
    assert (log[1].kind, log[1].wall, log[1].b) == ("wall", "right", -1)
    assert repr(log[-1]) == repr(log[1])
    assert log[0:2][0] == first
    assert len(log[1:]) == 1
    with pytest.raises(IndexError, match="there is no row 2"):
        log[2]


def test_a_log_is_a_data_frame(run):
    pd = pytest.importorskip("pandas")
    frame = run.log.to_pandas()
    assert list(frame["kind"]) == list(run.log.kinds)
    assert frame["wall"].isna().sum() == (run.log.kinds == "pair").sum()
    assert set(frame["wall"].dropna()) == set(run.log.wall_name) - {""}
    assert frame["xa"].tolist() == [run.log[k].xa for k in range(len(run.log))]
    assert frame["vxb"].isna().equals(frame["b"] == -1)
    assert isinstance(run.log[5:8].to_pandas(), pd.DataFrame)
    assert run.log[5:8].to_pandas()["event"].tolist() == [5, 6, 7]


def test_a_run_without_a_log_says_so_to_who_asks_for_it():
    bare = es.simulate(es.gallery("gas", n=20), events=20, engine="reference")
    assert not bare.has_log
    with pytest.raises(es.LogError, match=r"this run kept no log: simulate\(..., log=True\)"):
        _ = bare.log.time
    for ask in (lambda: bare.state_at(0.0), lambda: bare.plot("speeds"), lambda: bare.animate("a.gif")):
        with pytest.raises(es.LogError, match="needs the log of the run: simulate"):
            ask()
    assert "Run(gas" in repr(bare)


def test_files_of_logs_are_read_by_data_frame_libraries(run, tmp_path):
    polars = pytest.importorskip("polars")
    run.log.save(tmp_path / "log.csv")
    assert polars.read_csv(tmp_path / "log.csv", comment_prefix="#")["xa"].to_list() == run.log.xa.tolist()
    pytest.importorskip("pyarrow")
    run.log.save(tmp_path / "log.parquet")
    assert polars.read_parquet(tmp_path / "log.parquet")["time"].to_list() == run.log.time.tolist()


def test_a_compact_log_is_made_full_to_be_looked_at(tmp_path):
    scene = es.gallery("gas", n=8)
    run = es.simulate(scene, events=30, engine="reference", log=tmp_path / "a.csv", compact=True)
    full = es.simulate(scene, events=30, engine="reference", log=True).log
    assert run.log.compact
    assert run.log[4].xa == full[4].xa


def test_states_know_energy_and_momentum():
    fall = es.Scene(es.Disks([(0.5, 0.75)], [(1.0, 0.0)], 0.125, [2.0]), es.Box((4, 1)), gravity=(0.0, -2.0))
    run = es.simulate(fall, until=0.25, engine="reference", log=True)
    assert run.state_at(0.0).energy == 0.5 * 2 * 1 + 2 * 2 * 0.75
    assert run.state.energy == run.state_at(0.0).energy  # all of these numbers are short
    assert run.state.momentum == (2.0, -1.0)
    posts = es.Scene(es.Disks([(1, 1), (2, 1)], [(1, 0), (1, 0)], 0.1, [np.inf, 3.0]), es.Open())
    state = es.Simulation(posts, engine="reference").state
    assert (state.energy, state.momentum) == (1.5, (3.0, 0.0))
    with pytest.raises(es.EventsimError, match="made without its scene"):
        _ = es.State(0.0, state.position, state.velocity).energy


def test_states_cannot_be_written_to(run):
    sim = es.Simulation(run.scene, engine="reference")
    for state in (sim.state, run.state, run.state_at(0.0)):
        with pytest.raises(ValueError, match="read-only"):
            state.velocity[0] = (1.0, 1.0)
        with pytest.raises(ValueError, match="read-only"):
            state.position[0, 0] = 1.0


def failing(approach):
    return 1.0 if approach == 1.0 else approach / 0.0


def test_a_law_of_the_users_own_that_fails_is_told_and_put_back(tmp_path):
    scene = es.Scene(es.Disks([(0.5, 0.5)], [(2, 0)], 0.1), es.Box((2, 1)), law=failing, until=1)
    assert "stopped: law: the law" in repr(es.simulate(scene))
    assert "ZeroDivisionError" in repr(es.simulate(scene))
    scene.save(tmp_path / "law.toml")
    again = es.load_scene(tmp_path / "law.toml")
    with pytest.raises(es.EventsimError, match=r"dataclasses.replace\(scene, law=function\)"):
        es.simulate(again)
    assert es.simulate(replace(again, law=failing)).stopped == "law"


def test_a_trajectory_may_be_a_table(run, monkeypatch):
    pd = pytest.importorskip("pandas")
    monkeypatch.setattr("eventsim.judged.judge", lambda scene, samples, *options: samples)
    states = [run.state_at(time) for time in (0.0, 0.01, 0.02)]
    rows = [(state.time, k, *place) for state in states for k, place in enumerate(state.position)]
    samples = es.validate(run.scene, trajectory=pd.DataFrame(rows, columns=["t", "disk", "x", "y"])).judgement
    assert samples.times.tolist() == [0.0, 0.01, 0.02]
    assert samples.position.tolist() == [state.position.tolist() for state in states]
    with pytest.raises(es.EventsimError, match="must be a file"):
        es.validate(run.scene, trajectory=[("a", "b")])


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda scene: es.simulate(scene, t_max=1.0), "until=TIME says when to stop"),
        (lambda scene: es.simulate(scene, seed=2), "a seed belongs to who draws"),
        (lambda scene: es.simulate(scene, discard=2.0), "measure=TIME leaves out the beginning"),
        (lambda scene: es.simulate(scene, structure=True), "it has check; the call itself takes until, events, engine"),
        (lambda scene: es.Simulation(scene, until=3.0), r"it has no stop: advance_to\(time\)"),
        (lambda scene: es.simulate(scene, until=1.0, log=1), "log = 1: must be True"),
        (lambda scene: es.Simulation(scene, log=1), "log = 1: must be True"),
        (lambda scene: es.simulate(scene, until=1.0, progress=True), "progress = True: must be a function"),
        (lambda scene: es.Simulation(scene).set_velocity(0.5, (0.0, 1.0)), "disk 0.5 does not exist"),
        (lambda scene: es.Simulation(scene).set_velocity(0, (10**400, 1.0)), "too large for a number"),
        (lambda scene: es.Disks([(0.5, 0.5)], [(10**400, 0)], 0.1), "too large for a number"),
        (lambda scene: es.Disks([(0.5, 0.5)], radus=0.1), r"Disks has no keyword 'radus' \(did you mean 'radius'\?\)"),
        (lambda scene: es.Disks(pos=[(0.5, 0.5)]), "has no keyword 'pos' .*'position'"),
        (lambda scene: es.Disks(), "Disks lacks position; it takes position, velocity, radius"),
        (lambda scene: es.Scene(scene.disks, scene.domain, g=(0, -1)), "Scene has no keyword 'g' .*'gravity'"),
        (lambda scene: es.Box(sise=(1, 1)), "Box has no keyword 'sise' .*'size'"),
        (lambda scene: es.Segment((0, 0)), "Segment lacks end; it takes start, end, name"),
        (lambda scene: es.Polygon([(0, 0)], nam="a"), "Polygon has no keyword 'nam' .*'name'"),
        (lambda scene: es.Restitution(wals=0.9), "Restitution has no keyword 'wals' .*'wall'"),
        (lambda scene: replace(scene, grvity=(0, -1)), "'gravity'"),
        (lambda scene: es.validate(scene, step=lambda x, v, dt: None, dt=0.01, until=0.1), "step moves nothing"),
    ],
)
def test_what_is_given_by_mistake_is_told_in_a_sentence(run, call, sentence):
    with pytest.raises(es.EventsimError, match=sentence):
        call(run.scene)


def test_what_python_users_write_is_understood(run, tmp_path):
    sim = es.Simulation(run.scene, engine="reference", log=tmp_path / "log.csv", checkpoint=tmp_path / "run.ck", every=1e3)
    sim.set_velocity(np.int64(2), np.array([1.0, 0.0]))
    sim.close()
    assert (sim.log[0].kind, sim.log[0].a) == ("kick", 2)
    assert dict(run.measures.items())["Z"] == run.measures["Z"]
    assert len(run.measures) == len(run.measures.keys())
    assert es.Box([2, 1], np.array([0, 0])) == es.Box((2.0, 1.0))
    assert es.measure.measure(run.log)["Z"].value == run.measures["Z"].value
    assert "eventsim.sweep" in repr(es.sweep)
    with pytest.raises(AttributeError, match=r"no attribute 'Disk' \(did you mean 'Disks'\?\)"):
        getattr(es, "Disk")  # noqa: B009


def test_a_name_of_other_libraries_is_told_with_the_one_that_is_meant(run):
    sim = es.Simulation(run.scene, engine="reference")
    asked = (
        (run.log, "to_dataframe", "to_pandas"),
        (run, "events", "counters.events"),
        (sim, "kick", "set_velocity"),
        (sim, "run", "advance_to"),
        (run.scene, "replace", "dataclasses.replace"),
        (run.measures, "df", "to_dict"),
        (run.state, "kinetic_energy", "state.energy"),
    )
    for thing, name, meant in asked:
        with pytest.raises(AttributeError, match=rf"^'{type(thing).__name__}' object has no attribute '{name}': .*{meant}"):
            getattr(thing, name)
        assert not hasattr(thing, "nothing_of_the_kind")
    assert pickle.loads(pickle.dumps(run.scene)) == copy.deepcopy(run.scene) == run.scene


def test_settings_of_a_scene_may_be_one(tmp_path):
    scene = es.gallery("two-disks")
    scene.save(tmp_path / "scene.toml")
    assert es.load_scene(tmp_path / "scene.toml", "restitution=0.5").restitution.pair == 0.5
    with pytest.raises(es.SceneError, match='must be settings "key=value"') as refused:
        es.load_scene(tmp_path / "scene.toml", {"restitution": 0.5})
    assert len(refused.value.problems) == 1


@pytest.mark.parametrize("suffix", [".toml", ".json"])
def test_a_scene_is_saved(tmp_path, suffix):
    scene = es.gallery("funnel")
    scene.save(tmp_path / f"scene{suffix}")
    assert es.load_scene(tmp_path / f"scene{suffix}") == scene
    assert [path.name for path in tmp_path.iterdir()] == [f"scene{suffix}"]
    with pytest.raises(es.SceneError, match=r"ends in \.toml or \.json"):
        scene.save(tmp_path / "scene.txt")
    with pytest.raises(es.SceneError, match="cannot be written"):
        scene.save(tmp_path / "nowhere" / "scene.toml")


@pytest.mark.parametrize("name", ["balls", None])
def test_a_scene_equals_its_file_whatever_either_is_called(tmp_path, name):
    scene = es.Scene(es.Disks([(0.5, 0.5)], radius=0.1), es.Box((1, 1)), name=name)
    scene.save(tmp_path / "x.toml")
    loaded = es.load_scene(tmp_path / "x.toml")
    assert loaded == scene
    assert hash(loaded) == hash(scene)
    assert loaded.name == (name or "x")
    digests = {es.simulate(one, until=1.0, engine="reference", digest=True).digest for one in (scene, loaded)}
    assert len(digests) == 1
    assert loaded != es.Scene(scene.disks, es.Box((1, 2)), name="x")


def test_a_log_file_tells_states(run, tmp_path):
    run.log.save(tmp_path / "log.csv")
    log = es.load_log(tmp_path / "log.csv")
    for time in (0.0, 0.7, run.time):
        assert log.state_at(time).position.tobytes() == run.state_at(time).position.tobytes()
        assert log.state_at(time).energy == run.state_at(time).energy
    with pytest.raises(es.LogError, match="there is no state at time"):
        log.state_at(run.time + 1.0)


@pytest.mark.parametrize("compact", [False, True])
def test_a_log_file_is_measured_and_drawn_like_its_run(tmp_path, monkeypatch, compact):
    monkeypatch.setenv("MPLBACKEND", "Agg")
    run = es.simulate(es.gallery("gas", n=20), events=300, log=True, measure=True)
    run.log.save(tmp_path / "gas.npz", compact=compact)
    log = es.load_log(tmp_path / "gas.npz")
    assert isinstance(log, es.EventLog)
    assert log.compact == compact
    for one in (log, log.expand(), run.log):
        assert one.measure().table() == run.measures.table()
        assert one.measure(discard=0.1)["temperature"].value > 0.0
    drawn, wanted = log.plot("speeds"), run.plot("speeds")
    assert drawn.get_xlabel() == wanted.get_xlabel()
    assert log.plot("trajectories", ax=wanted) is wanted
    log.animate(tmp_path / "gas.png", moments=2)
    assert (tmp_path / "gas.png").read_bytes().startswith(b"\x89PNG")
    with es.Simulation(es.gallery("gas", n=20), engine="reference") as sim:
        sim.advance_to(0.1)
        assert sim.log.measure().keys() == sim.measures.keys()


def test_slips_of_users_are_told_in_a_sentence(run):
    for slip, words in (
        (lambda: run.log["time"], r"it is a column, log\.time"),
        (lambda: run.log[run.log.time], "rows go by one number, a slice, or an array"),
        (lambda: run.log[{1, 2}], r"choose among them in log\.rows or log\.to_pandas"),
        (lambda: run.state_at([1, 2]), r"time = \[1, 2\]: must be a number; ask for one state after another"),
        (lambda: run.state_at("1"), "must be a number"),
        (lambda: es.simulate(run.scene, until=1, measure="yes"), "measure = 'yes': must be a number"),
        (lambda: es.load_scene([1]), "from the path of a file, or a dict, not from the type list"),
        (lambda: es.Disks([(0, 0)], radius="0.1"), "disks.radius: every entry must be a number"),
        (lambda: es.Disks([(0, 1j)], radius=0.1), "disks.position: every entry must be a number"),
    ):
        with pytest.raises(es.EventsimError, match=words) as caught:
            slip()
        assert len(getattr(caught.value, "problems", [""])) == 1
    with pytest.raises(IndexError):
        run.log[len(run.log)]


def test_figures_are_axes(run, monkeypatch):
    monkeypatch.setenv("MPLBACKEND", "Agg")
    pyplot = pytest.importorskip("matplotlib.pyplot")
    pyplot.switch_backend("Agg")
    figure, (left, right) = pyplot.subplots(1, 2)
    for kind, ax in (("speeds", left), ("trajectories", right)):
        assert run.plot(kind, ax) is ax
        assert ax.get_xlabel()
    assert figure.axes == [left, right]
    fresh = run.plot("series")
    assert fresh.figure.number in pyplot.get_fignums()
    with pytest.raises(es.EventsimError, match="series has several panels: leave ax out"):
        run.plot("series", left)
    with pytest.raises(es.EventsimError, match=r"ndarray: must be axes of matplotlib \(of several, one: ax=axes.flat\[0\]\)"):
        run.plot("speeds", ax=np.array([left, right]))
    with pytest.raises(es.EventsimError, match="there is no figure 'speed'"):
        run.plot("speed")
    with pytest.raises(es.LogError, match="plot needs the log"):
        es.simulate(run.scene, events=5, engine="reference").plot("speeds")
    pyplot.close("all")


@pytest.mark.parametrize("suffix", [".csv", ".npz"])
def test_a_simulation_streams_its_log_and_goes_on_from_its_checkpoint(tmp_path, suffix):
    scene = es.gallery("gas", n=20)
    path, checkpoint = tmp_path / f"log{suffix}", tmp_path / "run.ckpt"

    def begun(**wishes):
        sim = es.Simulation(scene, engine="reference", **wishes)
        sim.advance_to(0.25)
        sim.set_velocity(3, (1.0, 0.5))
        return sim

    plain = begun()
    with begun(log=path, checkpoint=checkpoint, every=10) as sim:
        assert not path.exists()
        assert sim.log.digest() == plain.log.digest()  # of what is in the file so far
        assert np.array_equal(sim.step(), plain.step())
        assert isinstance(sim.measures, Measures)
    assert es.load_log(path).digest() == plain.log.digest()
    with pytest.raises(es.EventsimError, match="the simulation is closed"):
        sim.step()
    plain.advance_to(1.0)
    assert scene.until == 1.0
    assert es.resume(checkpoint, scene=scene).log.digest() == plain.log.digest()


def test_looking_at_the_log_costs_what_came_since_the_last_look():
    sim = es.Simulation(es.gallery("gas", n=20), engine="reference")
    logs = []
    for _ in range(100):
        sim.step()
        logs.append(sim.log)
        assert sim.log is logs[-1]
    kept = [log.digest() for log in logs]
    moved = sum(not np.shares_memory(one.rows, other.rows) for one, other in pairwise(logs))
    assert moved < 12  # the room doubles, so that most logs are written behind the one before
    saved = sim.snapshot()
    sim.set_velocity(3, (0.0, 1.0))
    assert (sim.log[-1].kind, sim.log.provenance.kicks) == ("kick", ((len(sim.log) - 1, 0.0, 1.0),))
    sim.restore(saved)
    sim.step()
    assert sim.log.provenance.kicks == ()
    assert sim.log.rows[: len(logs[-1])].tobytes() == logs[-1].rows.tobytes()
    assert kept == [log.digest() for log in logs]
    assert sim.measures is sim.measures


def test_nobody_is_warned_of_a_log_of_his_own_that_grows(tmp_path):
    scene, log, saved = es.gallery("gas", n=20), tmp_path / "log.csv", tmp_path / "run.ck"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with es.Simulation(scene, engine="reference", log=tmp_path / "grows.csv") as sim:
            sim.step()
            assert len(sim.log) == 1
            sim.step()
            assert len(sim.log) == 2
        assert sim.log.provenance.ending is not None
        es.simulate(scene, events=20, engine="reference", log=log, checkpoint=saved)
        assert len(es.resume(saved, events=30).log) == 30


def test_what_a_simulation_wrote_is_not_taken_back(tmp_path):
    sim = es.Simulation(es.gallery("gas", n=8), engine="reference", log=tmp_path / "log.csv")
    saved = sim.snapshot()
    sim.step()
    with pytest.raises(es.EventsimError, match="cannot be taken back"):
        sim.restore(saved)
    sim.close()
    for wishes in ({"log": False}, {"checkpoint": tmp_path / "a.ckpt"}):
        with pytest.raises(es.EventsimError):
            es.Simulation(es.gallery("gas", n=8), engine="reference", **wishes)


def test_measures_of_a_simulation_are_those_of_its_log():
    sim = es.Simulation(es.gallery("gas", n=20), engine="reference", measure=0.125)
    sim.advance_to(0.5)
    found = sim.measures
    assert found.discarded == 0.125
    assert found["collision_rate"].value > 0.0


DOCUMENTED = ("eventsim", "eventsim.simulation", "eventsim.scene.scene", "eventsim.run")


@pytest.mark.parametrize("name", DOCUMENTED)
def test_examples_in_docstrings_run(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = doctest.testmod(importlib.import_module(name), optionflags=doctest.NORMALIZE_WHITESPACE)
    assert done.attempted > 0
    assert done.failed == 0


SCRIPT = Path(__file__).parent / "typed" / "user_script.py"


@pytest.mark.slow
def test_a_script_of_a_user_is_clean_to_a_strict_type_checker(tmp_path):
    pytest.importorskip("basedpyright")
    settings = {"typeCheckingMode": "strict", "include": [str(SCRIPT)], "extraPaths": [str(SCRIPT.parents[2])]}
    (tmp_path / "pyrightconfig.json").write_text(json.dumps(settings))
    program = [sys.executable, "-m", "basedpyright", "-p", str(tmp_path)]
    done = subprocess.run(program, capture_output=True, text=True, timeout=280, check=False)
    assert done.returncode == 0, done.stdout
    assert "0 errors" in done.stdout


@pytest.mark.slow
def test_the_script_of_a_user_runs(tmp_path):
    pytest.importorskip("pandas")
    environment = {**os.environ, "PYTHONPATH": str(SCRIPT.parents[2]), "MPLBACKEND": "Agg"}
    done = subprocess.run(
        [sys.executable, str(SCRIPT)], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=280, check=False
    )
    assert done.returncode == 0, done.stderr
    assert "no such file" in done.stdout

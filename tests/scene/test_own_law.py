"""A law of contacts of the user's own: what a scene may name, what is refused in a sentence, and what a log holds of it."""

import json
import math

import pytest

import eventsim as es
from eventsim.scene.own_law import KNOWN
from eventsim.scene.restitution import OF_LAWS

TEXT = """
def soft(restitution, approach):
    return restitution / (1.0 + 0.5 * approach)

def by_all(mass, since, approach, restitution):
    return restitution if since < 0.5 or mass > 2.0 else 0.5

def zero(approach):
    return 1.0 / (approach - approach)

def pulls(approach):
    return -2.0

def leaves(approach):
    return -0.5

def nothing(approach):
    return float("nan")

def late(approach):
    return [0.5][int(approach)]

def text(approach):
    return str(approach)

def pair(approach):
    return approach, approach

def odd(speed):
    return 1.0

def any_of(*values):
    return 1.0

def without():
    return 1.0

def leaves_python(approach):
    raise SystemExit(7)

def imports(approach):
    import json
    return json.loads("0.5")

number = 3
"""


@pytest.fixture
def laws(tmp_path):
    (tmp_path / "laws.py").write_text(TEXT)
    return tmp_path


def two(velocity=4.0, **keys):
    disks = es.Disks([[0.0, 0.0], [2.0, 0.0]], [[velocity, 0.0], [0.0, 0.0]], 0.5)
    return es.Scene(disks, es.Open(), name="two", **keys)


def named(folder, law, **keys):
    """The scene of a file that names a law, two disks that meet at the speed 4."""
    tables = {
        "domain": {"kind": "open"},
        "contact_law": f"laws.py:{law}",
        "disk": [{"position": [0, 0], "velocity": [4, 0], "radius": 0.5}, {"position": [2, 0], "radius": 0.5}],
    }
    (folder / "scene.json").write_text(json.dumps(tables | keys))
    return es.load_scene(folder / "scene.json")


def relative(run):
    return float(run.state.velocity[1, 0] - run.state.velocity[0, 0])


@pytest.mark.parametrize("engine", ["reference", "fast"])
def test_a_function_says_what_comes_back(laws, engine):
    if engine == "fast":
        pytest.importorskip("numba")
    run = es.simulate(named(laws, "soft", restitution=0.75), events=1, engine=engine)
    assert relative(run) == 4.0 * (0.75 / 3.0)
    run = es.simulate(two(law=lambda approach: 2.0 / approach), events=1, engine=engine)
    assert relative(run) == 2.0


def test_it_may_ask_for_all_that_is_known(laws):
    assert relative(es.simulate(named(laws, "by_all"), events=1, engine="reference")) == 2.0
    assert set(KNOWN) == {"restitution", "approach", "since", "mass"}
    heavy = [{"position": [0, 0], "velocity": [4, 0], "radius": 0.5, "mass": 9}, {"position": [2, 0], "radius": 0.5, "mass": 9}]
    assert relative(es.simulate(named(laws, "by_all", disk=heavy), events=1, engine="reference")) == 4.0


@pytest.mark.parametrize("engine", ["reference", "fast"])
@pytest.mark.parametrize(
    ("law", "words"),
    [
        ("zero", "fails: ZeroDivisionError in line 9: float division by zero"),
        ("pulls", "returns -2.0: that is an impulse that pulls"),
        ("leaves", "returns -0.5: that leaves disks approaching"),
        ("nothing", "returns nan: that is no number that a contact can have"),
        ("late", "fails: IndexError in line 21"),
    ],
)
def test_a_law_that_fails_at_a_contact_stops_the_run_before_it_in_a_sentence(laws, law, words, engine, tmp_path):
    if engine == "fast":
        pytest.importorskip("numba")
    if law == "late":  # the trial is at 1, so the list is one longer
        (laws / "laws.py").write_text(TEXT.replace("[0.5][int", "[0.5, 0.5][int"))
    scene = named(laws, law)
    run = es.simulate(scene, until=2.0, engine=engine, log=tmp_path / "log.npz")
    assert (run.stopped, run.counters.events) == ("law", 0)
    assert f"the law laws.py:{law}, at the contact of disks 0, 1 with the approach 4, {words}" in run.reason
    assert len(es.load_log(tmp_path / "log.npz")) == 0
    assert run.state.velocity.tolist() == [[4.0, 0.0], [0.0, 0.0]]


@pytest.mark.parametrize("wrong", ["'0.5'", "(0.5, 0.5)", "None"])
def test_what_is_no_number_is_told_where_a_law_first_returns_it(laws, wrong):
    (laws / "laws.py").write_text(f"def law(approach):\n    return 1.0 if approach < 2.0 else {wrong}\n")
    run = es.simulate(named(laws, "law"), until=2.0, engine="reference")
    assert run.stopped == "law"
    assert f"with the approach 4, returns {wrong}: that is no number that a contact can have" in run.reason


def test_a_whole_number_that_is_too_large_is_told(laws):
    (laws / "laws.py").write_text("def law(approach):\n    return 10 ** (100 * int(approach))\n")
    run = es.simulate(named(laws, "law"), until=2.0, engine="reference")
    assert run.stopped == "law"
    assert "with the approach 4, fails: OverflowError: int too large" in run.reason


@pytest.mark.parametrize("engine", ["reference", "fast"])
@pytest.mark.parametrize("wrong", ["1.0 / (approach - approach)", "-2.0"])
def test_what_happened_before_a_law_fails_is_in_its_log(laws, wrong, engine, tmp_path):
    """4, 2, 1: the third contact is the one at which it fails."""
    if engine == "fast":
        pytest.importorskip("numba")
    box = {"domain": {"kind": "box", "size": [6, 6]}, "disk": [{"position": [1, 1], "velocity": [4, 0], "radius": 0.5}]}
    told = []
    for last in (wrong, "0.5"):
        (laws / "laws.py").write_text(f"def law(approach):\n    return 0.5 if approach > 1.0 else {last}\n")
        run = es.simulate(named(laws, "law", **box), events=3, engine=engine, log=tmp_path / "log.csv")
        told.append((run.stopped, es.load_log(tmp_path / "log.csv").rows))
    (stopped, kept), (whole, rows) = told
    assert (stopped, len(kept), whole, len(rows)) == ("law", 2, "events", 3)
    assert kept.tobytes() == rows[:2].tobytes()


@pytest.mark.parametrize("engine", ["reference", "fast"])
@pytest.mark.parametrize(("share", "events"), [("2.0", 26), ("1e12", 0), ("approach", 3)])
def test_a_law_that_gives_energy_is_stopped_where_disks_outrun_the_clock(laws, share, events, engine):
    """It was called an inelastic collapse, or speeds became infinite."""
    if engine == "fast":
        pytest.importorskip("numba")
    box = {"domain": {"kind": "box", "size": [6, 6]}, "disk": [{"position": [1, 1], "velocity": [4, 0], "radius": 0.5}]}
    (laws / "laws.py").write_text(f"def gains(approach):\n    return {share}\n")
    run = es.simulate(named(laws, "gains", **box), until=9.0, engine=engine)
    assert (run.stopped, run.counters.events) == ("digits", events)
    assert math.isfinite(run.state.energy)
    assert "the law laws.py:gains, at the contact of disk 0 and a wall with the approach" in run.reason
    assert "speeds, at the start up to 4, come to" in run.reason
    assert "see whether the law gives energy" in run.reason


@pytest.mark.parametrize(
    ("law", "words"),
    [
        ("text", "it returns '1.0': it must be a function of some of restitution, approach, since, mass"),
        ("pair", "it returns (1.0, 1.0): it must be a function"),
        ("odd", "its parameters are speed: it must be a function"),
        ("any_of", "its parameters are values: it must be a function"),
        ("without", "its parameters are none: it must be a function"),
        ("late", "it fails at a trial: IndexError in line 21"),
        ("leaves_python", "it fails at a trial: SystemExit in line 39: 7"),
        ("number", "has no function number"),
        ("missing", "has no function missing"),
    ],
)
def test_a_function_that_is_no_law_is_refused_with_the_scene(laws, law, words):
    with pytest.raises(es.SceneError) as refused:
        named(laws, law)
    assert words in str(refused.value)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("def law(approach)\n    return 1\n", "line 1 is no Python: expected ':'"),
        ("import math\n\nx = 1 / 0\n", "running the file fails: ZeroDivisionError in line 3: division by zero"),
        ("raise SystemError('no,\\n no')\n", "running the file fails: SystemError in line 1: no, no"),
        ("import sys\nsys.exit(5)\n", "running the file fails: SystemExit in line 2: 5"),
    ],
)
def test_a_file_that_cannot_be_run_is_refused_with_its_line(laws, text, words):
    (laws / "laws.py").write_text(text)
    with pytest.raises(es.SceneError) as refused:
        named(laws, "law")
    assert words in str(refused.value)


def test_what_is_wrong_in_the_file_of_a_law_is_not_mended_in_the_scene(laws):
    """Another name was proposed, as if this one were wrong."""
    scene = laws / "scene.toml"
    scene.write_text('until = 1.0\ncontact_law = "laws.py:missing"\n[domain]\nkind = "box"\nsize = [1.0, 1.0]\n')
    with pytest.raises(es.SceneError, match="has no function missing") as refused:
        es.load_scene(scene)
    assert 'line 2: contact_law = "laws.py:missing"' in str(refused.value)
    assert "write:" not in str(refused.value)


@pytest.mark.parametrize("law", ["laws.py", "laws.py:", "laws.py:a b", 3, {"name": "x"}])
def test_a_name_is_a_file_and_a_function(laws, law):
    with pytest.raises(es.SceneError, match="contact_law"):
        named(laws, "soft", contact_law=law)
    with pytest.raises(es.SceneError, match="cannot be read"):
        named(laws, "soft", contact_law="elsewhere.py:soft")


@pytest.mark.parametrize("key", OF_LAWS)
def test_a_law_and_a_key_that_asks_for_another_are_two_laws(laws, key):
    with pytest.raises(es.SceneError, match=f"has a restitution.{key} beside it: one law says what comes back"):
        named(laws, "soft", restitution={key: 1.0})


@pytest.mark.parametrize("suffix", ["npz", "csv", "jsonl"])
def test_a_log_holds_the_text_of_a_law_and_never_runs_it(laws, tmp_path, suffix):
    scene = named(laws, "soft", until=3.0)
    es.simulate(scene, engine="reference", log=tmp_path / f"log.{suffix}")
    (laws / "laws.py").write_text("raise SystemError('run')\n")
    log = es.load_log(tmp_path / f"log.{suffix}")
    assert log.scene == scene
    assert (log.scene.law.source, log.scene.law.function) == (TEXT, None)
    assert len(log) == 1
    with pytest.raises(es.SceneError, match=r"the law laws.py:soft is not run from a file that only holds its text"):
        log.scene.law(1.0, 4.0, 0.0, 1.0)
    with pytest.raises(es.EventsimError, match=r"the law laws.py:soft is not run from a file that only holds its text"):
        es.simulate(log.scene, engine="reference")


def test_a_compact_log_is_made_full_by_the_function_that_made_it(tmp_path):
    def law(approach):
        return 1.0 / (1.0 + approach)

    def other(approach):
        return 0.25

    run = es.simulate(two(law=law), events=1, engine="reference", log=True)
    run.log.save(tmp_path / "log.npz", compact=True)
    with pytest.raises(es.EventsimError, match="not run from a file that only holds its text"):
        es.load_log(tmp_path / "log.npz").digest()
    with pytest.raises(es.SceneError, match="has another text"):
        es.load_log(tmp_path / "log.npz", law=other)
    assert es.load_log(tmp_path / "log.npz", law=law).digest() == run.log.digest()


def test_a_run_goes_on_from_a_checkpoint_with_the_scene_that_names_its_law(laws, tmp_path):
    box = {"domain": {"kind": "box", "size": [6, 6]}, "disk": [{"position": [1, 1], "velocity": [4, 3], "radius": 0.5}]}
    scene = named(laws, "soft", **box)
    whole = es.simulate(scene, events=8, engine="reference", log=True).log.digest()
    es.simulate(scene, events=4, engine="reference", log=tmp_path / "log.npz", checkpoint=tmp_path / "saved")
    with pytest.raises(es.EventsimError, match="not run from a file that only holds its text"):
        es.resume(tmp_path / "saved", events=8)
    assert es.resume(tmp_path / "saved", events=8, scene=scene, digest=True).digest == whole
    (laws / "laws.py").write_text(TEXT.replace("0.5 * approach", "0.25 * approach"))
    with pytest.raises(es.EventsimError, match="another scene"):
        es.resume(tmp_path / "saved", events=8, scene=named(laws, "soft", **box))


def test_a_saved_scene_runs_its_file_if_that_is_as_it_was(laws, tmp_path):
    scene = named(laws, "soft")
    scene.save(tmp_path / "saved.toml")
    assert es.load_scene(tmp_path / "saved.toml").law.function(1.0, 2.0) == 0.5
    (laws / "laws.py").write_text(TEXT + "\n")
    with pytest.raises(es.SceneError, match="has changed since the scene was written"):
        es.load_scene(tmp_path / "saved.toml")


def test_numbers_that_a_function_takes_from_outside_are_part_of_its_text():
    def made(share):
        return two(law=lambda approach: share)

    assert made(0.5) == made(0.5)
    assert made(0.5) != made(0.25)
    with pytest.raises(es.SceneError, match="law = 3"):
        two(law=3)


def test_rest_is_off_under_a_law_of_ones_own():
    disks = es.Disks([[1.0, 2.0]], radius=0.5)
    scene = es.Scene(disks, es.Box((4.0, 4.0)), gravity=(0.0, -1.0), law=lambda approach: 0.5)
    run = es.simulate(scene, until=9.0, engine="reference")
    assert run.counters.rests == 0
    assert run.stopped == "collapse"
    assert math.isfinite(run.time)


@pytest.mark.compiled
@pytest.mark.kernels
def test_what_cannot_be_compiled_is_told_with_its_line_and_auto_goes_on_without(laws, capfd):
    pytest.importorskip("numba")
    scene = named(laws, "imports")
    with pytest.raises(es.EventsimError, match=r"cannot be compiled: line 42: .*engine = reference runs it"):
        es.simulate(scene, events=1, engine="fast")
    assert relative(es.simulate(scene, events=1, engine="reference")) == 2.0

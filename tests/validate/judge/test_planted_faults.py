"""A small engine with one fault planted at a time: the judgement names it, as the first wrong event, whatever the file."""

import numpy as np
import pytest

import eventsim as es
from eventsim.readers import read_samples
from eventsim.readers.contacts import told_from
from eventsim.readers.samples import Samples, checked
from eventsim.validation.judge.judgement import judge
from eventsim.validation.judge.words import judged_in_words
from tests.validate.judge.engine import FAULTS, motion, scene_of
from tests.validate.judge.files import FORMATS, write

SCENE = scene_of()
LIBRARIES = {"parquet": "pyarrow", "gsd": "gsd"}
CASES = [(fault, FORMATS[k % len(FORMATS)]) for k, fault in enumerate(FAULTS)]
"""A format for each fault; all of both are slow."""


def judged(fault, kind, folder, scene=SCENE, told=False, at=5):
    if kind in LIBRARIES:
        pytest.importorskip(LIBRARIES[kind])
    times, places, speeds, _ = motion(scene, fault, at)
    path = write(folder / f"motion.{kind}", kind, times, places, speeds if told else None)
    return judge(scene, read_samples(path))


def assert_is_named(judgement, fault):
    found = judgement.first_fault
    if fault == "none":
        assert found is None
        assert judged_in_words(judgement)[0].startswith("No wrong event")
        assert judgement.charge.found > 40
    else:
        assert found.kind == fault
        assert judged_in_words(judgement)[0].startswith(("First wrong event: ", "First wrong event that can be seen: "))
        assert f"event: {fault}: " in judged_in_words(judgement)[0] or f"seen: {fault}: " in judged_in_words(judgement)[0]
    assert judgement.charge.doubled == judgement.charge.false == 0
    assert judgement.charge.missed == (fault in ("missed", "leak"))


@pytest.mark.parametrize(("fault", "kind"), CASES)
def test_a_planted_fault_is_the_first_wrong_event(fault, kind, tmp_path):
    assert_is_named(judged(fault, kind, tmp_path), fault)


@pytest.mark.slow
@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize("fault", FAULTS)
def test_in_every_format(fault, kind, tmp_path):
    assert_is_named(judged(fault, kind, tmp_path), fault)
    if kind in ("csv", "npz", "parquet"):
        assert_is_named(judged(fault, kind, tmp_path, told=True), fault)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(20))
def test_on_many_scenes(seed, tmp_path):
    for fault in FAULTS:
        found = judged(fault, "npz", tmp_path, scene_of(seed=seed), told=bool(seed % 2), at=4)
        kinds = [one.kind for one in found.faults] or ["none"]
        if fault in ("restitution", "masses") and kinds[0] == "energy":
            kinds = [kind for kind in kinds if kind != "energy"]  # a contact entangled with another one came first
        assert kinds[0] == fault


@pytest.mark.parametrize("fault", ["none", "missed", "drift"])
def test_positions_of_five_digits_are_judged_alike(fault):
    """What rounding adds to velocities is neither a drift nor a turn."""
    times, places, _, _ = motion(SCENE, fault)
    assert_is_named(judge(SCENE, checked(Samples("rounded", times, places.round(5)))), fault)


def test_the_time_and_the_disks_of_a_fault_are_told(tmp_path):
    times, places, _, contacts = motion(SCENE, "missed", at=5)
    fault = judge(SCENE, checked(Samples("motion", times, places))).first_fault
    exact = es.simulate(SCENE, events=6, log=True).log
    assert fault.time == exact.time[5]
    assert fault.disks == (exact.a[5], exact.b[5])
    assert [(a, b) for _, a, b, _ in contacts[:5]] == list(zip(exact.a[:5], exact.b[:5], strict=True))


def test_contacts_that_are_told_are_matched_to_the_last_digits():
    times, places, _, contacts = motion(SCENE)
    time, a, b, wall = (list(column) for column in zip(*contacts, strict=True))
    told = told_from(np.array(time), np.array(a, float), np.array(b, float), wall, len(SCENE.disks), "contacts")
    found = judge(SCENE, checked(Samples("motion", times, places)), told)
    assert found.first_fault is None
    assert found.charge.missed == found.charge.doubled == found.charge.false == found.charge.unseen == 0
    assert np.abs(found.charge.errors[:, 1]).max() < 1e-9
    twice = told_from(np.repeat(time, 2), np.repeat(a, 2).astype(float), np.repeat(b, 2).astype(float),
                      list(np.repeat(wall, 2)), len(SCENE.disks), "contacts")  # fmt: skip
    again = judge(SCENE, checked(Samples("motion", times, places)), twice)
    assert again.first_fault.kind == "doubled"
    assert again.charge.doubled == again.charge.found


def test_an_honest_engine_of_fixed_steps_is_accused_of_nothing_but_what_it_misses():
    """Contacts late by up to a step are no fault; grazes that it steps over are, and are called so."""
    scene, step, until = es.gallery("gas", n=16), 0.001, 0.4
    run = es.simulate(scene, until=until, engine="stepped", dt=step)
    times = np.arange(0.0, until, step)
    states = [run.state_at(float(time)) for time in times]
    found = judge(scene, checked(Samples("stepped", times, np.array([state.position for state in states]))))
    assert {fault.kind for fault in found.faults} <= {"missed"}
    assert all("graze" in fault.sentence for fault in found.faults)
    assert found.charge.found > 20
    assert -0.5 * step < np.median(found.charge.errors[:10, 1]) < step


def two_beside_a_wall():
    """Disk 1 meets disk 0 at t = .3, which gets to the wall soon after: at .6, or at .45 with twice the impulse."""
    disks = es.Disks([(0.5, 1.5), (1.2, 1.5)], [(0.0, 0.0), (-1.0, 0.0)], 0.2)
    return es.Scene(disks, es.Box((3.0, 3.0)), until=4.0)


@pytest.mark.parametrize(("told", "frame"), [(False, 0.11), (True, 0.12)])
def test_energy_that_no_contact_gives_is_a_wrong_event(told, frame):
    """Contacts in neighbouring samples cannot be told apart, but together they keep the energy."""
    scene = two_beside_a_wall()
    times, places, speeds, _ = motion(scene, "double impulse", at=0, frame=frame)
    found = judge(scene, checked(Samples("motion", times, places, speeds if told else None)))
    assert found.first_fault.kind == "energy"
    assert found.first_fault.disks == (0, 1)
    assert 0.3 < found.first_fault.time < 0.61
    if told:
        assert found.first_fault.time == times[3]
    assert judge(scene, checked(Samples("motion", *motion(scene, frame=frame)[:2]))).first_fault is None


def test_momentum_that_comes_from_nowhere_is_a_wrong_event():
    """Three disks that turn at once keep the energy, and change the momentum, far from walls."""
    disks = es.Disks([(4.0, 5.0), (5.05, 5.0), (5.05, 5.945)], [(1.0, 0.0), (-1.0, 0.0), (0.0, -1.0)], 0.4)
    scene = es.Scene(disks, es.Open(), until=0.4)
    times = np.linspace(0.0, 0.4, 41)
    after = np.array([(0.0, 1.0), (0.0, 1.0), (0.0, 1.0)])
    speeds = np.where((times > 0.105)[:, None, None], after, disks.velocity)
    lag = np.maximum(times - 0.105, 0.0)[:, None, None]
    places = disks.position + disks.velocity * (times[:, None, None] - lag) + after * lag
    found = judge(scene, checked(Samples("motion", times, places, speeds)))
    assert found.first_fault.kind == "momentum"
    assert found.first_fault.disks == (0, 1, 2)


def test_what_explodes_late_does_not_hide_what_was_wrong_before():
    times, places, speeds, _ = motion(SCENE, "double impulse", at=5)
    early = judge(SCENE, checked(Samples("motion", times, places, speeds)))
    wild = np.where(times > 1.5, 3.0 ** (20.0 * (times - 1.5)), 1.0)[:, None, None]
    motion_of = (times, places * wild, speeds * wild)
    late = es.validate(SCENE, trajectory=motion_of)
    assert late.first_fault == early.first_fault
    assert late.judgement.charge.found > 5
    until = es.validate(SCENE, trajectory=motion_of, until=1.0)
    assert until.first_fault == early.first_fault
    assert until.judgement.times[-1] == pytest.approx(1.0)


@pytest.mark.parametrize("told", [False, True])
def test_contacts_that_samples_cannot_tell_apart_are_unseen_and_blame_nobody(told):
    scene = scene_of(seed=8)
    times, places, speeds, _ = motion(scene, frame=0.1)
    found = judge(scene, checked(Samples("motion", times, places, speeds if told else None)))
    assert found.first_fault is None
    assert found.charge.unseen > 0


def contacts_of(rows, n):
    time, a, b, wall = (list(column) for column in zip(*rows, strict=True))
    return told_from(np.array(time), np.array(a, float), np.array(b, float), wall, n, "contacts")


def test_contacts_that_are_told_are_as_precise_as_they_are_whatever_the_samples():
    """Samples of .2 would allow for contacts that are .4 late; the contacts themselves show that one is missing."""
    times, places, _, contacts = motion(SCENE, "missed", frame=0.01)
    found = judge(SCENE, checked(Samples("motion", times[::10], places[::10])), contacts_of(contacts, len(SCENE.disks)))
    assert found.tolerance < 0.05
    assert found.first_fault.kind == "missed"


def test_a_later_contact_of_the_same_two_is_not_doubled():
    """Between two contacts of a pair one of them met something else."""
    contacts = [(0.5, 0, 1, ""), (0.51, 0, -1, ""), (0.52, 0, 1, "")]
    scene = scene_of(n=2)
    times, places, _, real = motion(scene, until=1.0)
    found = judge(scene, checked(Samples("motion", times, places)), contacts_of(sorted(real + contacts), 2))
    assert found.charge.doubled == 0


def test_contacts_with_a_wall_that_is_not_named_are_looked_for_at_all_walls():
    times, places, _, contacts = motion(SCENE)
    rows = [(time, a, b, "") for time, a, b, _ in contacts]
    extra = next(row for row in rows if row[2] < 0)
    found = judge(SCENE, checked(Samples("motion", times, places)), contacts_of(sorted([*rows, extra]), len(SCENE.disks)))
    assert found.charge.false == 0


def test_the_first_that_can_be_seen_says_how_many_could_not():
    times, places, _, _ = motion(SCENE, "drift")
    said = judged_in_words(judge(SCENE, checked(Samples("motion", times, places))))[0]
    assert said.startswith("First wrong event that can be seen: drift: ")
    assert "1 earlier contact could not be checked (1 too weak, or too close to others)" in said


def test_few_contacts_that_could_be_compared_are_no_acquittal():
    """An engine that begins a little beside its place parts early: what it does after that nobody can tell."""
    disks = SCENE.disks
    beside = disks.position + 0.0025 * np.where(np.arange(len(disks)) % 2, 1.0, -1.0)[:, None]
    times, places, _, _ = motion(es.Scene(es.Disks(beside, disks.velocity, disks.radius, disks.mass), SCENE.domain))
    found = judge(SCENE, checked(Samples("motion", times, places)))
    assert found.first_fault is None
    assert found.charge.ahead < 0.5 * len(found.charge.all_at)
    said = judged_in_words(found)[0]
    assert said.startswith("No wrong event: ")
    assert f"{found.compared} contacts compared" in said
    assert f"The other {len(found.charge.all_at) - found.compared} cannot be compared: from t = " in said


def crowd(seed):
    """Nine disks of three masses that fill a third of their box."""
    rng = np.random.default_rng(seed)
    sites = np.array([(x, y) for x in (0.5, 1.5, 2.5) for y in (0.5, 1.5, 2.5)])
    mass = rng.choice([1.0, 2.0, 5.0], 9)
    disks = es.Disks(sites + rng.uniform(-0.1, 0.1, (9, 2)), rng.normal(size=(9, 2)), 0.3, mass)
    return es.Scene(disks, es.Box((3.0, 3.0)), until=3.0)


@pytest.mark.parametrize(("seed", "frame", "told"), [(7, 0.02, True), (24, 0.05, True), (13, 0.05, False), (20, 0.05, False)])
def test_an_exact_run_of_a_crowd_is_blamed_for_nothing(seed, frame, told):
    """Contacts that samples hide are no masses, no drift and no energy from nowhere."""
    scene = crowd(seed)
    run = es.simulate(scene, engine="reference", log=True, trust=False)
    times = np.arange(0.0, 3.0, frame)
    states = [run.state_at(float(time)) for time in times]
    place, speeds = (np.array([getattr(state, name) for state in states]) for name in ("position", "velocity"))
    assert judge(scene, checked(Samples("exact", times, place, speeds if told else None))).first_fault is None


def test_contacts_and_paths_that_disagree_are_told():
    """The contacts that are told hold one that the paths do not show."""
    times, places, _, contacts = motion(SCENE)
    rows = sorted([*contacts, (1.0005, 0, 1, "")])
    remarks = judge(SCENE, checked(Samples("motion", times, places)), contacts_of(rows, len(SCENE.disks))).remarks
    assert any(text.startswith("Contacts and paths disagree. The contacts that are told say: false: ") for text in remarks)
    assert any(text.endswith("The paths alone say: no wrong event.") for text in remarks)
    alike = judge(SCENE, checked(Samples("motion", times, places)), contacts_of(contacts, len(SCENE.disks))).remarks
    assert not any("disagree" in text for text in alike)


@pytest.mark.parametrize("gravity", [None, (0.0, -1.0)])
def test_disks_that_are_all_displaced_at_once_do_not_turn(gravity):
    """Four disks on a row: all are moved by (0.03, -0.02) between two samples, whose distances differ."""
    disks = es.Disks([(1.0 + k, 4.0) for k in range(4)], [(0.1 * k, 0.2) for k in range(4)], 0.2)
    scene = es.Scene(disks, es.Box((8.0, 8.0)), gravity=gravity, until=0.5)
    times = np.concatenate([np.linspace(0.0, 0.25, 26), np.linspace(0.27, 0.51, 13)])
    fall = 0.5 * np.array(gravity or (0.0, 0.0)) * times[:, None, None] ** 2
    places = disks.position + disks.velocity * times[:, None, None] + fall
    places[21:] += (0.03, -0.02)
    found = es.validate(scene, trajectory=(times, places))
    assert found.judgement.faults == [found.first_fault]
    assert found.first_fault.sentence == "jump: all disks are displaced by (0.03, -0.02) between t = 0.2 and 0.21"
    places[21:] -= (0.03, -0.02)
    assert es.validate(scene, trajectory=(times, places)).first_fault is None

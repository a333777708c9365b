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
        assert judged_in_words(judgement)[0].startswith(f"First wrong event: {fault}: ")
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
        assert (found.first_fault.kind if found.first_fault else "none") == fault


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

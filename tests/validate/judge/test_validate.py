"""es.validate and eventsim validate --trajectory, from end to end."""

import csv
import json
from dataclasses import replace

import numpy as np
import pytest
from click.testing import CliRunner

import eventsim as es
from eventsim.cli.program import main
from eventsim.scene.files import scene_to_dict
from tests.validate.judge.engine import motion, scene_of
from tests.validate.judge.files import write

SCENE = scene_of()


@pytest.fixture(scope="module")
def missed():
    return motion(SCENE, "missed")


@pytest.fixture
def files(missed, tmp_path):
    times, places, _, contacts = missed
    scene = tmp_path / "planted.json"
    scene.write_text(json.dumps(scene_to_dict(SCENE)))
    with (tmp_path / "contacts.csv").open("w", newline="") as file:
        csv.writer(file).writerows([("time", "a", "b", "wall"), *contacts])
    return scene, write(tmp_path / "mine.csv", "csv", times, places), tmp_path / "contacts.csv"


def test_the_command_prints_the_verdict_and_draws_it(files, tmp_path):
    scene, mine, contacts = map(str, files)
    told = ["validate", scene, "--trajectory", mine, "--contacts", contacts]
    done = CliRunner().invoke(main, [*told, "--figure", str(tmp_path / "a.svg"), "--csv", str(tmp_path / "a.csv")])
    assert done.exit_code == 0, done.output
    assert "First wrong event: missed: the contact of disks 3 and 4 at t = 0.550291" in done.output
    assert "Contacts are matched within" in done.output
    assert (tmp_path / "a.svg").read_text().startswith("<?xml")
    rows = list(csv.DictReader(line for line in (tmp_path / "a.csv").read_text().splitlines() if not line.startswith("#")))
    assert {"found", "missed", "position"} <= {row["what"] for row in rows}
    data = json.loads(CliRunner().invoke(main, [*told, "--json"]).output)
    assert data["first_fault"]["kind"] == "missed"
    assert data["first_fault"]["disks"] == [3, 4]
    assert data["contacts"]["missed"] == 1
    assert data["versions"]["eventsim"] == es.__version__


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--contacts", "c.csv"], "--contacts and --tolerance belong to --trajectory"),
        (["--trajectory", "no.csv"], "no.csv: no such file"),
        (["--trajectory", "no.csv", "--against", "stepped"], "judges one motion as it is"),
        (["--trajectory", "no.txt"], "positions at times are read from"),
    ],
)
def test_what_does_not_go_together_is_a_usage_error(arguments, said):
    done = CliRunner().invoke(main, ["validate", "two-disks", *arguments])
    assert done.exit_code == 2
    assert said in " ".join(done.output.split())


def test_a_motion_of_another_scene_is_refused_with_the_disk(missed):
    times, places, _, _ = missed
    with pytest.raises(es.EventsimError, match=r"disk 0 begins at .* another order of disks"):
        es.validate(SCENE, trajectory=(times, places[:, ::-1]))
    with pytest.raises(es.EventsimError, match="has 6 disks, and the scene 7"):
        es.validate(SCENE, trajectory=(times, places[:, :6]))
    with pytest.raises(es.EventsimError, match="before the scene does"):
        es.validate(SCENE, trajectory=(times - 1.0, places))


def test_a_function_is_stepped_and_judged():
    scene = es.gallery("two-disks")

    def step(position, velocity, dt):
        return position + velocity * dt, velocity

    judged = es.validate(scene, step=step, dt=0.01, until=6.0)
    assert judged.first_fault.kind == "missed"
    assert judged.first_fault.disks == (0, 1)
    assert judged.judgement.source == "step"
    assert judged.judgement.elapsed > 0.0
    assert str(judged).startswith("First wrong event: missed")
    assert f"found {judged.judgement.charge.found}, missed 1" in str(judged)
    with pytest.raises(es.EventsimError, match=r"step 1 returns a position of the shape \(3, 2\): must be \(2, 2\)"):
        es.validate(scene, step=lambda x, v, dt: (np.zeros((3, 2)), v), dt=0.01, until=6.0)
    with pytest.raises(es.EventsimError, match="contacts belong to a trajectory"):
        es.validate(scene, step=step, dt=0.01, until=6.0, contacts=[])
    as_lists = es.validate(scene, step=lambda x, v, dt: [each.tolist() for each in step(x, v, dt)], dt=0.01, until=6.0)
    assert as_lists.first_fault == judged.first_fault
    with pytest.raises(es.EventsimError, match="step 1 returns int"):
        es.validate(scene, step=lambda x, v, dt: 1, dt=0.01, until=6.0)


def test_a_function_may_change_its_arrays_in_place():
    scene = es.Scene(es.Disks([(0, 0), (5, 0)], [(1, 0), (0, 0)], radius=0.5), es.Open(), until=3.0)

    def step(position, velocity, dt):
        position += velocity * dt

    judged = es.validate(scene, step=step, dt=0.01)
    assert judged.first_fault is None
    assert judged.verdict[1].startswith("No contact could be charged")


def test_velocities_of_another_unit_are_not_used(missed):
    times, places, speeds, _ = missed
    judged = es.validate(SCENE, trajectory=(times, places, 3.6 * speeds))
    assert "they are not used" in judged.verdict[1]
    assert judged.first_fault.kind == "missed"


def test_samples_that_are_too_coarse_say_so():
    times, places, _, _ = motion(SCENE, frame=0.4)
    judged = es.validate(SCENE, trajectory=(times, places))
    assert "cannot be told: the samples are too coarse" in judged.verdict[0]
    assert judged.first_fault is None
    assert judged.judgement.charge.missed == 0


def test_a_periodic_gas_and_a_fall_are_judged_too():
    fluid = es.gallery("periodic-fluid", n=16, packing_fraction=0.2)  # below the size of the compiled engine
    run = es.simulate(fluid, until=0.5, log=True)
    times = np.linspace(0.0, 0.5, 2001)
    judged = es.validate(fluid, trajectory=(times, np.array([run.state_at(float(time)).position for time in times])))
    assert judged.first_fault is None
    assert judged.judgement.charge.found > 10
    assert judged.judgement.momentum < 1e-9
    fall = es.gallery("bounce")
    run = es.simulate(fall, until=2.5, log=True)
    times = np.linspace(0.0, 2.5, 2501)
    judged = es.validate(fall, trajectory=(times, np.array([run.state_at(float(time)).position for time in times])))
    assert judged.first_fault is None
    assert judged.judgement.charge.found >= 2


def test_a_motion_that_begins_late_is_judged_from_there_on():
    """What an engine did before nobody knows: it is charged with nothing."""
    times, places, _, contacts = motion(SCENE)
    begin = int(np.searchsorted(times, contacts[3][0])) + 1
    judged = es.validate(SCENE, trajectory=(times[begin:], places[begin:]), contacts=[(t, a, b) for t, a, b, _ in contacts])
    assert judged.first_fault is None
    assert judged.judgement.charge.found > 30
    assert "it is judged from the state" in judged.verdict[1]
    with pytest.raises(es.EventsimError, match=r"disk \d+ begins at"):
        es.validate(SCENE, trajectory=(times[begin:], places[:-begin]))


@pytest.mark.parametrize(
    ("unit", "said"),
    [
        (1e-3, "its disks begin with 1000 times the velocities of the scene"),
        (1e3, "of its 401 times, from 0 to 4000, only one is within the scene, which ends at t = 4: another unit of time"),
    ],
)
def test_a_motion_in_another_unit_of_time_is_refused(unit, said):
    times, places, _, _ = motion(SCENE)
    with pytest.raises(es.EventsimError, match=said):
        es.validate(SCENE, trajectory=(unit * times, places))


def test_a_disk_that_turns_round_in_the_first_step_is_in_its_own_unit_of_time():
    scene = es.Scene(es.Disks([[0.3, 0.5]], [[-1.0, 0.0]], 0.1), es.Box((1.0, 1.0)))
    run = es.simulate(scene, until=0.3, log=True)
    times = np.array([0.0, 0.25, 0.3])
    judged = es.validate(scene, trajectory=(times, np.array([run.state_at(float(time)).position for time in times])))
    assert judged.first_fault is None


def test_headers_that_are_comments_are_read_and_missing_ones_told(missed, tmp_path):
    times, places, _, _ = missed
    table, names = (
        np.column_stack([times, places.reshape(len(times), -1)]),
        "time," + ",".join(f"{axis}{disk}" for disk in range(places.shape[1]) for axis in "xy"),
    )
    np.savetxt(tmp_path / "named.csv", table, delimiter=",", header=names)
    assert es.validate(SCENE, trajectory=tmp_path / "named.csv").first_fault.disks == (3, 4)
    np.savetxt(tmp_path / "bare.csv", table, delimiter=",")
    with pytest.raises(es.EventsimError, match="has no header line: its first line must name the columns, as time,x0,y0"):
        es.validate(SCENE, trajectory=tmp_path / "bare.csv")
    np.savez(tmp_path / "pos.npz", t=times, pos=places)
    with pytest.raises(es.EventsimError, match=r"in .npz arrays time \(T,\), position \(T, n, 2\)"):
        es.validate(SCENE, trajectory=tmp_path / "pos.npz")


def test_an_engine_that_tells_no_contact_has_missed_what_it_flies_through(missed):
    times, places, _, _ = missed
    judged = es.validate(SCENE, trajectory=(times, places), contacts=[])
    assert judged.judgement.charge.found == 0
    with pytest.raises(es.EventsimError, match=r"contacts: must be rows \(time, a, b\) or"):
        es.validate(SCENE, trajectory=(times, places), contacts=np.zeros((3, 2)))


def test_the_figure_marks_the_first_wrong_event_and_what_was_missed(missed):
    """A line at its time in each panel, its kind beside it, and a cross among the times of contacts."""
    from matplotlib.figure import Figure

    from eventsim.show.versus.judgement import WRONG, draw_judgement

    times, places, _, _ = missed
    judgement = es.validate(SCENE, trajectory=(times, places)).judgement
    fault = judgement.first_fault
    figure = Figure()
    draw_judgement(figure, judgement)
    panels = [axes for axes in figure.axes if axes.axison]
    for axes in panels:
        marks = [line for line in axes.lines if line.get_color() == WRONG and list(line.get_xdata()) == [fault.time, fault.time]]
        assert len(marks) == 1
    assert any(text.get_text() == "first wrong event:\nmissed" for axes in panels for text in axes.texts)
    (crosses,) = (line for axes in panels for line in axes.lines if line.get_gid() == "missed")
    assert crosses.get_xdata().tolist() == [one.time for one in judgement.faults if one.kind == "missed"]


def test_contacts_may_name_their_walls():
    times, places, _, contacts = motion(SCENE)
    named, plain = (
        es.validate(SCENE, trajectory=(times, places), contacts=[row[:width] for row in contacts]).judgement.charge.found
        for width in (4, 3)
    )
    assert named == plain > 30


@pytest.mark.parametrize("pace", [1.01, 0.99])
def test_disks_that_begin_with_other_velocities_turn_nowhere(pace):
    """A clock that runs one per cent fast is told, and is no turn of every disk at the start."""
    times, places, _, _ = motion(SCENE)
    judged = es.validate(SCENE, trajectory=(pace * times, places), until=3.9)
    assert "turn" not in {fault.kind for fault in judged.judgement.faults}
    assert any("begin with velocities that differ from those of the scene" in text for text in judged.verdict)


@pytest.mark.parametrize("share", [0.12, 0.28])
def test_a_wall_that_takes_speed_along_it_is_friction(share):
    """And no wrong restitution: the part across the normal is told apart, as the wall's normal is known."""
    scene = es.Scene(es.Disks([[0.5, 0.5]], [[0.6, -0.5]], 0.1), es.Box((3.0, 3.0)))
    times = np.arange(0.0, 2.0, 0.01)
    late = np.maximum(times - 0.8, 0.0)
    speed = np.array([0.6 - 0.5 * share, 0.5])
    place = np.array([0.5, 0.5]) + np.outer(np.minimum(times, 0.8), [0.6, -0.5]) + np.outer(late, speed)
    first = es.validate(scene, trajectory=(times, place[:, None])).first_fault
    assert first.kind == "friction"
    assert "of its impulse across the normal" in first.sentence


def test_disks_that_spin_are_not_judged():
    times, places, _, _ = motion(SCENE)
    with pytest.raises(es.EventsimError, match="the disks of this scene spin"):
        es.validate(replace(SCENE, tangential_restitution=1.0), trajectory=(times, places))


@pytest.mark.parametrize("wide", [False, True])
def test_disks_that_are_counted_from_one_are_told_as_we_count_them(missed, tmp_path, wide):
    """In rows, in columns x1, y1, ..., and in contacts beside them."""
    times, places, _, contacts = missed
    if wide:
        rows, head = np.column_stack([times, places.reshape(len(times), -1)]), "time,x1,y1,x2,y2,x3,y3,x4,y4,x5,y5,x6,y6,x7,y7"
    else:
        rows = [(time, disk + 1, *place) for time, row in zip(times, places, strict=True) for disk, place in enumerate(row)]
        head = "time,disk,x,y"
    np.savetxt(tmp_path / "one.csv", rows, delimiter=",", header=head, comments="")
    met = [(time, a + 1, b + 1 if b >= 0 else -1) for time, a, b, _ in contacts]
    judged = es.validate(SCENE, trajectory=tmp_path / "one.csv", contacts=met)
    assert judged.verdict[1] == "its disks are counted from 1 on; here the first one is disk 0"
    assert judged.first_fault.disks == (3, 4)
    assert judged.judgement.charge.false == 0
    with pytest.raises(es.EventsimError, match=r"row \d+: a = 0: names no disk; they are 1 to 7, as in the motion"):
        es.validate(SCENE, trajectory=tmp_path / "one.csv", contacts=[row[:3] for row in contacts])


def test_an_energy_from_positions_alone_says_so():
    scene = es.Scene(es.Disks([(1.0, 1.0)], [(1.0, 0.0)], 0.25), es.Box((4.0, 2.0)), until=1.0)
    times = np.linspace(0.0, 1.0, 33)
    places = np.stack([1.0 + times, np.ones(33)], axis=1)[:, None]
    assert "The energy, estimated from differences" in str(es.validate(scene, trajectory=(times, places)))
    told = es.validate(scene, trajectory=(times, places, np.broadcast_to([1.0, 0.0], places.shape)))
    assert "The energy changes by" in str(told)

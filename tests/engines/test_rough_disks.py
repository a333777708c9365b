"""Scenes of disks that spin: their keys, their logs in every form, what is kept, what is refused."""

import json

import numpy as np
import pytest

import eventsim as es
from eventsim.errors import EventsimError
from eventsim.replay.states import state_columns, write_csv
from eventsim.scene.files import scene_from_dict, scene_to_dict, scene_to_json, scene_to_toml, tables_of_toml

ULP = 2.0**-52

BOX = """
until = 3.0
tangential_restitution = {pair = 0.5, wall = 1.0}
[domain]
kind = "box"
size = [2.0, 2.0]
[[disk]]
position = [0.5, 0.5]
velocity = [1.0, 0.25]
radius = 0.25
spin = -3.0
moment = 0.4
[[disk]]
position = [1.5, 0.5]
radius = 0.25
mass = 2.0
"""


def scene_of(text=BOX, **keys):
    return scene_from_dict(tables_of_toml(text) | keys)


def three(domain, **keys):
    disks = es.Disks(
        position=[(0.5, 0.5), (1.5, 0.5625), (1.0, 1.25)],
        velocity=[(1.0, 0.25), (-0.5, 0.0), (0.125, -1.0)],
        radius=[0.25, 0.2, 0.125],
        mass=[1.0, 2.0, 1.5],
        spin=[1.0, -2.0, 0.25],
        moment=[0.5, 0.4, 1.0],
    )
    return es.Scene(disks, domain, **{"tangential_restitution": 1.0, **keys})


def run(scene, **options):
    return es.simulate(scene, engine="reference", **{"events": 60, "log": True, **options})


def test_a_scene_file_with_spins_comes_back_bit_for_bit():
    scene = scene_of()
    assert scene.disks.spins().tolist() == [-3.0, 0.0]
    assert scene.disks.moments().tolist() == [0.4, 0.5]
    for again in (
        scene_from_dict(scene_to_dict(scene)),
        scene_from_dict(json.loads(scene_to_json(scene))),
        scene_of(scene_to_toml(scene)),
    ):
        assert again == scene
        assert hash(again.disks) == hash(scene.disks)


def test_a_gas_and_a_file_of_disks_have_spins(tmp_path):
    gas = 'tangential_restitution = 0.5\n[domain]\nkind = "box"\nsize = [9.0, 9.0]\n[[gas]]\ncount = 5\nradius = 0.5\nseed = 1\n'
    scene = scene_of(gas + "spin = 2.0\nmoment = 0.25\n")
    assert (scene.disks.spins() == 2.0).all()
    assert (scene.disks.moments() == 0.25).all()
    columns = state_columns(scene, [run(scene, events=None, until=0.5).state])
    with (tmp_path / "start.csv").open("wb") as file:
        write_csv(file, columns)
    again = scene_from_dict(
        {"tangential_restitution": 0.5, "domain": {"kind": "box", "size": [9.0, 9.0]}, "disks_file": [{"path": "start.csv"}]},
        tmp_path,
    )
    assert again.disks == scene.disks


def test_a_scene_without_roughness_has_no_column_of_it():
    smooth = es.simulate(es.gallery("two-disks"), events=3, engine="reference", log=True)
    assert "spin_a" not in smooth.log.rows.dtype.names
    assert smooth.state.spin is None
    assert not hasattr(smooth.log, "spin_a")


@pytest.mark.parametrize("suffix", ["csv", "jsonl", "npz", "parquet"])
@pytest.mark.parametrize("compact", [False, True])
def test_logs_of_every_form_tell_spins(tmp_path, suffix, compact):
    scene = three(es.Box((2.0, 2.0)), restitution=0.9)
    whole = run(scene)
    path = tmp_path / f"log.{suffix}"
    assert run(scene, log=path, compact=compact).digest == whole.digest
    log = es.load_log(path)
    assert log.digest() == whole.log.digest() == whole.digest
    full = log.expand()
    assert np.array_equal(full.spin_a, whole.log.spin_a)
    assert np.array_equal(full.spin_b, whole.log.spin_b, equal_nan=True)
    assert log.to_pandas()["spin_a"].tolist() == whole.log.spin_a.tolist()
    from eventsim.replay.audit import audit

    assert audit(path).digest == whole.digest


def test_the_digest_tells_spins():
    rows = run(three(es.Box((2.0, 2.0)))).log.rows.copy()
    from eventsim.record.digest import digest_of

    before = digest_of(rows)
    rows["spin_b"][np.flatnonzero(rows["b"] >= 0)[0]] += 1.0
    assert digest_of(rows) != before


def test_replay_gives_the_spins_of_the_run():
    scene = three(es.Periodic((2.0, 2.0)))
    whole = run(scene, events=None, until=6.0)
    assert np.array_equal(whole.state_at(6.0).spin, whole.state.spin)
    assert whole.state_at(0.0).spin.tolist() == [1.0, -2.0, 0.25]
    part = run(scene, events=None, until=2.5)
    assert np.array_equal(whole.state_at(2.5).spin, part.state.spin)


@pytest.mark.parametrize("compact", [False, True])
def test_a_run_goes_on_from_a_checkpoint_with_its_spins(tmp_path, compact):
    scene = three(es.Box((2.0, 2.0)), restitution=0.9)
    whole = run(scene)
    run(scene, events=25, log=tmp_path / "log.npz", compact=compact, checkpoint=tmp_path / "run.ckpt")
    more = es.simulation.resume(tmp_path / "run.ckpt", events=60)
    assert more.digest == whole.digest
    assert np.array_equal(more.state.spin, whole.state.spin)


def test_a_kick_leaves_the_spin_as_it_is():
    simulation = es.Simulation(three(es.Box((2.0, 2.0))), engine="reference")
    simulation.step()
    before = simulation.state.spin.copy()
    simulation.set_velocity(1, (0.5, 0.5))
    row = simulation.log.rows[-1]
    assert simulation.log[-1].kind == "kick"
    assert row["spin_a"] == before[1]
    assert np.array_equal(simulation.state.spin, before)


def test_energy_and_angular_momentum_are_kept_by_perfectly_rough_disks():
    kept = run(three(es.Box((2.0, 2.0))))
    assert abs(kept.residuals.energy) < 64 * ULP * 60  # a few ulp a contact
    start, end = kept.state_at(0.0), kept.state
    assert end.energy == pytest.approx(start.energy, rel=64 * ULP * 60)
    assert kept.residuals.angular_momentum is None  # walls turn disks
    free = run(three(es.Open()))
    assert free.counters.pair_contacts > 0
    assert abs(free.residuals.angular_momentum) < 64 * ULP
    assert free.residuals.momentum < 16 * ULP


def test_a_loss_along_surfaces_is_no_residual():
    assert run(three(es.Box((2.0, 2.0)), tangential_restitution=0.5)).residuals.energy is None
    assert run(three(es.Box((2.0, 2.0)), tangential_restitution=-1.0)).residuals.energy is not None


def test_smooth_disks_keep_their_spins_and_write_the_places_of_disks_without():
    told = run(three(es.Box((2.0, 2.0)), tangential_restitution=-1.0))
    disks = told.scene.disks
    bare = es.Scene(es.Disks(disks.position, disks.velocity, disks.radius, disks.mass), es.Box((2.0, 2.0)))
    plain = run(bare)
    assert told.state.spin.tolist() == disks.spin.tolist()
    for name in plain.log.rows.dtype.names:
        assert np.array_equal(told.log.rows[name], plain.log.rows[name], equal_nan=told.log.rows[name].dtype.kind == "f")


def test_a_turning_post_drives_what_it_meets_and_turns_on():
    disks = es.Disks([(0.0, 0.0), (2.0, 0.0)], [(1.0, 0.0), (0.0, 0.0)], 0.5, [1.0, np.inf], spin=[0.0, 4.0])
    driven = run(es.Scene(disks, es.Open(), tangential_restitution=0.0), events=1)
    assert driven.state.spin[1] == 4.0
    # slides at -r w_b = -2 along t = (0, -1): a third of it, q / (1 + q), goes into the velocity, away from the surface
    assert driven.state.velocity[0].tolist() == pytest.approx([-1.0, 2.0 / -3.0], abs=8 * ULP)
    assert driven.residuals.energy is None


def test_a_wall_turns_no_disk_that_cannot_be_deflected():
    disks = es.Disks([(1.0, 1.0)], [(1.0, 0.5)], 0.5, np.inf, spin=2.0)
    met = run(es.Scene(disks, es.Box((3.0, 3.0)), tangential_restitution=0.5), events=3)
    assert met.state.spin.tolist() == [2.0]
    assert np.abs(met.state.velocity).tolist() == [[1.0, 0.5]]


def test_rough_contacts_of_one_instant_that_share_disks_stop_the_run():
    disks = es.Disks([(0.0, 0.0), (2.0, 0.5), (2.0, -0.5)], [(1.0, 0.0), (0.0, 0.0), (0.0, 0.0)], 0.5)
    stopped = run(es.Scene(disks, es.Open(), tangential_restitution=0.5))
    assert stopped.stopped == "law"
    assert "disks 0, 1, 2 have contacts at one instant: the law of rough disks" in stopped.reason
    corner = es.Disks([(1.0, 1.0)], [(1.0, 1.0)], 0.5)
    assert run(es.Scene(corner, es.Box((3.0, 3.0)), tangential_restitution={"pair": 0.5}), events=4).stopped == "events"
    assert run(es.Scene(corner, es.Box((3.0, 3.0)), tangential_restitution=0.5), events=4).stopped == "law"


def test_disks_that_would_roll_on_a_rough_wall_stop_the_run():
    disks = es.Disks([(1.0, 1.0)], [(0.5, 0.0)], 0.5)
    falling = es.Scene(disks, es.Box((3.0, 3.0)), gravity=(0.0, -1.0), restitution=0.5, tangential_restitution=0.5)
    assert run(falling, events=1000).stopped == "collapse"


def test_proofs_know_rough_disks():
    pytest.importorskip("flint")
    scene = three(es.Box((2.0, 2.0)), restitution=0.9, tangential_restitution=0.5)
    float64, proven = run(scene, events=15), es.simulate(scene, events=15, engine="certified", log=True)
    for name in ("kind", "a", "b", "wall"):
        assert np.array_equal(proven.log.rows[name], float64.log.rows[name])
    assert proven.log.spin_a == pytest.approx(float64.log.spin_a, abs=1e-9)  # errors grow by less than 4 a contact


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"tangential_restitution": 1.5}, "tangential_restitution = 1.5: must be from -1 (smooth) to 1 (perfectly rough)"),
        ({"tangential_restitution": {"pair": -2}}, "tangential_restitution.pair = -2.0: must be from -1"),
        ({"tangential_restitution": {"walls": 1}}, 'tangential_restitution.walls: unknown key (did you mean "wall"?)'),
        ({"tangential_restitution": "rough"}, "tangential_restitution = 'rough': must be a number"),
    ],
)
def test_a_wrong_roughness_is_told(change, said):
    with pytest.raises(es.SceneError) as error:
        scene_of(**change)
    assert said in str(error.value)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("spin = nan", "disk[1].spin = nan: must be 0, or"),
        ("moment = 0", "disk[1].moment = 0.0: must be at most 1 and at least 1e-09"),
        ("moment = 1.5", "disk[1].moment = 1.5: must be at most 1"),
        ("radius = 0", "disk[1].radius = 0.0: a point has no surface that could be rough"),
        ("mass = 0", "disk[1].mass = 0.0: a tracer has no moment that could turn"),
    ],
)
def test_a_disk_that_cannot_be_rough_is_told(line, said):
    key = line.split()[0]
    first, last = BOX.rsplit("[[disk]]", 1)
    kept = "\n".join(each for each in last.splitlines() if not each.startswith(f"{key} ="))
    with pytest.raises(es.SceneError) as error:
        scene_of(f"{first}[[disk]]{kept}\n{line}\n")
    assert str(error.value).startswith(said)
    assert "\n" not in str(error.value)


def test_spins_of_smooth_disks_are_refused():
    text = BOX.replace("tangential_restitution = {pair = 0.5, wall = 1.0}\n", "")
    with pytest.raises(es.SceneError) as error:
        scene_of(text)
    assert error.value.problems == (
        "disk[0].spin = -3.0: is for disks that turn: say tangential_restitution = 0.5, or -1 where they are smooth and their "
        "spins are to be told",
        "disk[0].moment = 0.4: is for disks that turn: say tangential_restitution = 0.5, or -1 where they are smooth and their "
        "spins are to be told",
    )


@pytest.mark.parametrize("engine", ["frames", "stepped", "penalty"])
def test_stepped_engines_refuse_disks_that_spin(engine):
    with pytest.raises(EventsimError, match=f"{engine} cannot simulate this scene: it knows no disks that spin"):
        es.simulate(scene_of(), engine=engine)


def test_trajectories_of_disks_that_spin_are_not_judged(tmp_path):
    whole = run(three(es.Box((2.0, 2.0))), events=None, until=1.0)
    states = [whole.state_at(t) for t in (0.0, 0.25, 0.5, 0.75)]
    path = tmp_path / "motion.csv"
    with path.open("wb") as file:
        write_csv(file, state_columns(whole.scene, states))
    with pytest.raises(EventsimError, match="the disks of this scene spin"):
        es.validate(whole.scene, trajectory=path)

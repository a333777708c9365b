"""Walls that shake, heat and slide: what they do to a disk, where their way is, and what is refused."""

import math

import numpy as np
import pytest

import eventsim as es
from eventsim.formulas.chance import flux
from eventsim.scene.contact_law import law_of_scene

FAST = 2.0**20
"""A wall so much faster than its temperature lets a disk be tells its direction."""


def one(position, velocity, walls=(), domain=None, radius=0.25, **keys):
    return es.Scene(es.Disks([position], [velocity], radius), domain or es.Open(), walls, name="one", **keys)


def after(scene, events=1, engine="reference"):
    return es.simulate(scene, events=events, engine=engine)


def box(**walls):
    return es.Box((6.0, 6.0), walls=walls)


@pytest.mark.parametrize("engine", ["reference", "fast"])
def test_a_wall_that_shakes_throws_back_as_one_that_comes_to_meet(engine):
    if engine == "fast":
        pytest.importorskip("numba")
    run = after(one([3.0, 3.0], [-4.0, 1.0], domain=box(left={"shaking": 1.0, "restitution": 0.5})), engine=engine)
    assert run.state.velocity.tolist() == [[0.5 * 4.0 + 1.5 * 1.0, 1.0]]
    assert (run.residuals.energy, run.residuals.momentum) == (None, 0.0)
    wall = es.Segment((-4.0, 4.0), (4.0, -4.0), shaking=2.0)
    run = after(one([3.0, 3.0], [-1.0, -1.0], [wall]), engine=engine)
    assert run.state.velocity == pytest.approx(np.full((1, 2), 1.0 + 2.0 * np.sqrt(2.0)), abs=1e-14)


def test_a_corner_of_walls_that_shake_is_two_contacts():
    scene = one([3.0, 3.0], [-4.0, -4.0], domain=box(left={"shaking": 1.0, "restitution": 0.5}, bottom={"shaking": 2.0}))
    run = es.simulate(scene, events=2, engine="reference", log=True)
    assert run.state.velocity.tolist() == [[3.5, 8.0]]
    assert run.log.joint.tolist() == [0, 0]


def test_a_corner_with_a_wall_that_heats_stops_the_run():
    run = after(one([3.0, 3.0], [-4.0, -4.0], domain=box(left={"temperature": 1.0}), seed=1))
    assert (run.stopped, run.counters.events) == ("law", 0)
    assert "the law of walls that heat or shake" in run.reason


WAYS = [
    (es.Segment, ((0, 0), (4, 3)), [0.0, 2.0], [3.0, -4.0], (0.8, 0.6)),
    (es.Segment, ((0, 0), (4, 3)), [4.0, -2.0], [-3.0, 4.0], (0.8, 0.6)),
    (es.Circle, ((0, 0), 5.0), [1.0, 0.0], [1.0, 0.0], (0.0, 1.0)),
    (es.Arc, ((5, 0), (0, 5), (-5, 0)), [0.0, 1.0], [0.0, 1.0], (-1.0, 0.0)),
    (es.Arc, ((5, 0), (0, 5), (-5, 0)), [0.0, 9.0], [0.0, -1.0], (-1.0, 0.0)),
    (es.Arc, ((-5, 0), (0, 5), (5, 0)), [0.0, 1.0], [0.0, 1.0], (1.0, 0.0)),
    (es.Ellipse, ((0, 0), (5, 4)), [0.0, 1.0], [0.0, 1.0], (-1.0, 0.0)),
]


@pytest.mark.parametrize(("kind", "shape", "position", "velocity", "way"), WAYS)
def test_a_wall_slides_from_start_to_end_and_round_ones_counter_clockwise(kind, shape, position, velocity, way):
    wall = kind(*shape, temperature=1.0, velocity=FAST)
    run = after(one(position, velocity, [wall], radius=0.0 if kind is es.Ellipse else 0.25, seed=1))
    assert run.state.velocity[0] / FAST == pytest.approx(way, abs=1e-4)


@pytest.mark.parametrize(
    ("side", "velocity", "way"),
    [("left", [-1, 0], (0, 1)), ("right", [1, 0], (0, 1)), ("bottom", [0, -1], (1, 0)), ("top", [0, 1], (1, 0))],
)
def test_a_side_of_the_domain_slides_up_or_to_the_right(side, velocity, way):
    run = after(one([3.0, 3.0], velocity, domain=box(**{side: {"temperature": 1.0, "velocity": FAST}}), seed=1))
    assert run.state.velocity[0] / FAST == pytest.approx(way, abs=1e-4)


def test_the_end_of_a_wall_does_not_slide():
    wall = es.Segment((0, 0), (4, 0), temperature=1.0, velocity=FAST)
    run = after(one([-3.0, 0.0], [1.0, 0.0], [wall], seed=1))
    assert np.abs(run.state.velocity).max() < 10.0


def test_what_a_wall_draws_is_the_flux_of_its_temperature():
    """4096 disks of mass 4, each at the wall once: at kT = 2 the mean of m vy^2 / 2 is kT, that of m vx^2 / 2 half of it."""
    count = 4096
    place = np.stack([np.arange(count) * 4.0 + 2.0, np.full(count, 2.0)], axis=1)
    disks = es.Disks(place, np.tile([0.0, -1.0], (count, 1)), 0.5, 4.0)
    scene = es.Scene(disks, es.Box((4.0 * count, 4.0), walls={"bottom": {"temperature": 2.0, "velocity": 3.0}}), seed=5)
    velocity = es.simulate(scene, events=count, engine="reference").state.velocity
    bar = 4.0 / np.sqrt(count)
    assert np.all(velocity[:, 1] > 0.0)
    assert np.mean(2.0 * velocity[:, 1] ** 2) == pytest.approx(2.0, abs=2.0 * bar)
    assert np.mean(velocity[:, 0]) == pytest.approx(3.0, abs=np.sqrt(0.5) * bar)
    assert np.mean(2.0 * (velocity[:, 0] - 3.0) ** 2) == pytest.approx(1.0, abs=np.sqrt(2.0) * bar)


def test_what_a_wall_draws_follows_from_the_number_of_contacts_that_the_log_shows():
    disks = es.Disks([[1.0, 1.0], [4.0, 2.0], [2.0, 4.5]], [[-3.0, 1.0], [-2.0, 0.5], [1.0, -2.0]], 0.5)
    scene = es.Scene(disks, box(left={"temperature": 2.0}), restitution={"pair": 0.9}, seed=2**40 + 5)
    log = es.simulate(scene, events=200, engine="reference", log=True).log
    before, drawn = [0, 0, 0], 0
    for row, wall in zip(log.rows, log.wall_name, strict=True):
        if wall == "left":
            out, along, _ = flux((2**40 + 5, int(row["a"]), before[row["a"]]))
            assert (row["vxa"], abs(row["vya"])) == (math.sqrt(2.0) * out, math.sqrt(2.0) * abs(along))
            drawn += 1
        for i in (row["a"], row["b"]):
            if i >= 0:
                before[i] += 1
    assert drawn > 20


def test_disks_of_other_seeds_leave_otherwise():
    def found(seed):
        return after(one([3.0, 3.0], [1.0, 0.5], domain=box(right={"temperature": 1.0}), seed=seed)).state.velocity.tolist()

    assert found(1) == found(1)
    assert found(1) != found(2)


def test_keys_of_driven_walls_go_through_files(tmp_path):
    walls = [es.Segment((1, 1), (2, 1), temperature=2.0, velocity=-1.0), es.Circle((3.0, 3.0), 3.0, shaking=0.5)]
    scene = one([3.0, 3.0], [1.0, 0.0], walls, box(left={"shaking": 0.25, "restitution": 0.5}), seed=2**40)
    for suffix in ("toml", "json"):
        scene.save(tmp_path / f"scene.{suffix}")
        assert es.load_scene(tmp_path / f"scene.{suffix}") == scene
    assert es.load_scene(tmp_path / "scene.toml", seed=7).seed == 7
    words = law_of_scene(scene).driven_words(str)
    assert words == "; walls heat, by chance, at kT = 2.0; walls shake at 0.25 or 0.5; walls slide at -1.0"


@pytest.mark.parametrize(
    ("keys", "seed", "message"),
    [
        ({"temperature": 1.0}, None, "seed is missing: where chance is used"),
        ({"temperature": 1.0, "restitution": 0.5}, 1, "domain.walls.left.restitution stands beside temperature"),
        ({"temperature": 1.0, "shaking": 0.5}, 1, "domain.walls.left.shaking stands beside temperature"),
        ({"temperature": 0.0}, 1, "domain.walls.left.temperature = 0.0: must be from"),
        ({"shaking": -1.0}, None, "domain.walls.left.shaking = -1.0: must be 0 or from 1e-75 to 1e+75"),
        ({"velocity": float("inf")}, None, "domain.walls.left.velocity = inf: must be 0 or from 1e-75 to 1e+75, along"),
        ({"temperature": 1.0}, -1, "seed = -1: must be a whole number from 0"),
    ],
)
def test_what_cannot_be_is_refused(keys, seed, message):
    with pytest.raises(es.SceneError) as refused:
        one([3.0, 3.0], [1.0, 0.0], domain=box(left=keys), seed=seed)
    assert message in str(refused.value)


@pytest.mark.parametrize("mass", [0.0, np.inf])
def test_only_what_has_a_temperature_is_heated(mass):
    disks = es.Disks([[1.0, 1.0], [3.0, 3.0]], [[0.0, 0.0], [1.0, 0.0]], 0.25, [1.0, mass])
    with pytest.raises(es.SceneError, match=r"domain.walls.top.temperature: disk\[1\] has mass"):
        es.Scene(disks, box(top={"temperature": 1.0}), seed=1)


def test_no_disk_comes_to_rest_on_a_wall_that_shakes_or_heats():
    for treatment in ({"shaking": 0.5}, {"temperature": 0.1}):
        scene = one([3.0, 3.0], [0.0, 0.0], domain=box(bottom=treatment), gravity=(0.0, -1.0), restitution=0.5, seed=1)
        run = es.simulate(scene, until=40.0, engine="reference")
        assert (run.counters.rests, run.stopped) == (0, "until")


def test_an_engine_that_does_not_know_them_says_so():
    with pytest.raises(es.EventsimError, match="walls that heat, shake or slide"):
        es.simulate(one([3.0, 3.0], [1.0, 0.0], domain=box(left={"shaking": 0.5})), events=1, engine="stepped")

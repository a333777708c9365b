"""Until when positions hold: the tangent map against neighbouring runs, the estimate against proofs."""

import math
from dataclasses import replace

import numpy as np
import pytest

import eventsim as es
from eventsim.measure.tangent import Tangent
from eventsim.measure.trust import HELD, TrustLine, smallest_reach
from eventsim.scene.roughness import TangentialRestitution
from eventsim.scene.stage import stage_of
from tests.engines.law_scenes import random_scene
from tests.measure.trust_table import compared, generic_scene, truth

STEP = 2.0**-34
"""Of a neighbour: the square of it is what the tangent map leaves out."""


def one_point_of(scene):
    """The same scene without its second point, which meets the post at the same times."""
    disks = scene.disks
    return replace(scene, disks=es.Disks(disks.position[:2], disks.velocity[:2], disks.radius[:2], disks.mass[:2]))


def rough(seed):
    """A scene of the table whose disks spin, and grip."""
    scene = generic_scene(seed)
    spin = np.random.default_rng(seed).normal(size=len(scene.disks)) / scene.disks.radius * np.isfinite(scene.disks.mass)
    moment = np.where(np.arange(len(scene.disks)) % 2, 0.5, 0.3)
    disks = es.Disks(*(getattr(scene.disks, key) for key in ("position", "velocity", "radius", "mass")), spin=spin, moment=moment)
    return replace(scene, disks=disks, tangential_restitution=TangentialRestitution(0.6, -0.3))


SCENES = {
    "gas": (es.gallery("gas", n=12), 60),
    "sinai": (one_point_of(es.gallery("sinai")), 8),
    "stadium": (es.gallery("stadium"), 8),
    "funnel": (es.gallery("funnel"), 60),
    "galperin": (es.gallery("galperin"), 31),
    "round wall": (generic_scene(3), 60),
    "a post": (generic_scene(4), 60),
    "falling": (generic_scene(0), 60),
    "vibrated": (es.gallery("vibrated", n=6), 60),
    "rough": (rough(0), 60),
    "rough mixture in a box": (rough(1), 60),
    "rough in a jar": (rough(3), 60),
    "rough, falling": (rough(10), 60),
    "sheared": (es.gallery("sheared", n=12), 60),
    "shaken box": (random_scene(9, "walls that shake"), 60),
    "shaken arc": (random_scene(11, "walls that shake"), 60),
}


def rows_of(scene, events):
    return es.simulate(scene, events=events, engine="reference", log=True).log.rows


@pytest.mark.parametrize("name", SCENES)
def test_deviations_are_those_of_a_neighbouring_run(name):
    scene, events = SCENES[name]
    rng = np.random.default_rng(5)
    disks = scene.disks
    moves = np.isfinite(disks.mass)[:, None] * rng.uniform(0.1, 1.0, (2, len(disks), 2)) * smallest_reach(scene)
    turns = np.isfinite(disks.mass) * rng.uniform(0.1, 1.0, len(disks)) if scene.tangential_restitution is not None else None
    turned = {} if turns is None else {"spin": disks.spins() + STEP * turns}
    neighbour = replace(
        scene,
        disks=replace(disks, position=disks.position + STEP * moves[0], velocity=disks.velocity + STEP * moves[1], **turned),
    )
    rows, others = rows_of(scene, events), rows_of(neighbour, events)
    shifted = stage_of(neighbour).corner[0] - stage_of(scene).corner[0]
    tangent = Tangent(scene, [(*moves[0][i], *moves[1][i]) for i in range(len(disks))])
    if turns is not None:
        tangent.spun = turns.tolist()
    tried = 0
    for row, other, passed in zip(rows, others, tangent.follow(rows), strict=True):
        i = passed.disks[0]
        dx, dy, du, dw = tangent.off[i]
        if (row["a"], row["b"], row["wall"]) != (other["a"], other["b"], other["wall"]) or passed.joint:
            break
        size = max(abs(dx), abs(dy), abs(du), abs(dw))
        if STEP * size > 1e-4 * smallest_reach(scene):
            break  # what is left out, the square of a deviation, grows as well
        later = other["time"] - row["time"]
        tried += 1
        assert later / STEP == pytest.approx(passed.shift, rel=0.02, abs=1e-3 * size)
        assert (other["vxa"] - row["vxa"]) / STEP == pytest.approx(
            du + scene_pull(scene, i, 0) * later / STEP, abs=0.02 * size
        )
        assert (other["xa"] + shifted - row["xa"]) / STEP == pytest.approx(
            dx + row["vxa"] * later / STEP, abs=0.02 * size
        )
        if turns is not None:
            around = disks.radius[i]
            assert around * (other["spin_a"] - row["spin_a"]) / STEP == pytest.approx(around * tangent.spun[i], abs=0.02 * size)
    assert tried >= min(6, events)


def scene_pull(scene, i, axis):
    return 0.0 if scene.gravity is None or math.isinf(scene.disks.mass[i]) else scene.gravity[axis]


@pytest.mark.parametrize("seed", [6, 11])
def test_it_says_when_the_run_parts_from_its_proof(seed):
    pytest.importorskip("flint")
    line, event, _ = compared(seed)
    assert 1.0 / 1.5 < (line.event + 1) / (event + 1) < 1.5


@pytest.mark.parametrize("seed", [6, pytest.param(11, marks=pytest.mark.slow)])
def test_it_says_so_of_disks_that_spin(seed):
    pytest.importorskip("flint")
    scene = rough(seed)
    rows = rows_of(scene, None)
    line = TrustLine(scene)
    line.write(rows)
    event, _ = truth(scene, rows)
    assert 1.0 / 1.5 < (line.found().event + 1) / (event + 1) < 1.5


@pytest.mark.slow
def test_fifty_scenes_against_their_proofs():
    pytest.importorskip("flint")
    found = [compared(seed) for seed in range(50)]
    ratios = [(line.event + 1) / (event + 1) for line, event, _ in found if None not in (line.event, event)]
    assert len(ratios) >= 48
    assert max(ratios) < 1.5
    assert 1.0 / 1.3 < math.exp(np.mean(np.log(ratios))) < 1.3


def trust_of(scene, **options):
    line = TrustLine(scene)
    line.write(es.simulate(scene, engine="reference", log=True, **options).log.rows)
    return line.found()


def test_exact_ties_have_no_estimate():
    assert "one instant" in trust_of(es.gallery("break")).reason
    assert "exactly the time" in trust_of(es.gallery("newton-cradle")).reason


def test_errors_of_a_regular_motion_grow_gently():
    found = trust_of(es.gallery("galperin", mass_ratio=10000.0))
    assert found.event is None
    assert found.error < 1e-9
    assert found.gentle


def test_places_hold_while_there_is_no_event():
    scene = es.Scene(es.Disks([[2.0, 2.0]], [[1.0, 0.0]], 0.5), es.Box((4.0, 4.0)), until=1.0)
    found = trust_of(scene)
    assert (found.event, found.error, found.reason) == (None, 0.0, None)


def test_a_ball_that_comes_to_rest_is_known_to_the_end():
    """Its last bounces are shorter than their times are known, but have no other order."""
    ball = es.Scene(es.Disks([[0.5, 1.05]], radius=0.05), es.Box((1.0, 2.0)), gravity=(0.0, -9.81), restitution=0.8)
    run = es.simulate(ball, until=10.0, engine="reference", log=True)
    line = TrustLine(ball)
    line.write(run.log.rows)
    found = line.found()
    assert run.stopped == "quiet"
    assert (found.event, found.reason) == (None, None)
    assert 0.0 < found.error < 1e-12


def test_points_are_measured_by_what_they_meet():
    assert smallest_reach(es.gallery("sinai")) == pytest.approx(0.25)
    nothing = es.Scene(es.Disks([[0.0, 0.0]], [[1.0, 0.0]], 0.0), es.Open(), until=1.0)
    assert "nothing to be met" in trust_of(nothing).reason


def test_a_run_tells_it_where_that_costs_little_or_where_it_is_asked():
    scene = es.gallery("gas", n=16)
    assert es.simulate(scene, events=400, engine="reference").trust.event is not None
    assert es.simulate(scene, events=400, log=True).trust.event is not None
    assert es.simulate(scene, events=400, trust=True).trust.event is not None
    assert es.simulate(scene, events=400).trust is None
    assert es.simulate(scene, events=400, engine="reference", trust=False).trust is None
    with pytest.raises(es.EventsimError, match="trust is about"):
        es.simulate(scene, until=0.01, engine="stepped", trust=True)


def test_it_says_how_far_it_looked():
    scene = es.gallery("gas", n=16)
    line = TrustLine(scene, most=50)
    line.write(rows_of(scene, 100))
    assert line.found().reason == "only the first 50 events were looked at"
    assert line.found().error < HELD

"""Disks that are placed by growth."""

import math

import numpy as np
import pytest

import eventsim as es
from eventsim.growth import compiled, kernel, schedule
from eventsim.growth.schedule import grown
from eventsim.scene.compressed import neighbours
from eventsim.scene.files import scene_from_dict

HEXAGONAL = [1.0, math.sqrt(3.0) / 2.0]


def mixture(n, eta, size=(1.0, 1.0), kind="periodic", **gas):
    """n disks, half of them 1.4 times as wide, that cover eta of the domain."""
    share = {1.0: eta / 2.96, 1.4: eta * 1.96 / 2.96}
    tables = [
        {"count": n // 2, "packing_fraction": part, "arrangement": "compressed", "seed": seed, **gas}
        for seed, part in enumerate(share.values())
    ]
    return scene_from_dict({"domain": {"kind": kind, "size": list(size)}, "gas": tables})


def packing_fraction(scene):
    return math.pi * float((scene.disks.radius**2).sum()) / math.prod(scene.domain.size)


@pytest.mark.parametrize("kind", ["periodic", "box", "channel"])
def test_a_dense_mixture_is_placed_without_overlap(kind):
    scene = mixture(24, 0.7, kind=kind)  # a scene with an overlap would have been refused
    assert packing_fraction(scene) == pytest.approx(0.7, rel=1e-12)
    radii = scene.disks.radius
    assert radii[-1] / radii[0] == pytest.approx(1.4, rel=1e-12)


def test_the_same_seed_gives_the_same_places():
    first, second = (mixture(16, 0.6, temperature=1.0) for _ in range(2))
    assert first == second
    assert mixture(16, 0.6, temperature=1.0, mass=2.0).disks.position.tolist() == first.disks.position.tolist()


def test_velocities_have_the_temperature_that_is_asked_for():
    disks = mixture(16, 0.6, temperature=2.0, mass=3.0).disks
    for half in (slice(0, 8), slice(8, 16)):
        assert 0.5 * 3.0 * (disks.velocity[half] ** 2).sum() == pytest.approx(8 * 2.0, rel=1e-12)


def test_equal_disks_beyond_freezing_grow_as_a_crystal():
    scene = scene_from_dict(
        {
            "domain": {"kind": "periodic", "size": HEXAGONAL},
            "gas": [{"count": 36, "packing_fraction": 0.9, "arrangement": "compressed", "seed": 1}],
        }
    )
    assert packing_fraction(scene) == pytest.approx(0.9, rel=1e-12)


def test_a_compressed_state_runs():
    run = es.simulate(mixture(24, 0.7, temperature=1.0), events=500, engine="reference")
    assert run.stopped == "events"
    assert run.residuals.max_overlap < 1e-14
    assert abs(run.residuals.energy) < 1e-13


def test_a_region_of_the_domain_is_filled():
    scene = mixture(24, 0.3, size=(2.0, 1.0), kind="box", region=[1.0, 0.25, 2.0, 1.0])
    x, y = scene.disks.position.T
    assert (x - scene.disks.radius).min() >= 1.0
    assert (y - scene.disks.radius).min() >= 0.25


def test_too_dense_a_mixture_says_how_far_it_came(monkeypatch):
    pytest.importorskip("numba")  # plain Python takes its time to find out
    monkeypatch.setattr(schedule, "ATTEMPTS", 1)  # the later ones are slower still
    with pytest.raises(es.SceneError, match=r"gas\[0\].*jammed at a packing fraction of 0\.[78]"):
        mixture(50, 0.9)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"wall": [{"kind": "segment", "start": [0.3, 0.3], "end": [0.6, 0.6]}]}, "must be free of walls"),
        ({"disk": [{"position": [0.5, 0.5], "radius": 0.2}]}, "must be free of walls and of other disks"),
        (
            {"domain": {"kind": "periodic", "size": [1.0, 0.01]}},
            "four of its diameters|wider than the region|no arrangement|do not fit",
        ),
    ],
)
def test_what_is_in_the_way_is_named(change, message):
    gas = [{"count": 16, "radius": 0.1, "arrangement": "compressed", "seed": 1}]
    with pytest.raises(es.SceneError, match=message):
        scene_from_dict({"domain": {"kind": "periodic", "size": [1.0, 1.0]}, "gas": gas, **change})


def test_machine_code_gives_the_bits_of_python(monkeypatch):
    pytest.importorskip("numba")
    sites = (np.array([(i, j) for i in range(7) for j in range(7)]) + 0.5) / 7.0
    radius = np.full(49, math.sqrt(0.75 / (49 * math.pi)))
    scale = math.sqrt(0.3 / 0.75)

    def places(seed):
        return grown(sites.copy(), radius, scale, (1.0, 1.0), (1.0, math.inf), np.random.default_rng(seed), neighbours)

    assert compiled.grower(49) is not kernel.grow
    fast = places(1)
    monkeypatch.setattr(compiled, "FEW", 100)
    assert compiled.grower(49) is kernel.grow
    assert places(1).tobytes() == fast.tobytes()


@pytest.mark.parametrize("rate", [0.0, 0.1, 3.0])
def test_a_growing_pair_touches_when_the_delay_says(rate):
    delay = kernel.growing_delay(3.0, 0.5, -1.0, 0.1, 1.0, rate)
    distance = math.hypot(3.0 - delay, 0.5 + 0.1 * delay)
    assert distance == pytest.approx(1.0 + rate * delay, rel=1e-14)
    assert delay > 0.0


def test_receding_disks_meet_only_if_they_grow_faster():
    assert kernel.growing_delay(3.0, 0.0, 1.0, 0.0, 1.0, 0.5) == math.inf
    assert kernel.growing_delay(3.0, 0.0, 1.0, 0.0, 1.0, 2.0) == 2.0


@pytest.mark.slow
def test_a_thousand_disks_at_084():
    pytest.importorskip("numba")
    scene = mixture(1000, 0.84, temperature=1.0)
    run = es.simulate(scene, events=100_000)
    assert run.stopped == "events"
    assert run.residuals.max_overlap < 1e-13

"""Measured values against theory, with bars that mean something; what the issue of measurements asks for, a minute each.

Sources: equation of state, Kolafa & Rottner 2006 (`measure.theory`); mixtures, Jenkins & Mancini 1987; pi A / P, N. Chernov,
J. Stat. Phys. 88, 1 (1997), doi:10.1007/BF02508462.
"""

import math

import numpy as np
import pytest

import eventsim as es
from eventsim.measure.blocking import block_average
from eventsim.scene.files import scene_from_dict

pytestmark = [pytest.mark.slow, pytest.mark.timeout(3600)]


def measured(scene, **stop):
    pytest.importorskip("numba")
    return es.simulate(scene, engine="fast", measure=True, **stop).measures


@pytest.mark.parametrize("eta", [0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
def test_z_of_the_fluid(eta):
    z = measured(es.gallery("periodic-fluid", n=256, packing_fraction=eta, seed=5), events=2_000_000)["Z"]
    assert z.error < 2e-3 * z.value
    assert abs(z.deviation) < 3.0


def binary(seed=3):
    """Two species, diameters 1 and 2, masses 1 and 4, at a packing fraction of 0.2."""
    many, few = 400, 100
    area = (many * math.pi * 0.25 + few * math.pi) / 0.2
    side = math.sqrt(area)
    gas = {"temperature": 1.0, "arrangement": "random"}
    return scene_from_dict(
        {
            "domain": {"kind": "periodic", "size": [side, side]},
            "gas": [
                {"count": few, "radius": 1.0, "mass": 4.0, "seed": seed, **gas},
                {"count": many, "radius": 0.5, "mass": 1.0, "seed": seed + 1, **gas},
            ],
        }
    )


def test_rates_and_contact_values_of_a_mixture():
    measures = measured(binary(), events=3_000_000)
    names = [name for name in measures if name.startswith(("collision_rate_", "contact_value_"))]
    assert len(names) == 2 + 4 + 3
    for name in names:
        one = measures[name]
        assert one.value == pytest.approx(one.theory, rel=0.02), name
        assert one.error < 0.01 * one.value, name


def starts(inside, count, seed):
    """Places where `inside` holds, even in area, and directions."""
    rng = np.random.default_rng(seed)
    places = []
    while len(places) < count:
        place = rng.uniform(-2.0, 2.0, 2)
        if inside(*place):
            places.append(place)
    angle = rng.uniform(0.0, 2.0 * math.pi, count)
    return np.array(places), np.column_stack([np.cos(angle), np.sin(angle)])


TABLES = {
    "stadium": (
        lambda x, y: math.hypot(max(abs(x) - 1.0, 0.0), y) < 0.99,
        es.Open(),
        [
            es.Arc((1.0, -1.0), (2.0, 0.0), (1.0, 1.0)),
            es.Arc((-1.0, 1.0), (-2.0, 0.0), (-1.0, -1.0)),
            es.Segment((-1.0, -1.0), (1.0, -1.0)),
            es.Segment((1.0, 1.0), (-1.0, 1.0)),
        ],
        (),
        (math.pi + 4.0, 2.0 * math.pi + 4.0),
    ),
    "triangle": (
        lambda x, y: 0.01 < y < 0.79 and abs(x - 0.1 * y) < 0.99 * (1.0 - y / 0.8),
        es.Open(),
        [es.Polygon(((-1.0, 0.0), (1.0, 0.0), (0.08, 0.8)))],
        (),
        (0.8, 2.0 + math.hypot(1.08, 0.8) + math.hypot(0.92, 0.8)),
    ),
    "sinai": (
        lambda x, y: max(abs(x), abs(y)) < 0.5 and math.hypot(x, y) > 0.26,
        es.Periodic((1.0, 1.0), origin=(-0.5, -0.5)),
        [],
        ((0.0, 0.0), 0.25),
        (1.0 - math.pi / 16.0, 0.5 * math.pi),
    ),
}


def oval():
    """(Area, perimeter) of an ellipse of semi-axes 1.9 and 1.2; evenly spread points integrate what is periodic to all digits."""
    angle = 2.0 * math.pi * np.arange(4096) / 4096
    return math.pi * 1.9 * 1.2, 2.0 * math.pi * float(np.hypot(1.9 * np.sin(angle), 1.2 * np.cos(angle)).mean())


TABLES["ellipse"] = (
    lambda x, y: math.hypot(x / 1.9, y / 1.2) < 1.0 - 1e-6,
    es.Open(),
    [es.Ellipse((0.0, 0.0), (1.9, 1.2))],
    (),
    oval(),
)
STARTS = {"ellipse": 16_000}
"""Ways in an ellipse keep what they begin with, so many of them are needed."""


@pytest.mark.parametrize("name", TABLES)
def test_free_paths_of_points_from_random_starts(name):
    inside, domain, walls, post, (area, perimeter) = TABLES[name]
    place, velocity = starts(inside, STARTS.get(name, 200), seed=7)
    radius, mass = np.zeros(len(place)), np.zeros(len(place))
    if post:
        place, velocity = np.vstack([place, [post[0]]]), np.vstack([velocity, [[0.0, 0.0]]])
        radius, mass = np.append(radius, post[1]), np.append(mass, math.inf)
    path = measured(es.Scene(es.Disks(place, velocity, radius, mass), domain, walls), events=600_000)["mean_free_path"]
    assert path.theory == pytest.approx(math.pi * area / perimeter, rel=1e-9)
    assert path.error < 3e-3 * path.value
    assert abs(path.deviation) < 3.0


def jar(omega, seed=2):
    """120 disks in a round container that turns with their gas, or not."""
    place = np.array([[x, y] for x in range(-8, 9) for y in range(-8, 9) if x * x + y * y < 60])[:120] * 0.1
    velocity = np.random.default_rng(seed).normal(size=place.shape) + omega * np.column_stack([-place[:, 1], place[:, 0]])
    return es.Scene(es.Disks(place, velocity, 0.03), es.Open(), walls=[es.Circle((0.0, 0.0), 1.0, name="jar")])


class RadialHeat:
    """The mean of v_r^2 at contacts' rows, sampled from states: no turning has a part in it."""

    def __init__(self, scene, every):
        self.sim, self.every, self.found = es.Simulation(scene, engine="fast"), every, []

    def sample(self, begin, count):
        for k in range(count):
            self.sim.advance_to(begin + k * self.every)
            place, velocity = self.sim.state.position, self.sim.state.velocity
            along = (place * velocity).sum(axis=1) / np.hypot(*place.T)
            self.found.append(float((along**2).mean()))
        return np.array(self.found)


@pytest.mark.parametrize("omega", [0.0, 2.0])
def test_a_round_container_with_rotation(omega):
    """L^2 / 2 I is no heat.  Along the radius nothing turns: kT is m <v_r^2> there."""
    pytest.importorskip("numba")
    scene = jar(omega)
    measures = es.simulate(scene, events=500_000, engine="fast", measure=20.0).measures
    bar = block_average(RadialHeat(scene, 0.5).sample(20.0, 2400))
    assert bar.error < 3e-3 * bar.mean
    assert abs(measures["temperature"].value - bar.mean) < 3.0 * bar.error
    if omega == 0.0:
        assert abs(measures["Z_walls"].deviation) < 3.0
    else:
        assert math.isnan(measures["Z"].value)
        assert measures["temperature"].value < 0.9 * 0.5 * float((scene.disks.velocity**2).sum()) / len(scene.disks)


def test_the_barometer():
    """The density under gravity against hydrostatics with the fluid's pressure: no slice beyond chance, all to 1 %.

    Heat spreads over the height H within (H / free path)^2 contacts of a disk: 2000 of them are left out.
    """
    pytest.importorskip("numba")
    gas = {"count": 300, "radius": 0.5, "temperature": 1.0, "arrangement": "random", "seed": 1}
    domain = {"kind": "channel", "size": [40.0, 60.0]}
    scene = scene_from_dict({"gravity": [0.0, -0.05], "domain": domain, "gas": [gas]})
    measures = es.simulate(scene, events=4_000_000, engine="fast", measure=2700.0, profile="y").measures
    assert measures["collision_rate"].value * measures.discarded > 2000.0
    (one,) = measures.profile.species
    known = np.isfinite(one.theory)
    assert known.sum() == 28
    off = (one.density - one.theory)[known] / one.density_error[known]
    assert np.abs(off).max() < 4.0
    assert np.sqrt((off**2).mean()) < 1.5
    assert np.median(one.density_error[known] / one.density[known]) < 5e-3
    # one temperature from floor to top
    warm = (one.temperature - measures["temperature"].value) / one.temperature_error
    assert np.sqrt((warm**2).mean()) < 1.6

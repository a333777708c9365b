"""The same scene at other speeds: all velocities times 2**k, all times by exactly 2**-k, no other bit is another."""

import math
from dataclasses import replace

import numpy as np
import pytest

import eventsim as es
from eventsim.engines import ENGINES
from eventsim.engines.base import Stop
from eventsim.scene.stage import stage_of
from tests.engines.scenes import in_far_corner, lattice_gas

WALLS = [es.Segment((0.05, 0.05), (1.0, 0.3)), es.Arc((2.9, 0.2), (3.1, 0.15), (3.3, 0.2))]
POWERS = [-240, -1, 1, 240]


def in_container():
    gas = lattice_gas(36, 0.2, es.Open)
    return replace(gas, walls=(es.Circle(tuple(gas.disks.position.mean(axis=0).tolist()), 12.0),))


def heap():
    """Touching disks on a square lattice that all move towards their middle: a cluster of sixty contacts."""
    position = np.array([(i, j) for i in range(6) for j in range(6)], dtype=np.float64)
    return es.Scene(es.Disks(position, 0.3 * (position.mean(axis=0) - position), 0.5), es.Open())


def obstacle():
    """An immovable disk that drives a gas."""
    gas = lattice_gas(25, 0.2, es.Periodic, masses=(math.inf, *(1.0,) * 24))
    return replace(
        gas, disks=replace(gas.disks, velocity=np.where(gas.disks.mass[:, None] < math.inf, gas.disks.velocity, 0.5))
    )


SCENES = {
    "torus": lambda: lattice_gas(30, 0.3, es.Periodic),
    "box": lambda: lattice_gas(30, 0.3, masses=(1.0, 3.0)),
    "large box": lambda: lattice_gas(400, 0.5),
    "ties": lambda: lattice_gas(36, 0.3, quantum=0.5),
    "walls": lambda: lattice_gas(36, 0.1, walls=WALLS),
    "container": in_container,
    "cooling": lambda: lattice_gas(40, 0.3, restitution=0.9),
    "cooling channel": lambda: lattice_gas(40, 0.3, es.Channel, restitution=0.8),
    "contact duration": lambda: lattice_gas(40, 0.3, restitution=0.9, contact_duration=1e-4),
    "uneven": lambda: lattice_gas(36, 0.1, masses=(1.0, 2.0, 2.0**20), walls=WALLS[:1]),
    "very uneven": lambda: lattice_gas(36, 0.2, masses=(1.0, 1e16)),
    "uneven ties": lambda: lattice_gas(36, 0.2, es.Periodic, quantum=0.5, masses=(1.0, 2.0**20, 2.0**20)),
    "tracers": lambda: lattice_gas(40, 0.2, es.Periodic, radii=(0.5, 0.0, 0.4), masses=(1.0, 0.0, 2.0)),
    "posts": lambda: lattice_gas(40, 0.2, masses=(1.0, 2.0, math.inf)),
    "obstacle": obstacle,
    "plane": lambda: lattice_gas(40, 0.5, es.Open),
    "heap": heap,
    "wide": lambda: in_far_corner(lattice_gas(20, 0.3), 2.0**20),
    "giant": lambda: lattice_gas(49, 0.05, radii=(0.1,) * 48 + (1.0,)),
}
IN_KERNELS = ["torus", "box"]
BOTH = [("reference", name) for name in SCENES] + [
    pytest.param("fast", name, marks=() if name in IN_KERNELS else pytest.mark.slow) for name in SCENES
]


def faster(scene, k):
    """The scene with all velocities times 2**k."""
    duration = scene.contact_duration
    return replace(
        scene,
        disks=replace(scene.disks, velocity=np.ldexp(scene.disks.velocity, k)),
        contact_duration=None if duration is None else math.ldexp(duration, -k),
    )


def run_of(engine, scene):
    """(rows, why it stopped)."""
    session = ENGINES[engine].open(stage_of(scene))
    while (stopped := session.advance(Stop(None, 300), 10**9)) is None:
        pass
    return session.take_rows(), stopped


@pytest.mark.parametrize(("engine", "name"), BOTH)
def test_velocities_times_a_power_of_two_scale_the_times_exactly(engine, name):
    if engine == "fast":
        pytest.importorskip("numba")
    scene = SCENES[name]()
    one, stopped = run_of(engine, scene)
    assert len(one) > 20
    for k in POWERS:
        other, why = run_of(engine, faster(scene, k))
        assert why == stopped
        for column in ("kind", "a", "b", "wall", "joint", "epoch", "xa", "ya", "xb", "yb"):
            assert one[column].tobytes() == other[column].tobytes(), (k, column)
        assert np.array_equal(np.ldexp(one["remainder"], -k), other["remainder"]), k
        for column in ("vxa", "vya", "vxb", "vyb", "impulse"):
            assert np.array_equal(np.ldexp(one[column], k), other[column], equal_nan=True), (k, column)

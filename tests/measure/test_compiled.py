"""Sums in machine code and in plain Python: the same bits, whatever a scene has."""

import json

import pytest

import eventsim as es
from eventsim.measure import Meter, compiled, meter
from tests.engines.scenes import lattice_gas


def table():
    """Tracers inside a bow, beside a wall with two sides, among walls of a box."""
    walls = [es.Arc((1.0, -1.0), (2.0, 0.0), (1.0, 1.0)), es.Segment((-1.0, -0.5), (0.5, 0.7), name="slanted")]
    places, velocity = [[0.0, 1.5], [1.5, 0.1], [-1.5, -1.0]], [[1.0, 0.3], [0.2, -1.0], [0.5, 0.8]]
    disks = es.Disks(places, velocity, [0.1, 0.0, 0.05], [1.0, 0.0, 2.0])
    return es.Scene(disks, es.Box((6.0, 6.0), origin=(-3.0, -3.0)), walls)


def falling():
    """Disks that fall, bounce, slide and lie, faster and faster than at first."""
    disks = es.Disks([[2.0, 0.25], [0.3, 0.4], [1.0, 1.3]], [[0.0, 0.0], [0.02, 0.0], [0.0, 0.0]], 0.1, [1.0, 3.0, 2.0])
    slope = es.Segment((0.5, 1.2), (3.5, 0.9), name="slope")
    return es.Scene(disks, es.Box((4.0, 2.0)), [slope], gravity=(0.0, -8.0), restitution=0.5)


SCENES = {
    "mixture": lambda: lattice_gas(25, 0.3, es.Periodic, masses=(1.0, 3.0)),
    "cooling": lambda: lattice_gas(25, 0.2, es.Box, restitution=0.9),
    "table": table,
    "falling": falling,
}


@pytest.mark.parametrize("name", SCENES)
def test_compiled_sums_have_the_bits_of_plain_ones(name, monkeypatch):
    pytest.importorskip("numba")
    scene = SCENES[name]()
    run = es.simulate(scene, events=800, until=8.0, engine="reference", log=True)
    told = []
    for kernels in (compiled.PLAIN, compiled._compiled()):
        monkeypatch.setattr(meter, "kernels", lambda rows, waits=True, chosen=kernels: chosen)
        measured = Meter(scene, 0.1 * run.time, profile="y")
        for first in range(0, len(run.log), 150):
            measured.write(run.log.rows[first : first + 150])
        told.append(json.dumps(measured.finish(run.time).to_dict()))
    assert told[0] == told[1]

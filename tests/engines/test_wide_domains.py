"""Very wide domains: coordinates take bits from gaps, and `check` says how many are left; both engines still have one log."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import eventsim as es
from eventsim.compiler import is_interpreted
from eventsim.engines.base import Stop
from eventsim.scene.stage import stage_of
from tests.engines.scenes import in_far_corner, lattice_gas, session_of

SIZE = 2.0**20


def across_the_border(domain, n=30, **options):
    """A gas around the corner of a periodic domain, held by walls: half of its pairs see each other across a border."""
    gas = lattice_gas(n, 0.3, **options)
    half, middle = 0.5 * gas.domain.size[0], SIZE if domain is es.Periodic else 0.5 * SIZE
    place = gas.disks.position - half + (SIZE, middle)
    walls = [es.Polygon([(SIZE + x * half, middle + y * half) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))])]
    disks = replace(gas.disks, position=np.mod(place, SIZE))
    return replace(gas, disks=disks, domain=domain((SIZE, SIZE)), walls=walls)


def among_round_walls():
    """Disks in a container far from the corner, with an arc, a post and tracers."""
    gas = lattice_gas(25, 0.2, masses=(1.0, 3.0, 0.0, 1.0, math.inf))
    far = (SIZE - 30.0, SIZE - 40.0)
    middle = tuple(np.add(far, 0.5 * gas.domain.size[0]))
    still = np.isinf(gas.disks.mass)[:, None]
    disks = replace(
        gas.disks, position=gas.disks.position + far, velocity=np.where(still, 0.0, gas.disks.velocity), radius=0.4
    )
    walls = [
        es.Circle(middle, gas.domain.size[0]),
        es.Arc(*(tuple(np.add(middle, p)) for p in ((-6.0, 3.0), (-6.5, 0.3), (-6.0, -3.0)))),
    ]
    return es.Scene(disks, es.Box((SIZE, SIZE)), walls=walls)


SCENES = {
    "corner": lambda: in_far_corner(lattice_gas(16, 0.3), SIZE),
    "ties": lambda: in_far_corner(lattice_gas(16, 0.3, quantum=0.5), SIZE),
    "uneven": lambda: in_far_corner(lattice_gas(16, 0.3, masses=(1.0, 2.0**20)), SIZE),
    "torus": lambda: across_the_border(es.Periodic),
    "channel": lambda: across_the_border(es.Channel),
    "torus of ties": lambda: across_the_border(es.Periodic, quantum=0.5),
    "cooling": lambda: in_far_corner(lattice_gas(16, 0.3, restitution=0.9, contact_duration=1e-4), SIZE),
    "round walls": among_round_walls,
}
def test_disks_touch_to_the_last_bits_of_their_coordinates():
    run = es.simulate(SCENES["corner"](), events=2000, engine="reference")
    assert run.residuals.max_overlap < 4.0 * math.ulp(SIZE)


@pytest.mark.parametrize("name", SCENES)
def test_invariants_hold_after_every_event(name):
    session = session_of(SCENES[name](), check=True)
    session.advance(Stop(None, 100), 10**6)
    assert session.counters.events >= 100


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.kernels
def test_both_engines_have_one_log(name):
    pytest.importorskip("numba")
    from tests.engines.fast.test_same_log import assert_same

    assert_same(stage_of(SCENES[name]()), Stop(None, 100 if is_interpreted() else 1000))

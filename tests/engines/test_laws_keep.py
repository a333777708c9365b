"""What every law keeps: momentum and the stated loss of energy at a contact, and the motion of disks under other labels."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import eventsim as es
from eventsim.formulas import laws
from eventsim.formulas.impulse import approach_speed, mass_fractions, pair_update
from eventsim.formulas.laws import law_of
from eventsim.scene.contact_law import law_of_scene
from eventsim.scene.restitution import Restitution
from tests.engines.law_scenes import LAWS, by_chance, random_scene, relabelled, told

speeds = st.floats(-4.0, 4.0, width=32)
shares = st.floats(0.0, 1.0)
masses = st.floats(0.125, 64.0)


@settings(max_examples=200, deadline=None)
@given(speeds, speeds, speeds, speeds, masses, masses, shares, st.none() | st.floats(0.01, 8.0), st.floats(-1.0, 1.0))
def test_a_pair_keeps_its_momentum_and_loses_the_energy_that_its_law_states(ua, wa, ub, wb, a, b, share, yield_speed, dy):
    law = law_of(Restitution(share, 1.0, yield_speed), None)
    approach = approach_speed(1.0, dy, ua - ub, wa - wb)
    if not approach > 0.0:
        return
    e = law.restitution(law.pair, np.inf, np.inf, approach, 1.0)
    ua1, wa1, ub1, wb1, _ = pair_update(1.0, dy, ua, wa, ub, wb, *mass_fractions(a, b), e)
    size = a * (abs(ua) + abs(wa)) + b * (abs(ub) + abs(wb))
    assert a * ua1 + b * ub1 == pytest.approx(a * ua + b * ub, abs=32.0 * 2.0**-53 * size)
    assert a * wa1 + b * wb1 == pytest.approx(a * wa + b * wb, abs=32.0 * 2.0**-53 * size)

    def energy(u, w, v, x):
        return 0.5 * a * (u * u + w * w) + 0.5 * b * (v * v + x * x)

    before = energy(ua, wa, ub, wb)
    lost = 0.5 * (a * b / (a + b)) * (1.0 - e * e) * approach**2
    assert energy(ua1, wa1, ub1, wb1) == pytest.approx(before - lost, abs=64.0 * 2.0**-53 * before)


def test_each_law_has_random_scenes():
    scenes = [random_scene(seed, law) for law in LAWS for seed in range(4)]
    assert {type(law_of_scene(scene)) for scene in scenes} == set(laws.LAWS), "tests/engines/law_scenes.py lacks a law"


@pytest.mark.parametrize("law", [law for law in LAWS if not by_chance(law)])
def test_other_labels_give_the_same_contacts(law):
    for seed in range(2):
        scene = random_scene(seed, law)
        order = np.random.default_rng(seed).permutation(len(scene.disks))
        one, other = (es.simulate(s, until=2.0, engine="reference", log=True) for s in (scene, relabelled(scene, order)))
        assert other.stopped == one.stopped
        assert told(other.log.rows, order) == told(one.log.rows, range(len(order)))

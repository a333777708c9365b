"""The state of all disks at one time: equal numbers are equal states; energy and momentum follow from its scene."""

import math

import pytest

import eventsim as es

DISKS = es.Disks([[0.0, 2.0], [3.0, 1.0]], [[1.0, 0.0], [0.0, 0.0]], 0.5, [2.0, math.inf], spin=[4.0, 1.0])


def state(**keys: object) -> es.State:
    scene = es.Scene(DISKS, es.Open(), gravity=(0.0, -1.0), tangential_restitution=0.5)
    given = {"time": 1.0, "position": DISKS.position, "velocity": DISKS.velocity, "scene": scene, "spin": DISKS.spin}
    return es.State(**given | keys)  # type: ignore[arg-type]


def test_states_are_equal_where_their_numbers_are() -> None:
    assert state() == state(scene=None)
    assert hash(state()) == hash(state(scene=None))
    for keys in ({"time": 2.0}, {"position": DISKS.velocity}, {"velocity": DISKS.position}, {"spin": None}, {"spin": DISKS.mass}):
        assert state() != state(**keys)
    assert state() != 3


def test_energy_is_that_of_flight_spin_and_height_of_what_can_be_deflected() -> None:
    assert state().energy == 0.5 * 2.0 * 1.0**2 + 0.5 * (0.5 * 2.0 * 0.5**2) * 4.0**2 + 2.0 * 1.0 * 2.0
    assert state(spin=None).energy == 1.0 + 4.0
    assert state(spin=None, scene=es.Scene(DISKS, es.Open(), tangential_restitution=0.5)).energy == 1.0
    assert state().momentum == (2.0, 0.0)


def test_a_state_without_its_scene_has_no_masses() -> None:
    with pytest.raises(es.EventsimError, match="the masses of this state are not known: it was made without its scene"):
        _ = state(scene=None).momentum

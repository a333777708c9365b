"""What has no rest: disks on two walls, on each other, on round things; refused with the disks and the remedy."""

import dataclasses
import re

import pytest

import eventsim as es
from tests.engines.falling import ENGINES, dropped


def valley():
    walls = [es.Segment((-4.0, 4.0), (0.0, 0.0), name="l"), es.Segment((0.0, 0.0), (4.0, 4.0), name="r")]
    return es.Scene(es.Disks([[0.3, 3.0]], radius=0.5), es.Open(), walls, gravity=(0.0, -1.0), restitution=0.5)


def stack():
    disks = es.Disks([[5.0, 0.5], [5.0, 1.5]], radius=0.5)
    return es.Scene(disks, es.Box((10.0, 10.0)), gravity=(0.0, -1.0), restitution=0.5)


def corner():
    return dropped(gravity=(-1.0, -1.0))


def edge():
    """Too slow to fly off, it turns about the end of the wall, which is round."""
    wall = es.Segment((0.0, 1.0), (3.0, 1.0))
    return es.Scene(es.Disks([[2.0, 1.3]], [[0.1, 0.0]], 0.3), es.Open(), [wall], gravity=(0.0, -1.0), restitution=0.5)


REFUSED = {
    "valley": (valley, "disk 0 comes to rest on two walls, .*(l and r|r and l)"),
    "corner": (corner, "disk 0 comes to rest on two walls, .*(left and bottom|bottom and left)"),
    "stack": (stack, "disks 0, 1"),
    "edge": (edge, "disk 0 "),
    "end of a wall": (
        lambda: dropped([es.Segment((5.0, 0.0), (5.0, 0.5))], es.Open(), restitution=0.9),
        "disk 0",
    ),
}


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", REFUSED)
def test_what_lies_on_two_things_or_round_ones_is_refused_with_disks_and_remedy(engine, name):
    make, sentence = REFUSED[name]
    run = es.simulate(make(), until=100.0, events=10_000, engine=engine, log=True)
    assert run.stopped in ("collapse", "digits")
    assert re.search(sentence, run.reason)
    assert "contact_duration" in run.reason


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("duration", [None, 1e-3])
def test_a_pile_that_lies_still_is_told_to_begin_with_gaps_which_help(engine, duration):
    still = dataclasses.replace(stack(), contact_duration=duration)
    run = es.simulate(still, until=2.0, engine=engine)
    assert run.stopped == "collapse"
    assert run.reason.startswith("the contacts of disks 0, 1 at (5, 0.5) have no bounce: what lies still")
    loose = dataclasses.replace(still, disks=es.Disks([[5.0, 0.5], [5.0, 1.501]], radius=0.5), contact_duration=1e-3)
    assert es.simulate(loose, until=2.0, engine=engine).stopped == "until"


@pytest.mark.parametrize("name", ["valley", "corner", "end of a wall"])
def test_with_a_contact_duration_it_goes_on(name):
    scene = dataclasses.replace(REFUSED[name][0](), contact_duration=1e-2)
    run = es.simulate(scene, until=12.0, engine="reference")
    assert run.stopped == "until"


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", ["valley", "edge"])
def test_a_contact_duration_that_is_there_is_not_promised_as_the_remedy(engine, name):
    scene = dataclasses.replace(REFUSED[name][0](), contact_duration=1e-30)
    run = es.simulate(scene, until=20.0, engine=engine)
    assert run.stopped in ("collapse", "digits")
    assert "contact_duration = 1e-30, as in this scene, did not prevent it; a longer one may: contact_duration = 0." in run.reason


def test_a_disk_that_lies_in_a_corner_is_refused_whatever_the_contact_duration():
    disk = es.Disks([[0.5, 0.5]], radius=0.5)
    scene = es.Scene(disk, es.Box((10.0, 10.0)), gravity=(-1.0, -1.0), restitution=0.5, contact_duration=1e-3)
    run = es.simulate(scene, until=5.0, engine="reference")
    assert run.stopped == "collapse"
    assert run.reason.endswith("is modelled, whatever the contact_duration")

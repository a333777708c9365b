"""A run whose contacts come ever faster says so once, while it goes on and in its summary; one that does not says nothing."""

import pytest

import eventsim as es
from eventsim.runner import pace
from eventsim.scene.settling import remedy_of, settling_of
from eventsim.scene.stage import stage_of

BALLS = es.Disks(position=[(0.3, 0.5), (0.7, 0.6)], radius=0.1)


def falling(duration=None, restitution=0.5, gravity=(0.0, -10.0)):
    return es.Scene(BALLS, es.Box((1.0, 1.0)), gravity=gravity, restitution=restitution, contact_duration=duration)


def test_disks_that_bounce_for_ever_are_told_once_with_a_duration_that_suits(monkeypatch):
    monkeypatch.setattr(pace, "WINDOW", 2000)
    told = []
    run = es.simulate(falling(1e-7), until=100.0, events=10_000, engine="reference", notice=told.append)
    assert told == [run.pace]
    assert "times as often as at first; at this pace until = 100 is" in run.pace
    # 3 % of sqrt(2 * 0.1 / 10) = 0.0042
    assert "contact_duration = 0.004 suits, 3 % of sqrt(2 r / g)" in run.pace


@pytest.mark.parametrize("scene", [falling(0.02), es.gallery("gas", n=16)], ids=["a suitable duration", "a gas"])
def test_a_run_at_an_even_pace_says_nothing(monkeypatch, scene):
    monkeypatch.setattr(pace, "WINDOW", 500)
    told = []
    run = es.simulate(scene, events=3000, engine="reference", notice=told.append)
    assert run.pace is None
    assert told == []


def test_a_collapse_under_gravity_names_a_duration_and_what_it_costs():
    pile = es.Disks(position=[(0.3, 0.5), (0.3, 0.75)], radius=0.1)
    scene = es.Scene(pile, es.Box((1.0, 1.0)), gravity=(0.0, -10.0), restitution=0.5)
    run = es.simulate(scene, until=10.0, engine="reference")
    assert run.stopped in {"collapse", "digits"}
    assert run.reason.endswith("so a short one makes a run long: contact_duration = 0.004 suits, 3 % of sqrt(2 r / g)")


def test_nothing_is_said_of_rest_where_nothing_falls_onto_anything():
    assert settling_of(stage_of(falling(gravity=None))) is None
    free = es.Scene(BALLS, es.Open(), gravity=(0.0, -10.0), restitution=0.5)
    assert settling_of(stage_of(free)) is None
    assert remedy_of(stage_of(free)) == stage_of(free).law.remedy()


def test_points_have_no_duration_that_suits():
    points = es.Scene(es.Disks([(0.5, 0.5)], radius=0.0), es.Box((1.0, 1.0)), gravity=(0.0, -1.0), restitution=0.5)
    assert settling_of(stage_of(points)).duration is None


def test_wishes_that_go_together_are_not_ignored_alone():
    with pytest.raises(es.EventsimError, match="give checkpoint=PATH, too"):
        es.simulate(falling(), until=1.0, every="10s")
    with pytest.raises(es.EventsimError, match="give checkpoint=PATH, too"):
        es.Simulation(falling(), every="10s")
    with pytest.raises(es.EventsimError, match="give measure=True, too"):
        es.simulate(falling(), until=1.0, profile="x")

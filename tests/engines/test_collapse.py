"""Contacts that pile up are diagnosed: time, disks, rounds and ratio, the remedy; or that the digits are spent."""

import dataclasses
import math
import re

import numpy as np
import pytest

import eventsim as es
from eventsim.engines.collapse import diagnosis
from eventsim.engines.endless import is_endless
from eventsim.engines.reference.instants import MOST_AT_ONCE, instant_of
from eventsim.scene.stage import stage_of
from tests.engines.scenes import lattice_gas


def bounce(**changes):
    """Onto an immovable disk, straight from above: a support that is round is none."""
    disks = es.Disks([[5.0, 2.5], [5.0, 0.5]], radius=0.5, mass=[1.0, math.inf])
    return es.Scene(disks, es.Box((10.0, 10.0)), **{"gravity": (0.0, -2.0), "restitution": 0.5, **changes})


@pytest.mark.parametrize("log", [True, False])
def test_a_bounce_that_dies_out_is_a_collapse_with_its_ratio(log):
    run = es.simulate(bounce(), until=10.0, engine="reference", log=log)
    assert run.stopped == "collapse"
    assert run.time == pytest.approx(3.0, abs=1e-6)  # the gap at a round contact is known to some ulp, a fall of 1e-8
    assert re.search(r"collapse of disks 0, 1 at time 3[.\d]*: \d+ rounds of contacts", run.reason)
    assert "contact_duration" in run.reason


def between_a_heavy_disk_and_a_wall(restitution):
    disks = es.Disks([[1.0, 0.5], [2.0, 0.5]], [[1.0, 0.0], [0.0, 0.0]], radius=0.1, mass=[3.0, 1.0])
    return es.Scene(disks, es.Box((4.0, 1.0)), restitution=restitution)


def test_disks_that_stick_collapse_at_a_wall_in_no_time():
    """The light one stops at the wall, the heavy one shares 3 of 4 parts of its momentum with it again: all at 10 / 3."""
    run = es.simulate(between_a_heavy_disk_and_a_wall(0.0), until=4.0, engine="reference", log=True)
    assert run.stopped == "collapse"
    assert run.time == pytest.approx(10.0 / 3.0, rel=1e-15)
    assert "disks 0, 1 at time 3.33333333: contacts at that instant, in rounds of which each has 0.75 of" in run.reason
    pairs = run.log.impulse[run.log.b >= 0]
    assert pairs[1:] / pairs[:-1] == pytest.approx(0.75, rel=1e-14)  # two roundings each


def test_contacts_at_an_instant_that_show_no_rounds_stay_below_the_digits():
    """Three rows are no rounds yet: nobody knows how they go on."""
    stage = stage_of(between_a_heavy_disk_and_a_wall(0.0))
    run = es.simulate(between_a_heavy_disk_and_a_wall(0.0), until=4.0, engine="reference", log=True)
    rows = run.log.rows[:3].copy()  # one round and a contact before it
    clock = (int(rows["epoch"][-1]), float(rows["remainder"][-1]))
    stopped, reason = diagnosis(rows, stage, clock, run.time)
    assert stopped == "digits"
    assert "may or may not end" in reason


def test_a_collapse_late_on_the_clock_has_the_same_rounds():
    early, late = (
        es.simulate(bounce(start_time=start), until=start + 10.0, engine="reference").reason for start in (0.0, 2.0**30)
    )
    assert re.findall(r"(\d+) rounds", early) == re.findall(r"(\d+) rounds", late)


def test_a_finite_sequence_is_counted_exactly():
    run = es.simulate(es.gallery("collapse", restitution=0.08), engine="reference")
    assert (run.counters.events, run.stopped) == (11, "quiet")


def test_a_long_finite_sequence_is_beyond_the_digits():
    """e = .0719 gives 89 contacts, from 400 digits; the gaps sink below the last bits of places long before."""
    run = es.simulate(es.gallery("collapse", restitution=0.0719), engine="reference")
    assert run.stopped == "digits"
    assert 20 <= run.counters.events < 89


def test_three_disks_collapse_at_a_known_time():
    """e = .05: the rounds end before the gaps lose their digits."""
    run = es.simulate(es.gallery("collapse", restitution=0.05), engine="reference")
    assert run.stopped == "collapse"
    assert "disks 0, 1, 2" in run.reason
    ratio = float(re.search(r"each ([\d.e-]+) times", run.reason)[1])
    # the matrix of a round has the eigenvalue that gives its time: between 0 and 1, and steady to a few per cent
    assert 0.08 < ratio < 0.12


def test_gaps_below_the_digits_are_said_to_be_that():
    """The critical restitution is 7 - 4 sqrt 3 = .07179677."""
    run = es.simulate(es.gallery("collapse", restitution=0.0718), engine="reference", log=True)
    assert run.stopped == "digits"
    assert run.log.provenance.ending.reason == "digits"
    assert "disks 0, 1, 2" in run.reason
    assert "cannot be told" in run.reason


CRITICAL_AT_WALL, CRITICAL_OF_THREE = 3.0 - 2.0 * math.sqrt(2.0), 7.0 - 4.0 * math.sqrt(3.0)


@pytest.mark.parametrize("below", [1e-2, 1e-3, 1e-4, 1e-6, 1e-9])
def test_a_series_is_called_endless_below_the_critical_restitution_and_never_above(below):
    """Ratios of rounds settle on both sides; the eigenvalues of a round are real below, and complex above."""

    def wall_and_two(restitution):
        disks = es.Disks([(1.0, 0.0), (3.0, 0.0)], [(0.0, 0.0), (-1.0, 0.0)], 0.5)
        return es.Scene(disks, es.Open(), [es.Segment((-0.5, -9.0), (-0.5, 9.0))], restitution=restitution)

    def three(restitution):
        return es.gallery("collapse", restitution=restitution)

    for make, critical in ((wall_and_two, CRITICAL_AT_WALL), (three, CRITICAL_OF_THREE)):
        assert es.simulate(make(critical - below), until=1e6, engine="reference").stopped == "collapse"
        assert es.simulate(make(critical + below), until=1e6, engine="reference").stopped in ("digits", "quiet")


def test_whether_a_series_has_an_end_is_told_only_where_its_rows_tell():
    scene = es.gallery("collapse", restitution=0.05)
    stage, rows = stage_of(scene), es.simulate(scene, engine="reference", log=True).log.rows
    assert is_endless(rows, stage)
    assert is_endless(rows[:5], stage) is None  # no rounds yet
    for mass in ([1.0, 0.0, 1.0], [math.inf] * 3):  # no inverse, and nothing that moves
        assert is_endless(rows, dataclasses.replace(stage, mass=np.array(mass))) is None
    still = rows.copy()
    for name in ("vxa", "vya", "vxb", "vyb"):
        still[name] = 1.0
    assert is_endless(still, stage) is None  # contacts that change nothing have no normals
    assert is_endless(rows[-6:], stage)


def test_the_restitution_of_the_species_that_meet_tells_whether_a_series_ends():
    alike = es.gallery("collapse", restitution=0.05)
    disks = dataclasses.replace(alike.disks, species="b")
    named = dataclasses.replace(alike, disks=disks, restitution=es.Restitution(0.9, pairs={"b-b": 0.05}))
    reasons = [es.simulate(scene, engine="reference").reason for scene in (alike, named)]
    assert reasons[0] == reasons[1]
    assert "collapse" in reasons[0]


@pytest.mark.parametrize(("restitution", "stopped"), [(0.5, "digits"), (0.9, "collapse")])
def test_a_disk_that_is_squeezed_is_no_inelastic_collapse(restitution, stopped):
    """An immovable one comes on at the speed 1, and the way from 2.5 to the wall is full at 2.5."""
    disks = es.Disks([(1.0, 1.0), (4.0, 1.0)], [(0.1, 0.0), (-1.0, 0.0)], 0.5, [1.0, math.inf])
    run = es.simulate(es.Scene(disks, es.Box((6.0, 6.0)), restitution=restitution), until=9.0, engine="reference")
    assert run.stopped == stopped
    assert run.time == pytest.approx(2.5, rel=1e-12)
    assert "speeds do not fall: one is squeezed between" in run.reason
    assert "inelastic" not in run.reason
    assert "contact_duration" not in run.reason


@pytest.mark.parametrize("engine", ["reference", "fast"])
@pytest.mark.parametrize("duration", [None, 1e-3])
@pytest.mark.parametrize("walled", [True, False])
@pytest.mark.parametrize("restitution", [0.0, 1e-9])
def test_a_squeeze_without_bounces_gets_no_advice_that_does_not_help(restitution, walled, duration, engine):
    """After one contact it moves with what struck it, until it meets what it cannot deflect either."""
    places, speeds, masses = [(4.0, 1.0), (1.0, 1.0)], [(-1.0, 0.0), (0.0, 0.0)], [math.inf, 1.0]
    if not walled:
        places, speeds, masses = [*places, (-1.5, 1.0)], [*speeds, (0.5, 0.0)], [*masses, math.inf]
    domain = es.Box((6.0, 6.0)) if walled else es.Open()
    disks = es.Disks(places, speeds, 0.5, masses)
    scene = es.Scene(disks, domain, restitution=restitution, contact_duration=duration)
    run = es.simulate(scene, until=9.0, events=1000, engine=engine)
    assert run.stopped in ("digits", "collapse")
    assert "speeds do not fall: one is squeezed between" in run.reason
    assert "contact_duration" not in run.reason


def test_a_pile_between_what_stands_still_may_be_kept_up():
    """Two posts and a disk that falls between them: there a contact duration helps."""
    disks = es.Disks([(0.0, 0.0), (1.5, 0.0), (0.75, 1.5)], radius=0.5, mass=[math.inf, math.inf, 1.0])
    run = es.simulate(es.Scene(disks, es.Open(), gravity=(0.0, -1.0), restitution=0.3), until=9.0, engine="reference")
    assert run.stopped in ("digits", "collapse")
    assert "contact_duration" in run.reason


def test_step_by_step_the_same_is_said():
    sim = es.Simulation(bounce(), engine="reference")
    with pytest.raises(es.CollapseError, match=r"disks 0, 1 at time 3[.\d]*: \d+ rounds"):
        sim.advance_to(10.0)


def test_with_a_contact_duration_the_run_goes_on():
    run = es.simulate(es.gallery("collapse", restitution=0.05), until=3.0, events=2000, engine="reference")
    assert run.stopped == "collapse"
    scene = es.gallery("collapse", restitution=0.05)
    gentle = es.Scene(scene.disks, scene.domain, restitution=0.05, contact_duration=1e-3)
    assert es.simulate(gentle, until=10.0, engine="reference").stopped in ("until", "quiet")


@pytest.mark.slow
@pytest.mark.parametrize("duration", [None, 1e-6])
def test_ten_thousand_inelastic_disks_collapse_with_a_diagnosis_or_have_a_hundred_contacts_each(duration):
    pytest.importorskip("numba")
    scene = lattice_gas(10_000, 0.4, restitution=0.6, contact_duration=duration)
    run = es.simulate(scene, events=500_000, engine="fast")  # each of two disks
    if duration is None:
        assert run.stopped in ("collapse", "digits")
        assert re.search(r"disks,? \d+, .* at time [\d.]+", run.reason)
        assert "contact_duration" in run.reason
    else:
        assert run.stopped == "events"
        assert np.isfinite(run.state.velocity).all()
    assert run.residuals.max_overlap < 1e-12  # some hundred last bits of a coordinate, 140
    assert run.residuals.momentum < 1e-14


@pytest.mark.parametrize(("ratio", "most"), [(100.0, 100_000), (1e16, 800_000_000), (1e150, MOST_AT_ONCE)])
def test_uneven_masses_may_have_as_many_contacts_at_one_instant_as_the_law_gives_them(ratio, most):
    """Between a heavy disk and a wall a light one has pi sqrt(M/m): 314159265 of them for 1e16."""
    assert instant_of(stage_of(es.gallery("galperin", mass_ratio=ratio)))[1] == most

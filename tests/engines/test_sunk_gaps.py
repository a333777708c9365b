"""Behind contacts that take energy a gap of a few last bits is no contact that anybody knows: the run stops and says so."""

import math
from decimal import Decimal, localcontext
from itertools import pairwise

import pytest

import eventsim as es
from eventsim.record.events import Kind

ENGINES = ["reference", "fast"]


def wall_and_two(restitution):
    """A wall and two disks, whose critical restitution is 3 - 2 sqrt 2 = .17157."""
    disks = es.Disks([(1.0, 0.0), (3.0, 0.0)], [(0.0, 0.0), (-1.0, 0.0)], 0.5)
    wall = es.Segment((-0.5, -9.0), (-0.5, 9.0))
    return es.Scene(disks, es.Open(), [wall], restitution=restitution)


def bent_three(height):
    """Three disks nearly in line."""
    disks = es.Disks([(0.0, 0.0), (2.0, height), (3.7, 0.0)], [(1.0, 0.0), (0.0, 0.0), (-0.7, 0.0)], 0.5)
    return es.Scene(disks, es.Open(), restitution=0.0728)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("restitution", "true", "end"), [(0.1717, 137, 4.951), (0.17, 10**9, 4.1637064)])
def test_a_series_near_the_critical_restitution_stops_before_rounding_makes_it_up(engine, restitution, true, end):
    run = es.simulate(wall_and_two(restitution), until=1e6, engine=engine)
    assert run.stopped in ("collapse", "digits")
    assert 20 < run.counters.events < true
    assert run.time < end
    assert "the gaps sank below the digits" in run.reason or "collapse of disks 0, 1" in run.reason


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("restitution", "contacts"), [(0.175, 26), (0.19, 11)])
def test_a_series_that_ends_within_the_digits_is_counted(engine, restitution, contacts):
    run = es.simulate(wall_and_two(restitution), until=1e6, engine=engine)
    assert (run.counters.events, run.stopped) == (contacts, "quiet")


@pytest.mark.parametrize("engine", ENGINES)
def test_no_contacts_are_made_up_behind_the_last_true_one(engine):
    """25 contacts in exact arithmetic; rounding would add four at one time."""
    run = es.simulate(bent_three(0.001), until=1e4, engine=engine)
    assert run.stopped in ("collapse", "digits")
    assert run.counters.events <= 25


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("keys", [{}, {"restitution": 0.0728, "contact_duration": 1e-3}])
def test_elastic_scenes_and_the_tc_model_go_on(engine, keys):
    scene = bent_three(0.001)
    run = es.simulate(es.Scene(scene.disks, scene.domain, **keys), until=1e4, engine=engine)
    assert run.stopped == "quiet"


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("gap", [2.0**-52, 2.0**-50])
def test_a_gap_of_a_last_bit_at_the_start_is_known(engine, gap):
    """Places that no contact has rounded are what they are, so the second contact comes; what follows that may be below them."""
    disks = es.Disks([(-2.0, 0.0), (0.0, 0.0), (1.0 + gap, 0.0)], [(1.0, 0.0), (0.0, 0.0), (0.0, 0.0)], 0.5)
    run = es.simulate(es.Scene(disks, es.Open(), restitution=0.9), until=10.0, engine=engine, log=True)
    assert list(zip(run.log.a.tolist(), run.log.b.tolist(), strict=True))[:2] == [(0, 1), (1, 2)]


@pytest.mark.parametrize("engine", ENGINES)
def test_a_disk_that_is_kicked_back_into_what_it_has_just_met_meets_it_again(engine):
    """They touch, whatever rounding makes of their places: so it is known who comes next, and when."""
    for angle in (0.1, 0.7, 1.3, 2.9, 4.4):
        x, y = 1.7 * math.cos(angle), 1.7 * math.sin(angle)
        disks = es.Disks([(0.0, 0.0), (x, y)], [(0.0, 0.0), (-0.9 * x, -0.9 * y)], 0.4)
        sim = es.Simulation(es.Scene(disks, es.Open(), restitution=0.9), engine=engine)
        sim.step()
        sim.set_velocity(1, (-x, -y))
        sim.advance_to(sim.time + 1.0)
        assert [row["kind"] for row in sim.log.rows] == [Kind.PAIR, Kind.KICK, Kind.PAIR]
        assert sim.log.time[2] == pytest.approx(sim.log.time[0], abs=1e-14)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_disk_in_a_corner_meets_both_walls_however_small_the_gap(engine):
    """It flies along the bisector but for the last bits; which wall comes first is exact, and then it is in the corner."""
    seen = 0
    for k in range(40):
        turn, half = 0.37 * k, 0.5
        ends = [(5.0 * math.cos(turn + s * half), 5.0 * math.sin(turn + s * half)) for s in (-1, 1)]
        start = 3.0 * math.cos(turn), 3.0 * math.sin(turn)
        disks = es.Disks([start], [(-start[0], -start[1])], 0.3)
        scene = es.Scene(
            disks, es.Open(), [es.Polyline((ends[0], (0.0, 0.0), ends[1]), name="corner")], restitution=0.8
        )
        run = es.simulate(scene, until=2.0, engine=engine, log=True)
        assert run.stopped in ("until", "quiet")
        assert set(run.log.wall_name[:2]) == {"corner.0", "corner.1"}
        first, second = run.log.time[:2].tolist()
        seen += first < second
        assert second - first < 2.0**-48
    assert seen > 5


def light_and_heavy(restitution, mass):
    """A wall and a light disk that a heavy one drives against it."""
    disks = es.Disks([(1.0, 0.0), (3.0, 0.0)], [(0.0, 0.0), (-1.0, 0.0)], 0.5, [1.0, mass])
    wall = es.Segment((0.0, -9.0), (0.0, 9.0))
    return es.Scene(disks, es.Open(), [wall], restitution=restitution)


def flights(restitution, mass, most):
    """(when it ends, how long it was) of the flights between their contacts, in 100 digits, from the floats."""
    e, m = Decimal(restitution), Decimal(mass)
    x, y, u, w = (Decimal(v) for v in (0.5, 1.5, 0.0, -1.0))  # gaps to the wall
    time, found = Decimal(0), []
    for _ in range(most):
        lag = x / -u if u < 0 else (y - x) / (u - w)
        x, y, time = x + u * lag, y + w * lag, time + lag
        push = (1 + e) * (u - w) / (1 + m)
        u, w = (-e * u, w) if u < 0 else (u - m * push, w + push)
        found.append((time, lag))
    return found


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("restitution", "critical"), [(0.1717, 1.0), (0.6, 15.0), (0.9, 360.0), (0.98, 9800.0)])
def test_errors_that_pile_up_in_a_series_never_show_in_its_times(restitution, critical, engine):
    """A gap is off by a few last bits over 1 - e; at the critical mass flights are long until then, whatever e."""
    run = es.simulate(light_and_heavy(restitution, critical), until=1e9, engine=engine, log=True)
    assert run.stopped in ("collapse", "digits")
    assert len(run.log) > 30
    with localcontext() as digits:
        digits.prec = 100
        true = flights(restitution, critical, len(run.log))
    for time, (ends, lag) in zip(run.log.time.tolist(), true, strict=True):
        assert abs(time - float(ends)) <= 0.15 * float(lag) + 2.0**-50 * time


@pytest.mark.parametrize("engine", ENGINES)
def test_a_near_tie_in_a_gas_is_no_sunk_gap(engine):
    """Behind a contact that takes energy the next gap is 20 last bits: its contact comes at once, and is right to last bits."""
    gap = 20.0 * 2.0**-52
    disks = es.Disks([(-2.0, 0.0), (0.0, 0.0), (2.0 + gap, 0.0)], [(1.0, 0.0), (0.0, 0.0), (-1.0, 0.0)], 0.5)
    run = es.simulate(es.Scene(disks, es.Open(), restitution=0.9), events=2, engine=engine)
    assert run.stopped == "events"


ROUND = {
    "container": es.Circle((0.0, 0.0), 2.7),
    "arc": es.Arc((2.7, 0.0), (0.0, 2.7), (-2.7, 0.0)),
}


def along(wall, angle, until):
    """A disk on contact with the inside of a round wall, which moves along it but for an angle, outwards."""
    x, y = 2.4 * math.cos(0.3), 2.4 * math.sin(0.3)
    velocity = -math.sin(0.3 + angle), math.cos(0.3 + angle)
    return es.Scene(es.Disks([(x, y)], [velocity], 0.3), es.Open(), [ROUND[wall]], until=until)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("wall", ROUND)
@pytest.mark.parametrize("angle", [0.0, 1e-10, 1e-8])
def test_hops_along_a_round_wall_below_the_digits_end_a_run(wall, angle, engine):
    """At an angle of 1e-8 they open gaps of 1e-16: rounding would make up as many as it likes."""
    run = es.simulate(along(wall, angle, 1.0), engine=engine)
    assert run.stopped == "digits"
    assert run.counters.events < 5
    assert "creeps along" in run.reason or "do not end" in run.reason


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("wall", ROUND)
def test_hops_that_digits_can_tell_go_on(wall, engine):
    """Each takes 2 (R - r) sin(angle) / v, of which the last bits of a place are a part of 1e-16 / angle."""
    run = es.simulate(along(wall, 1e-5, 0.01), engine=engine, log=True)
    assert run.stopped == "until"
    hops = [b - a for a, b in pairwise(run.log.time.tolist())][1:]
    assert len(hops) > 200
    assert hops == pytest.approx([4.8 * math.sin(1e-5)] * len(hops), rel=1e-4)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("wall", ROUND)
@pytest.mark.parametrize("restitution", [1.0, 0.9])
def test_what_begins_to_slide_down_a_round_wall_does_not_stand_still(wall, restitution, engine):
    """At rest where the wall is upright: pressed onto it as soon as it falls, in hops of 1e-60 at first."""
    scene = es.Scene(es.Disks([(2.4, 0.0)], radius=0.3), es.Open(), [ROUND[wall]], (0.0, 1.0), restitution, until=1.0)
    run = es.simulate(scene, events=1000, engine=engine)
    assert run.stopped == "digits"
    assert run.counters.events < 5


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("restitution", [1.0, 0.8])
def test_disks_that_meet_below_the_last_bits_of_their_places_end_a_run(restitution, engine):
    """Where they meet both are at one float place: no normal, so they flew on through each other, or it divided by zero."""
    places, velocities = [(0.5657428043105057, 4.6), (0.5657428043105057, 3.4)], [(0.0, -1.7), (0.0, 0.2)]
    for radius, stopped, contacts in ((1e-18, "digits", 0), (1e-14, "until", 1)):
        scene = es.Scene(es.Disks(places, velocities, radius), es.Box((4.0, 8.0)), restitution=restitution)
        run = es.simulate(scene, until=1.5, engine=engine)
        assert (run.stopped, run.counters.events) == (stopped, contacts)
        assert run.reason is None or "reach of 2e-18 is below the last bits" in run.reason


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("speed", "stopped"), [(-1.0, "digits"), (1.0, "until")])
def test_so_do_those_that_slide_into_each_other_on_one_wall(engine, speed, stopped):
    """Last bits across the slope are wider than both: their contact would be missed."""
    slope = es.Segment((-9.0, 0.5), (19.0, 7.3))
    disks = es.Disks([(8.0, 5.0), (6.0, 4.3)], [(speed, 0.0), (0.0, 0.0)], 1e-18)
    run = es.simulate(es.Scene(disks, es.Open(), [slope], (0.0, -9.81), 0.3), until=1.2, engine=engine)
    assert run.stopped == stopped
    assert run.counters.rests == (1 if stopped == "digits" else 2)
    assert run.reason is None or "slide into each other" in run.reason

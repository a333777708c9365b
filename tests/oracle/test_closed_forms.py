"""The oracle itself, against closed forms (each told where it is used) and exact fractions."""

from __future__ import annotations

import math
from decimal import Decimal
from types import SimpleNamespace
from typing import Any

import mpmath
import numpy as np
import pytest

import eventsim as es
from tests.oracle.digits import exact, working_with
from tests.oracle.doubt import contact_map
from tests.oracle.loop import story
from tests.oracle.roots import survey, value
from tests.oracle.story import Kick, Story


def disks(position: Any, velocity: Any = None, radius: Any = 0.5, mass: Any = 1.0) -> es.Disks:
    return es.Disks(position, velocity, radius, mass)


def velocities(told: Story) -> list[tuple[float, float]]:
    return [(float(part.velocity[0]), float(part.velocity[1])) for part in told.state(told.time)]


def test_roots_are_those_of_mpmath() -> None:
    rng = np.random.default_rng(1)
    mpmath.mp.dps = 60
    with working_with(60):
        for _ in range(100):
            p = tuple(exact(c * 10.0 ** rng.uniform(-3, 3)) for c in rng.normal(0, 1, int(rng.integers(2, 6))))
            crossings, turns = survey(p)
            roots = mpmath.polyroots([mpmath.mpf(str(c)) for c in p], maxsteps=500, extraprec=300, asc=True)
            real = sorted(mpmath.re(r) for r in roots if abs(mpmath.im(r)) < 1e-30 * (1 + abs(r)) and mpmath.re(r) > 0)
            assert len(real) == len(crossings)
            for crossing, r in zip(crossings, real, strict=True):
                assert abs(mpmath.mpf(str(crossing.time)) - r) < 1e-45 * r
            for turn in turns:
                step = turn.time * Decimal("1e-12")
                around = value(p, turn.time - step), value(p, turn.time + step)
                assert min(around) >= turn.value if turn.is_minimum else max(around) <= turn.value


@pytest.mark.parametrize(("ratio", "contacts"), [(1.0, 3), (3.0, 5), (100.0, 31), (2.5, 5), (0.2, 2)])
def test_galperin_counts(ratio: float, contacts: int) -> None:
    """ceil(pi/theta) - 1 contacts, theta = arctan sqrt(m/M); 1 and 3 are ties.  Galperin, Regul. Chaotic Dyn. 8, 375
    (2003).
    """
    scene = es.Scene(
        disks((((1.0, 0.0)), (3.0, 0.0)), ((0.0, 0.0), (-1.0, 0.0)), 0.25, (1.0, ratio)),
        es.Open(),
        walls=[es.Segment((0.0, -4.0), (0.0, 4.0))],
        until=1e6,
    )
    told = story(scene)
    expected = math.ceil(math.pi / math.atan(math.sqrt(1 / ratio)) - 1e-9) - 1
    assert expected == contacts
    assert (len(told.rows), told.ending) == (contacts, "quiet")


def test_zeno_bounce_halves_its_flights_and_rests_at_3() -> None:
    scene = es.Scene(
        disks([(2.0, 1.25)], radius=0.25), es.Box((4.0, 4.0)), gravity=(0.0, -2.0), restitution=0.5, until=5.0
    )
    told = story(scene)
    for n, row in enumerate(told.rows[:-1]):
        assert row.time == 3 - Decimal(2) ** (1 - n)
    assert told.rows[-1].kind == "rest"
    assert abs(told.rows[-1].time - 3) < Decimal("1e-50")


@pytest.mark.parametrize(("e", "contacts"), [(0.0719, 89), (0.08, 11)])
def test_three_points_on_a_line_meet_so_often(e: float, contacts: int) -> None:
    """McNamara and Young, Phys. Fluids A 4, 496 (1992); floats do not determine all of the 89, so doubt is put aside
    here.
    """
    scene = es.Scene(
        disks([(-0.5, 0.0), (1.0, 0.0), (3.5, 0.0)], [(1.0, 0.0), (0.0, 0.0), (-1.0, 0.0)], 0.25),
        es.Open(),
        restitution=e,
        until=1e9,
    )
    assert len(story(scene, judged=False).rows) == contacts


def test_a_cradle_passes_its_impulse_on() -> None:
    scene = es.Scene(
        disks([(float(k), 0.0) for k in (-2, -1, 1, 2, 3)], [(1.0, 0.0), (1.0, 0.0), (0, 0), (0, 0), (0, 0)]),
        es.Open(),
        until=9.0,
    )
    told = story(scene)
    assert velocities(told) == [(0, 0), (0, 0), (0, 0), (1, 0), (1, 0)]


def test_a_graze_within_a_last_bit_is_told_from_a_tangency() -> None:
    """F1, F2: dy = 1 - 2^-53 is a hit at 3 - sqrt(1 - dy^2), dy = 1 and 1 + 2^-52 are none."""
    for dy, hits in ((1 - 2.0**-53, 1), (1.0, 0), (1 + 2.0**-52, 0)):
        told = story(es.Scene(disks([(-3.0, dy), (0.0, 0.0)], [(1.0, 0.0), (0.0, 0.0)]), es.Open(), until=9.0))
        assert len(told.rows) == hits
        if hits:
            assert float(told.rows[0].time) == 3 - math.sqrt((1 - dy) * (1 + dy))


def test_symmetric_break_is_one_cluster() -> None:
    """F6: d = 5, targets 40/57 along (.8, +-.6), cue -7/57."""
    told = story(
        es.Scene(disks([(-3.0, 0.0), (4.0, 3.0), (4.0, -3.0)], [(1.0, 0.0), (0, 0), (0, 0)], 2.5), es.Open(), until=9.0)
    )
    assert {row.group for row in told.rows} == {1}
    assert velocities(told)[0] == (float(Decimal(-7) / 57), 0.0)
    assert velocities(told)[1] == pytest.approx((0.8 * 40 / 57, 0.6 * 40 / 57), abs=1e-15)


@pytest.mark.parametrize("power", [-40, -52])
def test_the_sign_of_a_gap_decides_who_comes_first(power: int) -> None:
    """F7: masses 1, 3, 1, x = (-2, 0, 2 + eps), v = (1, 0, -1)."""
    for eps, after in ((2.0**power, (-0.5, -0.25, 1.25)), (-(2.0**power), (-1.25, 0.25, 0.5))):
        eps = eps * 4  # 2 + eps is a float
        told = story(
            es.Scene(
                disks([(-2.0, 0), (0.0, 0), (2.0 + eps, 0)], [(1.0, 0), (0, 0), (-1.0, 0)], mass=(1, 3, 1)),
                es.Open(),
                until=5.0,
            )
        )
        assert [u for u, _ in velocities(told)] == [pytest.approx(v, abs=1e-14) for v in after]


def test_a_corner_reverses() -> None:
    told = story(es.Scene(disks([(5.0, 5.0)], [(1.0, 1.0)]), es.Box((10.0, 10.0)), until=400.0))
    assert [float(row.time) for row in told.rows[:4]] == [4.5, 4.5, 13.5, 13.5]
    assert told.ending == "until"
    assert len(told.rows) == 88


def test_a_tie_of_two_walls_is_one_cluster() -> None:
    told = story(
        es.Scene(
            disks([(3.0, 0.5636958593624257)], [(0.0, -1.0)]),
            es.Box((6.0, 8.0)),
            walls=[es.Segment((0.0, 0.7), (3.0, 0.0)), es.Segment((3.0, 0.0), (6.0, 0.7))],
            until=1.0,
        )
    )
    assert [row.walls for row in told.rows] == [{"wall0"}, {"wall1"}]
    assert velocities(told) == [(0.0, 1.0)]


def an_ellipse(**numbers: Any) -> Any:
    """A scene of a point in an ellipse, as far as the oracle reads it."""
    wall = SimpleNamespace(
        kind="ellipse", name=None, center=(0.0, 0.0), direction=(1.0, 0.0), semi_axes=numbers.pop("semi_axes")
    )
    scene = es.Scene(
        disks([numbers.pop("position")], [numbers.pop("velocity")], 0.0), es.Open(), until=numbers.pop("until")
    )
    parts = {
        name: getattr(scene, name)
        for name in ("disks", "domain", "gravity", "restitution", "contact_duration", "until")
    }
    return SimpleNamespace(walls=[wall], events=None, start_time=0.0, **parts)


def test_a_round_ellipse_is_a_container() -> None:
    start = {"position": (0.3, 0.2), "velocity": (1.0, 0.37)}
    oval = story(an_ellipse(semi_axes=(2.0, 2.0), until=30.0, **start))
    ring = story(
        es.Scene(
            disks([start["position"]], [start["velocity"]], 0.0), es.Open(), walls=[es.Circle((0, 0), 2.0)], until=30.0
        )
    )
    assert len(oval.rows) == len(ring.rows) > 5
    for one, other in zip(oval.rows, ring.rows, strict=True):
        assert abs(one.time - other.time) < Decimal("1e-50")
        assert one.parts[0].place_error == pytest.approx(other.parts[0].place_error, rel=0.5)


def test_paths_through_a_focus_pass_through_the_other_one() -> None:
    """Semi-axes 5 and 3: foci at -4 and 4."""
    told = story(an_ellipse(semi_axes=(5.0, 3.0), position=(-4.0, 0.0), velocity=(0.6, 0.8), until=60.0))
    assert len(told.rows) > 4
    for number, row in enumerate(told.rows):
        (x, y), (u, w) = row.parts[0].place, row.parts[0].velocity
        focus = 4 if number % 2 == 0 else -4
        with working_with(60):
            assert abs((focus - x) * w - (0 - y) * u) < Decimal("1e-45")


def test_the_map_of_a_contact_is_its_derivative() -> None:
    """Against differences of contacts that are calculated with deviations of 1e-7."""

    def after(deviation: Any) -> Any:
        x = np.array([-1.3, 0.2, 0.0, 0.0, 1.0, 0.3, -0.2, 0.1]) + deviation  # xa, ya, xb, yb, ua, wa, ub, wb
        d, v, reach = x[:2] - x[2:4], x[4:6] - x[6:8], 1.0
        b, a, c = d @ v, v @ v, d @ d - reach**2
        t = c / (-b + math.sqrt(b * b - a * c))
        n = (d + v * t) / reach
        q = 1.5 * (n @ v)
        ua, ub = x[4:6] - 0.25 * q * n, x[6:8] + 0.75 * q * n
        at = 0.4  # both places go back to one time
        return (
            np.concatenate([x[:2] + x[4:6] * t + ua * (at - t), ua, x[2:4] + x[6:8] * t + ub * (at - t), ub]),
            n,
            t,
            ua,
            ub,
        )

    _, n, t, ua, ub = after(np.zeros(8))
    still = ((0.0, 0.0), (0.0, 0.0))
    matrix = contact_map(
        (n[0], n[1]), 1.0, [((1.0, 0.3), tuple(ua)), ((-0.2, 0.1), tuple(ub))], [still, still], [0.25, 0.75], 0.5
    )
    fly = lambda s: np.kron(np.eye(2), np.block([[np.eye(2), s * np.eye(2)], [np.zeros((2, 2)), np.eye(2)]]))  # noqa: E731
    whole = fly(0.4 - t) @ matrix @ fly(t)
    order = [0, 1, 4, 5, 2, 3, 6, 7]
    for column in range(8):
        step = np.zeros(8)
        step[order[column]] = 1e-7
        difference = (after(step)[0] - after(-step)[0]) / 2e-7
        assert whole[:, column] == pytest.approx(difference, abs=1e-6)


def test_a_kick_at_the_instant_of_a_contact_keeps_a_point_on_its_side() -> None:
    scene = es.Scene(
        disks([(1.0, 1.0)], [(0.3, -1.0)], 0.0), es.Open(), walls=[es.Segment((0.0, 0.0), (3.0, 0.7))], until=5.0
    )
    told = story(scene, kicks=[Kick(0, (0.1, -1.0), after=0)])
    assert [row.kind for row in told.rows] == ["wall", "kick", "wall"]
    assert told.rows[2].time == told.rows[0].time
    nx, ny = -0.7, 3.0
    u, w = velocities(told)[0]
    assert nx * u + ny * w > 0


def test_what_lies_on_a_wall_slides_and_falls_over_its_end() -> None:
    scene = es.Scene(
        disks([(0.0, 0.5)], [(1.0, 0.0)]),
        es.Open(),
        walls=[es.Segment((-1.0, 0.0), (2.0, 0.0))],
        gravity=(0.0, -1.0),
        restitution=0.5,
        until=3.0,
    )
    told = story(scene)
    assert [(row.kind, float(row.time)) for row in told.rows[:2]] == [("rest", 0.0), ("wall", 2.0)]


def test_a_disk_in_a_channel_falls_onto_its_side_wherever_it_is() -> None:
    scene = es.Scene(disks([(2.5, 1.0)], radius=0.5), es.Channel((3.0, 4.0)), gravity=(0.0, -1.0), until=1.5)
    told = story(scene)
    assert [float(row.time) for row in told.rows] == [1.0]


def test_what_keeps_no_speed_rests_at_its_first_contact() -> None:
    scene = es.Scene(disks([(1.5, 1.0)], radius=0.5), es.Box((3.0, 4.0)), gravity=(0.0, -1.0), restitution=0.0, until=9.0)
    told = story(scene)
    assert [(row.kind, float(row.time)) for row in told.rows] == [("wall", 1.0), ("rest", 1.0)]


def test_a_drop_into_a_corner_of_a_level_and_a_steep_wall_rests_on_the_level_one_at_its_zeno_time() -> None:
    """Drop height h = 2, g = 1, e = .5: t* = sqrt(2h/g) (1+e)/(1-e) = 6; the steep wall is met each time, and gives nothing."""
    corner = es.Polyline(((0.0, 3.0), (1.0, 1.0), (4.0, 1.0)))
    told = story(
        es.Scene(disks([(1.0, 3.0)], radius=0.0), es.Open(), [corner], gravity=(0.0, -1.0), restitution=0.5, until=9.0)
    )
    assert told.rows[-1].kind == "rest"
    assert float(told.rows[-1].time) == pytest.approx(6.0, abs=1e-12)
    assert velocities(told) == [(0.0, 0.0)]


def test_what_slides_into_a_corner_of_two_sides_has_no_answer_behind_its_zeno_time() -> None:
    """It lies on the bottom, 1 from the right side, to which gravity pulls it by 1/2: 2 until there, 4 more of bounces."""
    scene = es.Scene(disks([(1.5, 0.5)]), es.Box((3.0, 4.0)), gravity=(0.5, -1.0), restitution=0.5, until=9.0)
    told = story(scene)
    assert told.ending == "collapse"
    assert float(told.time) == pytest.approx(6.0, abs=1e-7)


def test_a_point_into_a_corner_meets_both_walls_and_a_vertex_once() -> None:
    """Off the corner by a last bit its way is that of directions alone; a vertex turns it round in one row."""
    corner = es.Polyline(((-1.0, 1.0), (0.0, 0.0), (1.0, 1.0)))
    inside = story(es.Scene(disks([(2.0**-50, 1.0)], [(0.0, -1.0)], 0.0), es.Open(), [corner], until=3.0))
    assert [len(row.walls) for row in inside.rows[:2]] == [2, 2]
    assert velocities(inside) == [(0.0, 1.0)]
    outside = story(es.Scene(disks([(0.0, -1.0)], [(0.0, 1.0)], 0.0), es.Open(), [corner], until=3.0))
    assert len(outside.rows) == 1
    assert velocities(outside) == [(0.0, -1.0)]


def test_a_drop_on_a_vertex_has_no_answer_behind_its_zeno_time() -> None:
    """Drop height h = 0.5, g = 1, e = .5: t* = sqrt(2h/g) (1+e)/(1-e) = 3."""
    told = story(
        es.Scene(
            disks([(0.0, 1.0)]),
            es.Open(),
            walls=[es.Polygon(((0.0, 0.0), (-1.0, -2.0), (1.0, -2.0)))],
            gravity=(0.0, -1.0),
            restitution=0.5,
            until=9.0,
        )
    )
    assert told.ending == "collapse"
    assert float(told.time) == pytest.approx(3.0, abs=1e-9)


@pytest.mark.parametrize(("short", "first"), [(4 * 2.0**-51, "chord"), (1e-10, "round")])
def test_a_point_does_not_pass_between_a_chord_and_the_circle_that_it_ends_on(short: float, first: str) -> None:
    """It flies into the middle of a gap of some last bits, which is none, or of one that can be told."""
    walls = [es.Circle((0.0, 0.0), 5.0, name="round"), es.Segment((3.0, -4.0), (3.0, 4.0 - short), name="chord")]
    told = story(es.Scene(disks([(0.0, 4.0 - short / 2)], [(1.0, 0.0)], 0.0), es.Open(), walls, until=3.5))
    assert told.rows[0].walls == {first}
    assert float(told.rows[0].time) == pytest.approx(3.0, abs=1e-9)

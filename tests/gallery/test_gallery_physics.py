"""The gallery scenes do what their texts say; every expected value is a closed form."""

import math
from dataclasses import replace
from decimal import Decimal, localcontext

import numpy as np
import pytest

import eventsim as es
from eventsim.scene.gallery import gallery
from eventsim.scene.stage import stage_of


def log_of(scene: es.Scene, **stop: float) -> es.EventLog:
    return es.simulate(scene, engine="reference", log=True, **stop).log


def corridor_error(n: int, length: float, events: int) -> float:
    """Largest distance of a disk from Jepsen's solution after `events` events, in lengths of the corridor."""
    scene = gallery("corridor", n=n, length=length)
    run = es.simulate(scene, engine="reference", events=events)
    radius = scene.disks.radius[0]
    cut = radius * (2 * np.arange(n) + 1)
    free = length - 2 * radius * n
    folded = (scene.disks.position[:, 0] - cut + scene.disks.velocity[:, 0] * run.time) % (2 * free)
    points = np.sort(np.minimum(folded, 2 * free - folded))
    return float(np.max(np.abs(run.state.position[:, 0] - points - cut)) / length)


def test_two_disks_are_periodic() -> None:
    log = log_of(gallery("two-disks"))
    assert list(log.time) == [2.0, 4.5, 7.0, 10.5, 14.0, 16.5, 19.0, 22.5]
    assert [str(wall) for wall in log.wall_name] == ["", "right", "", "left"] * 2
    assert list(log.vxa[:4]) == [0.0, -1.0, -1.0, 1.0]


def test_oblique_disks_part_at_a_right_angle() -> None:
    run = es.simulate(gallery("oblique"), engine="reference", log=True)
    assert list(run.log.time) == [6.0]
    # One contact: each component is rounded a few times.
    assert run.state.velocity == pytest.approx(np.array([[0.36, 0.48], [0.64, -0.48]]), abs=4e-16)


def test_oblique_disks_do_not_touch_at_their_reach() -> None:
    assert len(log_of(gallery("oblique", offset=5.0))) == 0
    assert len(log_of(gallery("oblique", offset=math.nextafter(5.0, 0.0)))) == 1


@pytest.mark.parametrize("moving", [1, 2, 3, 4])
def test_as_many_disks_leave_the_cradle_as_came_in(moving: int) -> None:
    run = es.simulate(gallery("newton-cradle", moving=moving), engine="reference", log=True)
    half_swing = run.state_at(6.0).velocity
    assert np.array_equal(half_swing[:, 0], [0.0] * (5 - moving) + [1.0] * moving)
    assert not half_swing[:, 1].any()
    start = gallery("newton-cradle", moving=moving).disks
    assert np.array_equal(run.state_at(16.0).position, start.position)


@pytest.mark.parametrize(
    ("k", "engine"),
    [
        *((k, "reference") for k in range(4)),
        pytest.param(4, "reference", marks=pytest.mark.slow),
        pytest.param(5, "reference", marks=pytest.mark.slow),
        pytest.param(5, "fast", marks=pytest.mark.slow),
        pytest.param(8, "fast", marks=[pytest.mark.slow, pytest.mark.timeout(1200)]),
    ],
)
def test_galperin_contacts_are_the_digits_of_pi(k: int, engine: str) -> None:
    ratio = 100**k
    run = es.simulate(gallery("galperin", mass_ratio=ratio), engine=engine)
    assert run.stopped == "quiet"
    assert run.counters.events == int("314159265"[: k + 1])
    light, heavy = galperin_speeds(ratio, run.counters.events)
    # Low parts leave the rounding of the end; without them (k <= 2) each of up to 314 contacts is rounded.
    tolerance = 1e-9 if k <= 2 else 2.0**-52
    assert run.state.velocity[0, 0] == pytest.approx(light, rel=tolerance)
    assert run.state.velocity[1, 0] == pytest.approx(heavy, rel=tolerance)


def galperin_speeds(ratio: int, contacts: int) -> tuple[float, float]:
    """Final velocities (light, heavy), right to the last bit.

    A pair contact, then the wall, are together a rotation of (sqrt M V, sqrt m v) by 2 theta, tan theta = sqrt(m/M): the
    number ((M - m) + 2i sqrt(M m)) / (M + m), here raised to the number of pair contacts in 60 digits.
    """
    with localcontext(prec=60):
        mass = Decimal(ratio)
        step = (mass - 1) / (mass + 1), 2 * mass.sqrt() / (mass + 1)
        x, y = Decimal(1), Decimal(0)
        for bit in f"{(contacts + 1) // 2:b}":
            x, y = x * x - y * y, 2 * x * y
            if bit == "1":
                x, y = x * step[0] - y * step[1], x * step[1] + y * step[0]
        return float(mass.sqrt() * y) * (-1 if contacts % 2 else 1), float(-x)


@pytest.mark.parametrize(("ratio", "contacts"), [(1 / 3, 2), (1.0, 3), (3.0, 5)])
def test_galperin_ties_are_counted_by_the_ceiling(ratio: float, contacts: int) -> None:
    assert es.simulate(gallery("galperin", mass_ratio=ratio), engine="reference").counters.events == contacts


def test_galperin_contacts_come_when_the_unfolded_line_crosses() -> None:
    log = log_of(gallery("galperin", mass_ratio=10_000))
    theta = math.atan(0.01)
    expected = [-math.tan(theta) / math.tan(k * theta) for k in range(1, 315)]
    # All times are of the order of 1, and the smallest distances of the order of theta: 300 roundings of 1e-16 / theta.
    assert log.time == pytest.approx(expected, abs=1e-10)


@pytest.mark.parametrize(
    ("n", "length", "events"), [(50, 100.0, 10_000), pytest.param(1000, 2000.0, 100_000, marks=pytest.mark.slow)]
)
def test_the_corridor_gas_follows_jepsen(n: int, length: float, events: int) -> None:
    assert corridor_error(n, length, events) < 1e-12


def test_the_corner_reverses_the_disk_with_both_walls_at_once() -> None:
    log = log_of(gallery("corner"), until=18.0 * 100)
    assert np.array_equal(log.time, np.repeat(4.5 + 9.0 * np.arange(200), 2))
    assert np.array_equal(log.joint, np.repeat(2 * np.arange(200), 2))
    assert np.array_equal(log.vxa[1::4], np.full(100, -1.0))
    assert np.array_equal(log.xa[3::4], np.full(100, 0.5))


def test_the_rack_touches_exactly() -> None:
    position, radius = gallery("break").disks.position, gallery("break").disks.radius
    touching = 0
    for i in range(1, 16):
        for j in range(1, i):
            gap = np.sum((position[i] - position[j]) ** 2) - (radius[i] + radius[j]) ** 2
            assert gap >= 0
            touching += bool(gap == 0)
    assert touching == 20, "each of the ten disks of the first four rows touches two of the next row"


def test_the_break_is_symmetric_at_first() -> None:
    scene = gallery("break")
    log = log_of(scene)
    first = log.time == log.time[0]
    apex = scene.disks.position[1, 0]
    assert log.time[0] == pytest.approx(
        (apex - scene.disks.position[0, 0] - 2 * scene.disks.radius[0]) / 6.0, rel=1e-15
    )
    assert first.sum() > 10, "the impulse passes through the rack at one instant"
    state = es.simulate(scene, engine="reference", until=log.time[0]).state
    mirror = [0, 1, 3, 2, 6, 5, 4, 10, 9, 8, 7, 15, 14, 13, 12, 11]
    assert state.velocity[:, 0] == pytest.approx(state.velocity[mirror, 0], abs=1e-14)
    assert state.velocity[:, 1] == pytest.approx(-state.velocity[mirror, 1], abs=1e-14)


def test_the_tie_is_resolved_jointly() -> None:
    run = es.simulate(gallery("tie"), engine="reference", log=True)
    assert list(run.log.time) == [3.0, 3.0]
    assert list(run.log.joint) == [0, 0]
    expected = [[-7 / 57, 0.0], [32 / 57, 24 / 57], [32 / 57, -24 / 57]]
    assert run.state.velocity == pytest.approx(np.array(expected), abs=2e-16)


@pytest.mark.parametrize(("restitution", "contacts"), [(0.08, 11), (1.0, 3)])
def test_the_collapse_scene_has_as_many_contacts_as_known(restitution: float, contacts: int) -> None:
    run = es.simulate(gallery("collapse", restitution=restitution), engine="reference")
    assert run.stopped == "quiet"
    assert run.counters.events == contacts


def test_collapse_is_said() -> None:
    run = es.simulate(gallery("collapse", restitution=0.07), engine="reference")
    assert run.stopped in ("collapse", "digits")


def test_the_impacts_of_the_bounce_are_exact() -> None:
    log = log_of(gallery("bounce"), until=3.0 - 1.5 * 2.0**-39)
    assert list(log.time) == [3.0 - 2.0 ** (2 - n) for n in range(1, 41)]
    assert set(log.wall_name) == {"bottom"}
    assert np.array_equal(log.ya, np.full(40, 0.5))


def test_the_bounce_stops_by_itself_before_the_zeno_time() -> None:
    for restitution in (0.0, 0.3, 0.5, 0.9, 1.0):
        assert es.simulate(gallery("bounce", restitution=restitution), engine="reference").stopped == "until"


def test_points_part_exponentially_on_the_sinai_billiard() -> None:
    run = es.simulate(gallery("sinai"), engine="reference", log=True)
    apart = run.state.position[1] - run.state.position[2]
    assert np.hypot(*(apart - np.round(apart))) > 1e-3
    assert np.array_equal(run.state.position[0], [0.0, 0.0])
    assert np.hypot(*run.state.velocity.T)[1:] == pytest.approx([1.0, 1.0], rel=1e-13)


def test_the_disk_stays_in_the_stadium() -> None:
    log = log_of(gallery("stadium"))
    room = 1.0 - 0.125
    beyond = np.maximum(np.abs(log.xa) - 1.0, 0.0)
    assert np.hypot(beyond, log.ya) == pytest.approx(np.full(len(log), room), abs=1e-12)


def test_a_stadium_without_length_is_a_circle_and_keeps_the_angle() -> None:
    log = log_of(gallery("stadium", half_length=0.0), until=100.0)
    angular = log.xa * log.vya - log.ya * log.vxa
    assert np.ptp(angular) < 1e-12


def test_the_channel_keeps_its_momentum_along_the_plates() -> None:
    scene = gallery("channel")
    run = es.simulate(scene, engine="reference")
    assert run.state.velocity[:, 0].sum() == pytest.approx(scene.disks.velocity[:, 0].sum(), abs=1e-11)
    assert run.counters.wall_contacts > 0


def test_the_cooling_gas_follows_haff_at_first() -> None:
    scene = gallery("cooling")
    run = es.simulate(scene, engine="reference", events=1000)
    contacts = 2 * run.counters.pair_contacts / len(scene.disks)
    left = np.sum(run.state.velocity**2) / np.sum(scene.disks.velocity**2)
    # Ten contacts per disk: e^-0.95; the sum over 1000 random losses scatters by about 3 %.
    assert left == pytest.approx(math.exp(-(1 - 0.9**2) * contacts / 2), rel=0.1)


def test_the_obstacle_cannot_be_deflected_and_heats_the_gas() -> None:
    scene = gallery("obstacle")
    run = es.simulate(scene, engine="reference")
    assert np.array_equal(run.state.velocity[0], scene.disks.velocity[0])
    assert np.sum(run.state.velocity[1:] ** 2) > np.sum(scene.disks.velocity[1:] ** 2)
    assert run.residuals.energy is None


def test_the_large_disk_begins_to_wander() -> None:
    run = es.simulate(gallery("brownian"), engine="reference")
    assert np.all(run.state.position[0] != [13.0, 13.0])


@pytest.mark.parametrize("name", ["funnel", "jar", "sculpture"])
def test_energy_is_kept_under_gravity(name: str) -> None:
    run = es.simulate(gallery(name), engine="reference")
    assert run.residuals.energy is not None
    assert abs(run.residuals.energy) < 1e-11
    assert run.residuals.max_overlap < 1e-11


def test_disks_fall_through_the_funnel() -> None:
    run = es.simulate(gallery("funnel"), engine="reference")
    assert np.sum(run.state.position[:, 1] < 5.0) > 5


def test_points_in_an_ellipse_keep_the_product_of_their_angular_momenta_about_the_foci() -> None:
    scene = replace(gallery("ellipse"), until=None, events=30_000)
    log = es.simulate(scene, engine="reference", log=True).log
    corner = stage_of(scene).corner[0]
    for disk, product in ((0, 0.0), (1, -15.0 * 0.96**2), (2, 4.25 * 0.96**2)):
        of = log.a == disk
        x, y, vx, vy = log.xa[of] + corner, log.ya[of], log.vxa[of], log.vya[of]
        found = ((x + 4.0) * vy - y * vx) * ((x - 4.0) * vy - y * vx)
        assert len(found) > 6_000
        assert np.abs(found - product).max() < 1e-9


def test_a_point_that_starts_in_a_focus_of_an_ellipse_is_in_one_every_two_semi_axes() -> None:
    run = es.simulate(gallery("ellipse"), log=True)
    for k in range(1, 4):
        assert np.allclose(run.state_at(10.0 * k).position[0], (4.0 * (-1) ** (k + 1), 0.0), atol=1e-12)

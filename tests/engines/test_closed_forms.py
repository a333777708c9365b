"""What is known exactly: each scene has a closed form, and the engine must give it."""

import math
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import eventsim as es
from tests.engines.scenes import lattice_gas, rows_of, run_of

ULP = 2.0**-52


def pair_scene(position, velocity, radius=0.5, mass=1.0, domain=None, **scene):
    return es.Scene(es.Disks(position, velocity, radius, mass), domain or es.Open(), **scene)


@given(
    st.floats(-300, 300).map(lambda k: 10.0**k),
    st.floats(-300, 300).map(lambda k: 10.0**k),
    st.floats(0.0, 2.0 * math.pi),
    st.floats(-1.5, 1.5),
    st.floats(0.0, 1.0),
)
def test_a_pair_is_resolved_as_the_closed_form_says(mass_a, mass_b, angle, aim, restitution):
    """A touches B in the direction `angle` and moves at `aim` to the line of centres."""
    n = np.array([math.cos(angle), math.sin(angle)])
    v = np.array([math.cos(angle + aim), math.sin(angle + aim)])
    scene = pair_scene([-3.0 * v - n, [0.0, 0.0]], [v, [0.0, 0.0]], mass=[mass_a, mass_b], restitution=restitution)
    rows = rows_of(scene, until=10.0)
    assert len(rows) == 1
    log_ratio = math.log(mass_b) - math.log(mass_a)
    share_a = 1.0 / (1.0 + math.exp(log_ratio)) if log_ratio < 700.0 else math.exp(-log_ratio)
    share_b = 1.0 / (1.0 + math.exp(-log_ratio)) if log_ratio > -700.0 else math.exp(log_ratio)
    vn = float(v @ n)
    after_a = v - (1.0 + restitution) * share_b * vn * n
    after_b = (1.0 + restitution) * share_a * vn * n
    # positions at contact carry rounding of about 4 ulp of 3, which turns the normal by as much
    assert rows[0]["vxa"] == pytest.approx(after_a[0], abs=64 * ULP)
    assert rows[0]["vya"] == pytest.approx(after_a[1], abs=64 * ULP)
    # the logarithms of the masses, up to 700, are known to an ulp: the fraction to 700 ulp
    assert rows[0]["vxb"] == pytest.approx(after_b[0], rel=2000 * ULP, abs=64 * ULP * share_a)


@given(st.floats(0.0, 0.999))
def test_equal_disks_leave_at_right_angles(b):
    rows = rows_of(pair_scene([[-3.0, b], [0.0, 0.0]], [[1.0, 0.0], [0.0, 0.0]]), until=10.0)
    s = math.sqrt(1.0 - b * b)
    got = [rows[0][name] for name in ("vxa", "vya", "vxb", "vyb")]
    # the normal turns by the error of the contact position, which near a graze is that of sqrt(1 - b^2)
    assert got == pytest.approx([b * b, b * s, s * s, -b * s], abs=32 * ULP / s)


def test_f1_a_graze_by_one_bit_is_a_hit():
    dy = 1.0 - 2.0**-53
    rows = rows_of(pair_scene([[-3.0, dy], [0.0, 0.0]], [[1.0, 0.0], [0.0, 0.0]]), until=10.0)
    s = math.sqrt(1.0 - dy * dy)
    assert rows["time"] == pytest.approx([3.0 - s], abs=4 * ULP)
    assert rows[0]["vxa"] == pytest.approx(dy * dy, abs=4 * ULP)
    assert rows[0]["vya"] == pytest.approx(dy * s, abs=4 * ULP)


@pytest.mark.parametrize("dy", [1.0, 1.0 + 2.0**-52])
def test_f2_a_tangency_and_a_miss_are_no_event(dy):
    session, stopped = run_of(pair_scene([[-3.0, dy], [0.0, 0.0]], [[1.0, 0.0], [0.0, 0.0]]), until=10.0)
    assert stopped == "quiet"
    assert session.counters.events == 0
    assert session.motion().vx.tolist() == [1.0, 0.0]


def test_f3_disks_in_contact_that_move_tangentially_do_not_meet():
    session, _ = run_of(pair_scene([[0.0, 0.0], [3.0, 4.0]], [[0.0, 0.0], [-4.0, 3.0]], radius=2.5), until=10.0)
    assert session.counters.events == 0


def test_f3_a_tangential_motion_that_rounds_to_approaching_does_not_loop():
    """3 (-0.8) + 4 (0.6) is -2e-16 for the floats nearest to these decimals."""
    session, stopped = run_of(pair_scene([[0.0, 0.0], [3.0, 4.0]], [[0.0, 0.0], [-0.8, 0.6]], radius=2.5), until=10.0)
    assert stopped == "quiet"
    assert session.counters.events <= 1


def test_f4_a_corner_reverses_the_velocity_and_a_million_periods_lose_no_bit():
    scene = es.Scene(es.Disks([[5.0, 5.0]], [[1.0, 1.0]], 0.5), es.Box((10.0, 10.0)))
    rows = rows_of(scene, until=18.0)
    assert rows["time"].tolist() == [4.5, 4.5, 13.5, 13.5]
    assert rows["joint"].tolist() == [0, 0, 2, 2]
    assert (rows[1]["vxa"], rows[1]["vya"]) == (-1.0, -1.0)


def test_f4_many_periods_are_bit_exact():
    scene = es.Scene(es.Disks([[5.0, 5.0]], [[1.0, 1.0]], 0.5), es.Box((10.0, 10.0)))
    run = es.simulate(scene, until=18.0 * 2000)
    assert run.counters.events == 8000
    assert run.state.position.tolist() == [[5.0, 5.0]]
    assert run.state.velocity.tolist() == [[1.0, 1.0]]


@pytest.mark.slow
@pytest.mark.timeout(1200)  # two million joint contacts in exact arithmetic
def test_f4_a_million_periods_are_bit_exact():
    scene = es.Scene(es.Disks([[5.0, 5.0]], [[1.0, 1.0]], 0.5), es.Box((10.0, 10.0)))
    run = es.simulate(scene, until=18.0 * 10**6, engine="reference")
    assert run.counters.events == 4 * 10**6
    assert run.state.position.tolist() == [[5.0, 5.0]]
    assert run.state.velocity.tolist() == [[1.0, 1.0]]


@pytest.mark.parametrize("moving", [1, 2])
def test_f5_a_touching_cradle_passes_on_what_comes_in(moving):
    x = [-2.0 - k for k in range(moving, 0, -1)] + [float(k) for k in range(5 - moving)]
    scene = pair_scene([[value, 0.0] for value in x], [[1.0, 0.0]] * moving + [[0.0, 0.0]] * (5 - moving))
    session, stopped = run_of(scene, until=20.0)
    assert stopped == "quiet"
    assert session.motion().vx.tolist() == [0.0] * (5 - moving) + [1.0] * moving
    assert session.motion().vy.tolist() == [0.0] * 5


def symmetric_break(order):
    position = np.array([[-3.0, 0.0], [4.0, 3.0], [4.0, -3.0]])[order]
    velocity = np.array([[1.0, 0.0], [0.0, 0.0], [0.0, 0.0]])[order]
    return pair_scene(position, velocity, radius=2.5)


@pytest.mark.parametrize("order", list(permutations(range(3))))
def test_f6_a_symmetric_break_is_one_cluster_and_independent_of_labels(order):
    session, _ = run_of(symmetric_break(list(order)), until=3.5)
    motion = session.motion()
    after = {order[i]: (motion.vx[i], motion.vy[i]) for i in range(3)}
    assert after[0] == (-7 / 57, 0.0)
    assert after[1] == (40 / 57 * 4 / 5, 40 / 57 * 3 / 5) == (32 / 57, 24 / 57)
    assert after[2] == (32 / 57, -24 / 57)
    assert session.counters.clusters == 1


@pytest.mark.parametrize("order", list(permutations(range(4)))[::3])
def test_three_disks_at_120_degrees_onto_one_do_not_depend_on_labels(order):
    angles = 2.0 * math.pi * np.arange(3) / 3.0
    ring = np.column_stack([np.cos(angles), np.sin(angles)])
    ring[2] = ring[1] * [1.0, -1.0]  # symmetric in floats too
    position, velocity = np.vstack([[[0.0, 0.0]], 3.0 * ring]), np.vstack([[[0.0, 0.0]], -ring])
    base, _ = run_of(pair_scene(position, velocity), until=4.0)
    other, _ = run_of(pair_scene(position[list(order)], velocity[list(order)]), until=4.0)
    assert other.counters.events == base.counters.events
    for i, k in enumerate(order):
        assert other.motion().vx[i] == base.motion().vx[k]
        assert other.motion().vy[i] == base.motion().vy[k]
    assert math.hypot(base.motion().vx[0], base.motion().vy[0]) < 8 * ULP


@pytest.mark.parametrize("order", list(permutations(range(3))))
def test_two_disks_onto_a_heavy_middle_do_not_depend_on_labels(order):
    position = np.array([[-3.0, 0.0], [0.0, 0.0], [3.0, 0.0]])[list(order)]
    velocity = np.array([[1.0, 0.0], [0.0, 0.0], [-1.0, 0.0]])[list(order)]
    mass = np.array([1.0, 1000.0, 1.0])[list(order)]
    session, _ = run_of(pair_scene(position, velocity, mass=mass), until=4.0)
    vx = session.motion().vx
    assert [vx[order.index(k)] for k in range(3)] == [-1.0, 0.0, 1.0]


def test_f7_the_sign_of_a_gap_decides_the_order_of_contacts():
    for eps, expected in ((2.0**-40, (-0.5, -0.25, 1.25)), (-(2.0**-40), (-1.25, 0.25, 0.5))):
        scene = pair_scene(
            [[-2.0, 0.0], [0.0, 0.0], [2.0 + eps, 0.0]],
            [[1.0, 0.0], [0.0, 0.0], [-1.0, 0.0]],
            mass=[1.0, 3.0, 1.0],
        )
        session, _ = run_of(scene, until=4.0)
        assert session.motion().vx.tolist() == pytest.approx(expected, abs=4 * ULP)


@pytest.mark.parametrize("order", list(permutations(range(4)))[::5])
def test_f8_disjoint_pairs_at_the_same_time_do_not_depend_on_labels(order):
    position = np.array([[-2.0, 0.0], [2.0, 0.0], [-2.0, 7.0], [2.0, 7.25]])
    velocity = np.array([[1.0, 0.0], [-1.0, 0.0], [1.0, 0.0], [-1.0, 0.0]])
    base = run_of(pair_scene(position, velocity), until=4.0)[0].motion()
    other = run_of(pair_scene(position[list(order)], velocity[list(order)]), until=4.0)[0].motion()
    for name in ("vx", "vy", "x", "y"):
        assert getattr(other, name).tolist() == getattr(base, name)[list(order)].tolist()


@pytest.mark.parametrize(("speed", "events"), [(-1.0, 1), (1.0, 0), (0.0, 0)])
def test_f9_touching_disks_meet_at_once_only_if_they_approach(speed, events):
    rows = rows_of(pair_scene([[0.0, 0.0], [1.0, 0.0]], [[0.0, 0.0], [speed, 0.0]]), until=5.0)
    assert rows["time"].tolist() == [0.0] * events


def test_f10_an_overlap_by_rounding_meets_now():
    scene = pair_scene([[1e6, 0.0], [1e6 + 1.0 - 1e-9, 0.0]], [[1.0, 0.0], [0.0, 0.0]])
    rows = rows_of(scene, until=5.0)
    assert rows["time"].tolist() == [0.0]
    assert (rows[0]["vxa"], rows[0]["vxb"]) == (0.0, 1.0)


@pytest.mark.parametrize("domain", [es.Open(), es.Box((40.0, 40.0)), es.Periodic((40.0, 40.0))])
def test_f20_nothing_happens_where_nothing_can(domain):
    rest = es.Scene(es.Disks([[5.0, 5.0], [9.0, 9.0]], radius=0.5), domain)
    for stop in ({"until": 1e9}, {"events": 10}):
        session, stopped = run_of(rest, **stop)
        assert (stopped, session.counters.events) == ("quiet", 0)
    together = es.Scene(es.Disks([[5.0, 5.0], [9.0, 9.0]], [[1.0, 0.0]] * 2, 0.5), domain)
    session, stopped = run_of(together, until=3.0)
    assert session.counters.pair_contacts == 0


def test_f20_disks_that_share_one_velocity_on_a_torus_are_quiet():
    scene = es.Scene(es.Disks([[5.0, 5.0], [9.0, 9.0]], [[1.0, 0.3]] * 2, 0.5), es.Periodic((40.0, 40.0)))
    session, stopped = run_of(scene, events=10)
    assert (stopped, session.counters.events) == ("quiet", 0)


def test_f23_the_first_40_impacts_of_a_zeno_bounce_are_bit_exact():
    """g = 2, drop height 1, e = 1/2: impacts at 3 - 2^(2-n)."""
    scene = es.Scene(es.Disks([[5.0, 1.5]], radius=0.5), es.Box((10.0, 10.0)), gravity=(0.0, -2.0), restitution=0.5)
    rows = rows_of(scene, events=40)
    assert rows["time"].tolist() == [3.0 - 2.0 ** (2 - n) for n in range(1, 41)]


def test_f25_an_apex_that_touches_the_ceiling_is_no_event():
    def scene(height):
        return es.Scene(
            es.Disks([[5.0, 1.0]], [[0.0, 2.0]], 0.5),
            es.Open(),
            walls=[es.Segment((0.0, height + 1.5), (10.0, height + 1.5))],
            gravity=(0.0, -2.0),
        )

    assert len(rows_of(scene(1.0), until=4.0)) == 0
    assert len(rows_of(scene(1.0 - 2.0**-50), until=4.0)) == 1


@pytest.mark.parametrize(("v", "expected"), [(1.0, (1.0 + math.sqrt(1.0 + 2 * 9.81e-12)) / 9.81), (-1.0, 1e-12)])
def test_f26_a_parabola_close_to_the_floor_keeps_its_digits(v, expected):
    from eventsim.formulas.crossing import closing_delay

    assert closing_delay(1e-12, v, -9.81) == pytest.approx(expected, rel=4 * ULP + (9.81e-12 if v < 0 else 0.0))


def test_f27_a_disk_meets_the_image_in_a_small_periodic_box():
    scene = es.Scene(es.Disks([[0.0, 0.0], [1.9, 0.0]], [[0.0, 0.0], [1.0, 0.0]], 0.5), es.Periodic((4.0, 4.0)))
    rows = rows_of(scene, events=1)
    assert rows[0]["time"] == pytest.approx(1.1, abs=4 * ULP)


def test_f28_two_images_are_met_at_once_and_a_disk_larger_than_the_box_is_refused():
    """d = 3 in a box of 4: between its images, B at rest is met from two sides by symmetry."""
    scene = es.Scene(es.Disks([[0.0, 0.0], [2.0, 3.0]], [[0.0, 0.0], [0.0, -1.0]], 1.5), es.Periodic((4.0, 8.0)))
    rows = rows_of(scene, events=2)
    assert len(rows) == 2
    assert rows["joint"].tolist() == [0, 0]
    assert rows[0]["time"] == pytest.approx(3.0 - math.sqrt(5.0), abs=4 * ULP)
    # the two normals are (2, +-sqrt 5)/3: by symmetry B's momentum is exchanged along y
    assert rows[1]["vxb"] == 0.0
    assert rows[1]["vyb"] + rows[1]["vya"] == pytest.approx(-1.0, abs=4 * ULP)
    assert rows[1]["vya"] ** 2 + rows[1]["vyb"] ** 2 == pytest.approx(1.0, abs=8 * ULP)
    with pytest.raises(es.SceneError):
        es.Scene(es.Disks([[1.0, 1.0]], radius=2.1), es.Periodic((4.0, 4.0)))


def test_f29_a_wrapped_coordinate_stays_inside():
    scene = es.Scene(es.Disks([[1e-17, 0.5]], [[-1.0, 0.25]], 0.1), es.Periodic((1.0, 1.0)))
    sim = es.Simulation(scene)
    for t in np.linspace(0.0, 5.0, 501):
        sim.advance_to(float(t))
        assert (sim.state.position >= 0.0).all()
        assert (sim.state.position < 1.0).all()


def test_f31_a_stale_prediction_is_dropped():
    scene = pair_scene([[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]], [[1.0, 0.0], [0.0, 0.0], [1.0, -2.0]])
    rows = rows_of(scene, until=20.0, check=True)
    assert rows[0]["time"] < 1.0
    assert (rows[0]["a"], rows[0]["b"]) == (0, 2)


def test_f31_quantised_velocities_give_the_log_of_all_pairs():
    scene = lattice_gas(40, 0.3, es.Box, quantum=0.25)
    assert rows_of(scene, events=20_000).tobytes() == rows_of(scene, events=20_000, grid=None).tobytes()


@pytest.mark.slow
def test_f31_quantised_velocities_give_the_log_of_all_pairs_over_1e5_events():
    scene = lattice_gas(40, 0.3, es.Box, quantum=0.25)
    assert rows_of(scene, events=100_000).tobytes() == rows_of(scene, events=100_000, grid=None).tobytes()


def test_f36_the_state_at_the_time_of_an_event_is_the_state_after_it():
    run = es.simulate(pair_scene([[-3.0, 0.0], [0.0, 0.0]], [[1.0, 0.0], [0.0, 0.0]]), until=5.0, log=True)
    assert run.state_at(2.0).velocity.tolist() == [[0.0, 0.0], [1.0, 0.0]]
    assert run.state_at(math.nextafter(2.0, 0.0)).velocity.tolist() == [[1.0, 0.0], [0.0, 0.0]]


def test_f37_bad_input_is_refused_and_the_disks_are_named():
    with pytest.raises(es.SceneError, match=r"disk\[0\] and disk\[1\]"):
        pair_scene([[0.0, 0.0], [0.5, 0.0]], [[0.0, 0.0], [0.0, 0.0]])
    with pytest.raises(es.SceneError, match=r"disk\[0\]"):
        es.Scene(es.Disks([[0.2, 5.0]], radius=0.5), es.Box((10.0, 10.0)))
    with pytest.raises(es.SceneError, match="nan"):
        es.Scene(es.Disks([[math.nan, 5.0]], radius=0.5), es.Open())
    with pytest.raises(es.SceneError, match="-1"):
        es.Scene(es.Disks([[0.0, 5.0]], radius=-1.0), es.Open())


@given(st.integers(0, 10**6))
def test_f38_three_equal_disks_on_the_plane_meet_at_most_four_times(seed):
    rng = np.random.default_rng(seed)
    angle = rng.uniform(0.0, 2.0 * math.pi) + np.array([0.0, 2.0, 4.0]) + rng.uniform(-0.3, 0.3, 3)
    place = rng.uniform(1.0, 3.0, (3, 1)) * np.column_stack([np.cos(angle), np.sin(angle)])
    velocity = -place * rng.uniform(0.5, 2.0, (3, 1)) + rng.normal(scale=0.2, size=(3, 2))
    session, stopped = run_of(pair_scene(place, velocity, radius=0.5), events=100)
    assert stopped == "quiet"
    assert session.counters.events <= 4


def test_f35_disks_without_restitution_do_not_loop():
    scene = lattice_gas(30, 0.3, es.Box, restitution=0.0, contact_duration=1e-3)
    session, stopped = run_of(scene, events=2000)
    assert stopped == "events"
    pair = pair_scene([[-3.0, 0.3], [0.0, 0.0]], [[1.0, 0.0], [0.1, 0.0]], restitution=0.0)
    session, stopped = run_of(pair, until=50.0)
    assert stopped == "quiet"
    assert session.counters.events == 1


def test_an_immovable_disk_is_not_deflected_and_a_tracer_deflects_nobody():
    scene = pair_scene([[-3.0, 0.0], [0.0, 0.0]], [[1.0, 0.0], [0.5, 0.0]], mass=[math.inf, 1.0])
    rows = rows_of(scene, until=10.0)
    assert (rows[0]["vxa"], rows[0]["vxb"]) == (1.0, 1.5)
    scene = pair_scene([[-3.0, 0.0], [0.0, 0.0]], [[1.0, 0.0], [0.5, 0.0]], mass=[0.0, 1.0])
    rows = rows_of(scene, until=10.0)
    assert (rows[0]["vxa"], rows[0]["vxb"]) == (0.0, 0.5)


def test_masses_of_1e200_do_not_overflow():
    rows = rows_of(pair_scene([[-3.0, 0.0], [0.0, 0.0]], [[1.0, 0.0], [0.0, 0.0]], mass=1e200), until=10.0)
    assert (rows[0]["vxa"], rows[0]["vxb"]) == (0.0, 1.0)


def test_a_disk_squeezed_between_immovable_ones_stops_the_run_with_a_reason():
    scene = pair_scene(
        [[-2.0, 0.0], [0.0, 0.0], [2.0, 0.0]], [[1.0, 0.0], [0.0, 0.0], [-1.0, 0.0]], mass=[math.inf, 1.0, math.inf]
    )
    session, stopped = run_of(scene, until=5.0)
    assert stopped == "collapse"
    assert "disks 0, 1, 2" in session.reason


@pytest.mark.parametrize(
    ("wrong", "word"),
    [
        ({"until": math.inf}, "finite"),
        ({"until": -1.0}, "before the start"),
        ({"until": "4"}, "must be a number"),
        ({"events": 2.5}, "whole number"),
        ({"events": True}, "whole number"),
        ({"events": -3}, "at least 0"),
        ({}, "nothing says when to stop"),
    ],
)
def test_a_stop_that_makes_no_sense_is_refused(wrong, word):
    with pytest.raises(es.SceneError, match=word):
        es.simulate(pair_scene([[0.0, 0.0]], [[1.0, 0.0]]), **wrong)
    with pytest.raises(es.SceneError, match="not a scene"):
        es.simulate("break")


def test_a_snapshot_of_another_scene_is_refused():
    saved = es.Simulation(lattice_gas(5, 0.1)).snapshot()
    with pytest.raises(es.EventsimError, match="same scene"):
        es.Simulation(lattice_gas(6, 0.1)).restore(saved)


def test_every_engine_of_the_list_takes_a_scene_and_a_stop():
    run = es.ENGINES["reference"].run(lattice_gas(5, 0.1), es.Stop(events=3))
    assert run.counters.events == 3
    assert es.ENGINES["reference"].run(lattice_gas(5, 0.1), 0.5).time == 0.5


def test_the_state_at_a_time_of_the_log_is_the_state_after_that_event():
    run = es.simulate(es.gallery("break"), log=True)
    for i, time in enumerate(run.log.time):
        if i + 1 < len(run.log) and run.log.time[i + 1] == time:
            continue
        state = run.state_at(float(time))
        assert state.velocity[run.log.a[i]].tolist() == [run.log.vxa[i], run.log.vya[i]]


def test_a_time_that_the_clock_cannot_count_is_refused():
    with pytest.raises(es.EventsimError, match="the clock of this scene ends at"):
        es.simulate(pair_scene([[0.0, 0.0]], [[1.0, 0.0]]), until=1e300)


@pytest.mark.parametrize("k", [20, 40, 50, 52])
@pytest.mark.parametrize("sign", [1, -1])
def test_f7_the_sign_of_the_smallest_gap_decides(k, sign):
    scene = es.Scene(
        disks=es.Disks(
            [(0.0, 0.0), (0.5, 0.0), (1.0 + sign * 2.0**-k, 0.0)],
            [(1.0, 0.0), (0.0, 0.0), (-1.0, 0.0)],
            0.125,
            (1.0, 3.0, 1.0),
        ),
        domain=es.Open(),
    )
    run = es.simulate(scene, until=10.0, engine="reference")
    expected = (-0.5, -0.25, 1.25) if sign > 0 else (-1.25, 0.25, 0.5)
    assert run.state.velocity[:, 0].tolist() == list(expected)
    assert run.counters.clusters == 0

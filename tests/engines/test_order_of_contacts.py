"""Which contact comes next: ties, stale predictions, causality, and what is known when nothing comes any more."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

import eventsim as es
from eventsim.validation.stress.catalogue.order import onto_heavy, three_disks
from eventsim.validation.stress.catalogue.scenes import on_plane
from tests.engines.scenes import lattice_gas, rows_of, run_of


@pytest.mark.parametrize("eps", [2.0**-52, -(2.0**-52)])
def test_contacts_one_bit_apart_are_no_cluster(eps):
    session, _ = run_of(onto_heavy(eps), until=10.0)
    assert session.counters.clusters == 0


def test_a_stale_prediction_is_dropped():
    scene = on_plane([[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]], [[1.0, 0.0], [0.0, 0.0], [1.0, -2.0]])
    rows = rows_of(scene, until=20.0, check=True)
    assert rows[0]["time"] < 1.0
    assert (rows[0]["a"], rows[0]["b"]) == (0, 2)


def test_quantised_velocities_give_the_log_of_all_pairs():
    scene = lattice_gas(40, 0.3, es.Box, quantum=0.25)
    assert rows_of(scene, events=20_000).tobytes() == rows_of(scene, events=20_000, grid=None).tobytes()


@pytest.mark.slow
def test_quantised_velocities_give_the_log_of_all_pairs_over_1e5_events():
    scene = lattice_gas(40, 0.3, es.Box, quantum=0.25)
    assert rows_of(scene, events=100_000).tobytes() == rows_of(scene, events=100_000, grid=None).tobytes()


@given(st.integers(0, 10**6))
def test_three_equal_disks_on_the_plane_meet_at_most_four_times(seed):
    session, stopped = run_of(three_disks(seed), events=100)
    assert stopped == "quiet"
    assert session.counters.events <= 4


@pytest.mark.parametrize("domain", [es.Open(), es.Box((40.0, 40.0)), es.Periodic((40.0, 40.0))])
def test_nothing_happens_where_nothing_can(domain):
    rest = es.Scene(es.Disks([[5.0, 5.0], [9.0, 9.0]], radius=0.5), domain)
    for stop in ({"until": 1e9}, {"events": 10}):
        session, stopped = run_of(rest, **stop)
        assert (stopped, session.counters.events) == ("quiet", 0)
    together = es.Scene(es.Disks([[5.0, 5.0], [9.0, 9.0]], [[1.0, 0.0]] * 2, 0.5), domain)
    session, stopped = run_of(together, until=3.0)
    assert session.counters.pair_contacts == 0


def test_disks_that_share_one_velocity_on_a_torus_are_quiet():
    scene = es.Scene(es.Disks([[5.0, 5.0], [9.0, 9.0]], [[1.0, 0.3]] * 2, 0.5), es.Periodic((40.0, 40.0)))
    session, stopped = run_of(scene, events=10)
    assert (stopped, session.counters.events) == ("quiet", 0)


def test_the_state_at_a_time_of_the_log_is_the_state_after_that_event():
    run = es.simulate(es.gallery("break"), log=True)
    for i, time in enumerate(run.log.time):
        if i + 1 < len(run.log) and run.log.time[i + 1] == time:
            continue
        state = run.state_at(float(time))
        assert state.velocity[run.log.a[i]].tolist() == [run.log.vxa[i], run.log.vya[i]]

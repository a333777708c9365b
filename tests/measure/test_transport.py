"""Transport coefficients by Helfand moments, against moments of places, and Enskog."""

import math
from dataclasses import replace

import numpy as np
import pytest

import eventsim as es
from eventsim.measure import study, theory
from eventsim.measure.studies.transport import Transport


def fluid(n=16, fraction=0.2, **changes):
    return replace(es.gallery("periodic-fluid", n=n, packing_fraction=fraction, seed=7), **changes)


def run_log(scene, **stop):
    return es.simulate(scene, engine="reference", log=True, trust=False, **stop).log


def moments_of_places(log, times):
    """Sum m v_x y and sum x e at times, places not wrapped; less what contacts carry over a period, which is no way of theirs."""
    disks, size = log.scene.disks, np.array(log.scene.domain.size)
    drift = disks.velocity.mean(axis=0)
    place, velocity, since = disks.position.copy(), disks.velocity - drift, np.zeros(len(disks))
    rows, found, carried = list(log.rows), [], np.zeros(2)
    for time in times:
        while rows and rows[0]["remainder"] + rows[0]["epoch"] * log.provenance.epoch_length < time:
            row = rows.pop(0)
            now, a, b = row["remainder"] + row["epoch"] * log.provenance.epoch_length, row["a"], row["b"]
            for i in (a, b):
                place[i] += velocity[i] * (now - since[i])
                since[i] = now
            apart = place[a] - place[b]
            periods = size * np.round(apart / size)
            after = np.array([row["vxa"], row["vya"]]) - drift
            push, gained = after[0] - velocity[a, 0], 0.5 * (after @ after - velocity[a] @ velocity[a])
            carried += push * periods[1], gained * periods[0]
            velocity[a], velocity[b] = after, np.array([row["vxb"], row["vyb"]]) - drift
        there = place + velocity * (time - since)[:, None]
        energy = 0.5 * (velocity**2).sum(axis=1)
        found.append(np.array([(velocity[:, 0] * there[:, 1]).sum(), (there[:, 0] * energy).sum()]) - carried)
    return np.array(found)


def test_moments_are_those_of_places_and_velocities():
    log = run_log(fluid(), events=400)
    transport = Transport(log.scene)
    for block in np.array_split(log.rows, 7):
        transport.write(block)
    transport.found(float(log.time[-1]))
    walks = np.array(transport._samples)
    assert len(walks) > 100
    moments = moments_of_places(log, [k * transport._step for k in range(len(walks))])
    assert np.abs(walks[:, (0, 2)] - (moments - moments[0])).max() < 1e-10 * np.abs(moments).max()


def test_they_do_not_depend_on_how_rows_are_cut_and_need_no_log():
    log = run_log(fluid(), events=3_000)
    whole = study(log, "transport")
    pieces = Transport(log.scene)
    for block in np.array_split(log.rows, 11):
        pieces.write(block)
    assert len(whole.tables["transport"]["lag"]) > 5
    ending = log.provenance.ending
    again = pieces.found(ending.epoch * log.provenance.epoch_length + ending.remainder)
    # the first block makes the mean free time, so lags are those of a little more or less time
    assert again["viscosity"].value == pytest.approx(whole["viscosity"].value, rel=0.5)
    assert again["heat_conductivity"].value > 0.0


def test_enskog_has_its_parts():
    """(1 + y / 2)^2 and (1 + 3 y / 4)^2 of what is carried in flight, 2 / pi and 1 / pi y^2 across the disks."""
    g = theory.contact_value(0.3, theory.compressibility_factor(0.3))
    y = 0.6 * g
    unit = math.sqrt(1.0 / math.pi)
    viscosity = 0.5 * unit * (1.022 * (1.0 + 0.5 * y) ** 2 + 2.0 / math.pi * y * y) / g
    conductivity = 2.0 * unit * (1.029 * (1.0 + 0.75 * y) ** 2 + y * y / math.pi) / g
    assert theory.enskog_viscosity(0.3, 1.0, 1.0, 1.0) == pytest.approx(viscosity, rel=2e-4)
    assert theory.enskog_conductivity(0.3, 1.0, 1.0, 1.0) == pytest.approx(conductivity, rel=2e-4)


def test_a_small_fluid_comes_near_to_enskog():
    found = study(run_log(fluid(36, 0.1), events=8_000), "transport")
    for name in ("viscosity", "heat_conductivity"):
        one = found[name]
        assert abs(one.value - one.theory) < 4.0 * one.error + 0.2 * one.theory
    assert "logarithm" in found["viscosity"].doubt
    assert found["self_diffusion"].value == pytest.approx(found["self_diffusion"].theory, rel=0.5)


@pytest.mark.parametrize(
    ("scene", "words"),
    [
        (es.gallery("gas", n=12), "periodic ones"),
        (fluid(restitution=es.gallery("cooling").restitution), "contacts take energy"),
        (fluid(gravity=(0.0, -1.0)), "fall for ever"),
        (fluid(tangential_restitution=1.0), "spins"),
    ],
)
def test_where_they_have_no_meaning_there_is_a_dash(scene, words):
    assert words in study(run_log(scene, events=30), "transport")["viscosity"].doubt


def test_a_short_run_and_a_cluster_are_dashes():
    assert "too few" in study(run_log(fluid(), events=40), "transport")["viscosity"].doubt
    transport = Transport(fluid())
    rows = run_log(fluid(), events=40).rows.copy()
    rows["joint"][5] = 4
    transport.write(rows)
    assert "share disks" in transport.found(1.0)["viscosity"].doubt


@pytest.mark.slow
@pytest.mark.timeout(1500)
def test_viscosity_and_conductivity_of_a_dilute_gas():
    scene = fluid(1_000, 0.1)
    transport = Transport(scene)
    run = es.simulate(scene, events=30_000_000, engine="fast", on_event=transport.write)
    found = transport.found(run.state.time)
    for name in ("viscosity", "heat_conductivity"):
        one = found[name]
        print(name, one.value, one.error, one.theory, one.value / one.theory)
        assert one.error < 0.02 * one.value
        assert abs(one.value - one.theory) < 0.05 * one.theory

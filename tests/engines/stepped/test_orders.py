"""Orders of convergence, fitted in log-log, against the order that theory gives; and the bias of Chipmunk."""

import numpy as np
import pytest

import eventsim as es
from eventsim.engines import STEPPED
from eventsim.engines.stepped import ChipmunkOptions
from eventsim.measure.theory import compressibility_factor
from eventsim.scene.stage import stage_of
from eventsim.validation.averages import kinetic_energy, virial_pressure
from eventsim.validation.follow import follow


def slope(steps, errors):
    return float(np.polyfit(np.log(steps), np.log(errors), 1)[0])


def errors_of(scene, until, exact, steps, engine, **options):
    """Largest position errors; averaged over eight phases of the grid of steps, on which the error of one contact depends."""
    return [
        np.mean(
            [
                np.abs(
                    es.simulate(scene, until=until, engine=engine, dt=dt * phase, **options).state.position - exact
                ).max()
                for phase in np.linspace(0.8, 1.2, 8)
            ]
        )
        for dt in steps
    ]


def oblique_contacts():
    return es.Scene(
        es.Disks([(2.0, 2.1), (5.0, 2.0), (7.0, 2.8)], [(1.0, 0.1), (0.0, 0.0), (-0.3, 0.0)], radius=0.5),
        es.Box((9, 4)),
    )


STEPS = (0.02, 0.01, 0.005, 0.0025)


def test_fixed_steps_are_of_order_one_on_a_colliding_scene():
    scene = oblique_contacts()
    exact = es.simulate(scene, until=6.0).state.position
    assert slope(STEPS, errors_of(scene, 6.0, exact, STEPS, "stepped")) == pytest.approx(1.0, abs=0.3)


def test_free_flight_under_gravity_is_exact_in_every_step():
    # The smooth scene: a parabola has no third derivative, so the error is rounding whatever the step.
    scene = es.Scene(es.Disks([(2.0, 5.0)], [(0.1, 0.3)], radius=0.5), es.Box((9, 9)), gravity=(0.0, -1.0))
    exact = es.simulate(scene, until=2.0).state.position
    run = es.simulate(scene, until=2.0, engine="stepped", dt=0.01)
    assert np.abs(run.state.position - exact).max() < 200 * 2.0**-50  # 200 additions of numbers below 8


def test_locating_the_impact_on_its_chord_is_of_order_two_under_gravity():
    scene = es.Scene(es.Disks([(2.0, 1.7)], [(0.1, 0.3)], radius=0.5), es.Box((9, 9)), gravity=(0.0, -1.0))
    exact = es.simulate(scene, until=2.9).state.position
    errors = errors_of(scene, 2.9, exact, STEPS, "stepped", locate=True)
    assert slope(STEPS, errors) == pytest.approx(2.0, abs=0.4)


def test_springs_are_of_order_two_at_constant_stiffness():
    # The smooth scene of springs: two soft disks, compared with their own motion at a step 16 times smaller.
    scene = es.Scene(es.Disks([(2.0, 2.3), (4.0, 2.0)], [(1.0, 0.0), (0.0, 0.0)], radius=0.5), es.Open())
    steps = (0.02, 0.01, 0.005)
    fine = es.simulate(scene, until=4.0, engine="penalty", dt=0.005 / 16, stiffness=100.0).state.position
    errors = errors_of(scene, 4.0, fine, steps, "penalty", stiffness=100.0)
    assert slope(steps, errors) == pytest.approx(2.0, abs=0.4)


def test_springs_come_to_hard_disks_with_order_one_when_their_stiffness_follows_the_step():
    # A contact lasts 20 steps and ends late by a share of that.
    scene = es.Scene(es.Disks([(2.0, 2.3), (4.0, 2.0)], [(1.0, 0.0), (0.0, 0.0)], radius=0.5), es.Open())
    exact = es.simulate(scene, until=4.0).state.position
    steps = (0.004, 0.002, 0.001, 0.0005)
    assert slope(steps, errors_of(scene, 4.0, exact, steps, "penalty")) == pytest.approx(1.0, abs=0.2)


def test_too_soft_a_step_for_a_spring_costs_energy():
    # k = 1e4, dt = .01: a contact of two unit masses lasts 2.2 steps; the energy changes by a tenth and more.
    scene = es.Scene(es.Disks([(2.0, 2.3), (4.0, 2.0)], [(1.0, 0.0), (0.0, 0.0)], radius=0.5), es.Open())
    changes = [
        abs(es.simulate(scene, until=4.0, engine="penalty", dt=dt, stiffness=1e4).residuals.energy)
        for dt in np.linspace(0.009, 0.011, 9)
    ]
    fine = abs(es.simulate(scene, until=4.0, engine="penalty", dt=0.0005, stiffness=1e4).residuals.energy)
    assert max(changes) > 0.05
    assert fine < 1e-3


def test_a_dashpot_loses_what_the_restitution_says():
    scene = es.Scene(
        es.Disks([(2.0, 2.0), (4.0, 2.0)], [(1.0, 0.0), (0.0, 0.0)], radius=0.5), es.Open(), restitution=0.8
    )
    velocity = es.simulate(scene, until=4.0, engine="penalty", dt=0.0005).state.velocity
    # The force never pulls, so a contact ends a little early and loses a little less.
    assert velocity[1, 0] - velocity[0, 0] == pytest.approx(0.8, abs=0.02)


def test_chipmunk_misses_a_sixth_of_the_pressure():
    # At 1/60, N = 100, packing .3, in the units of m = kT = 1 and a box of side 1: r = sqrt(.3 / (100 pi)) = .0309, so that a
    # typical disk, of speed sqrt(2), flies .76 radii in a step.  Z with the run's own temperature (it loses energy) against the
    # fluid's: 17 +- 3 % low; measured over six starts -18.2 +- .3 %, and -19.8 +- .6 % against the same box event-driven.
    pytest.importorskip("pymunk")
    scene = es.gallery("gas", n=100, packing_fraction=0.3)
    stage, until = stage_of(scene), 4.0
    assert np.mean(stage.vx**2 + stage.vy**2) == pytest.approx(2.0)
    run = follow(STEPPED["pymunk"].open(stage, options=ChipmunkOptions(dt=1.0 / 60.0)), np.linspace(0.0, until, 61)[1:].tolist())
    energy = float(np.mean([kinetic_energy(stage, velocity) for velocity in run.velocity]))
    z = virial_pressure(stage, run.rows, energy, until)
    assert z / compressibility_factor(0.3) - 1.0 == pytest.approx(-0.17, abs=0.03)

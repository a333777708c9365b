"""Walls that heat, grip and slide: the force across them is the pressure, the one along them is their shear."""

import math

import numpy as np
import pytest

import eventsim as es
from eventsim.measure import sums
from eventsim.measure.compiled import PLAIN, kernels
from eventsim.measure.meter import Meter
from eventsim.scene.manner import Side
from tests.engines.scenes import lattice_gas


def exchanged(log):
    """What disks gave to each wall, (x, y) summed over its rows, from the velocities that the log has; no gravity."""
    mass, velocity = log.scene.disks.mass, log.scene.disks.velocity.copy()
    given: dict[str, list[tuple[float, float, float, float]]] = {}
    for event in log:
        if event.kind == "wall":
            u, w = mass[event.a] * (velocity[event.a] - (event.vxa, event.vya))
            given.setdefault(event.wall, []).append((u, w, event.xa, event.ya))
        velocity[event.a] = event.vxa, event.vya
        if event.kind == "pair":
            velocity[event.b] = event.vxb, event.vyb
    return {wall: np.array(rows) for wall, rows in given.items()}


def box(walls, n=25, **more):
    gas = lattice_gas(n, 0.2, es.Box, seed=4)
    return es.Scene(gas.disks, es.Box(gas.domain.size, walls=walls), **more)


HOT = {name: Side(temperature=2.0) for name in ("left", "right", "bottom", "top")}


@pytest.mark.parametrize(
    "scene",
    [
        box(HOT, seed=1),
        box({}, tangential_restitution={"pair": -1.0, "wall": 0.7}),
        box({"top": Side(velocity=2.0), "bottom": Side(velocity=-2.0)}, tangential_restitution={"pair": 0.5, "wall": 1.0}),
        box({"left": Side(temperature=1.0, velocity=3.0)}, seed=2, tangential_restitution={"pair": 0.5, "wall": 0.5}),
    ],
    ids=["hot", "rough", "sheared", "hot and sliding"],
)
def test_forces_at_sides_are_the_sums_of_the_momentum_across_and_along_them(scene):
    run = es.simulate(scene, events=1500, engine="reference", log=True, measure=True)
    measures = run.log.measure(0.0)
    for name, rows in exchanged(run.log).items():
        across, along = (0, 1) if name in {"left", "right"} else (1, 0)
        assert measures[f"force_{name}"].value == pytest.approx(abs(rows[:, across].sum()) / run.time, rel=1e-9)
        if f"shear_{name}" in measures:
            assert measures[f"shear_{name}"].value == pytest.approx(rows[:, along].sum() / run.time, rel=1e-9, abs=1e-9)
        else:
            assert abs(rows[:, along].sum()) < 1e-9
    streamed = run.measures
    assert {name: one.value for name, one in streamed.items() if name.startswith(("force", "shear"))} == {
        name: one.value for name, one in run.log.measure().items() if name.startswith(("force", "shear"))
    }


def test_walls_that_slide_are_held_back_by_the_gas_between_them():
    sides = {"top": Side(velocity=3.0), "bottom": Side(velocity=-3.0)}
    measures = es.simulate(
        box(sides, tangential_restitution={"pair": 0.5, "wall": 1.0}), events=1000, engine="reference", measure=True
    ).measures
    assert measures["shear_top"].value < 0.0 < measures["shear_bottom"].value


def test_the_pressure_at_walls_that_grip_is_that_of_the_virial():
    """The virial theorem: the sum of force x lever is 2 E and the virial of pairs.  The whole impulse makes it a tenth larger."""
    scene = box({}, n=100, tangential_restitution={"pair": 1.0, "wall": 1.0})
    log = es.simulate(scene, events=16_000, engine="reference", log=True).log
    radius, (width, height) = float(scene.disks.radius[0]), scene.domain.size
    levers = {"left": width, "right": width, "bottom": height, "top": height}
    meter = Meter(scene, 0.0)
    meter.write(log.rows)
    measures = meter.finish(log.time[-1])
    at_walls = sum(measures[f"force_{name}"].value * (0.5 * size - radius) for name, size in levers.items())
    heat, virial = (float(meter._sums.bins[:, channel].sum()) / log.time[-1] for channel in (sums.ENERGY, sums.VIRIAL))
    # what is left: the virial of what pulls along walls, 0 on the average, and d/dt of the sum of p x over the time of the run
    assert at_walls == pytest.approx(2.0 * heat + virial, rel=0.03)


def test_the_virial_of_rough_disks_is_that_of_the_normal_part():
    scene = es.gallery("rough", n=36, roughness=1.0)
    run = es.simulate(scene, events=1200, engine="reference", log=True)
    mass, velocity, stage_size = scene.disks.mass, scene.disks.velocity.copy(), np.array(scene.domain.size)
    virial = 0.0
    for event in run.log:
        line = np.array([event.xa - event.xb, event.ya - event.yb])
        line -= stage_size * np.round(line / stage_size)
        virial += float(mass[event.a] * (np.array([event.vxa, event.vya]) - velocity[event.a]) @ line)
        velocity[event.a], velocity[event.b] = (event.vxa, event.vya), (event.vxb, event.vyb)
    meter = Meter(scene, 0.0)
    meter.write(run.log.rows)
    meter.finish(run.time)
    assert meter._sums.bins[:, sums.VIRIAL].sum() == pytest.approx(virial, rel=1e-9)


def test_forces_at_walls_of_any_shape_are_across_and_along_them():
    gas = lattice_gas(4, 0.1, es.Box, seed=4)
    width, height = gas.domain.size
    middle = (0.5 * width, 0.5 * height)
    ring = es.Circle(middle, 0.5 * math.hypot(width, height), temperature=2.0, velocity=1.0, name="ring")
    disks = es.Disks(gas.disks.position, gas.disks.velocity, gas.disks.radius)
    scene = es.Scene(disks, es.Open(), walls=[ring], seed=5)
    run = es.simulate(scene, events=600, engine="reference", log=True)
    rows = exchanged(run.log)["ring"]
    arm = rows[:, 2:] - middle
    arm /= np.hypot(*arm.T)[:, None]
    measures = run.log.measure(0.0)
    assert measures["force_ring"].value == pytest.approx((rows[:, :2] * arm).sum() / run.time, rel=1e-9)
    counter_clockwise = np.column_stack([-arm[:, 1], arm[:, 0]])
    assert measures["shear_ring"].value == pytest.approx((rows[:, :2] * counter_clockwise).sum() / run.time, rel=1e-9)


def test_a_slanted_wall_that_heats_tells_its_sides_apart():
    gas = lattice_gas(16, 0.1, es.Box, seed=4)
    width, height = gas.domain.size
    wall = es.Segment((-0.5 * width, 0.3 * height), (0.0, 0.5 * height), temperature=2.0, name="shelf")
    disks = es.Disks(gas.disks.position, gas.disks.velocity, gas.disks.radius)
    scene = es.Scene(disks, es.Box((3.0 * width, height), origin=(-2.0 * width, 0.0)), walls=[wall], seed=5)
    run = es.simulate(scene, events=1500, engine="reference", log=True)
    measures = run.log.measure(0.0)
    rows = exchanged(run.log)["shelf"]
    way = np.array([0.5 * width, 0.2 * height]) / math.hypot(0.5 * width, 0.2 * height)
    foot = (rows[:, 2:] - wall.start) @ way
    flat = (foot >= 0.0) & (foot <= math.hypot(0.5 * width, 0.2 * height))
    across = np.abs(rows[flat, 0] * way[1] - rows[flat, 1] * way[0]).sum()
    for u, w, x, y in rows[~flat]:  # at an end: along the line to it
        dx, dy = min(((x - ex, y - ey) for ex, ey in (wall.start, wall.end)), key=lambda d: math.hypot(*d))
        across += abs(u * dx + w * dy) / math.hypot(dx, dy)
    assert measures["force_shelf"].value == pytest.approx(across / run.time, rel=1e-9)
    assert {"shear_shelf_left", "shear_shelf_right"} <= set(measures)


@pytest.mark.slow  # it is compiled
def test_plain_python_and_machine_code_sum_forces_alike(monkeypatch):
    pytest.importorskip("numba")
    scene = box({"left": Side(temperature=1.0)}, seed=2, tangential_restitution={"pair": 0.5, "wall": 0.5})
    log = es.simulate(scene, events=900, engine="reference", log=True).log
    held = []
    for kernel in (PLAIN, kernels(1 << 20)):
        monkeypatch.setattr("eventsim.measure.meter.kernels", lambda rows, waits=True, kernel=kernel: kernel)
        meter = Meter(scene)
        meter.write(log.rows)
        meter.finish(log.time[-1])
        held.append(meter._sums)
    assert all(np.array_equal(one, other, equal_nan=True) for one, other in zip(*held, strict=True))

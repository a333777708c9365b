"""Flows between two walls: heat from the warm to the cold one, momentum from one that slides to the other; each with its bars."""

from __future__ import annotations

import math

import numpy as np
import pytest

import eventsim as es
from eventsim.engines.base import Stop
from eventsim.measure import theory
from eventsim.record.events import Kind
from eventsim.scene.stage import stage_of

pytest.importorskip("numba")
pytestmark = pytest.mark.slow

SLICES = 24
BLOCKS = 40
"""Parts of a run whose means tell the bar of its mean."""

BESIDE = 3.0
"""Diameters beside a wall, three mean free paths, in which a gas is not as cold or as slow as the wall."""


def channel(walls, height, count=200, eta=0.2):
    """Disks of diameter and mass 1 in a channel, at random places, kT = 1."""
    domain = {"kind": "channel", "size": [0.25 * math.pi * count / (eta * height), height], "walls": walls}
    return es.scene.files.scene_from_dict(
        {"seed": 5, "domain": domain, "gas": [{"count": count, "radius": 0.5, "temperature": 1.0, "seed": 6}]}
    )


class Slices:
    """Sums over states of a channel in even slices of its height, block by block of a run."""

    def __init__(self, height):
        self.height = height
        self.blocks = []

    def begin(self):
        self.blocks.append(np.zeros((5, SLICES)))

    def add(self, motion):
        where = np.clip((motion.y * (SLICES / self.height)).astype(int), 0, SLICES - 1)
        squares = motion.vx**2 + motion.vy**2
        spin = np.zeros(len(where)) if motion.spin is None else motion.spin
        for row, weights in zip(self.blocks[-1], (None, motion.vx, squares, motion.y, spin), strict=True):
            row += np.bincount(where, weights, SLICES)

    def found(self):
        """(SLICES,) of heights; (BLOCKS, SLICES) of shares of the disks, of the flow along the walls, and of kT about it."""
        count, u, squares, y, _ = np.array(self.blocks).transpose(1, 0, 2)
        flow = u.sum(axis=0) / count.sum(axis=0)  # of the whole run: that of a block would take a freedom of few disks
        temperature = 0.5 * (squares / count - 2.0 * flow * u / count + flow**2)
        return y.sum(axis=0) / count.sum(axis=0), count / count.sum(axis=1)[:, None], u / count, temperature


class Given:
    """Momentum along the walls, and energy, that each wall gave to disks of mass 1, from rows and what disks had before."""

    def __init__(self, stage):
        self.velocity = np.stack([stage.vx, stage.vy], axis=1)
        self.walls = len(stage.wall_names)
        self.blocks = []

    def begin(self):
        self.blocks.append(np.zeros((2, self.walls)))

    def add(self, rows):
        pairs = np.flatnonzero(rows["b"] >= 0)
        disk = np.concatenate([rows["a"], rows["b"][pairs]])
        wall = np.concatenate([np.where(rows["kind"] == Kind.WALL, rows["wall"], -1), np.full(len(pairs), -1)])
        after = np.concatenate(
            [np.stack([rows[f"vx{i}"], rows[f"vy{i}"]], axis=1)[own] for i, own in (("a", ...), ("b", pairs))]
        )
        order = np.lexsort((np.concatenate([np.arange(len(rows)), pairs]), disk))
        disk, wall, after = disk[order], wall[order], after[order]
        begins = np.append(True, disk[1:] != disk[:-1])
        before = np.where(begins[:, None], self.velocity[disk], np.roll(after, 1, axis=0))
        ends = np.append(begins[1:], True)
        self.velocity[disk[ends]] = after[ends]
        for k in range(self.walls):
            u, v = before[wall == k], after[wall == k]
            self.blocks[-1][:, k] += (v - u)[:, 0].sum(), 0.5 * ((v * v).sum() - (u * u).sum())


def followed(scene, begin, step, samples):
    """(Slices, Given, the time of a block) of a run from `begin` on: BLOCKS of so many samples at even steps."""
    from eventsim.engines.fast.session import FastSession

    stage = stage_of(scene)
    session, slices, given = FastSession(stage), Slices(scene.domain.size[1]), Given(stage)
    given.begin()
    for block in range(-1, BLOCKS):
        for k in range(1, samples + 1) if block >= 0 else (1,):
            until = begin + step * (block * samples + k) if block >= 0 else begin
            while session.advance(Stop(until), 1 << 20) is None:
                pass
            rows = session.take_rows()
            if len(rows):
                given.add(rows)
            if block >= 0:
                slices.add(session.motion())
        if block + 1 < BLOCKS:
            slices.begin()
            given.begin()
    del given.blocks[0]
    return slices, given, step * samples


def bar(values):
    """(mean, bar) of values of blocks."""
    return float(np.mean(values)), float(np.std(values, ddof=1)) / math.sqrt(len(values))


def test_heat_flows_down_a_line_and_as_much_goes_in_as_comes_out():
    """T2 / T1 = 1.1; the flux is that of Gass's conductivity at the slope found within 10 %."""
    cold, warm = 1.0, 1.1
    scene = channel({"bottom": {"temperature": warm}, "top": {"temperature": cold}}, 16.0)
    slices, given, time = followed(scene, begin=500.0, step=1.0, samples=2000)
    width, height = scene.domain.size
    y, shares, _, temperature = slices.found()
    inner = (y > BESIDE) & (y < height - BESIDE)
    middle = y[inner] - 0.5 * height
    bends, slopes, means = np.polyfit(middle, temperature[:, inner].T, 2)
    slope, bend, mean = bar(slopes), bar(bends), bar(means)
    into, out = (bar(given_ / (time * width)) for given_ in np.array(given.blocks)[:, 1].T * np.array([[1.0], [-1.0]]))
    across = bar((np.array(given.blocks)[:, 1].sum(axis=1)) / (time * width))
    eta = 0.25 * math.pi * len(scene.disks) * float(shares[:, inner].mean()) * SLICES / (width * height)
    flux = -theory.enskog_conductivity(eta, 1.0, mean[0], 1.0) * slope[0]
    print(
        f"T in the middle {mean}, slope {slope}, bend {bend}; flux in {into}, out {out}, difference {across}; Gass {flux}"
    )
    reach = 0.5 * float(np.ptp(middle))
    assert slope[0] + 10.0 * slope[1] < 0.0
    # T^(3/2) is straight, so T bends by T'^2 / 4 T: some thousandth of its fall
    assert abs(bend[0] + slope[0] ** 2 / (4.0 * mean[0])) < 3.0 * bend[1]
    assert bend[1] * reach**2 < 0.1 * abs(slope[0]) * reach
    assert abs(into[0] - out[0]) < 3.0 * across[1]
    for one in (into, out):
        assert one[1] < 0.05 * one[0]
        assert one[0] == pytest.approx(flux, rel=0.1)


def test_sliding_walls_shear_smooth_disks_with_the_viscosity_of_gass():
    """Within 10 %, at the temperature and density found in the inner half, whose shear rate is taken: the gas slips at walls."""
    speed = 0.5
    walls = {name: {"temperature": 1.0, "velocity": v} for name, v in (("bottom", -speed), ("top", speed))}
    scene = channel(walls, 25.0)
    slices, given, time = followed(scene, begin=500.0, step=1.0, samples=1000)
    width, height = scene.domain.size
    y, shares, flow, temperature = slices.found()
    inner = np.abs(y - 0.5 * height) < 0.25 * height
    rates, _ = np.polyfit(y[inner] - 0.5 * height, flow[:, inner].T, 1)
    rate = bar(rates)
    below, above = (
        bar(given_ / (time * width)) for given_ in np.array(given.blocks)[:, 0].T * np.array([[-1.0], [1.0]])
    )
    kt = bar(temperature[:, inner].mean(axis=1))
    eta = 0.25 * math.pi * len(scene.disks) * float(shares[:, inner].mean()) * SLICES / (width * height)
    viscosity = theory.enskog_viscosity(eta, 1.0, kt[0], 1.0)
    stress = bar(0.5 * np.array(given.blocks)[:, 0] @ np.array([-1.0, 1.0]) / (time * width))
    print(
        f"kT {kt}, eta {eta}, rate {rate}, stress {stress}: {below} and {above}; {stress[0] / rate[0] / viscosity} of Gass"
    )
    assert abs(below[0] - above[0]) < 3.0 * math.hypot(below[1], above[1])
    assert 3.0 * math.hypot(stress[1] / stress[0], rate[1] / rate[0]) < 0.1
    assert stress[0] / rate[0] == pytest.approx(viscosity, rel=0.1)


def test_rough_disks_turn_half_as_fast_as_their_flow_shears():
    """Where no torque is left the mean spin is that of the flow: half of its vorticity."""
    scene = es.gallery("sheared")
    slices, _, _ = followed(scene, begin=200.0, step=0.5, samples=250)
    y, _, flow, _ = slices.found()
    middle = y - 0.5 * scene.domain.size[1]
    inner = np.abs(middle) < 0.25 * scene.domain.size[1]
    count, *_, spins = np.array(slices.blocks).transpose(1, 0, 2)[:, :, inner]
    rates = np.polyfit(middle[inner], flow[:, inner].T, 1)[0]
    ratio = bar(-2.0 * spins.sum(axis=1) / count.sum(axis=1) / rates)
    print(f"shear rate {bar(rates)}, spin over half of it {ratio}")
    assert 3.0 * ratio[1] < 0.05
    assert abs(ratio[0] - 1.0) < 3.0 * ratio[1]

"""Contacts that share a disk and, nearly, their time: exact arithmetic orders them; only true ties are clusters."""

import random
from decimal import Decimal, localcontext
from fractions import Fraction

import numpy as np
import pytest

import eventsim as es
from eventsim.formulas.roots import Moment, order_of
from tests.engines.scenes import lattice_gas

ENGINES = ["reference", pytest.param("fast", marks=pytest.mark.slow)]
GAP, SPEED = 0.5, 3.0


def crossfire(gap, speed, domain):
    """Disk 0 flies along x, disk 2 along y, towards disk 1 at rest: from gaps of 1/2 and `gap`, at speeds 3 and `speed`."""
    return es.Scene(
        disks=es.Disks([(0.0, 0.0), (0.75, 0.0), (0.75, 0.25 + gap)], [(SPEED, 0.0), (0.0, 0.0), (0.0, -speed)], 0.125),
        domain=domain,
    )


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("domain", [es.Open(), es.Periodic((8.0, 8.0))])
@pytest.mark.parametrize(("bits", "pairs"), [(1, [(0, 1), (1, 2)]), (2, [(1, 2), (0, 1)])])
def test_contacts_that_only_share_a_float_time_are_in_their_exact_order(engine, domain, bits, pairs):
    """The gap is longer by 2**-52, the speed higher by 2/3 or 4/3 of that: the times differ by a ninth of it."""
    scene = crossfire(GAP * (1.0 + 2.0**-52), SPEED + bits * 2.0**-51, domain)
    run = es.simulate(scene, events=2, engine=engine, log=True)
    assert np.ptp(run.log.time) <= np.spacing(run.log.time[0])  # floats would need luck
    assert list(zip(run.log.a.tolist(), run.log.b.tolist(), strict=True)) == pairs
    assert run.log.joint.tolist() == [-1, -1]


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("factor", [1.0, 2.0, 5.0])
def test_contacts_at_exactly_one_time_are_a_cluster(engine, factor):
    """A third of a gap has no float, so the two float times may differ; the exact ones do not."""
    run = es.simulate(crossfire(GAP * factor, SPEED * factor, es.Open()), events=2, engine=engine, log=True)
    assert run.log.joint.tolist() == [0, 0]
    assert run.log.remainder[0] == run.log.remainder[1]


@pytest.mark.parametrize("factor", [1.0, 2.0, 5.0, 7.0])
def test_a_cluster_of_different_float_times_is_expanded(factor, tmp_path):
    scene, compact = crossfire(GAP * factor, SPEED * factor, es.Open()), tmp_path / "log.npz"
    run = es.simulate(scene, events=2, log=True)
    es.simulate(scene, events=2, log=compact, compact=True)
    assert es.load_log(compact).digest() == run.log.digest()


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("k", [20, 40, 50, 52])
@pytest.mark.parametrize("sign", [1, -1])
def test_f7_the_sign_of_the_smallest_gap_decides(engine, k, sign):
    scene = es.Scene(
        disks=es.Disks(
            [(0.0, 0.0), (0.5, 0.0), (1.0 + sign * 2.0**-k, 0.0)],
            [(1.0, 0.0), (0.0, 0.0), (-1.0, 0.0)],
            0.125,
            (1.0, 3.0, 1.0),
        ),
        domain=es.Open(),
    )
    run = es.simulate(scene, until=10.0, engine=engine)
    expected = (-0.5, -0.25, 1.25) if sign > 0 else (-1.25, 0.25, 0.5)
    assert run.state.velocity[:, 0].tolist() == list(expected)
    assert run.counters.clusters == 0


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("beside", "joint"), [(0.0, [0, 0]), (2.0**-51, [-1, -1])])
def test_a_tie_with_the_walls_of_a_corner_is_exact(engine, beside, joint):
    """Into a corner along a diagonal of slope 2: the walls are met at one time; a last bit beside it, at two."""
    disks = es.Disks([(1.5, 2.5 + beside)], [(-3.0, -6.0)], 0.5)
    run = es.simulate(es.Scene(disks=disks, domain=es.Box((8.0, 8.0))), events=2, engine=engine, log=True)
    assert run.log.joint.tolist() == joint
    assert sorted(run.log.wall.tolist()) == [0, 2]  # left and bottom


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("gap", "faster", "partner"), [(1, 2, -1), (1, 4, 1), (-1, -2, 1), (-1, -4, -1)])
def test_a_wall_and_a_disk_are_met_in_their_exact_order(engine, gap, faster, partner):
    """Disk 0 flies into a wall, disk 1 into it, from a gap of 1 at speed 3 both; but for a third of a last bit."""
    unit = 2.0**-51
    disks = es.Disks([(1.5, 4.0), (3.5 + gap * unit, 4.0)], [(-3.0, 0.0), (-6.0 - faster * unit, 0.0)], 0.5)
    run = es.simulate(es.Scene(disks=disks, domain=es.Box((8.0, 8.0))), events=1, engine=engine, log=True)
    assert run.log.joint.tolist() == [-1]
    assert run.log.b.tolist() == [partner]


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("scale", [1.0, 0.7, 1.0 / 3.0])
def test_shapes_of_one_wall_met_at_one_time_are_expanded(engine, scale, tmp_path):
    """A disk falls into a notch, whose faces are one wall: the float times of the two contacts may differ."""
    notch = es.Polyline([(1.0 * scale, 4.0 * scale), (4.0 * scale, 1.0 * scale), (7.0 * scale, 4.0 * scale)])
    disks = es.Disks([(4.0 * scale, 5.0 * scale)], [(0.0, -1.0 * scale)], 0.5 * scale)
    scene, compact = es.Scene(disks=disks, domain=es.Box((8.0 * scale, 8.0 * scale)), walls=(notch,)), tmp_path / "log.npz"
    run = es.simulate(scene, events=20, engine=engine, log=True)
    es.simulate(scene, events=20, engine=engine, log=compact, compact=True)
    assert es.load_log(compact).digest() == run.log.digest()


@pytest.mark.parametrize("domain", [es.Box, es.Periodic])
def test_a_log_with_many_ties_is_expanded_bit_for_bit(domain, tmp_path):
    scene = lattice_gas(25, 0.3, domain=domain, seed=2, quantum=0.5)
    run = es.simulate(scene, events=600, log=True)
    compact = tmp_path / "log.npz"
    es.simulate(scene, events=600, log=compact, compact=True)
    assert es.load_log(compact).digest() == run.log.digest()


def test_moments_are_ordered_exactly():
    def value(moment):
        place, square = (Decimal(x.numerator) / Decimal(x.denominator) for x in (moment.place, moment.square))
        return place + moment.side * square.sqrt()

    rng = random.Random(1)
    with localcontext() as context:
        context.prec = 60
        for _ in range(3000):
            one, other = (
                Moment(
                    Fraction(rng.randint(-4, 4), rng.randint(1, 3)),
                    rng.choice((-1, 1)),
                    Fraction(rng.randint(0, 9), rng.randint(1, 4)),
                )
                for _ in range(2)
            )
            apart = value(one) - value(other)
            assert order_of(one, other) == (0 if abs(apart) < Decimal(10) ** -40 else np.sign(apart))


@pytest.mark.parametrize("engine", ["reference", "fast"])
def test_near_ties_of_enormous_exact_times_are_ordered(engine):
    """The exact coefficients of these contact times have numerators that are no floats."""
    if engine == "fast":
        pytest.importorskip("numba")
    position = [[0.0, 0.0], [3.0, 0.0], [-2.9999999999999996, 0.0]]
    velocity = [[0.0, 0.0], [-1.0000000000000004, 1e-160], [1.0000000000000004, -1.2e-16]]
    scene = es.Scene(es.Disks(position, velocity, 1.0, [1e9, 1.0, 1.0]), es.Open(), restitution=0.5)
    run = es.simulate(scene, until=20.0, engine=engine)
    assert (run.counters.events, run.stopped) == (2, "quiet")

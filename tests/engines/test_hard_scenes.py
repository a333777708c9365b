"""Hard scenes from the first row to the last, in both engines; what `validate.stress.catalogue` asks of their end states is not
asked again."""

from fractions import Fraction

import numpy as np
import pytest

import eventsim as es
from eventsim.compiler import is_interpreted
from eventsim.engines.base import Stop
from eventsim.engines.reference import ReferenceOptions
from eventsim.engines.reference.loop import ReferenceSession
from eventsim.scene.stage import stage_of
from eventsim.validation.stress.catalogue.long_runs import crystal
from eventsim.validation.stress.catalogue.scenes import on_plane
from tests.engines.scenes import lattice_gas

ULP = 2.0**-52
EVENTS = 500 if is_interpreted() else 2000
BOTH = ["reference", "fast"]


def log_of(scene, engine, **stop):
    if engine == "fast":
        pytest.importorskip("numba")
    return es.simulate(scene, engine=engine, log=True, **stop).log


@pytest.mark.parametrize("engine", BOTH)
def test_f10_an_overlap_by_rounding_is_due_now(engine):
    scene = on_plane([[1e6, 0.0], [1e6 + 1.0 - 1e-9, 0.0]], [[1.0, 0.0], [0.0, 0.0]])
    log = log_of(scene, engine, until=5.0)
    assert log.time.tolist() == [0.0]
    assert (log.vxa[0], log.vxb[0]) == (0.0, 1.0)


@pytest.mark.parametrize(
    ("engine", "events"), [("reference", 20_000), pytest.param("fast", 1_000_000, marks=pytest.mark.slow)]
)
def test_f11_overlaps_do_not_grow_in_a_long_dense_run(engine, events):
    """Of coordinates between 8 and 16, in diameters, this is six last bits."""
    if engine == "fast":
        pytest.importorskip("numba")
    run = es.simulate(crystal(8, 1.1), events=events, engine=engine)
    assert 0.0 <= run.residuals.max_overlap < 1e-14


@pytest.mark.slow
@pytest.mark.timeout(3600)  # two thousand million contacts, and a turn of the clock for every 32 of them
def test_f16_after_1e9_periods_the_phase_has_no_error():
    pytest.importorskip("numba")
    scene = es.Scene(es.Disks([(1.0, 1.0)], [(2.0, 0.0)], 0.5), es.Box((2.0, 2.0)))
    run = es.simulate(scene, until=1e9, engine="fast")
    assert run.counters.events == 2 * 10**9
    assert run.state.position.tolist() == [[1.0, 1.0]]
    assert run.state.velocity.tolist() == [[2.0, 0.0]]


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_f18_one_large_disk_among_1e5_small_ones_has_one_log():
    """The large one, a hundred times as wide, on a square lattice from which a disc was cut."""
    pytest.importorskip("numba")
    sites = np.stack(np.meshgrid(np.arange(-165, 165), np.arange(-165, 165)), axis=-1).reshape(-1, 2) * 2.0 + 1.0
    small = sites[np.hypot(*sites.T) > 50.6]
    assert len(small) > 100_000
    velocity = np.vstack([[[0.0, 0.0]], np.random.default_rng(18).normal(size=small.shape)])
    radius = np.array([50.0, *[0.5] * len(small)])
    scene = es.Scene(
        es.Disks(np.vstack([[[0.0, 0.0]], small]), velocity, radius, radius**2),
        es.Box((664.0, 664.0), (-332.0, -332.0)),
    )
    runs = [es.simulate(scene, events=20_000, engine=engine, log=True) for engine in BOTH]
    assert runs[0].log.digest() == runs[1].log.digest()
    assert np.any(runs[0].log.a == 0)
    assert runs[1].residuals.max_overlap < 8.0 * np.spacing(664.0)


@pytest.mark.parametrize("engine", BOTH)
def test_f21_the_slowest_disk_meets_the_nearest_one_in_time(engine):
    """The smallest gap that the coordinate 1 takes; the jump of the clock may cost a last bit.  Slower disks are refused."""
    speed = 1e-75
    log = log_of(on_plane([[0.0, 0.0], [1.0 + ULP, 0.0]], [[speed, 0.0], [0.0, 0.0]]), engine, events=1)
    assert log.time.tolist() == pytest.approx([float(Fraction(ULP) / Fraction(speed))], rel=ULP)
    assert (log.vxa[0], log.vxb[0]) == (0.0, speed)
    with pytest.raises(es.SceneError, match="other units"):
        on_plane([[0.0, 0.0], [1.0 + ULP, 0.0]], [[1e-310, 0.0], [0.0, 0.0]])


def along_diagonals(side, seed, first, domain):
    """Disks on the sites of a square lattice, side by side, two apart from `first` on, which fly along diagonals."""
    sites = np.array([(i, j) for i in range(side) for j in range(side)], float)
    signs = np.random.default_rng(seed).choice([-1.0, 1.0], size=(len(sites), 2))
    return es.Scene(es.Disks(2.0 * sites + first, signs, 0.5), domain((2.0 * side, 2.0 * side)))


@pytest.mark.parametrize("domain", [es.Box, es.Periodic])
@pytest.mark.kernels
def test_f30_ties_with_cell_crossings_leave_the_log_of_all_pairs(domain):
    """Disks along diagonals, which pass corners of cells of width 1 (and 2) at the times of contacts on their edges."""
    scene = along_diagonals(6, 30, 0.5, domain)
    session = ReferenceSession(stage_of(scene), options=ReferenceOptions(grid=None))
    session.advance(Stop(None, EVENTS), 10**9)
    rows = session.take_rows()
    for engine in BOTH:
        assert log_of(scene, engine, events=EVENTS).rows.tobytes() == rows.tobytes()


def swapped(scene):
    """The scene with its axes exchanged."""
    disks = scene.disks
    size = None if scene.domain.size is None else scene.domain.size[::-1]
    domain = es.Open() if size is None else type(scene.domain)(size)
    return es.Scene(es.Disks(disks.position[:, ::-1], disks.velocity[:, ::-1], disks.radius, disks.mass), domain)


@pytest.mark.parametrize("engine", BOTH)
@pytest.mark.parametrize("domain", [es.Open, es.Periodic])
def test_f32_exchanged_axes_exchange_columns_of_the_log(engine, domain):
    scene = lattice_gas(30, 0.5, domain, seed=32)
    one, other = (log_of(each, engine, events=400) for each in (scene, swapped(scene)))
    assert len(one) >= (20 if domain is es.Open else 400)
    for name, mapped in (("a", "a"), ("b", "b"), ("remainder", "remainder"), ("impulse", "impulse")):
        assert getattr(one, name).tolist() == getattr(other, mapped).tolist(), name
    for x, y in (("xa", "ya"), ("vxa", "vya"), ("xb", "yb"), ("vxb", "vyb")):
        assert getattr(one, x).tobytes() == getattr(other, y).tobytes(), x
        assert getattr(one, y).tobytes() == getattr(other, x).tobytes(), y


@pytest.mark.parametrize("engine", BOTH)
def test_f32_a_mirror_image_has_the_same_contacts(engine):
    """Its coordinates count from the other corner and round otherwise; while that is small, the order is the same."""
    scene = lattice_gas(30, 0.5, es.Open, seed=9)
    disks = scene.disks
    mirrored = es.Disks(disks.position * [-1.0, 1.0], disks.velocity * [-1.0, 1.0], disks.radius, disks.mass)
    one, other = (log_of(each, engine, until=3.0) for each in (scene, es.Scene(mirrored, es.Open())))
    assert len(one) > 40
    assert (one.a.tolist(), one.b.tolist()) == (other.a.tolist(), other.b.tolist())
    # an ulp of coordinates below 8, doubled about ten times by chaos, and 2^6 for chance
    np.testing.assert_allclose(other.vxa, -one.vxa, rtol=0.0, atol=1e-10)
    np.testing.assert_allclose(other.vya, one.vya, rtol=0.0, atol=1e-10)


@pytest.mark.kernels
def test_f30_a_tie_that_only_the_partner_knows_is_seen():
    """At .79289 a disk meets two at once; the first of them knows but of its own contact, the second one of none."""
    scene = along_diagonals(8, 2, 1.0, es.Box)
    reference, fast = (log_of(scene, engine, events=60) for engine in BOTH)
    at_once = reference.joint[reference.joint >= 0]
    assert len(at_once) > 10
    assert fast.rows.tobytes() == reference.rows.tobytes()


@pytest.mark.kernels
def test_f29_both_boundaries_passed_at_one_time_are_passed_in_one_order():
    """A disk flies along the diagonal of a torus and through its corner, then into another one; places that round differently."""
    side = 7.8
    for k in range(6, 22):
        place = (0.3 + k / 61) * side
        disks = es.Disks([(place, place), (0.125 * side, 0.225 * side)], [(1.3, 1.3), (0.0, 0.0)], 0.05 * side)
        reference, fast = (log_of(es.Scene(disks, es.Periodic((side, side))), engine, events=20) for engine in BOTH)
        assert len(reference) == 20
        assert reference.digest() == fast.digest()

"""What numbers mean: who is counted, what is conserved, until when averages go, and where there is a dash instead."""

import math

import numpy as np
import pytest

import eventsim as es
from eventsim.measure import Meter, measure
from eventsim.measure.free_paths import free_paths
from eventsim.measure.measures import Measure
from eventsim.measure.words import table_text
from eventsim.record.events import Kind
from eventsim.replay.flight_table import flight_table, flights
from eventsim.replay.replay import Replay
from eventsim.scene.gallery import names
from tests.engines.scenes import lattice_gas
from tests.measure.write_pages import PAGES, page

INF = math.inf


def run_of(scene, **stop):
    return es.simulate(scene, engine="reference", log=True, **stop)


def posts():
    """A small disk between two large posts that cannot be moved: a Lorentz gas."""
    disks = es.Disks([[0.5, 0.5], [0.05, 0.05], [0.1, 0.55]], [[0, 0], [0, 0], [0.6, 0.8]], [0.2, 0.2, 0.01], [INF, INF, 1.0])
    return es.Scene(disks, es.Periodic((1.0, 1.0)))


def with_tracers():
    """A gas of 16 disks, and six tracers among it."""
    scene = lattice_gas(16, 0.2, es.Periodic, seed=2)
    gas, side = scene.disks, scene.domain.size[0]
    places = [[0.25 * side * (k % 4), 0.25 * side * (k // 4)] for k in range(6)]
    velocity = np.concatenate([gas.velocity, np.random.default_rng(1).normal(size=(6, 2))])
    radius, mass = np.append(gas.radius, np.zeros(6)), np.append(gas.mass, np.zeros(6))
    return es.Scene(es.Disks(np.concatenate([gas.position, places]), velocity, radius, mass), scene.domain)


def turning(n=36, omega=2.0, seed=4):
    """Disks in a round container, all turning about its middle."""
    rng = np.random.default_rng(seed)
    place = np.array([[x, y] for x in range(-4, 5) for y in range(-4, 5) if x * x + y * y < 16])[:n] * 0.2
    velocity = rng.normal(size=place.shape) * 0.6 + omega * np.column_stack([-place[:, 1], place[:, 0]])
    return es.Scene(es.Disks(place, velocity, 0.04), es.Open(), walls=[es.Circle((0.0, 0.0), 1.0)])


# --- who is counted, and whom they meet


def test_a_lone_disk_among_posts_has_every_contact_once():
    run = run_of(posts(), events=400)
    measures = measure(run.log, discard=0.0)
    assert measures["collision_rate"].value == pytest.approx(len(run.log) / measures.duration, rel=1e-12)
    assert measures["mean_free_time"].value == pytest.approx(measures.duration / len(run.log), rel=1e-12)
    # 1 - 2 pi .21^2 and 4 pi .21: no post overlaps the other
    assert measures["mean_free_path"].theory == pytest.approx(0.8606089618, rel=1e-9)


def test_contacts_with_a_post_count_once_and_with_each_other_twice():
    gas = lattice_gas(16, 0.2, es.Periodic, seed=3).disks
    mass = gas.mass.copy()
    mass[5] = INF
    velocity = gas.velocity.copy()
    velocity[5] = 0.0
    scene = es.Scene(es.Disks(gas.position, velocity, gas.radius, mass), lattice_gas(16, 0.2, es.Periodic, seed=3).domain)
    run = run_of(scene, events=1500)
    with_post = int(((run.log.a == 5) | (run.log.b == 5)).sum())
    rate = (2 * (len(run.log) - with_post) + with_post) / 15 / run.time
    assert measure(run.log, discard=0.0)["collision_rate"].value == pytest.approx(rate, rel=1e-12)


def test_tracers_change_no_number_of_the_gas():
    run = run_of(with_tracers(), events=1200)
    measures, rows = measure(run.log, discard=0.0), run.log.rows
    gas = rows[rows["b"] < 16]
    disks = run.scene.disks
    energy = 0.5 * float((disks.mass[:, None] * disks.velocity**2).sum())
    drift = 0.5 * float((disks.velocity[:16].mean(axis=0) ** 2).sum()) * 16
    kt = (energy - drift) / 15
    virial = 2.0 * disks.radius[0] * float(gas["impulse"].sum())
    assert measures["temperature"].value == pytest.approx(kt, rel=1e-12)
    assert measures["Z"].value == pytest.approx(1.0 + virial / (2.0 * 16 * kt * run.time), rel=1e-9)
    assert measures["collision_rate"].value == pytest.approx(2.0 * len(gas) / 16 / run.time, rel=1e-9)
    assert (measures.disks, measures.tracers) == (16, 6)
    met = int(((rows["a"] < 16) & (rows["b"] >= 16)).sum())
    assert measures["tracer_collision_rate"].value == pytest.approx(met / 6 / run.time, rel=1e-9)


def test_the_way_of_tracers_in_a_table_is_pi_a_over_p():
    measures = es.simulate(es.gallery("sinai", n=16), events=2000, engine="reference", measure=True).measures
    assert measures["mean_free_path"].theory == pytest.approx(math.pi * (1.0 - math.pi / 16.0) / (0.5 * math.pi), rel=1e-12)
    assert abs(measures["mean_free_path"].deviation) < 4.0
    assert measures.table_seen == pytest.approx((1.0 - math.pi / 16.0, 0.5 * math.pi), rel=1e-12)
    assert measures["mean_speed"].fixed
    assert measures["mean_speed"].value == pytest.approx(1.0, rel=1e-12)


def test_the_stadium_has_the_free_path_of_its_table():
    measures = es.simulate(es.gallery("stadium"), events=4000, engine="reference", measure=True).measures
    area, perimeter = math.pi * 0.875**2 + 2.0 * 1.75, 2.0 * math.pi * 0.875 + 4.0
    assert measures["mean_free_path"].theory == pytest.approx(math.pi * area / perimeter, rel=1e-12)
    assert abs(measures["mean_free_path"].deviation) < 4.0


def test_a_disk_that_repeats_its_way_is_not_compared_with_the_mean_over_all_ways():
    path = es.simulate(es.gallery("corner"), events=400, engine="reference", measure=True).measures["mean_free_path"]
    assert path.theory is None
    assert "7.06858" in path.doubt  # pi 81 / 36


# --- what is conserved


def test_a_gas_that_turns_in_a_jar_keeps_its_angular_momentum_out_of_the_temperature():
    scene = turning()
    run = run_of(scene, events=4000)
    measures = measure(run.log, discard=0.0)
    disks = scene.disks
    energy = 0.5 * float((disks.velocity**2).sum())
    turn = float((disks.position[:, 0] * disks.velocity[:, 1] - disks.position[:, 1] * disks.velocity[:, 0]).sum())
    times = np.linspace(0.0, run.time, 2000, endpoint=False)
    inertia = np.array([float((run.state_at(t).position ** 2).sum()) for t in times])
    kt = 2.0 * (energy - float((0.5 * turn**2 / inertia).mean())) / (2 * len(disks) - 1)
    # means over 2000 times and over the meter's own differ by their scatter
    assert measures["temperature"].value == pytest.approx(kt, rel=5e-3)
    assert measures["temperature"].value < 0.8 * energy / len(disks)
    assert math.isnan(measures["Z"].value)
    assert "turns" in measures["Z"].doubt
    assert measures.packing_fraction == pytest.approx(len(disks) * 0.04**2, rel=1e-12)
    assert measures["pressure_edge" if "pressure_edge" in measures else "pressure_wall0"].value > 0.0


# --- until the end of the run


def test_two_contacts_are_a_rate_without_a_bar():
    scene = es.Scene(
        es.Disks([(0.5, 0.5), (1.5, 0.5)], [(1, 0), (0, 0)], 0.1, [1, 2]),
        es.Box((2, 1)),
        walls=[es.Segment((1.8, 0.2), (1.9, 0.8))],
    )
    run = run_of(scene, until=4.0)
    rate = measure(run.log)["collision_rate"]
    assert rate.value == pytest.approx(int((run.log.kind == Kind.PAIR).sum()) / 4.0, rel=1e-12)
    assert math.isnan(rate.error)
    assert "too few" in rate.doubt
    assert measure(run.log).discarded == 0.0
    assert not measure(run.log).equilibrated


@pytest.mark.parametrize("name", ["mixture", "brownian", "jar", "channel"])
def test_averages_go_to_the_end_of_the_run(name):
    run = run_of(es.gallery(name), events=600)
    measures = measure(run.log, discard=0.0)
    table = flight_table(Replay(run.log))
    lag = table.duration[:, None]
    ends = table.velocity, table.velocity + 0.5 * lag * table.pull, table.velocity + lag * table.pull
    square = sum(weight * (v**2).sum(axis=1) for weight, v in zip((1, 4, 1), ends, strict=True)) / 6.0
    mass = run.scene.disks.mass
    species = np.unique(mass)
    if len(species) == 1:
        energy = 0.5 * float((mass[table.disk] * square * table.duration).sum()) / run.time
        assert measures.series.energy.mean() == pytest.approx(energy, rel=0.05)
        return
    for kind, value in enumerate(species):
        mine = mass[table.disk] == value
        kt = 0.5 * value * float((square * table.duration)[mine].sum()) / (run.time * (mass == value).sum())
        assert measures[f"temperature_{kind}"].value == pytest.approx(kt, rel=1e-9)


def test_what_is_left_out_is_left_out_to_the_last_bit_of_a_flight():
    run = run_of(es.gallery("gas", n=20), events=2000)
    cut = 0.37 * run.time
    kept = run.log.time > cut
    measures = measure(run.log, discard=cut)
    met = int(((run.log.kind == Kind.PAIR) & kept).sum())
    assert measures["collision_rate"].value == pytest.approx(2.0 * met / 20 / (run.time - cut), rel=1e-9)


# --- any length


def test_a_run_that_falls_quiet_costs_no_more_samples():
    scene = es.Scene(es.Disks([[0.0, 0.0], [3.0, 0.0]], [[1.0, 0.0], [0.0, 0.0]], 0.5), es.Open())
    run = run_of(scene, until=1e3)
    meter = Meter(scene)
    meter.write(run.log.rows)
    before = meter._sums.way.shape
    measures = meter.finish(1e14)
    assert meter._sums.way.shape == before
    assert len(measures.correlations.lag) < 400
    assert measures["mean_speed"].value == pytest.approx(0.5, rel=1e-9)


def test_rows_far_apart_are_measured_as_those_close_by():
    """A disk that slows down by a factor 2 at each of 200 contacts: the intervals between samples double with it."""
    meter = Meter(es.Scene(es.Disks([[0.0, 0.0]], [[1.0, 0.0]], 0.0), es.Box((2.0, 2.0), origin=(-1.0, -1.0))), 0.0)
    rows = es.simulate(meter.scene, events=4_000, engine="reference", log=True).log.rows.copy()
    slow = 2.0 ** np.minimum(np.arange(len(rows)) / 20.0, 200.0)
    rows["remainder"] = np.cumsum(2.0 * slow)
    rows["epoch"] = 0
    rows["vxa"] /= slow
    meter.write(rows)
    measures = meter.finish(float(rows["remainder"][-1]))
    assert measures["wall_contact_rate"].value == pytest.approx(len(rows) / rows["remainder"][-1], rel=1e-9)
    assert measures.correlations.lag[-1] > 1e50


# --- dashes


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("galperin", "open plane"),
        ("newton-cradle", "one direction"),
        ("two-disks", "one direction"),
        ("corridor", "one direction"),
        ("bounce", "take energy"),
        ("corner", "with nobody"),
        ("obstacle", "obstacles"),
        ("cooling", "take energy"),
    ],
)
def test_there_is_a_dash_where_there_is_no_temperature(name, why):
    measures = es.simulate(es.gallery(name), events=300, engine="reference", measure=True).measures
    assert math.isnan(measures["temperature"].value)
    assert why in measures["temperature"].doubt
    assert not measures.equilibrated
    assert all(quantity.theory is None for quantity in measures.quantities if quantity.name != "cooling_exponent")


def test_three_contacts_do_not_make_an_equilibrium():
    measures = es.simulate(es.gallery("break"), events=40, engine="reference", measure=True).measures
    assert not measures.equilibrated
    assert all(quantity.theory is None for quantity in measures.quantities)


def test_a_cooling_gas_is_told_by_its_series():
    scene = lattice_gas(64, 0.1, es.Periodic, seed=7, restitution=0.9)
    run = run_of(scene, events=64 * 20)
    series = measure(run.log).series
    assert math.isnan(measure(run.log)["temperature"].value)
    fall = -np.diff(np.log(series.temperature)).sum() / (series.contacts[-1] - series.contacts[0])
    assert fall == pytest.approx(0.5 * (1.0 - 0.81), rel=0.1)
    energy = 0.5 * float((run.state_at(series.time[-1]).velocity ** 2).sum())
    assert series.energy[-1] == pytest.approx(energy, rel=1e-9)


def test_diffusion_tells_the_lags_it_was_read_between():
    measures = es.simulate(lattice_gas(36, 0.3, es.Periodic, seed=3), events=8_000, engine="reference", measure=True).measures
    assert "slope between lags" in measures["diffusion"].doubt
    assert "grows with the lag" in measures["diffusion"].doubt
    assert measures["diffusion"].theory is None


def test_walls_with_two_sides_have_two_pressures():
    disks = es.Disks([[0.25, 0.25], [0.25, 0.75], [0.75, 0.5]], [[1, 0.3], [0.2, -1], [0.3, 0.5]], 0.05)
    scene = es.Scene(disks, es.Box((1.0, 1.0)), walls=[es.Segment((0.5, 0.0), (0.5, 1.0), name="middle")])
    measures = es.simulate(scene, events=2000, engine="reference", measure=True).measures
    left, right = measures["force_middle_left"].value, measures["force_middle_right"].value
    assert measures["force_middle"].value == pytest.approx(left + right, rel=1e-12)
    assert left > right  # two fast disks against a slow one; the left of the way up is towards smaller x


def test_the_table_shows_the_accuracy_of_a_theory_that_the_difference_counts():
    approximate = Measure(0.1022, 0.0069, theory=0.095, accuracy=0.0019, name="cooling_exponent", source="Haff 1983")
    assert approximate.deviation == pytest.approx(0.0072 / math.hypot(0.0069, 0.0019))
    assert "0.095 ± 0.0019  +1.0 sigma  Haff 1983" in table_text([approximate])
    exact = Measure(2.06, 0.02, theory=2.05, name="Z")
    assert "2.05    +0.5 sigma" in table_text([exact])


def test_measures_have_keys_and_a_table():
    measures = es.simulate(lattice_gas(16, 0.2, es.Periodic, seed=3), events=2000, engine="reference", measure=True).measures
    assert measures.keys()[0] == "temperature"
    assert "collision_rate" in measures.table()
    assert len(repr(measures)) < 100
    with pytest.raises(KeyError, match="there are temperature"):
        measures["heat"]


def two_lanes(other_y):
    """Two disks that fly towards each other, on one line or beside each other."""
    disks = es.Disks([[1.0, 0.5], [3.0, other_y]], [[1, 0], [-1, 0]], 0.1)
    return es.simulate(es.Scene(disks, es.Box((4.0, 2.0))), until=40.0, engine="reference", measure=True).measures


def test_disks_that_never_met_are_told_so_and_not_that_they_move_along_one_direction():
    assert two_lanes(1.5)["temperature"].doubt == "the disks never met each other"
    assert "along one direction" in two_lanes(0.5)["temperature"].doubt


def test_the_table_tells_who_the_species_are_and_whose_contacts_a_rate_counts():
    places, velocities = [[0.25, 0.25], [0.25, 0.75], [0.75, 0.5]], [[1, 0.3], [0.2, -1], [0.3, 0.5]]
    disks = es.Disks(places, velocities, [0.05, 0.05, 0.1], [0.5, 0.5, 2.0])
    measures = es.simulate(es.Scene(disks, es.Box((1.0, 1.0))), events=300, engine="reference", measure=True).measures
    rows = measures.table().splitlines()
    assert "  species 0: 2 disks, r 0.05, m 0.5" in rows
    assert "  species 1: 1 disk, r 0.1, m 2" in rows
    assert [row.split()[-2:] for row in rows if row.startswith("  collision_rate ")] == [["per", "disk"]]
    assert [row.split()[-3:] for row in rows if row.startswith("  wall_contact_rate")] == [["of", "all", "disks"]]
    assert "species" not in two_lanes(0.5).table()


@pytest.mark.parametrize(("height", "told"), [(1.0, False), (0.5, True)])
def test_the_table_tells_where_the_sides_of_a_wall_are_not_all_of_it(height, told):
    disks = es.Disks([[0.25, 0.25], [0.25, 0.75], [0.75, 0.5]], [[1, 0.3], [0.2, -1], [0.3, 0.5]], 0.05)
    scene = es.Scene(disks, es.Box((1.0, 1.0)), walls=[es.Segment((0.5, 0.0), (0.5, height), name="middle")])
    measures = es.simulate(scene, events=2000, engine="reference", measure=True).measures
    assert "  left and right of a wall: as seen from its start to its end" in measures.table().splitlines()
    assert ("the ends of middle take a share" in measures.table()) == told
    sides = measures["force_middle_left"].value + measures["force_middle_right"].value
    assert (measures["force_middle"].value > 1.0001 * sides) == told


# --- pages


@pytest.mark.parametrize("name", names())
def test_the_page_of_a_gallery_scene_is_the_one_that_was_read(name):
    """To change a page, read it, and write it by `python -m tests.measure.write_pages`."""
    assert page(name) == (PAGES / f"{name}.txt").read_text()


@pytest.mark.parametrize("name", names())
def test_no_bar_is_zero_and_no_number_is_without_a_reason(name):
    measures = es.simulate(es.gallery(name), events=300, engine="reference", measure=True).measures
    for quantity in measures.quantities:
        assert quantity.error != 0.0, quantity.name
        assert quantity.fixed or quantity.error > 0.0 or quantity.doubt, quantity.name
        assert not math.isnan(quantity.value) or quantity.doubt, quantity.name


def test_a_restitution_that_no_contact_has_takes_no_energy():
    gas = lattice_gas(16, 0.2, es.Periodic, seed=2)
    law = es.Restitution(pair=1.0, wall=0.5)
    plain, lossy = (
        run_of(es.Scene(gas.disks, gas.domain, restitution=one), events=300).log for one in (None, law)
    )
    assert measure(lossy).table() == measure(plain).table()
    alone = es.Disks([[0.5, 0.5]], [[0.6, 0.8]], 0.1)
    scene = es.Scene(alone, es.Box((1.0, 1.0)), restitution=es.Restitution(pair=0.5, wall=1.0))
    assert measure(run_of(scene, events=100).log).steady


def test_disks_too_heavy_to_share_energy_with_others_are_not_held_against_theory():
    """A contact of masses m and M gives 4 m M / (m + M)^2 of what one of equal masses gives."""
    gas = lattice_gas(16, 0.2, es.Periodic, seed=2)
    for heavy, known in ((1.0, True), (1e6, False)):
        mass = np.where(np.arange(16) < 4, heavy, 1.0)
        radius = np.where(np.arange(16) < 4, 0.9, 1.0) * gas.disks.radius
        scene = es.Scene(es.Disks(gas.disks.position, gas.disks.velocity / np.sqrt(mass)[:, None], radius, mass), gas.domain)
        measures = measure(run_of(scene, events=400).log)
        assert (measures["temperature_0"].theory is not None) == known
        assert ("species 0 has shared its energy" in "".join(measures.doubts)) != known


def test_free_paths_do_not_end_at_tracers():
    scene = with_tracers()
    gas = np.arange(16)
    alone = es.Scene(es.Disks(*(column[gas] for column in (scene.disks.position, scene.disks.velocity, scene.disks.radius))),
                     scene.domain)  # fmt: skip
    long = run_of(scene, events=250)  # until places are beyond the digits
    short = run_of(alone, until=long.time)
    with_, without = (
        np.sort(np.concatenate(list(free_paths((table.of(gas) for table in flights(Replay(run.log))), len(run.scene.disks)))))
        for run in (long, short)
    )
    assert len(with_) == len(without) > 60
    assert np.allclose(with_, without, rtol=1e-6)

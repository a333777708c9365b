"""Lyapunov exponents: conservation of volume, pairs, the recursion of curvature, two neighbours in 60 digits."""

import math
from dataclasses import replace

import numpy as np
import pytest
from mpmath import mp, mpf, sqrt

import eventsim as es
from eventsim.errors import EventsimError
from eventsim.measure import study
from eventsim.measure.studies.lyapunov import found
from eventsim.scene.restitution import Restitution
from tests.measure.trust_table import generic_scene


def fluid(n=8, **changes):
    return replace(es.gallery("periodic-fluid", n=n, packing_fraction=0.3, seed=2), **changes)


def run_log(scene, events, engine="reference"):
    return es.simulate(scene, events=events, engine=engine, log=True, trust=False).log


def sinai(radius, angles):
    """Points that start at a corner of the unit torus around a post."""
    velocity = np.column_stack([np.cos(angles), np.sin(angles)])
    disks = es.Disks([[0.0, 0.0]] + [[-0.5, -0.4]] * len(angles), [[0.0, 0.0], *velocity], [radius] + [0.0] * len(angles),
                     [math.inf] + [0.0] * len(angles))  # fmt: skip
    return es.Scene(disks, es.Periodic((1.0, 1.0), origin=(-0.5, -0.5)))


ELASTIC = {
    "fluid": (fluid(), 600),
    "stadium": (es.gallery("stadium"), 300),
    "a round wall": (replace(generic_scene(3), restitution=None), 300),
    "a post": (replace(generic_scene(4), restitution=None), 300),
    "gravity": (replace(generic_scene(0), restitution=None), 300),
    "an ellipse": (es.gallery("ellipse"), 100),
}


@pytest.mark.parametrize("name", ELASTIC)
def test_elastic_contacts_keep_the_volume_of_phase_space(name):
    result = found(run_log(*ELASTIC[name]), None, 1000)
    for system in result.tables:
        largest = result[f"{system}_1"].value
        assert abs(result[f"{system}_sum"].value) < 1e-9 * largest
        exponents = np.array(result.tables[system]["exponent"])
        errors = np.array(result.tables[system]["error"])
        assert (np.abs(exponents + exponents[::-1]) <= 3.0 * errors + 0.05 * largest).all()


def test_each_inelastic_contact_takes_its_share_of_the_volume():
    result = found(run_log(fluid(restitution=Restitution(0.9, 1.0)), 600), None, 32)
    # of a contact of 2 disks e^2: the distance along the normal, and its rate, are each multiplied by -e
    assert sum(result.tables["lyapunov"]["per_contact"]) == pytest.approx(8 * math.log(0.9), rel=1e-9)
    assert "no steady state" in result["lyapunov_1"].doubt


@pytest.mark.parametrize(("e", "beta"), [(1.0, 1.0), (1.0, 0.5), (0.9, -0.6)])
def test_contacts_of_rough_disks_take_their_share_of_the_volume(e, beta):
    scene = fluid(restitution=Restitution(e, 1.0), tangential_restitution=beta)
    result = found(run_log(scene, 600), None, 40)
    # besides e^2 of the contact: the velocity at which surfaces slide past each other is multiplied by -beta
    exponents = result.tables["lyapunov"]["per_contact"]
    assert len(exponents) == 5 * len(scene.disks)
    assert sum(exponents) == pytest.approx(8 * math.log(e * math.sqrt(abs(beta))), rel=1e-9, abs=1e-9 * exponents[0])
    assert exponents[0] > 0.0


def test_smooth_disks_that_spin_part_like_smooth_ones():
    smooth = found(run_log(fluid(), 600), None, 1)["lyapunov_1"].value
    spun = found(run_log(fluid(tangential_restitution=-1.0), 600), None, 1)["lyapunov_1"].value
    assert spun == pytest.approx(smooth, rel=0.02)


def by_curvature(log, disk=1):
    """The exponent of a point among posts, per contact, from the curvature of its front: k -> k / (1 + k t) + 2 / (r cos)."""
    rows, radius = log.rows, float(log.scene.disks.radius[0])
    time = (rows["epoch"] * log.provenance.epoch_length + rows["remainder"])[rows["a"] != rows["b"]]
    post_first = rows["a"] == 0
    place = np.where(post_first[:, None], np.column_stack([rows["xb"], rows["yb"]]), np.column_stack([rows["xa"], rows["ya"]]))
    speed = np.where(
        post_first[:, None], np.column_stack([rows["vxb"], rows["vyb"]]), np.column_stack([rows["vxa"], rows["vya"]])
    )
    middle = np.where(post_first[:, None], np.column_stack([rows["xa"], rows["ya"]]), np.column_stack([rows["xb"], rows["yb"]]))
    away = place - middle
    away -= np.round(away)
    cosine = (away * speed).sum(axis=1) / radius
    curvature, logs = 0.0, []
    for k in range(1, len(rows)):
        curvature += 2.0 / (radius * cosine[k - 1])
        flight = time[k] - time[k - 1]
        logs.append(math.log1p(curvature * flight))
        curvature /= 1.0 + curvature * flight
    first = len(logs) // 10
    return float(np.mean(logs[first:]))


def test_a_point_among_posts_agrees_with_the_recursion_of_curvature():
    log = run_log(sinai(0.1, [0.7]), 500)
    assert found(log, None, 1)["lyapunov_tracer_1_per_contact"].value == pytest.approx(by_curvature(log), rel=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("radius", [0.05, 0.1])
def test_sinai_torus_per_contact(radius):
    log = run_log(sinai(radius, [0.7]), 40_000)
    entry = found(log, None, 1)["lyapunov_tracer_1_per_contact"]
    print(radius, entry.value, entry.error, by_curvature(log))
    assert entry.value == pytest.approx(by_curvature(log), rel=3e-3)
    asymptote = -2.0 * math.log(radius) + 1.0 - 4.0 * math.log(2.0) + 27.0 * 1.2020569031595943 / (2.0 * math.pi**2)
    assert abs(entry.value - asymptote) < radius * math.log(radius) ** 2


def test_tracers_are_systems_of_their_own():
    angles = [0.7, 2.0]
    both = run_log(sinai(0.2, angles), 400)
    end = float(both.time[-1])
    alone = []
    for angle in angles:
        one = es.simulate(sinai(0.2, [angle]), until=end, engine="reference", log=True, trust=False).log
        alone.append(found(one, None, 1)["lyapunov_tracer_1"].value)
    assert found(both, None, 1)["lyapunov_tracer_1"].value == pytest.approx(np.mean(alone), rel=0.05)


def test_tracers_change_nothing_for_the_gas():
    gas = fluid(4)
    disks = gas.disks
    box = np.array(gas.domain.size)
    place = box * 0.5 + 0.5 * disks.position[0]
    clear = next(p for p in (place + np.array([k * 0.07, 0.0]) for k in range(200))
                 if np.hypot(*((p - disks.position + box / 2) % box - box / 2).T).min() > disks.radius[0] * 1.05)  # fmt: skip
    more = es.Disks(np.vstack([disks.position, [clear % box]]), np.vstack([disks.velocity, [[0.3, 0.4]]]), [*disks.radius, 0.0],
                    [*disks.mass, 0.0])  # fmt: skip
    end = 40.0 * disks.radius[0]
    alone, beside = (
        found(es.simulate(scene, until=end, engine="reference", log=True, trust=False).log, None, 1)
        for scene in (replace(gas, until=None, events=None), replace(gas, disks=more, until=None, events=None))
    )
    assert beside["lyapunov_1"].value == pytest.approx(alone["lyapunov_1"].value, rel=0.05)
    assert beside["lyapunov_tracer_1"].value > 0.0


def test_it_stops_at_a_cluster_and_has_no_meaning_where_something_is_forgotten():
    assert "share disks" in found(run_log(es.gallery("break"), 100), None, 1)["lyapunov_1"].doubt
    forgotten = found(run_log(fluid(restitution=Restitution(0.0, 1.0)), 40), None, 32)["lyapunov_sum"]
    assert math.isnan(forgotten.value)
    assert "forgets" in forgotten.doubt
    kicked = run_log(fluid(), 10)
    kicked.provenance = replace(kicked.provenance, kicks=((3, 0.0, 1.0),))
    assert "kicks" in found(kicked, None, 1)["lyapunov_1"].doubt
    free = es.Scene(es.Disks([[0.5, 0.5]], [[0.1, 0.2]], 0.1), es.Periodic((1.0, 1.0)))
    assert "nothing meets" in found(es.simulate(free, until=1.0, engine="reference", log=True).log, None, 1)["lyapunov_1"].doubt
    for values, words in (((0,), "at least 1"), ((), "asks for K")):
        with pytest.raises(EventsimError, match=words):
            study(run_log(fluid(), 10), "lyapunov", *values)
    with pytest.raises(EventsimError, match="there is no study"):
        study(run_log(fluid(), 10), "liapunov")


def test_what_is_left_out_is_what_was_asked():
    log = run_log(fluid(), 400)
    early, late = (found(log, discard, 1)["lyapunov_1"].value for discard in (0.0, 0.5 * float(log.time[-1])))
    assert early != late
    assert "left out: too few" in found(log, 1e9, 1)["lyapunov_1"].doubt


class Neighbours:
    """Two runs in 60 digits, a little apart, through rows of a log: rows say who meets, these say when and where."""

    def __init__(self, scene):
        self.n, self.reach = len(scene.disks), mpf(2.0 * float(scene.disks.radius[0]))
        self.period = [mpf(length) for length in scene.domain.size]
        self.runs = [{}, {}]

    def begin(self, states, apart):
        """From states (x, y, vx, vy, time) of the disks, and how far the second run is apart: (n, 4)."""
        for i, (x, y, u, w, t) in enumerate(states):
            one = [mpf(x), mpf(y), mpf(u), mpf(w)]
            self.runs[0][i] = [*one, t]
            self.runs[1][i] = [*(v + d for v, d in zip(one, apart[i], strict=True)), t]

    def meet(self, a, b, time):
        for run in self.runs:
            p, q = run[a], run[b]
            for disk in (p, q):
                disk[0] += disk[2] * (time - disk[4])
                disk[1] += disk[3] * (time - disk[4])
            rx, ry = p[0] - q[0], p[1] - q[1]
            rx -= self.period[0] * mp.nint(rx / self.period[0])
            ry -= self.period[1] * mp.nint(ry / self.period[1])
            ux, uy = p[2] - q[2], p[3] - q[3]
            along, u2, gap = rx * ux + ry * uy, ux * ux + uy * uy, rx * rx + ry * ry - self.reach**2
            delay = (-along - sqrt(along * along - u2 * gap)) / u2
            nx, ny = (rx + ux * delay) / self.reach, (ry + uy * delay) / self.reach
            push = nx * ux + ny * uy
            for disk, sign in ((p, -1), (q, 1)):
                disk[0] += disk[2] * delay
                disk[1] += disk[3] * delay
                disk[2] += sign * push * nx
                disk[3] += sign * push * ny
                disk[4] = time + delay

    def apart(self):
        """(n, 4) how far the second run is apart, each disk at the time of its last contact in the first one."""
        found = []
        for i in range(self.n):
            p, q = self.runs[0][i], self.runs[1][i]
            lag = p[4] - q[4]
            found.append([q[0] + q[2] * lag - p[0], q[1] + q[3] * lag - p[1], q[2] - p[2], q[3] - p[3]])
        return found


def growth_of_neighbours(log, piece):
    """The largest exponent from neighbours that are brought near again after every `piece` of rows."""
    scene, rows, length = log.scene, log.rows, mpf(log.provenance.epoch_length)
    states = [(*p, *v, mpf(0)) for p, v in zip(scene.disks.position.tolist(), scene.disks.velocity.tolist(), strict=True)]
    pair, apart, far = Neighbours(scene), np.random.default_rng(2).normal(size=(len(states), 4)), mpf(10) ** -30
    logs, times = [], []
    for first in range(0, len(rows) - piece + 1, piece):
        size = sqrt(sum(mpf(d) ** 2 for one in apart for d in one))
        pair.begin(states, [[mpf(d) / size * far for d in one] for one in apart])
        for row in rows[first : first + piece]:
            time = int(row["epoch"]) * length + mpf(float(row["remainder"]))
            pair.meet(int(row["a"]), int(row["b"]), time)
            for i, end in ((int(row["a"]), "a"), (int(row["b"]), "b")):
                states[i] = (*(float(row[f"{k}{end}"]) for k in ("x", "y", "vx", "vy")), time)
        apart = pair.apart()
        logs.append(float(mp.log(sqrt(sum(d**2 for one in apart for d in one)) / far)))
        times.append(float(time))
    return sum(logs[1:]) / (times[-1] - times[0])


@pytest.mark.slow
@pytest.mark.timeout(1500)
def test_the_fluid_against_two_neighbours_in_60_digits():
    log = run_log(fluid(64), 80_000, engine="auto")
    entry = found(log, None, 1)["lyapunov_1"]
    with mp.workdps(60):
        other = growth_of_neighbours(log, piece=512)
    print(entry.value, entry.error, other)
    assert entry.error < 0.01 * entry.value
    assert abs(entry.value - other) < 3.0 * entry.error


def test_a_small_fluid_against_two_neighbours_in_60_digits():
    log = run_log(fluid(), 320)
    with mp.workdps(60):
        other = growth_of_neighbours(log, piece=32)
    assert found(log, 0.1 * float(log.time[-1]), 1)["lyapunov_1"].value == pytest.approx(other, rel=0.05)


@pytest.mark.slow
def test_all_exponents_of_a_fluid_come_in_pairs():
    result = found(run_log(fluid(32), 8_000, engine="auto"), None, 128)
    table = result.tables["lyapunov"]
    exponents, errors = np.array(table["exponent"]), np.array(table["error"])
    print(exponents[:3], errors[:3], exponents[-3:], result["lyapunov_sum"].value)
    assert abs(result["lyapunov_sum"].value) < 1e-9 * exponents[0]
    assert (np.abs(exponents + exponents[::-1]) <= 3.0 * np.hypot(errors, errors[::-1])).all()

"""Disks that fly through each other are wrong behind chaos, too; what steps, springs and margins leave is not."""

import json
from dataclasses import replace

import numpy as np
import pytest
from click.testing import CliRunner

import eventsim as es
from eventsim.cli.program import main
from tests.validate.judge.files import write

GAS = es.gallery("gas", n=20)


def motion(scene=GAS, until=0.5, pairs_until=9.0, walls_until=9.0, dt=1e-3):
    """Times and positions: fly; turn round at walls; disks that overlap and approach exchange velocities along their centres."""
    x, v, r, size = scene.disks.position, scene.disks.velocity, scene.disks.radius, np.array(scene.domain.size)
    ones, others = np.triu_indices(len(x), 1)
    places = [x]
    for k in range(1, round(until / dt) + 1):
        x, v = x + v * dt, v.copy()
        if k * dt < walls_until:
            out = ((x < r[:, None]) & (v < 0.0)) | ((x > size - r[:, None]) & (v > 0.0))
            v = np.where(out, -v, v)
        if k * dt < pairs_until:
            near = np.hypot(*(x[ones] - x[others]).T) < r[ones] + r[others]
            for a, b in zip(ones[near], others[near], strict=True):
                normal = (x[a] - x[b]) / np.hypot(*(x[a] - x[b]))
                approach = min((v[a] - v[b]) @ normal, 0.0)
                v[a] -= approach * normal
                v[b] += approach * normal
        places.append(x)
    return dt * np.arange(len(places)), np.array(places)


@pytest.mark.parametrize("every", [1, 10, 20])
def test_pairs_that_stop_meeting_behind_the_last_contact_compared_are_wrong(every):
    times, places = (values[::every] for values in motion(pairs_until=0.25))
    judged = es.validate(GAS, trajectory=(times, places))
    first = judged.first_fault
    assert judged.compared > 0
    assert first.kind == "overlap"
    assert 0.25 < first.time < 0.35
    a, b = first.disks
    apart = np.hypot(*(places[:, a] - places[:, b]).T) / GAS.disks.radius[[a, b]].sum()
    then = 1.0 - apart[np.searchsorted(times, first.time - 1e-9)]
    assert f"disks {a} and {b} at t = {first.time:.6g}: by {then:.2%} of the reach, where one step brings at most" in str(judged)
    assert f"by {1.0 - apart.min():.2%} at t = " in first.sentence


@pytest.mark.parametrize("every", [1, 10])
def test_a_step_too_late_is_no_wrong_overlap(every):
    times, places = motion()
    judged = es.validate(GAS, trajectory=(times[::every], places[::every]))
    assert judged.judgement.deepest[0] > 0.01
    assert judged.judgement.faults == []


def test_walls_that_stop_holding_behind_the_last_contact_compared_are_wrong():
    first = es.validate(GAS, trajectory=motion(until=0.4, walls_until=0.3)).first_fault
    assert first.kind == "overlap"
    assert len(first.disks) == 1
    assert 0.3 < first.time < 0.33
    assert f"disk {first.disks[0]} with " in first.sentence


def test_the_command_names_an_overlap_and_its_code_is_that_of_other_wrong_events(tmp_path):
    mine = write(tmp_path / "mine.csv", "csv", *motion(until=0.4, pairs_until=0.25))
    told = ["validate", "gas", "--set", "n=20", "--trajectory", str(mine)]
    done = CliRunner().invoke(main, told)
    assert done.exit_code == 0
    assert "First wrong event that can be seen: overlap: disks " in " ".join(done.output.split())
    data = json.loads(CliRunner().invoke(main, [*told, "--json"]).output)
    assert data["first_fault"]["kind"] == "overlap"
    assert data["compared"] > 0


def head_on(deep, through=False, dt=0.002):
    """Times and positions of two disks of radius 0.5 that come at speed 2 and that springs turn, so deep in each other."""
    scene = es.Scene(es.Disks([(2.0, 2.0), (4.0, 2.0)], [(1.0, 0.0), (-1.0, 0.0)], 0.5), es.Box((6.0, 4.0)), until=1.4)
    times = dt * np.arange(round(1.4 / dt))
    pace = 2.0 / deep
    late = np.maximum(times - 0.5, 0.0)
    inside = np.where(pace * late < np.pi, -deep * np.sin(pace * late), 2.0 * (late - np.pi / pace))
    apart = np.where(times < 0.5, 2.0 - 2.0 * times, 1.0 + (-2.0 * late if through else inside))
    places = np.stack([np.column_stack([3.0 + side * apart, np.full(len(times), 2.0)]) for side in (-0.5, 0.5)], axis=1)
    return scene, (times, places)


@pytest.mark.parametrize(("deep", "wrong"), [(0.08, False), (0.4, True)])
def test_springs_may_give_way_by_a_tenth(deep, wrong):
    """Deeper than many steps, but turned in each."""
    scene, path = head_on(deep)
    judged = es.validate(scene, trajectory=path, tolerance=0.5)
    assert judged.judgement.deepest[0] == pytest.approx(deep, rel=0.01)
    assert ("overlap" in {fault.kind for fault in judged.judgement.faults}) == wrong


def test_a_contact_that_is_missed_is_one_wrong_event():
    """And no overlap besides."""
    scene, path = head_on(0.1, through=True)
    assert [fault.kind for fault in es.validate(scene, trajectory=path).judgement.faults] == ["missed"]


def test_a_disk_that_lies_on_the_ground_does_not_overlap_by_its_last_bits():
    scene = es.Scene(es.Disks([(0.3, 0.1), (1.0, 1.0)], [(0.0, 0.0), (0.1, 0.0)], 0.1), es.Box((2.0, 2.0)), gravity=(0.0, -1.0))
    scene = replace(scene, until=0.5)
    times = np.arange(0.0, 0.5, 0.005)
    places = np.tile(scene.disks.position, (len(times), 1, 1))
    places[1:, 0, 1] -= 1e-15
    places[:, 1] += np.column_stack([0.1 * times, -0.5 * times**2])
    assert es.validate(scene, trajectory=(times, places)).first_fault is None


def test_a_point_that_leaves_its_box_is_wrong():
    """A point has no reach: the depth is told as a length.  With contacts that are told nothing else is wrong."""
    scene = es.Scene(es.Disks([(0.5, 0.5)], [(1.0, 0.0)], 0.0), es.Box((1.0, 1.0)), until=0.8)
    times = 0.01 * np.arange(81)
    places = np.column_stack([0.5 + times, np.full(81, 0.5)])[:, None]
    faults = es.validate(scene, trajectory=(times, places), contacts=[(0.5, 0, -1)]).judgement.faults
    assert "overlap: disk 0 with right at t = 0.53: by 0.03, where one step brings at most 0.01; by 0.3 at t = 0.8" in {
        fault.sentence for fault in faults
    }

"""One contact of two disks: each has a closed form, and the engine must give it."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from eventsim.validation.stress.catalogue.grazes import passing
from eventsim.validation.stress.catalogue.scenes import on_plane
from tests.engines.scenes import rows_of, run_of

ULP = 2.0**-52


@given(
    st.floats(-300, 300).map(lambda k: 10.0**k),
    st.floats(-300, 300).map(lambda k: 10.0**k),
    st.floats(0.0, 2.0 * math.pi),
    st.floats(-1.5, 1.5),
    st.floats(0.0, 1.0),
)
def test_a_pair_is_resolved_as_the_closed_form_says(mass_a, mass_b, angle, aim, restitution):
    """A touches B in the direction `angle` and moves at `aim` to the line of centres."""
    n = np.array([math.cos(angle), math.sin(angle)])
    v = np.array([math.cos(angle + aim), math.sin(angle + aim)])
    scene = on_plane([-3.0 * v - n, [0.0, 0.0]], [v, [0.0, 0.0]], mass=[mass_a, mass_b], restitution=restitution)
    rows = rows_of(scene, until=10.0)
    assert len(rows) == 1
    log_ratio = math.log(mass_b) - math.log(mass_a)
    share_a = 1.0 / (1.0 + math.exp(log_ratio)) if log_ratio < 700.0 else math.exp(-log_ratio)
    share_b = 1.0 / (1.0 + math.exp(-log_ratio)) if log_ratio > -700.0 else math.exp(log_ratio)
    vn = float(v @ n)
    after_a = v - (1.0 + restitution) * share_b * vn * n
    after_b = (1.0 + restitution) * share_a * vn * n
    # positions at contact carry rounding of about 4 ulp of 3, which turns the normal by as much
    assert rows[0]["vxa"] == pytest.approx(after_a[0], abs=64 * ULP)
    assert rows[0]["vya"] == pytest.approx(after_a[1], abs=64 * ULP)
    # the logarithms of the masses, up to 700, are known to an ulp: the fraction to 700 ulp
    assert rows[0]["vxb"] == pytest.approx(after_b[0], rel=2000 * ULP, abs=64 * ULP * share_a)


@given(st.floats(0.0, 0.999))
def test_equal_disks_leave_at_right_angles(b):
    rows = rows_of(passing(b), until=10.0)
    s = math.sqrt(1.0 - b * b)
    got = [rows[0][name] for name in ("vxa", "vya", "vxb", "vyb")]
    # the normal turns by the error of the contact position, which near a graze is that of sqrt(1 - b^2)
    assert got == pytest.approx([b * b, b * s, s * s, -b * s], abs=32 * ULP / s)


def test_a_graze_by_one_bit_comes_at_the_time_of_the_closed_form():
    dy = 1.0 - 2.0**-53
    rows = rows_of(passing(dy), until=10.0)
    assert rows["time"] == pytest.approx([3.0 - math.sqrt((1.0 - dy) * (1.0 + dy))], abs=4 * ULP)


@pytest.mark.parametrize("dy", [1.0, 1.0 + 2.0**-52])
def test_after_a_tangency_or_a_miss_nothing_is_ahead(dy):
    session, stopped = run_of(passing(dy), until=10.0)
    assert (stopped, session.counters.events) == ("quiet", 0)


def test_an_immovable_disk_is_not_deflected_and_a_tracer_deflects_nobody():
    scene = on_plane([[-3.0, 0.0], [0.0, 0.0]], [[1.0, 0.0], [0.5, 0.0]], mass=[math.inf, 1.0])
    rows = rows_of(scene, until=10.0)
    assert (rows[0]["vxa"], rows[0]["vxb"]) == (1.0, 1.5)
    scene = on_plane([[-3.0, 0.0], [0.0, 0.0]], [[1.0, 0.0], [0.5, 0.0]], mass=[0.0, 1.0])
    rows = rows_of(scene, until=10.0)
    assert (rows[0]["vxa"], rows[0]["vxb"]) == (0.0, 0.5)

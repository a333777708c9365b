"""Contacts of rough disks: the closed form of Jenkins and Richman, and what they keep or lose, in rational numbers."""

from fractions import Fraction as Q
from math import isqrt

from hypothesis import given
from hypothesis import strategies as st

from eventsim.formulas.impulse import mass_fractions, pair_update, reduced_mass, wall_update
from eventsim.formulas.rough import grip_strength, gripped, pair_grip, wall_grip

ULP = Q(1, 2**52)

lengths = st.floats(0.125, 8.0)
speeds = st.floats(-4.0, 4.0).filter(lambda v: v == 0.0 or abs(v) >= 1e-75)  # as in scenes
masses = st.floats(2.0**-20, 2.0**20)
moments = st.floats(1e-3, 1.0)
restitutions = st.floats(0.0, 1.0)
roughnesses = st.floats(-1.0, 1.0)
pairs = st.fixed_dictionaries(
    {
        "d": st.tuples(speeds, speeds),
        "v": st.tuples(speeds, speeds, speeds, speeds),
        "spin": st.tuples(speeds, speeds),
        "mass": st.tuples(masses, masses),
        "radius": st.tuples(lengths, lengths),
        "moment": st.tuples(moments, moments),
    }
).filter(lambda p: max(map(abs, p["d"])) > 0.1)


def met(p, e, beta):
    """Velocities and spins after the contact as floats, q and k."""
    (dx, dy), (ua, wa, ub, wb) = p["d"], p["v"]
    shares = mass_fractions(*p["mass"])
    *spins, k = pair_grip(dx, dy, ua - ub, wa - wb, *p["spin"], *shares, *p["radius"], *p["moment"], beta)
    *after, q = pair_update(dx, dy, ua, wa, ub, wb, *shares, e)
    return (*gripped(dx, dy, *after, *shares, k), *spins), q, k


def exactly(p, e, beta):
    """The same from the impulses of Jenkins and Richman, in rationals; the distance of centres is taken for the reach.

    P = -mu (1 + e) g_n n - mu_t (1 + beta) g_t t with 1 / mu_t = (1 + 1/q_a) / m_a + (1 + 1/q_b) / m_b.
    """
    (dx, dy), (ua, wa, ub, wb) = map(Q, p["d"]), map(Q, p["v"])
    (ma, mb), (qa, qb), (wa_, wb_) = map(Q, p["mass"]), map(Q, p["moment"]), map(Q, p["spin"])
    ra, rb = map(Q, p["radius"])
    square, scale = dx * dx + dy * dy, 1 / (ra + rb)
    ra, rb = ra * scale, rb * scale  # arms in terms of the distance
    u, w = ua - ub, wa - wb
    gn = (dx * u + dy * w) / square
    gt = (dx * w - dy * u) / square - (ra * wa_ + rb * wb_)
    if not gn < 0:
        return (ua, wa, ub, wb, wa_, wb_)
    mu = ma * mb / (ma + mb)
    ia, ib = qa * ma * (ra / scale) ** 2, qb * mb * (rb / scale) ** 2
    mut = 1 / (1 / ma + 1 / mb + square * (ra * ra / ia + rb * rb / ib))
    jn, jt = -mu * (1 + Q(e)) * gn, -mut * (1 + Q(beta)) * gt
    jx, jy = jn * dx - jt * dy, jn * dy + jt * dx
    return (
        ua + jx / ma, wa + jy / ma, ub - jx / mb, wb - jy / mb, wa_ - ra * square * jt / ia, wb_ - rb * square * jt / ib,
    )  # fmt: skip


def magnitude(p):
    """The largest velocity of a surface before the contact, as a bound of all that is added to it, and of spins."""
    fast = max(map(abs, p["v"])) + max(p["radius"]) * max(map(abs, p["spin"])) + 1e-300
    square = p["d"][0] ** 2 + p["d"][1] ** 2
    arm = (square**0.5 + 1.0) * max(square**0.5 / sum(p["radius"]), 1.0)
    return Q(fast * arm), Q(1.0 / (min(p["moment"]) * min(p["radius"])))


@given(pairs, restitutions, roughnesses)
def test_a_rough_pair_is_resolved_as_jenkins_and_richman_say(p, e, beta):
    found, *_ = met(p, e, beta)
    fast, turns = magnitude(p)
    for k, (one, other) in enumerate(zip(found, exactly(p, e, beta), strict=True)):
        assert abs(Q(one) - other) <= 256 * ULP * fast * (max(turns, 1) if k > 3 else 1)  # two dozen roundings of a few terms


def kinetic(p, state):
    (ma, mb), (qa, qb), (ra, rb) = map(Q, p["mass"]), map(Q, p["moment"]), map(Q, p["radius"])
    ua, wa, ub, wb, sa, sb = map(Q, state)
    return (ma * (ua * ua + wa * wa) + mb * (ub * ub + wb * wb) + qa * ma * (ra * sa) ** 2 + qb * mb * (rb * sb) ** 2) / 2


@given(pairs, st.tuples(speeds, speeds), restitutions, roughnesses)
def test_momentum_and_angular_momentum_about_any_point_are_kept_to_the_last_bits(p, about, e, beta):
    (dx, dy), (ma, mb), (qa, qb), (ra, rb) = map(Q, p["d"]), map(Q, p["mass"]), map(Q, p["moment"]), map(Q, p["radius"])
    xb, yb = map(Q, about)
    xa, ya = xb + dx, yb + dy

    def terms(state):
        ua, wa, ub, wb, sa, sb = map(Q, state)
        turning = [ma * (xa * wa), -ma * (ya * ua), mb * (xb * wb), -mb * (yb * ub), qa * ma * ra**2 * sa, qb * mb * rb**2 * sb]
        return [ma * ua, mb * ub], [ma * wa, mb * wb], turning

    state, *_ = met(p, e, beta)
    reach = max(ra + rb, (dx * dx + dy * dy) / (ra + rb))
    for before, after in zip(terms((*p["v"], *p["spin"])), terms(state), strict=True):
        size = sum(map(abs, before)) + sum(map(abs, after))
        exchanged = min(ma, mb) * magnitude(p)[0] * (reach + 16)  # what goes from one to the other is rounded, too
        assert abs(sum(after) - sum(before)) <= 16 * ULP * (size + exchanged)


@given(pairs, restitutions, roughnesses)
def test_a_rough_pair_loses_what_is_stated_and_nothing_else(p, e, beta):
    """Half the reduced mass times (1 - e^2) g_n^2, and half the tangential one times (1 - beta^2) g_t^2."""
    (dx, dy), (ma, mb), (qa, qb) = map(Q, p["d"]), map(Q, p["mass"]), map(Q, p["moment"])
    before, (after, q, _) = (*p["v"], *p["spin"]), met(p, e, beta)
    lost = Q(0)
    if q < 0.0:
        (ua, wa, ub, wb), (sa, sb), (ra, rb) = map(Q, p["v"]), map(Q, p["spin"]), map(Q, p["radius"])
        square, reach = dx * dx + dy * dy, ra + rb
        gn, gt = dx * (ua - ub) + dy * (wa - wb), dx * (wa - wb) - dy * (ua - ub) - square * (ra * sa + rb * sb) / reach
        mu = ma * mb / (ma + mb)
        mut = 1 / (1 / ma + 1 / mb + square / reach**2 * (1 / (ma * qa) + 1 / (mb * qb)))
        lost = (mu * (1 - Q(e) ** 2) * gn**2 + mut * (1 - Q(beta) ** 2) * gt**2) / square / 2
    energy = kinetic(p, before)
    assert abs(kinetic(p, after) + lost - energy) <= 256 * ULP * energy


@given(pairs, st.sampled_from([-1.0, 1.0]))
def test_perfectly_smooth_and_perfectly_rough_disks_keep_their_energy(p, beta):
    state, *_ = met(p, 1.0, beta)
    energy = kinetic(p, (*p["v"], *p["spin"]))
    assert abs(kinetic(p, state) - energy) <= 256 * ULP * energy


@given(pairs, restitutions)
def test_smooth_disks_do_not_turn(p, e):
    state, *_ = met(p, e, -1.0)
    assert state[4:] == p["spin"]
    assert state[:4] == pair_update(*p["d"], *p["v"], *mass_fractions(*p["mass"]), e)[:4]


@given(pairs, restitutions, roughnesses)
def test_exchange_of_the_disks_changes_no_bit(p, e, beta):
    (dx, dy), (ua, wa, ub, wb) = p["d"], p["v"]
    swapped = {key: value[::-1] for key, value in p.items()} | {"d": (-dx, -dy), "v": (ub, wb, ua, wa)}
    (a, b, c, d, f, g), q, k = met(p, e, beta)
    assert met(swapped, e, beta) == ((c, d, a, b, g, f), q, k)


@given(pairs, restitutions, roughnesses)
def test_a_post_turns_others_and_stays_as_it_is(p, e, beta):
    p = p | {"mass": (p["mass"][0], float("inf"))}
    state, *_ = met(p, e, beta)
    assert (*state[2:4], state[5]) == (*p["v"][2:], p["spin"][1])


@given(pairs, restitutions, roughnesses)
def test_the_strength_is_the_momentum_that_is_exchanged(p, e, beta):
    (ua, wa, *_), q, k = met(p, e, beta)
    (dx, dy), mass = p["d"], p["mass"]
    strength = Q(grip_strength(q, k, reduced_mass(*mass), float(isqrt(int((Q(dx) ** 2 + Q(dy) ** 2) * 4**60))) / 2.0**60))
    square = Q(mass[0]) ** 2 * ((Q(ua) - Q(p["v"][0])) ** 2 + (Q(wa) - Q(p["v"][1])) ** 2)
    size = Q(mass[0]) * magnitude(p)[0]  # the change of a heavy disk is rounded as its velocity is
    assert abs(strength**2 - square) <= 256 * ULP * (size + strength) * max(size * 256 * ULP, strength)


triples = st.sampled_from([(3, 4, 5), (-5, 12, 13), (8, -15, 17), (0, 1, 1), (-1, 0, 1)])


@given(pairs, triples, restitutions, roughnesses)
def test_a_wall_turns_a_disk_as_the_closed_form_says(p, triple, e, beta):
    """g_n -> -e g_n and g_t -> -beta g_t, where the spin takes what the disk loses along the wall; normals of any length."""
    (nx, ny, length), (u, w, *_) = triple, p["v"]
    spin, radius, moment = p["spin"][0], p["radius"][0], p["moment"][0]
    turned, k = wall_grip(float(nx), float(ny), u, w, spin, radius, moment, beta)
    ux, wy, q = wall_update(float(nx), float(ny), u, w, e)
    ux, wy = ux + k * ny, wy - k * nx
    gn, along = Q(nx) * Q(u) + Q(ny) * Q(w), (Q(nx) * Q(w) - Q(ny) * Q(u)) / length
    if not q < 0.0:
        assert (ux, wy, turned, k) == (u, w, spin, 0.0)
        return
    change = -(1 + Q(beta)) * (along - Q(radius) * Q(spin)) / (1 + 1 / Q(moment))
    normal = -(1 + Q(e)) * gn / length
    true = (Q(u) + (normal * nx - change * ny) / length, Q(w) + (normal * ny + change * nx) / length)
    fast = Q(max(abs(u), abs(w)) + radius * abs(spin))
    assert abs(Q(ux) - true[0]) <= 64 * ULP * fast
    assert abs(Q(wy) - true[1]) <= 64 * ULP * fast
    assert abs(Q(turned) - (Q(spin) - change / (Q(moment) * Q(radius)))) <= 64 * ULP * fast / (Q(moment) * Q(radius))


@given(pairs, triples, st.sampled_from([-1.0, 1.0]))
def test_a_perfectly_smooth_or_rough_wall_keeps_the_energy(p, triple, beta):
    (nx, ny, _), (u, w, *_) = triple, p["v"]
    spin, radius, moment = p["spin"][0], p["radius"][0], p["moment"][0]
    turned, k = wall_grip(float(nx), float(ny), u, w, spin, radius, moment, beta)
    ux, wy, _ = wall_update(float(nx), float(ny), u, w, 1.0)
    ux, wy = ux + k * ny, wy - k * nx
    energy = Q(u) ** 2 + Q(w) ** 2 + Q(moment) * (Q(radius) * Q(spin)) ** 2
    after = Q(ux) ** 2 + Q(wy) ** 2 + Q(moment) * (Q(radius) * Q(turned)) ** 2
    assert abs(after - energy) <= 64 * ULP * energy

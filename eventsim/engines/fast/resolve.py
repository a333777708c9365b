"""Contacts are resolved: one pair, or one disk and a wall.  Contacts that share a time go to the reference engine's rules."""

from __future__ import annotations

import math

from eventsim.engines.fast.advance import anchor, place, pulls, speed
from eventsim.engines.fast.compiled import inline, part, real, store, word
from eventsim.engines.fast.last_contact import just_met, remember, unwrapped_x, unwrapped_y
from eventsim.engines.fast.layout import (
    AT_ONCE,
    CONTACT_TIME,
    LABEL,
    MET,
    OUTER_X,
    OUTER_Y,
    OWN_OF_WALL,
    RADIUS,
    REALS,
    SHAKING,
    SHARE,
    SLIDE,
    TEMPERATURE,
    VX,
    VY,
    WALL,
    WORDS,
    T,
    X,
    Y,
)
from eventsim.engines.fast.pairs import image, pair_is_due, shift
from eventsim.engines.fast.rest import is_support, launched, support_face
from eventsim.engines.fast.rows import write_pair, write_spins, write_wall
from eventsim.engines.fast.shapes import CENTER, WIDTH, is_exact_hit, laid_on_shape, shape_normal, wall_normal
from eventsim.engines.fast.sides import NOWHERE, keep_sides
from eventsim.formulas.careful_impulse import careful_flat_update, careful_pair_update, careful_wall_update
from eventsim.formulas.chance import flux
from eventsim.formulas.doubt import AT_ONCE as SERIES_AT_ONCE
from eventsim.formulas.doubt import is_still, outruns_clock
from eventsim.formulas.impulse import (
    along,
    approach_speed,
    contact_restitution,
    flat_update,
    heated,
    mass_fractions,
    pair_update,
    reduced_mass,
    wall_impulse,
    wall_update,
)
from eventsim.formulas.real import sqrt
from eventsim.formulas.rest import rebound
from eventsim.formulas.rough import grip_strength, gripped, heated_spin, pair_grip, wall_grip
from eventsim.formulas.walls.face import face_normal
from eventsim.formulas.walls.point import is_still_rising


@inline
def _mass_of(m, rules, i):
    return rules.common_mass if m.mass is None else real(m.mass, i)


@inline
def _shares(m, a, b):
    if m.mass is None:
        return 0.5, 0.5
    return mass_fractions(real(m.mass, a), real(m.mass, b))


@inline
def _reduced(m, rules, a, b):
    if m.mass is None:
        return 0.5 * rules.common_mass
    return reduced_mass(real(m.mass, a), real(m.mass, b))


@inline
def _restitution(m, rules, a, b, t, usual, approach, mass):
    """What the law makes of the usual restitution."""
    since_a, since_b = t - real(m.disks, a * REALS + CONTACT_TIME), t - real(m.disks, b * REALS + CONTACT_TIME)
    return contact_restitution(usual, rules.law, since_a, since_b, approach, mass)


@inline
def _approach_of_pair(m, rules, a, b, t, dx, dy):
    """The speed at which two disks (dx, dy) apart meet; 0 where the law does not ask."""
    if rules.by_speed is None:
        return 0.0
    ua, wa = speed(m, rules, a, t)
    ub, wb = speed(m, rules, b, t)
    return approach_speed(dx, dy, ua - ub, wa - wb)


@inline
def _approach_to_wall(m, rules, i, place_, side, x, y, u, w, u0, w0):
    """The same of a disk and a wall."""
    if rules.by_speed is None:
        return 0.0
    nx, ny = _towards(m, rules, i, place_, side, x, y, u0, w0)
    return approach_speed(nx, ny, u, w)


@inline
def _towards(m, rules, i, place_, side, x, y, u, w):
    """The normal of the wall that disk i meets; where a point hits a post, against its velocity."""
    if _hits_a_post(m, rules, i, place_):
        return (0.0, 1.0) if u == 0.0 and w == 0.0 else (-u, -w)
    return wall_normal(m, rules, place_, side, x, y)


@inline
def _restitution_of_pair(m, rules, a, b, t, dx, dy):
    """The restitution of two disks (dx, dy) apart."""
    usual = rules.pair_restitution
    if m.species is not None:
        usual = real(m.pairs, 1 + int(real(m.pairs, 0)) * word(m.species, a) + word(m.species, b))
    if rules.law is None:
        return usual
    approach = _approach_of_pair(m, rules, a, b, t, dx, dy)
    return _restitution(m, rules, a, b, t, usual, approach, _reduced(m, rules, a, b))


@inline
def _restitution_at_wall(m, rules, i, t, place_, side, x, y, u, w, u0, w0):
    """The restitution of a disk at a wall; (u0, w0): its velocity, (u, w): as the wall sees it."""
    usual = rules.wall_restitution if m.shares is None else real(m.shares, OWN_OF_WALL * place_ + SHARE)
    if rules.law is None:
        return usual
    approach = _approach_to_wall(m, rules, i, place_, side, x, y, u, w, u0, w0)
    return _restitution(m, rules, i, i, t, usual, approach, _mass_of(m, rules, i))


@part
def is_unlawful(m, rules, i, code, t):
    """Whether a law of the user's own has no restitution for a contact that can be: the reference engine's rules tell why."""
    if code <= WALL:
        wall_code = WALL - code
        x, y = place(m, rules, i, t)
        u0, w0 = speed(m, rules, i, t)
        place_, side = wall_code // 2, -1 if wall_code % 2 else 1
        u, w = u0, w0
        if rules.driven is not None:
            u, w = _from_wall(m, rules, i, place_, side, x, y, u0, w0, -1.0, u0, w0)
        e = _restitution_at_wall(m, rules, i, t, place_, side, x, y, u, w, u0, w0)
        approach = _approach_to_wall(m, rules, i, place_, side, x, y, u, w, u0, w0)
    else:
        a, b = (i, code) if m.mass is None else _in_order(m, i, code)
        xa, ya = place(m, rules, a, t)
        xb, yb = place(m, rules, b, t)
        dx, dy = xa - xb, ya - yb
        kx, ky = _image_met(m, rules, a, b, t, dx, dy, m.slots)
        dx, dy = dx - shift(kx, rules.length_x), dy - shift(ky, rules.length_y)
        e = _restitution_of_pair(m, rules, a, b, t, dx, dy)
        approach = _approach_of_pair(m, rules, a, b, t, dx, dy)
    return not 0.0 <= e < math.inf or outruns_clock(e * approach, t, rules.own)


@inline
def _hits_a_post(m, rules, i, place_):
    """Whether disk i is a point, and that wall a post."""
    if m.features is None:
        return False
    if place_ < rules.first_feature:
        return False
    return is_exact_hit(m, place_ - rules.first_feature, real(m.disks, i * REALS + RADIUS))


@inline
def _is_still(m, rules, i, t):
    """Whether disk i has not come further, since its flight began, than the last bits of its place, where disks settle."""
    f = i * REALS
    x, y = place(m, rules, i, t)
    u, w = speed(m, rules, i, t)
    return is_still(x, y, real(m.disks, f + VX), real(m.disks, f + VY), u, w, t - real(m.disks, f + T), rules.still)


@inline
def _note_time(m, rules, i, t, idle, still, instant):
    """Note a contact of disk i, to see that an instant does not end; idle ones, which change nothing, weigh more.

    instant: the share of the clock within which contacts are at one instant.
    """
    weight = rules.at_once_limit // 3 + 1 if idle else 1
    if still or t - real(m.disks, i * REALS + CONTACT_TIME) <= instant * t:
        weight += word(m.disks, i * WORDS + AT_ONCE)
    store(m.disks, i * WORDS + AT_ONCE, weight)
    store(m.disks, i * REALS + CONTACT_TIME, t)


@inline
def _book_pair(m, sums, a, b, jx, jy):
    """Note the momentum that an immovable disk gave to the other one; (jx, jy) is what a received."""
    if math.isinf(real(m.mass, b)):
        sums[OUTER_X] += jx
        sums[OUTER_Y] += jy
    elif math.isinf(real(m.mass, a)):
        sums[OUTER_X] -= jx
        sums[OUTER_Y] -= jy


@inline
def _is_finite(m, i):
    return 0.0 < real(m.mass, i) < math.inf


@inline
def _in_order(m, i, j):
    """The disks of a pair, the smaller label first; where all masses are alike nobody can tell."""
    swap = word(m.disks, j * WORDS + LABEL) < word(m.disks, i * WORDS + LABEL)
    return (j if swap else i), (i if swap else j)


@inline
def _image_met(m, rules, a, b, t, dx, dy, clear):
    """The image in which two disks that are (dx, dy) apart meet at time t; clear: it is the nearest one."""
    if rules.length_x is None and rules.length_y is None:
        return 0, 0
    if clear is None:
        return _image_due(m, rules, a, b, t)
    return image(dx, rules.length_x), image(dy, rules.length_y)


@part
def _image_due(m, rules, a, b, t):
    """The same in a box too small for cells, where several images can be equally near: the one that is due."""
    span_x = 0 if rules.length_x is None else 1
    span_y = 0 if rules.length_y is None else 1
    for kx in range(-span_x, span_x + 1):
        for ky in range(-span_y, span_y + 1):
            if pair_is_due(m, rules, a, b, kx, ky) == t:
                return kx, ky
    return 0, 0


@inline
def resolve_pair(m, rules, sums, i, j, t, clock, number, slot, posts):
    """Resolve the contact of disks i and j at time t; its overlap in reaches."""
    a, b = (i, j) if m.mass is None else _in_order(m, i, j)
    xa, ya = place(m, rules, a, t)
    xb, yb = place(m, rules, b, t)
    dx, dy = xa - xb, ya - yb
    clear = None if m.slots is None and posts is None else 1  # else several images of a disk can be equally near
    kx, ky = _image_met(m, rules, a, b, t, dx, dy, clear)
    dx, dy = dx - shift(kx, rules.length_x), dy - shift(ky, rules.length_y)
    still = False
    if rules.still is not None and not just_met(m, a, b, kx, ky):  # of those who have, bounces are exact however low
        still = _is_still(m, rules, a, t) and _is_still(m, rules, b, t)
    ua, wa, ub, wb, q = _parted(m, rules, a, b, t, dx, dy)
    k = 0.0
    if rules.pair_roughness is not None:
        ua, wa, ub, wb, k = _turned(m, rules, a, b, t, dx, dy, ua, wa, ub, wb)
    if m.sides is not None:
        keep_sides(m, rules, a, t, pulls(m, rules, a), xa, ya, ua, wa, NOWHERE, 0)
        keep_sides(m, rules, b, t, pulls(m, rules, b), xb, yb, ub, wb, NOWHERE, 0)
    anchor(m, a, t, xa, ya, ua, wa)
    anchor(m, b, t, xb, yb, ub, wb)
    ux, uy = unwrapped_x(m, a, b, kx), unwrapped_y(m, a, b, ky)
    remember(m, a, b, ux, uy)
    remember(m, b, a, -ux, -uy)
    _note_time(m, rules, a, t, q == 0.0, still, rules.instant)
    _note_time(m, rules, b, t, q == 0.0, still, rules.instant)
    if m.contacts is not None:
        _count(m, a)
        _count(m, b)
    reduced = _reduced(m, rules, a, b)
    distance = sqrt(dx * dx + dy * dy)
    reach = real(m.disks, a * REALS + RADIUS) + real(m.disks, b * REALS + RADIUS)
    overlap = (reach - distance) / reach
    jx, jy, strength = -(q * reduced) * dx, -(q * reduced) * dy, -(q * reduced) * distance
    if rules.pair_roughness is not None:
        jx, jy, strength = jx + (k * reduced) * dy, jy - (k * reduced) * dx, grip_strength(q, k, reduced, distance)
    if m.mass is not None:
        _book_pair(m, sums, a, b, jx, jy)
    flight_a, flight_b = (xa, ya, ua, wa), (xb, yb, ub, wb)
    write_pair(m, number, slot, a, b, flight_a, flight_b, strength, t, clock)
    if m.spin_rows is not None:
        write_spins(m, slot, a, b)
    return overlap if m.mass is None or (_is_finite(m, a) and _is_finite(m, b)) else 0.0


@inline
def _count(m, i):
    """Count a contact of disk i, where chance hangs on the number of contacts."""
    store(m.contacts, i, word(m.contacts, i) + 1)


@inline
def _parted(m, rules, a, b, t, dx, dy):
    """The velocities of a pair after contact, and q; low parts are set."""
    e = _restitution_of_pair(m, rules, a, b, t, dx, dy)
    if m.low is not None:
        return _carefully_parted(m, a, b, dx, dy, e)
    ua, wa = speed(m, rules, a, t)
    ub, wb = speed(m, rules, b, t)
    share_a, share_b = _shares(m, a, b)
    return pair_update(dx, dy, ua, wa, ub, wb, share_a, share_b, e)


@inline
def _turned(m, rules, a, b, t, dx, dy, ua, wa, ub, wb):
    """The velocities of a pair, which are those of smooth disks after the contact, and k as from `pair_grip`; spins are set."""
    ua0, wa0 = speed(m, rules, a, t)
    ub0, wb0 = speed(m, rules, b, t)
    share_a, share_b = _shares(m, a, b)
    radius_a, radius_b = real(m.disks, a * REALS + RADIUS), real(m.disks, b * REALS + RADIUS)
    i, j = 2 * a, 2 * b
    spin_a, spin_b, moment_a, moment_b = real(m.spin, i), real(m.spin, j), real(m.spin, i + 1), real(m.spin, j + 1)
    about = (share_a, share_b, radius_a, radius_b, moment_a, moment_b, rules.pair_roughness)
    spin_a, spin_b, k = pair_grip(dx, dy, ua0 - ub0, wa0 - wb0, spin_a, spin_b, *about)
    store(m.spin, i, spin_a)
    store(m.spin, j, spin_b)
    ua, wa, ub, wb = gripped(dx, dy, ua, wa, ub, wb, share_a, share_b, k)
    return ua, wa, ub, wb, k


@inline
def _slid(m, rules, i, place_, side, x, y, u, w):
    """What roughness makes of the velocity of disk i, which comes with (u, w), besides the normal part; its spin is set."""
    if math.isinf(_mass_of(m, rules, i)):
        return 0.0, 0.0
    if rules.driven is not None and real(m.shares, OWN_OF_WALL * place_ + TEMPERATURE) != 0.0:
        return 0.0, 0.0  # nothing grips where a wall draws velocities
    nx, ny = wall_normal(m, rules, place_, side, x, y)
    if rules.driven is not None:
        u, w = _over_wall(m, place_, side, nx, ny, u, w)
    radius, moment = real(m.disks, i * REALS + RADIUS), real(m.spin, 2 * i + 1)
    spin, k = wall_grip(nx, ny, u, w, real(m.spin, 2 * i), radius, moment, rules.wall_roughness)
    store(m.spin, 2 * i, spin)
    return k * ny, k * nx


@inline
def _over_wall(m, place_, side, nx, ny, u, w):
    """A velocity, as seen from a wall that slides along itself."""
    velocity = real(m.shares, OWN_OF_WALL * place_ + SLIDE)
    if velocity == 0.0:
        return u, w
    slide_x, slide_y = along(ny, -nx, side * velocity)
    return u - slide_x, w - slide_y


@part
def _carefully_parted(m, a, b, dx, dy, e):
    f, g, i, j = a * REALS, b * REALS, 2 * a, 2 * b
    ua, wa, ub, wb = real(m.disks, f + VX), real(m.disks, f + VY), real(m.disks, g + VX), real(m.disks, g + VY)
    ea, fa, eb, fb = real(m.low, i), real(m.low, i + 1), real(m.low, j), real(m.low, j + 1)
    masses = real(m.mass, a), real(m.mass, b)
    ua, wa, ub, wb, ea, fa, eb, fb, q = careful_pair_update(dx, dy, ua, wa, ub, wb, ea, fa, eb, fb, *masses, e)
    store(m.low, i, ea)
    store(m.low, i + 1, fa)
    store(m.low, j, eb)
    store(m.low, j + 1, fb)
    return ua, wa, ub, wb, q


@part
def resolve_wall(m, rules, sums, i, code, t, clock, number, slot):
    """Resolve the contact of disk i with the wall that the code of the event stands for."""
    wall_code = WALL - code
    place_, side = wall_code // 2, -1 if wall_code % 2 else 1
    x, y = place(m, rules, i, t)
    u, w = speed(m, rules, i, t)
    u0, w0 = u, w
    came_x, came_y = x, y
    if rules.driven is not None:
        u, w = _from_wall(m, rules, i, place_, side, x, y, u, w, -1.0, u0, w0)
    settles = m.supports is not None and is_support(m, place_)  # a series on this wall comes to an end
    low_is_exact = rules.still is not None or settles
    series = low_is_exact and word(m.disks, i * WORDS + MET) == -1 - place_
    still = rules.still is not None and not series and _is_still(m, rules, i, t)
    ends = series and settles
    e = _restitution_at_wall(m, rules, i, t, place_, side, x, y, u, w, u0, w0)
    r = real(m.disks, i * REALS + RADIUS)
    du = dw = 0.0
    if rules.wall_roughness is not None:
        du, dw = _slid(m, rules, i, place_, side, x, y, u0, w0)
    if rules.wall_x is not None and rules.wall_x <= place_ < rules.wall_x + 2:
        x = rules.width - r if side < 0 else r
        u = _across(m, 2 * i, u, float(side), e)
        wall = place_
    elif rules.wall_y is not None and rules.wall_y <= place_ < rules.wall_y + 2:
        y = rules.height - r if side < 0 else r
        w = _across(m, 2 * i + 1, w, float(side), e)
        wall = place_
    elif m.features is not None:
        k = place_ - rules.first_feature
        x, y, u, w = _in_velocity(m, rules, i, k, side, x, y, u, w, e)
        wall = int(real(m.features, WIDTH * k + 1))
        if low_is_exact:  # on contact but for the last bits
            x, y = laid_on_shape(m, k, side, x, y, r)
    else:
        wall = -1  # there is no other wall
    if m.supports is not None:
        u, w = _rebound_again(m, rules, i, place_, side, u0, w0, u, w, e)
    if rules.wall_roughness is not None:
        u, w = u + du, w - dw
    if rules.driven is not None:
        u, w = _from_wall(m, rules, i, place_, side, came_x, came_y, u, w, 1.0, u0, w0)
    if rules.driven is not None and rules.seed is not None:
        u, w = _heated(m, rules, i, place_, side, came_x, came_y, u, w, u0, w0)
    if m.sides is not None:
        keep_sides(m, rules, i, t, pulls(m, rules, i), x, y, u, w, place_, side)
    anchor(m, i, t, x, y, u, w)
    remember(m, i, -1 - place_, side, 0)
    _note_time(m, rules, i, t, u == u0 and w == w0, still, SERIES_AT_ONCE if ends else rules.instant)
    if m.contacts is not None:
        _count(m, i)
    mass = _mass_of(m, rules, i)
    if not math.isinf(mass):
        sums[OUTER_X] += mass * (u - u0)
        sums[OUTER_Y] += mass * (w - w0)
    write_wall(m, number, slot, i, wall, (x, y, u, w), wall_impulse(mass, u - u0, w - w0), t, clock)
    if m.spin_rows is not None:
        write_spins(m, slot, i, -1)


@inline
def _from_wall(m, rules, i, place_, side, x, y, u, w, sign, u0, w0):
    """A velocity, with that of a wall that shakes added to it, or taken away."""
    speed_ = real(m.shares, OWN_OF_WALL * place_ + SHAKING)
    if speed_ == 0.0:
        return u, w
    nx, ny = _towards(m, rules, i, place_, side, x, y, u0, w0)
    shift_x, shift_y = along(nx, ny, speed_)
    return u + sign * shift_x, w + sign * shift_y


@part
def _heated(m, rules, i, place_, side, x, y, u, w, u0, w0):
    """The velocity that a wall that heats draws; another wall leaves it as it is."""
    temperature = real(m.shares, OWN_OF_WALL * place_ + TEMPERATURE)
    if temperature == 0.0:
        return u, w
    out, sideways, other = flux((rules.seed, word(m.disks, i * WORDS + LABEL), word(m.contacts, i)))
    mass = _mass_of(m, rules, i)
    if m.spin is not None:
        radius, moment = real(m.disks, i * REALS + RADIUS), real(m.spin, 2 * i + 1)
        store(m.spin, 2 * i, heated_spin(other, temperature, mass, radius, moment))
    nx, ny = _towards(m, rules, i, place_, side, x, y, u0, w0)
    return heated(nx, ny, out, sideways, temperature, mass, side * real(m.shares, OWN_OF_WALL * place_ + SLIDE))


@part
def _rebound_again(m, rules, i, place_, side, u0, w0, u, w, e):
    """The velocity after contact: e times as fast as the disk left the wall, if that is straight and what it met last.

    u0, w0: before the contact; u, w: after it, for another wall.
    """
    if not is_support(m, place_):
        return u, w
    nx, ny = face_normal(support_face(m, place_), side, 0.0, 0.0)
    again = launched(m, rules, i, place_, side, nx, ny)
    return rebound(nx, ny, u0, w0, e * again) if again > 0.0 else (u, w)


@inline
def _across(m, place_, v, side, e):
    """The component across a wall of the domain after a contact; its low part, if it has one, is set."""
    if m.low is None or not side * v < 0.0:
        return flat_update(v, side, e)[0]
    after, rest = careful_flat_update(v, real(m.low, place_), e)
    store(m.low, place_, rest)
    return after


@inline
def _in_velocity(m, rules, i, k, side, x, y, u, w, e):
    """The place and velocity of a disk after contact with the k-th shape; low parts are set."""
    if is_exact_hit(m, k, real(m.disks, i * REALS + RADIUS)):
        return _turned_round(m, rules, i, k, u, w, e)
    nx, ny = shape_normal(m, k, side, x, y)
    if m.low is None:
        u, w, _ = wall_update(nx, ny, u, w, e)
    else:
        u, w, low_x, low_y, _ = careful_wall_update(nx, ny, u, w, real(m.low, 2 * i), real(m.low, 2 * i + 1), e)
        store(m.low, 2 * i, low_x)
        store(m.low, 2 * i + 1, low_y)
    return x, y, u, w


@part
def _turned_round(m, rules, i, k, u, w, e):
    """The same for a point that hits a post."""
    f, s = i * REALS, WIDTH * k
    x, y = real(m.features, s + CENTER), real(m.features, s + CENTER + 1)
    gx, gy = pulls(m, rules, i)
    if is_still_rising(real(m.disks, f + X), real(m.disks, f + Y), gx, gy, x, y, u, w):
        return x, y, u, w
    if m.low is not None:
        store(m.low, 2 * i, -(e * real(m.low, 2 * i)))
        store(m.low, 2 * i + 1, -(e * real(m.low, 2 * i + 1)))
    return x, y, -(e * u), -(e * w)

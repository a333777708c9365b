"""What a contact does where masses are very uneven: velocities carry what their rounding left, in low parts.

A light disk between a heavy one and a wall ends, after pi sqrt(M/m) contacts, far slower than it was in between, and the
rounding of all its velocities, each relative to the highest speed, is then much of what is left.  So a velocity is the
unrounded sum of two floats: the high part is the rounded velocity, with which disks fly, the low part at most 2**-53 of it.

The change of the relative velocity v is P = p + s p: p = 2 d (d.v)/d^2 in plain floats, s = p.(2v - p)/p^2.  So P.(2v - P) = 0,
which keeps the energy however p was rounded.  Only p.(2v - p), which cancels, needs error-free products.  With restitution e the
change is the part (1 + e) / 2 of that, unrounded too.  The heavier disk takes its share of it, the lighter one the rest, which
keeps the momentum.

Source: T. J. Dekker, Numer. Math. 18, 224 (1971), doi:10.1007/BF01397083.
"""

import math

from eventsim.formulas.expansion import two_product, two_sum
from eventsim.formulas.impulse import LEAST, MOST


def careful_pair_update(
    dx: float,
    dy: float,
    ua: float,
    wa: float,
    ub: float,
    wb: float,
    ea: float,
    fa: float,
    eb: float,
    fb: float,
    mass_a: float,
    mass_b: float,
    restitution: float,
) -> tuple[float, float, float, float, float, float, float, float, float]:
    """(u_a, w_a, u_b, w_b, e_a, f_a, e_b, f_b, q) after contact of two disks at d = a - b; q as in `pair_update`.

    e, f: the low parts of u, w.  A pair that does not approach is left as it is, q = 0.  Exchange of the disks changes no bit.
    """
    u, e = two_sum(ua, -ub)
    w, f = two_sum(wa, -wb)
    if not dx * u + dy * w < 0.0:
        return ua, wa, ub, wb, ea, fa, eb, fb, 0.0
    px, py, sx, sy, q = _change(dx, dy, u, w, e + (ea - eb), f + (fa - fb), restitution)
    share, share_rest = _lighter_share(min(mass_a, mass_b), max(mass_a, mass_b))
    hx, hx_rest = two_product(share, px)
    hy, hy_rest = two_product(share, py)
    hx_rest, hy_rest = hx_rest + (share * sx + share_rest * px), hy_rest + (share * sy + share_rest * py)
    lx, lx_rest = two_sum(px, -hx)
    ly, ly_rest = two_sum(py, -hy)
    lx_rest, ly_rest = lx_rest + (sx - hx_rest), ly_rest + (sy - hy_rest)
    if mass_a <= mass_b:
        ua, ea = _sum(ua, ea, -lx, -lx_rest)
        wa, fa = _sum(wa, fa, -ly, -ly_rest)
        ub, eb = _sum(ub, eb, hx, hx_rest)
        wb, fb = _sum(wb, fb, hy, hy_rest)
    else:
        ua, ea = _sum(ua, ea, -hx, -hx_rest)
        wa, fa = _sum(wa, fa, -hy, -hy_rest)
        ub, eb = _sum(ub, eb, lx, lx_rest)
        wb, fb = _sum(wb, fb, ly, ly_rest)
    return ua, wa, ub, wb, ea, fa, eb, fb, q


def careful_wall_update(
    nx: float, ny: float, u: float, w: float, e: float, f: float, restitution: float
) -> tuple[float, float, float, float, float]:
    """(u, w, e, f, q) after contact with a wall whose normal, of any length, points to the disk; q as in `wall_update`.

    Where contacts are elastic a normal along an axis reverses exactly.  A disk that does not approach is left as it is, q = 0.
    """
    if not nx * u + ny * w < 0.0:
        return u, w, e, f, 0.0
    if ny == 0.0:
        after, e = careful_flat_update(u, e, restitution)
        return after, w, e, f, (1.0 + restitution) * (u / nx)
    if nx == 0.0:
        after, f = careful_flat_update(w, f, restitution)
        return u, after, e, f, (1.0 + restitution) * (w / ny)
    px, py, sx, sy, q = _change(nx, ny, u, w, e, f, restitution)
    u, e = _sum(u, e, -px, -sx)
    w, f = _sum(w, f, -py, -sy)
    return u, w, e, f, q


def careful_flat_update(v: float, low: float, restitution: float) -> tuple[float, float]:
    """(v, low) of the component across a wall along an axis, after a contact: -e times the unrounded sum of both."""
    after, rest = two_product(restitution, v)
    return two_sum(-after, -(rest + restitution * low))


def _change(
    dx: float, dy: float, u: float, w: float, e: float, f: float, restitution: float
) -> tuple[float, float, float, float, float]:
    """(p_x, p_y, s p_x, s p_y, q): what is taken off the relative velocity v = (u + e, w + f) along d."""
    q = 2.0 * ((dx * u + dy * w) / (dx * dx + dy * dy))
    px, py = q * dx, q * dy
    s = _excess(px, py, u, w, e, f)
    part, part_rest = two_sum(0.5, 0.5 * restitution)
    x, x_rest = two_product(part, px)
    y, y_rest = two_product(part, py)
    return x, y, x_rest + (part_rest * px + part * (s * px)), y_rest + (part_rest * py + part * (s * py)), part * q


def _excess(px: float, py: float, u: float, w: float, e: float, f: float) -> float:
    """s = p.(2v - p)/p^2; 0 where the square of p is no float to the last bit."""
    square = px * px + py * py
    if not LEAST < square < MOST:
        return 0.0
    x, x_rest = two_sum(2.0 * u, -px)
    y, y_rest = two_sum(2.0 * w, -py)
    along_x, fine_x = two_product(px, x)
    along_y, fine_y = two_product(py, y)
    along, fine = two_sum(along_x, along_y)
    fine = fine + ((fine_x + fine_y) + (px * (x_rest + 2.0 * e) + py * (y_rest + 2.0 * f)))
    share: float = (along + fine) / square
    return share


def _lighter_share(lighter: float, heavier: float) -> tuple[float, float]:
    """lighter / (lighter + heavier) as an unrounded sum; 0 for a tracer, and beside an immovable disk."""
    if lighter == 0.0 or math.isinf(heavier):
        return 0.0, 0.0
    total, rest = two_sum(lighter, heavier)
    share = lighter / total
    product, fine = two_product(share, total)
    return share, (((lighter - product) - fine) - share * rest) / total


def _sum(high: float, low: float, more: float, rest: float) -> tuple[float, float]:
    """Two unrounded sums added, the high part rounded to nearest."""
    total, error = two_sum(high, more)
    return two_sum(total, error + (low + rest))

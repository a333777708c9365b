"""When two disks meet: the delay until the gap of a pair in straight relative flight closes."""

from eventsim.formulas.real import NEVER, Real, sqrt


def pair_delay(dx: Real, dy: Real, du: Real, dw: Real, reach: Real) -> Real:
    """The delay until two disks at relative position (dx, dy) with relative velocity (du, dw) are `reach` apart.

    Signs before numbers: b = d.v >= 0, they recede: NEVER; they overlap and approach: now; then
    D = a reach^2 - (d x v)^2 decides hit or miss (Lagrange's identity: equal to b^2 - a c, but free of its cancellation
    far away and at a graze), and t = c / (sqrt D - b).  Exchange of the two disks changes no bit of it.

    Source: Bannerman, Strobl, Formella, Poeschel, Comp. Part. Mech. 1, 191 (2014), doi:10.1007/s40571-014-0021-8.
    """
    b = dx * du + dy * dw
    if not b < 0.0:
        return NEVER
    reach2 = reach * reach
    c = (dx * dx + dy * dy) - reach2
    if not c > 0.0:
        return 0.0
    cross = dx * dw - dy * du
    discriminant = (du * du + dw * dw) * reach2 - cross * cross
    if not discriminant > 0.0:
        return NEVER
    return c / (sqrt(discriminant) - b)

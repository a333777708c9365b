"""What rounding leaves of times, gaps and flights: all decisions within the last bits ask here.

A contact time is a gap over the speed at which it closes.  The gap is a difference of places, and each of these is rounded.  So
a contact time is known to about (last bits of the places) / (closing speed), and to a last bit of the clock.  Nearer to each
other, only exact arithmetic tells which of two contacts comes first.  A gap may have sunk to the last bits of its places.
Flights may be so short that rounding alone keeps them up; contacts behind such flights are at one instant.
"""

from typing import Any

from eventsim.formulas.clock import FIRST_WINDOW, window_length
from eventsim.formulas.real import NEVER, Real

UNIT = 2.0**-53
"""The relative error of one rounding to nearest."""

ROUNDINGS = 32.0
"""Roundings in two contact times, with room.

A coordinate apart carries those of two products u lag, two sums x + u lag, the lag, the shift and the difference: at most seven
halves of a last bit.  There are two coordinates, c and D round a few times more, and two times are compared.
"""

SLOW = 2.0**-12
"""Contacts that close at this part of the slowest disk's speed, or faster, are within the screen."""

GLANCES = 2.0**-12
"""The screen is at most this part of the mean time between two events of the scene: so a second look costs nothing."""

AT_ONCE = 2.0**-48
"""Events closer than this part of the clock are at one instant: a few of its last bits."""

ROUNDED = 2.0**-52
"""What rounding may do to the speed across a slanted wall, as a part of the components that it is calculated from."""

NO_SPEED = 8.0
"""A speed across a wall, or along it, of no more than so many roundings of its terms (`rounding_of`) is none."""

FLOORS = 32.0
"""A series is cut so many times above the speed that rounding may keep up, which is ROUNDED / (1 - e): the errors of all the
bounces before are then a few per cent of the last one."""

LEAST_LOSS = 2.0**-20
"""The least 1 - e with which that speed is reckoned: a series that takes millions of bounces is not cut early."""

LONGEST_INSTANT, LONGEST_STILL = 2.0**-32, 2.0**-30
"""The most that counts as one instant of the clock, and as no way in coordinates, however little is lost at a contact."""

TOUCHING = 2.0**-48
"""A gap is rounding below this part of the coordinates: 16 units in their last place, as for disks that touch at the start."""


SLACK = 2.0**-48
"""A foot this part of the coordinates beyond an end without a post is still on the wall: 16 units in the last place.  So rounding
lets no disk through where one wall goes on in another one; a post is met so much before its walls end."""

CLOCK_BITS = 1.0 + 2.0**-50
"""What the clock rounds: 4 to 8 units in the last place of a contact time; each is right to about two."""

OUTRUN = 2.0**26
"""A disk that comes so many times through all places in a time of the clock is too fast for it: a last bit of that time moves it
by 2**-27 of them.  At the start it is some tens."""

GAP_ROUNDINGS = 4.0
"""Roundings in a gap: a place x + v lag has one of the lag, one of the product, one of the sum; the difference is one more."""

CLOCK_ROUNDINGS = 2.0
"""Roundings in the time of a contact: the delay's last bit, and the sum."""

FAR = 64.0
"""Distances in reaches from which on a contact time of round things is careful (`contact.DIGITS_LOST`)."""

BELOW = 2.0**-50
"""A gap that is a smaller part of the places it is the difference of is below the digits: four to eight of their last bits.

Each of two places is rounded where its flight begins and where the gap is looked at, and the contact before was off by as much.
"""

SLOWLY = 2.0**-30
"""A flight of more than this part of an epoch is slow: contact times are to be right to 1e-9, however badly a gap is known."""

LARGEST_PILE = 2.0**-42
"""The most that errors are taken to pile up to, as a part of the places: a gap of that size is hardly slow to close in a gas."""


def rounding_of(one: Any, other: Any) -> Any:
    """What rounding may do to a speed across a wall, or along it, that is the sum of two products."""
    return ROUNDED * (abs(one) + abs(other))


def contact_doubt(size: Real, approach: Real, bend: Real, time: Real) -> Real:
    """How far a computed contact time may be from the exact one of the two flights; NEVER where even the contact is in doubt.

    The gap is known to E = GAP_ROUNDINGS * UNIT * size.  A time s before the contact it is at least approach * s - bend s^2 / 2.
    So it is E, or -E, within s <= (E / approach) (1 + z) with z = 2 bend E / approach^2 < 1, as 1 - sqrt(1 - z) <= z (1 + z) / 2.

    Args:
        size: the sum of all numbers that the gap is made of, length: coordinates, ways, reach, shifts (`round_size` for round
            things); 0 where careful arithmetic took the flights as they are.
        approach: the speed at which the gap closes at the contact.
        bend: a bound of the second derivative of the gap: of round things speed^2 / reach, of a fall its acceleration.
        time: the clock's remainder at the contact.
    """
    gap = GAP_ROUNDINGS * UNIT * size
    square, bent = approach * approach, 2.0 * bend * gap
    if not bent < square:
        return NEVER
    return (gap / approach) * (1.0 + bent / square) + CLOCK_ROUNDINGS * UNIT * time


def round_size(places: Real, distance: Real, reach: Real, way: Real) -> Real:
    """The `size` of a contact of round things.

    The discriminant a reach^2 - (d x v)^2 is rounded to last bits of a d^2.  So the gap is known to last bits of d^2 / reach,
    until the careful formula takes over.

    Args:
        places: the sum of all coordinates, shifts and ways flown until the prediction, of both.
        distance: of the centres, at the prediction.
        reach: of the contact, above 0.
        way: relative speed times delay.
    """
    far = distance / reach
    return places + 2.0 * distance + reach + way + distance * (far if far < FAR else FAR)


def piled_up(loss: float) -> float:
    """The part of its places above which a gap of a losing series is known to some per cent.

    Each contact leaves a last bit or two in a gap.  It turns errors round with the velocities, so e of them is left: they pile
    up to 1 / (1 - e) of one.  Gaps shrink faster than that: so the last ones are known worst.  Twice that leaves the order sure.

    loss: 1 - e; 0 where nothing is lost, and nothing piles up to be feared.
    """
    return min(2.0 * BELOW / loss, LARGEST_PILE) if loss > 0.0 else BELOW


def is_sunk(approach: Real, lag: Real, size: Real, pile: float, slowly: float) -> Real:
    """Whether the gap that closed at speed `approach` for a time `lag` was one of the last bits of places of that size.

    What closed at once was no open gap.  A flight that is not slow is right to last bits of the clock however badly its gap is
    known, as long as the order is: so nearly simultaneous contacts in a gas end no run.

    Args:
        approach: the speed at which the gap closed.
        lag: for so long.
        size: of what the gap is a difference of.
        pile: `piled_up` of the scene.
        slowly: SLOWLY of its epoch.
    """
    gap = approach * lag
    return (lag > 0.0) & ((gap <= BELOW * size) | ((lag > slowly) & (gap <= pile * size)))


def outruns_clock(speed: Real, time: Real, size: Real) -> Real:
    """Whether a disk has become too fast for the clock, in whose window it is, under a law that may give energy.

    Args:
        speed: at which it parts from what it meets.
        time: the clock's remainder at that contact.
        size: of the places of the scene.
    """
    return not speed * time <= OUTRUN * size


def is_too_small(reach: Real, place: Real) -> Real:
    """Whether places of that size cannot tell on which side two disks of that reach meet: it is below their last bits."""
    return reach <= BELOW * place


def tie_screen(size: float, slowest: float, between: float) -> float:
    """The span of time within which contacts that share a disk are ordered exactly.

    Wider than it needs to be, it only makes engines look twice.

    Args:
        size: the sum of the largest coordinates that gaps are differences of, a length.
        slowest: the lowest speed of a moving disk; 0 where none moves at the start.
        between: about the mean time between two events of the scene.
    """
    most = GLANCES * between
    if not slowest > 0.0:
        return most
    least = ROUNDINGS * UNIT * (size / SLOW / slowest)
    return least if least < most else most


def screen_in(screen: float, length: float, epoch_length: float) -> float:
    """The screen in a window of that length: longer ones mean a slower pace, at which times are known less well."""
    first = window_length(FIRST_WINDOW, epoch_length)
    return screen * (length / first) if length > first else screen


def latest_tie(time: Real, screen: float) -> Real:
    """The latest time of a contact that may still come before one at `time`, or together with it."""
    return time * CLOCK_BITS + screen


def may_tie(one: Real, other: Real, screen: float) -> Real:
    """Whether two contact times are so close that their order has to be looked at exactly; without a branch."""
    return max(one, other) <= latest_tie(min(one, other), screen)


def kept_up_instant(loss: float) -> float:
    """The share of the clock within which flights may be kept up by its rounding: ROUNDED / (1 - e), and FLOORS above it.

    loss: 1 - e.  The end of a flight is rounded, and with it the speed there; that is lost again in 1 / (1 - e) bounces.
    """
    return min(FLOORS * ROUNDED / loss, LONGEST_INSTANT)


def kept_up_way(loss: float) -> float:
    """The way, as a part of the coordinates, of flights that the rounding of places may keep up, and FLOORS above it in time.

    A place known to u, its last bit, leaves the energy of a fall from u: so bounces last sqrt(2 u / (a (1 - e))), a t^2 long.
    """
    return min(FLOORS * FLOORS * 2.0 * ROUNDED / loss, LONGEST_STILL)


def is_still(x: Real, y: Real, u0: Real, w0: Real, u1: Real, w1: Real, lag: Real, share: float) -> bool:
    """Whether a flight to (x, y), with these velocities at its ends, was shorter than a share of the coordinates."""
    way = (abs(u0) + abs(w0) + abs(u1) + abs(w1)) * lag
    return bool(not way > share * (abs(x) + abs(y)))

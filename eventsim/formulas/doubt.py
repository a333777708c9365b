"""How well contact times are known: the span within which only exact arithmetic tells which of two contacts comes first.

A contact time is a gap over the speed at which it closes.  The gap is a difference of places, and each of these is rounded.  So
a contact time is known to about (last bits of the places) / (closing speed), and to a last bit of the clock.
"""

from eventsim.formulas.clock import FIRST_WINDOW, window_length
from eventsim.formulas.real import Real

UNIT = 2.0**-53
"""The relative error of one rounding to nearest."""

ROUNDINGS = 32.0
"""Roundings in two contact times, with room.

A coordinate apart carries those of two products u lag, two sums x + u lag, the lag, the shift and the difference: at most seven
halves of a last bit.  There are two coordinates, c and D round a few times more, and two times are compared.
"""

SLOW = 2.0**-6
"""Contacts that close at this part of the slowest disk's speed, or faster, are within the screen."""

GLANCES = 2.0**-12
"""The screen is at most this part of the mean time between two events of the scene: so a second look costs nothing."""

CLOCK_BITS = 1.0 + 2.0**-50
"""What the clock rounds: 4 to 8 units in the last place of a contact time; each is right to about two."""


BELOW = 2.0**-50
"""A gap that is a smaller part of the places it is the difference of is below the digits: four to eight of their last bits.

Each of two places is rounded where its flight begins and where the gap is looked at, and the contact before was off by as much.
"""


def is_sunk(approach: Real, lag: Real, size: Real) -> Real:
    """Whether the gap that closed at speed `approach` for a time `lag` was one of the last bits of places of that size.

    What closed at once was no open gap.
    """
    return (lag > 0.0) & (approach * lag <= BELOW * size)


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
    least = ROUNDINGS * UNIT * (size / (SLOW * slowest))
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
    return (one <= latest_tie(other, screen)) & (other <= latest_tie(one, screen))

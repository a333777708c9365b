"""Which of two events comes first."""

from __future__ import annotations

from eventsim.engines.fast.compiled import inline
from eventsim.engines.fast.layout import WALL
from eventsim.formulas.doubt import latest_tie


@inline
def is_contact(code):
    """Whether an event is a contact, with a disk or with a wall."""
    return code >= 0 or code <= WALL


@inline
def earlier(time, code, shared, new_time, new_code, screen):
    """The earlier of two events; at one time wraps and crossings come first, and of these the one that is known already.

    shared: whether another contact may come before the earlier one or with it, within the screen, so that it is not for kernels.
    """
    if new_time < time:
        return new_time, new_code, 1 if time <= latest_tie(new_time, screen) else 0
    if new_time == time and is_contact(code) and not is_contact(new_code):
        return new_time, new_code, 1
    return time, code, 1 if new_time <= latest_tie(time, screen) else shared

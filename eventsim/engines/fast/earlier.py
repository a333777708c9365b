"""Which of two events comes first."""

from __future__ import annotations

from eventsim.engines.fast.compiled import inline
from eventsim.engines.fast.layout import WALL
from eventsim.formulas.roots import NEARLY


@inline
def is_contact(code):
    """Whether an event is a contact, with a disk or with a wall."""
    return code >= 0 or code <= WALL


@inline
def earlier(time, code, shared, new_time, new_code):
    """The earlier of two events; at one time wraps and crossings come first, and of these the one that is known already.

    shared: whether another contact may be nearly at the time of the earlier one, so that it is not for kernels.
    """
    if new_time < time:
        return new_time, new_code, 1 if time <= new_time * NEARLY else 0
    if new_time == time and is_contact(code) and not is_contact(new_code):
        return new_time, new_code, 1
    return time, code, 1 if new_time <= time * NEARLY else shared

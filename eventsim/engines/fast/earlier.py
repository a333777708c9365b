"""Which of two events comes first."""

from __future__ import annotations

from eventsim.engines.fast.compiled import inline
from eventsim.engines.fast.layout import WALL
from eventsim.formulas.real import NEVER


@inline
def is_contact(code):
    """Whether an event is a contact, with a disk or with a wall."""
    return code >= 0 or code <= WALL


@inline
def earlier(time, code, shared, new_time, new_code):
    """The earlier of two events; at one time wraps and crossings come first, and two contacts are noted as `shared`."""
    if new_time < time:
        return new_time, new_code, 0
    if new_time == time and new_time < NEVER and is_contact(code):
        if is_contact(new_code):
            return time, code, 1
        return new_time, new_code, 0
    return time, code, shared

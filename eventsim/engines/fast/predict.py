"""Predictions: the earliest event that the present flight of a disk can lead to becomes its scheduled event."""

from __future__ import annotations

from eventsim.engines.fast.advance import place, speed
from eventsim.engines.fast.compiled import inline
from eventsim.engines.fast.corner import may_be_spent
from eventsim.engines.fast.event_order import earlier
from eventsim.engines.fast.layout import (
    COUNT,
    COUNTS,
    DUE,
    EDGE,
    FLAGS,
    LOOK,
    PARTNER,
    PARTNER_COUNT,
    REALS,
    WORDS,
)
from eventsim.engines.fast.levels import home_of, look_delay
from eventsim.engines.fast.memory import either, store, word
from eventsim.engines.fast.rest import is_for_rules
from eventsim.engines.fast.search import contacts_in_cells, contacts_of_everyone
from eventsim.engines.fast.single_disk_events import border_events, crossing, earliest_at_shapes


@inline
def predict(m, grid, rules, i, now, floor):
    """Schedule the earliest event of disk i that is not before `floor`: a contact, a wrap, or the next cell crossing."""
    x, y = place(m, rules, i, now)
    u, w = speed(m, rules, i, now)
    home = home_of(m, grid, i)
    if word(m.disks, i * WORDS + FLAGS) & EDGE:
        time, code, shared = border_events(m, home, rules, i, now, floor, x, y, u, w)
    else:
        time, code = crossing(m, home, rules, i, now, x, y, u, w, rules.gx)
        shared = 0
    time, code, shared = _look(m, grid, rules, i, now, u, w, time, code, shared, grid.levels)
    time, code, shared = earliest_at_shapes(m, rules, i, floor, time, code, shared, rules.features)
    contacts = either(m.slots, contacts_in_cells, contacts_of_everyone)
    time, code, shared = contacts(m, grid, rules, i, now, floor, x, y, time, code, shared)
    shared = _or_for_rules(m, rules, i, code, time, shared, m.supports, rules.still)
    count = word(m.disks, (code if code >= 0 else grid.n) * WORDS + COUNT)  # of the sentinel: 0
    store(m.disks, i * REALS + DUE, time)
    store(m.disks, i * WORDS + PARTNER, code)
    store(m.disks, i * WORDS + PARTNER_COUNT, count + COUNTS * shared)


@inline
def _or_for_rules(m, rules, i, code, time, shared, supports, still):
    """Whether an event is to be left to the reference engine's rules: because of rest, as if another one shared its time."""
    if may_be_spent(m, rules, i, code, time, still):
        return 1
    if supports is None:
        return shared
    return 1 if is_for_rules(m, rules, i, code, time) else shared


@inline
def _look(m, grid, rules, i, now, u, w, time, code, shared, levels):
    """The time to look for smaller disks again, if that is before the given event."""
    if levels is None:
        return time, code, shared
    return earlier(time, code, shared, now + look_delay(m, grid, rules, i, u, w), LOOK, rules.tie_screen)

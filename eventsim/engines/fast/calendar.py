"""The event calendar: one scheduled event a disk, in a linked list of disks per day; push and take in O(1).

The days are so short that there is less than one event in most of them, so the earliest event is found by walking through
the list of the present day.
"""

from __future__ import annotations

from eventsim.engines.fast.cells import depth_of, home_of, slot_of
from eventsim.engines.fast.compiled import inline, part, prefetch, real, store, word
from eventsim.engines.fast.layout import (
    COLUMN,
    COUNT,
    COUNTS,
    DUE,
    LINK,
    NEXT,
    NOTHING,
    PARTNER,
    PARTNER_COUNT,
    REALS,
    ROW,
    WAITING,
    WALL,
    WORDS,
)
from eventsim.formulas.doubt import latest_tie, may_tie
from eventsim.formulas.real import NEVER

NO_DAY = 1 << 62
"""A deadline that does not come."""


@inline
def day_of(grid, time, day):
    """The day of a time, as seen on `day`: not before it, not beyond the end of the calendar."""
    last = day + grid.days - 1
    exact = time * grid.days_per_time
    if not exact < last:
        return last
    due = int(exact)
    return due if due > day else day


@inline
def bucket(grid, day):
    """The place, among the words of the records and the buckets behind them, of the first disk that is due on a day."""
    return (grid.n + 1) * WORDS + (day & (grid.days - 1))


@inline
def push(m, grid, i, day):
    """Put disk i into the calendar.

    The list of a day ends with the sentinel, whose link is written and never read: so there is no branch that depends on
    the time of the event, and what comes next need not wait until that is known.
    """
    link = bucket(grid, day_of(grid, real(m.disks, i * REALS + DUE), day))
    follower = word(m.disks, link)
    store(m.disks, i * WORDS + LINK, link)
    store(m.disks, i * WORDS + NEXT, follower)
    store(m.disks, link, i)
    store(m.disks, follower * WORDS + LINK, i * WORDS + NEXT)


@inline
def take(m, i):
    """Take disk i out of the calendar."""
    link, follower = word(m.disks, i * WORDS + LINK), word(m.disks, i * WORDS + NEXT)
    store(m.disks, link, follower)
    store(m.disks, follower * WORDS + LINK, link)


@inline
def _waiting(grid, k):
    """The place of the k-th word of the waiting room, behind the buckets."""
    return (grid.n + 1) * WORDS + grid.days + (k & (WAITING - 1))


@inline
def push_later(m, grid, i, day, room, deadline):
    """Put disk i into the calendar; (room, deadline) afterwards.

    Where memory is far, a disk first spends some events in a waiting room, while the memory of its bucket comes: else the
    processor would stand still until it is there, for most of the time of a run.  It is on a list there as in a bucket, so
    `take` need not know.  room: how many have waited; deadline: the day by which all must be in the calendar.
    """
    if grid.look_ahead is None:
        push(m, grid, i, day)
        return room, deadline
    due = day_of(grid, real(m.disks, i * REALS + DUE), day)
    if due < day + 2 * grid.look_ahead:  # near at hand, in every sense
        push(m, grid, i, day)
        return room, deadline
    place = _waiting(grid, room)
    _end_waiting(m, grid, place, day)
    store(m.disks, place, i)
    store(m.disks, i * WORDS + LINK, place)
    store(m.disks, i * WORDS + NEXT, grid.n)
    prefetch(m.disks, bucket(grid, due) // 2)
    return room + 1, due if due < deadline else deadline


@inline
def _end_waiting(m, grid, place, day):
    """Put the disk that waits at a place, if there is one, into its bucket."""
    i = word(m.disks, place)
    if i != grid.n:
        push(m, grid, i, day)


@inline
def empty_room(m, grid, day):
    """Put all disks that wait into the calendar."""
    if grid.look_ahead is None:
        return
    for k in range(WAITING):
        _end_waiting(m, grid, _waiting(grid, k), day)
        store(m.disks, _waiting(grid, k), grid.n)


@inline
def first(m, grid, day, limit, deadline, screen):
    """(disk, day, others, deadline): the earliest event, which stays in the calendar, and how many others are within the screen.

    Two stands for more than one.  The end of the day counts as an event: what follows on the next day may be near.
    disk -1: nothing is due up to `limit`; -2: many days without any event.  deadline: see `push_later`.
    """
    quiet = 0
    while True:
        head = word(m.disks, bucket(grid, day))
        earliest, i = -1, head  # all updated without branches, which could not be foreseen
        time, second, third = float(day + 1) * grid.day_length, NEVER, NEVER
        while i != grid.n:
            due = real(m.disks, i * REALS + DUE)
            earliest = i if due < time else earliest
            time, later = min(time, due), max(time, due)
            second, later = min(second, later), max(second, later)
            third = min(third, later)
            i = word(m.disks, i * WORDS + NEXT)
        if earliest >= 0:
            latest = latest_tie(time, screen)
            return earliest, day, int(second <= latest) + int(third <= latest), deadline
        if float(day - 1) * grid.day_length > limit:  # a day less: the day of a time is rounded
            return -1, day, 0, deadline
        quiet += 1
        if quiet > 4 * grid.days:
            return -2, day, 0, deadline
        store(m.disks, bucket(grid, day), grid.n)
        day += 1
        fetch_coming(m, grid, day)
        i = head
        while i != grid.n:  # due on a later day
            follower = word(m.disks, i * WORDS + NEXT)
            push(m, grid, i, day)
            i = follower
        if day >= deadline:
            empty_room(m, grid, day)
            deadline = NO_DAY


@inline
def is_mutual(m, i):
    """Whether the contact of disk i is fresh, and its partner expects it as well, and nothing else at that time."""
    j = word(m.disks, i * WORDS + PARTNER)
    if j < 0 or word(m.disks, j * WORDS + PARTNER) != i:
        return False
    if real(m.disks, j * REALS + DUE) != real(m.disks, i * REALS + DUE):
        return False
    fresh = word(m.disks, i * WORDS + PARTNER_COUNT) == word(m.disks, j * WORDS + COUNT)
    return fresh and word(m.disks, j * WORDS + PARTNER_COUNT) == word(m.disks, i * WORDS + COUNT)


@inline
def is_stale(m, i):
    """Whether the partner of disk i has begun another flight since the prediction."""
    j = word(m.disks, i * WORDS + PARTNER)
    if j < 0:
        return False
    return word(m.disks, i * WORDS + PARTNER_COUNT) & (COUNTS - 1) != word(m.disks, j * WORDS + COUNT)


@part
def unsettled(m, grid, i, day, screen):
    """What comes before the contact of disk i: a stale event within the screen, a wrap or crossing exactly at its time; or n."""
    time = real(m.disks, i * REALS + DUE)
    latest = latest_tie(time, screen)
    k = word(m.disks, bucket(grid, day))
    while k != grid.n:
        due = real(m.disks, k * REALS + DUE)
        if due <= latest:
            code = word(m.disks, k * WORDS + PARTNER)
            if is_stale(m, k) or (due == time and NOTHING <= code < 0):
                return k
        k = word(m.disks, k * WORDS + NEXT)
    return k


@part
def is_tied(m, grid, i, day, screen):
    """Whether the contact of disk i has to be ordered exactly.

    So it is where a contact within the screen shares a disk with it, or may do so, or has exactly its time; also one that is
    hidden behind a wrap or crossing within the screen.
    """
    time, j = real(m.disks, i * REALS + DUE), word(m.disks, i * WORDS + PARTNER)
    for later in range(2):  # what follows on the next day may be within the screen
        k = word(m.disks, bucket(grid, day + later))
        while k != grid.n:
            due, code = real(m.disks, k * REALS + DUE), word(m.disks, k * WORDS + PARTNER)
            flagged = word(m.disks, k * WORDS + PARTNER_COUNT) & COUNTS != 0
            if k != i and is_contact(code) and may_tie(due, time, screen):
                mutual = k == j and code == i and due == time
                shares = code == i or (j >= 0 and (k == j or code == j))
                if flagged or (not mutual and (shares or due == time)):  # a partner may know of a tie that disk i does not see
                    return True
            elif (
                NOTHING < code < 0  # behind a wrap or crossing a contact may follow at once, which posts do not foresee
                and (flagged or (grid.posts is not None and j >= 0))
                and may_tie(due, time, screen)
            ):
                return True
            k = word(m.disks, k * WORDS + NEXT)
    return False


@inline
def earliest_floor(grid, now, screen):
    """The time before which no contact of a flight that goes on is still to come.

    Where posts foresee no contacts, a post that begins another flight may bring one forward by the last bits of its time.
    """
    return now if grid.posts is None else 2.0 * now - latest_tie(now, screen)


@inline
def fetch_record(m, i):
    """Ask for both lines of a disk."""
    prefetch(m.disks, i * REALS)
    prefetch(m.disks, i * REALS + 8)


@inline
def fetch_around(m, grid, i, disks):
    """Ask for the slots of the cells around disk i; or for the first line of each disk in them."""
    home = home_of(m, grid, i)
    depth, width = depth_of(home), home.columns + 2
    start = slot_of(home, word(m.disks, i * WORDS + COLUMN) - 1, word(m.disks, i * WORDS + ROW) - 1)
    for _ in range(3):
        if disks:
            for k in range(3 * depth):
                prefetch(m.disks, word(m.slots, start + k) * REALS)
        else:
            prefetch(m.slots, start // 2)  # two int32 to a float64
        start += depth * width


@inline
def fetch_coming(m, grid, day):
    """Ask for what the events of coming days need, in four stages; each reads what the one before it asked for."""
    if grid.look_ahead is None:
        return
    look_ahead = grid.look_ahead
    fetch_record(m, word(m.disks, bucket(grid, day + look_ahead)))
    i = word(m.disks, bucket(grid, day + look_ahead * 3 // 4))
    if i != grid.n:
        j = word(m.disks, i * WORDS + PARTNER)
        fetch_record(m, j if j >= 0 else i)
        fetch_record(m, word(m.disks, i * WORDS + NEXT))
        fetch_around(m, grid, i, False)
    i = word(m.disks, bucket(grid, day + look_ahead // 2))
    if i != grid.n:
        fetch_around(m, grid, i, True)
        j = word(m.disks, i * WORDS + PARTNER)
        if j >= 0:
            fetch_around(m, grid, j, False)
            fetch_record(m, word(m.disks, j * WORDS + NEXT))
            prefetch(m.disks, word(m.disks, j * WORDS + LINK) // 2)  # two int32 to a float64
    i = word(m.disks, bucket(grid, day + look_ahead // 4))
    if i != grid.n:
        j = word(m.disks, i * WORDS + PARTNER)
        if j >= 0:
            fetch_around(m, grid, j, True)


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

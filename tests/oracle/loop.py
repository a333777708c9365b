"""The oracle's run: the earliest contact of all, resolved, then the next; every row with how far floats may be from it.

`story(scene, ...)` follows a scene until its stop, or until floats can no longer tell what comes next.  Nothing here
is fast, clever or shared with the engines: all pairs, all walls, decimals.

The rules are those that the scene format promises:

* Contacts that share disks and come at exactly the same time are resolved together; what approaches after that is a
new contact, due now.
* Under gravity a disk that bounces on a straight wall with restitution e < 1 is at rest there after a time 2 v / (g
(1 - e)), v being its
  speed across the wall after a bounce.  So do disks that lie on a straight wall at the start.  Walls in line are one.
  It then slides without friction, until an impulse or the end of the wall.
* What would come to rest on a round wall, on another disk or on two walls has no answer: the run must stop with a
reason.
* A disk that touches a wall at the start, but for rounding, and moves along it glides on it and on what is in line
with it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tests.oracle.contact import resolve
from tests.oracle.digits import ROUNDS, UNIT, ZERO, TooFewDigitsError, exact, working_with
from tests.oracle.impact import SqueezedError
from tests.oracle.order import cluster_of, demand_before, demand_calls, demand_clear, first_of, look_again, predict
from tests.oracle.rest import come_to_rest, leave, press
from tests.oracle.search import LEAVE, LOOK, PRESSED, REST, wall_key
from tests.oracle.start import touch_at_start
from tests.oracle.state import State
from tests.oracle.story import KICK, BeyondError, CollapseError, Kick, Story


def story(
    scene: Any,
    until: float | None = None,
    events: int | None = None,
    kicks: Sequence[Kick] = (),
    rounds: Sequence[int] = ROUNDS,
    judged: bool = True,
) -> Story:
    """Follow a scene with as many digits as its decisions need.

    until, events: instead of the scene's.  rounds: the digits to try.  judged: False follows it without asking what
    floats can tell.
    """
    for digits in rounds:
        try:
            with working_with(digits):
                return follow(State(scene, until, events, kicks, judged))
        except TooFewDigitsError:
            if digits == rounds[-1]:
                raise
    raise AssertionError("no rounds")


def follow(run: State) -> Story:
    """Follow a scene from its start to its end, or as far as floats determine it."""
    ending, why = "", ""
    try:
        touch_at_start(run)
        predict(run, range(run.n))
        ending = pass_time(run)
    except BeyondError as beyond:
        ending, why = "beyond", str(beyond)
        run.now = run.last
    except CollapseError as collapse:
        ending, why = "collapse", str(collapse)
    except SqueezedError:
        ending, why = "collapse", "squeezed"
    glides = any(flight.skip and flight.held is None for flight in run.flights)
    return Story(run.table, run.rows, ending, why, run.now, free_times(run), run.parts, glides)


def pass_time(run: State) -> str:
    """The earliest event of all, again and again; why it ends."""
    while True:
        if run.events is not None and len(run.rows) >= run.events:
            return "events"
        first = first_of(run)
        kick = run.timed[0] if run.timed else None
        limits = [
            t for t in (run.until, None if kick is None or kick.time is None else exact(kick.time)) if t is not None
        ]
        stop = min(limits) if limits else None
        if first is None and stop is None:
            return "quiet"
        if first is None or (stop is not None and first.time > stop):
            assert stop is not None
            demand_clear(run, stop, first)
            if kick is not None and kick.time is not None and exact(kick.time) == stop:
                run.now = stop
                run.timed.pop(0)
                kick_now(run, kick)
                continue
            run.now = stop
            return "quiet" if first is None and not wraps_ahead(run) else "until"
        demand_calls(run, first.time)
        run.now = first.time
        if first.how == LOOK:
            look_again(run, first)
            continue
        if stop is not None and first.time != stop:
            demand_before(run, first, stop)
        cluster = cluster_of(run, first)
        if cluster[0].how == LEAVE:
            leave(run, first)
        elif cluster[0].how == REST:
            come_to_rest(run, first)
        elif len(cluster) == 1 and cluster[0].how == PRESSED:
            press(run, first)
        else:
            kick_at_contacts(run, resolve(run, cluster))


def kick_now(run: State, kick: Kick) -> None:
    """Give a disk another velocity."""
    i = kick.disk
    before = run.flights[i]
    clock = run.tick()
    place, velocity = run.fly_to_now(i, clock)
    if run.doubt.p.any():
        late = 0.0 if kick.time is not None else UNIT * clock
        run.doubt.round(i, [late * abs(float(v)) for v in velocity] + [0.0, 0.0])
        k = 4 * i
        run.doubt.p[k + 2 : k + 4] = 0.0
        run.doubt.p[:, k + 2 : k + 4] = 0.0
    touch = dict.fromkeys(before.touch, False) if before.time == run.now else {}
    if before.held is not None:
        touch[wall_key(before.held[0], (0, 0), before.held[1])] = False
    run.rest_due.pop(i, None)
    run.begin_flight(i, place, (exact(kick.velocity[0]), exact(kick.velocity[1])), touch)
    run.group += 1
    run.add_row(KICK, (i,), frozenset(), UNIT * clock)
    run.last = run.now
    predict(run, [i])


def kick_at_contacts(run: State, disks: list[int]) -> None:
    """The kicks at the instant of the contact that these disks have just had."""
    for i in disks:
        run.contacts[i] += 1
        for kick in [k for k in run.hooked if k.disk == i and k.after == run.contacts[i] - 1]:
            run.hooked.remove(kick)
            kick_now(run, kick)


def free_times(run: State) -> tuple[float, float]:
    """The median and the mean time between two rows of a disk."""
    last = [ZERO] * run.n
    flights = []
    for row in run.rows:
        for part in row.parts:
            flights.append(row.time - last[part.disk])
            last[part.disk] = row.time
    if not flights:
        return 0.0, 0.0
    return float(sorted(flights)[len(flights) // 2]), float(sum(flights) / len(flights))


def wraps_ahead(run: State) -> bool:
    """Whether a disk moves through periods for ever."""
    return any(
        period is not None and any((f.u, f.w)[axis] != 0 or (f.ax, f.ay)[axis] != 0 for f in run.flights)
        for axis, period in enumerate(run.table.period)
    )

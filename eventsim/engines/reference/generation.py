"""The contacts of one instant: which of those that come nearly at once are resolved now, and which of these together."""

from __future__ import annotations

from eventsim.engines.exact_state import ExactState
from eventsim.engines.exact_times import ExactTimes
from eventsim.engines.reference.calendar import Event
from eventsim.formulas.roots import order_of
from eventsim.scene.stage import Stage


class Ties:
    """Decides the order of contacts so close in time that floats cannot: from the flights of one run, exactly.

    Contacts that only share a float time are no cluster; those whose exact times are equal are one.  A graze, at which nothing
    approaches, is left out of it: what another contact makes of it comes after that.
    """

    def __init__(self, stage: Stage, state: ExactState) -> None:
        self._moments = ExactTimes(stage, state)

    def settle(self, near: list[Event]) -> list[Event]:
        """Of contacts within the screen: those that are to be resolved in one instant, in the order of rows.

        Of each component whose earliest float time is the first of all: those that come first.
        """
        first = min(event.time for event in near)
        chosen: list[Event] = []
        for component in components(near):
            if min(event.time for event in component) == first:
                chosen += component if len(component) == 1 else self._earliest(component)
        return sorted(chosen, key=lambda event: (row_order(event), event.image))

    def _earliest(self, component: list[Event]) -> list[Event]:
        moments = [self._moments.of(event.a, event.b, event.image, event.time) for event in component]
        first = moments[0]
        for moment in moments:
            if order_of(moment, first) < 0:
                first = moment
        tied = [event for event, moment in zip(component, moments, strict=True) if order_of(moment, first) == 0]
        if len(tied) == 1:
            return tied
        return [event for event in tied if not self._moments.grazes(event.a, event.b, event.image)] or tied


def disks_of(event: Event) -> list[int]:
    """The disks of a contact."""
    return [event.a] if event.b < 0 else [event.a, event.b]


def row_order(event: Event) -> tuple[int, int, int]:
    """The order of rows of equal time: by (a, b, wall), where b is -1 for a wall."""
    return event.a, max(event.b, -1), -event.b


def components(generation: list[Event]) -> list[list[Event]]:
    """The groups of contacts that are connected through shared disks, in the order of their first contacts."""
    if len(generation) == 1:
        return [generation]
    parent: dict[int, int] = {}

    def root(i: int) -> int:
        while parent.setdefault(i, i) != i:
            i = parent[i]
        return i

    for event in generation:
        if event.b >= 0:
            one, other = root(event.a), root(event.b)
            parent[max(one, other)] = min(one, other)
    groups: dict[int, list[Event]] = {}
    for event in generation:
        groups.setdefault(root(event.a), []).append(event)
    return list(groups.values())

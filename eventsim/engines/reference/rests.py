"""Disks come to rest on straight walls, and leave them."""

from __future__ import annotations

from eventsim.engines.base import Counters
from eventsim.engines.exact_state import ExactState
from eventsim.engines.reference.calendar import Event
from eventsim.engines.reference.instants import Instants
from eventsim.engines.reference.ledger import Ledger
from eventsim.formulas.corner import is_spent
from eventsim.formulas.real import Real
from eventsim.formulas.rest import LEFT, STRUCK, SUPPORTED, held_by
from eventsim.formulas.walls.face import slope
from eventsim.record.events import Kind
from eventsim.scene.corners import corners_of
from eventsim.scene.settling import remedy_of
from eventsim.scene.stage import Stage


class TwoSupportsError(Exception):
    """A disk comes to rest on two walls: how they share its weight is no question of impulses."""

    def __init__(self, disk: int, walls: list[str], stage: Stage) -> None:
        # with a contact duration there is rest only of disks that lie on a wall at the start, however long it is
        then = f"; {remedy_of(stage)}" if stage.law.duration is None else ", whatever the contact_duration"
        super().__init__(
            f"disk {disk} comes to rest on two walls, {' and '.join(walls)}: only rest on one straight wall is modelled{then}"
        )


class Rests:
    """Puts disks onto walls and takes them off; books what walls give them meanwhile.

    radius: of every disk, in the engine's numbers.
    """

    def __init__(
        self,
        stage: Stage,
        state: ExactState,
        radius: list[Real],
        instants: Instants,
        ledger: Ledger,
        counters: Counters,
    ) -> None:
        self._stage = stage
        self._state = state
        self._radius = radius
        self._instants = instants
        self._ledger = ledger
        self._counters = counters

    def take_place(self, event: Event) -> None:
        """Let a disk rest on a wall, or fly on from the end of the one that it slid along."""
        self._rest(event) if event.image[1] == SUPPORTED else self._leave(event)

    def free(self, i: int, t: Real) -> None:
        """Book what a wall has given to disk i until now, if it rested there; the impulse that comes frees it."""
        if self._state.supports is not None:
            self._ledger.book_support(i, t, -1.0)

    def _rest(self, event: Event) -> None:
        """Let a disk rest on a wall; it may have rested on another one, which this one takes it from.

        Raises TwoSupportsError where it would lie on both.
        """
        state = self._state
        t, i, place, side = event.time, event.a, -1 - event.b, event.image[0]
        assert state.supports is not None
        support = state.supports[place]
        assert support is not None
        self._check_single(i, place)
        self.free(i, t)
        x, y = state.place(i, t)
        u, w = before = state.speed(i, t)
        x, y = support.face.touching(side, x, y, self._radius[i])
        still = self._instants.is_still(i, t)
        u, w = slope(support.face, u, w)
        state.keep_sides(i, t, (x, y), (u, w), ((place, side),))
        state.anchor(i, t, x, y, u, w)
        state.meet(i, ((event.b, side, SUPPORTED),))
        self._ledger.book_support(i, t, 1.0)
        self._instants.note(i, t, False, still)
        impulse = self._ledger.book_wall(i, u - before[0], w - before[1])
        self._counters.rests += 1
        self._ledger.log(t, Kind.REST, i, -1, self._stage.surfaces[place].wall, impulse, -1)

    def _check_single(self, i: int, place: int) -> None:
        """Raise TwoSupportsError where disk i, which comes to rest on one wall, stays pressed onto the one that it rests on."""
        state = self._state
        held = held_by(state.met[i])
        if held is None or held.how != SUPPORTED or state.supports is None:
            return
        old, new = state.supports[held.place], state.supports[place]
        assert old is not None
        assert new is not None
        if held.side * (old.face.nx * new.ax + old.face.ny * new.ay) < 0.0:
            walls = [self._stage.wall_names[self._stage.surfaces[k].wall] for k in (held.place, place)]
            raise TwoSupportsError(i, walls, self._stage)

    def check_corner(self, component: list[Event]) -> None:
        """Raise TwoSupportsError where a disk meets a wall that holds it in a corner, and has no energy left to bounce there."""
        i, state, stage = component[0].a, self._state, self._stage
        gravity = stage.gravity
        if gravity is None or not stage.settles or any(event.b >= 0 for event in component):
            return
        now = tuple((event.b, event.image[0], STRUCK) for event in component)
        for event in component:
            t, place, side = event.time, -1 - event.b, event.image[0]
            x, y = state.place(i, t)
            for corner in corners_of(stage, state.met[i] + now, place, side, x, y):
                is_now = any(corner.place == -1 - other.b for other in component)
                lag = 0.0 if corner.rests or is_now else t - state.contact_time[i]
                size = abs(x) + abs(y) + self._radius[i]
                e = min(stage.law.of_wall(stage.surfaces[k].wall) for k in (corner.place, place))
                if is_spent(*corner.first, *corner.second, *gravity, *state.speed(i, t), lag, size, e):
                    walls = [stage.wall_names[stage.surfaces[k].wall] for k in (corner.place, place)]
                    raise TwoSupportsError(i, walls, stage)

    def _leave(self, event: Event) -> None:
        """Let a disk that slid over the end of its wall fly on; a row without an impulse."""
        state = self._state
        t, i = event.time, event.a
        x, y = state.place(i, t)
        u, w = state.speed(i, t)
        self.free(i, t)
        state.keep_sides(i, t, (x, y), (u, w), ((-1 - event.b, event.image[0]),))
        state.anchor(i, t, x, y, u, w)
        state.meet(i, ((event.b, event.image[0], LEFT),))
        self._instants.note(i, t, False, False)
        self._counters.wall_contacts += 1
        self._ledger.log(t, Kind.WALL, i, -1, self._stage.surfaces[-1 - event.b].wall, 0.0, -1)

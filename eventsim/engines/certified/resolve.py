"""Contacts are resolved on balls; rows and counters get the floats nearest to them."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

from eventsim.engines.certified.ball import Ball, Irrational, about
from eventsim.engines.certified.traced import of_rational
from eventsim.engines.reference.calendar import Event
from eventsim.engines.reference.generation import disks_of
from eventsim.engines.reference.ledger import Ledger
from eventsim.engines.reference.resolve import Resolver
from eventsim.formulas.impulse import mass_fractions
from eventsim.formulas.simultaneous import JointContact, Outcome, resolve_exactly
from eventsim.record.events import Kind

AT_ONCE = 2.0**-256
"""Share of the clock within which contacts are at one instant.  Nothing rounds here, so it only has to lie far below what a
sequence that ends comes to: three disks with e = .0718, 3e-6 above the limit of the collapse, part after 504 contacts, no
two of them closer than 2**-18.  A collapse of theirs costs three bits a contact and comes a tenth of a bit closer to its end with
each, so a much smaller share would take minutes."""


class CertifiedLedger(Ledger):
    """Books the floats nearest to balls."""

    def book(self, jx: Any, jy: Any) -> None:
        """Note momentum that came from outside."""
        super().book(float(jx), float(jy))

    def book_wall(self, i: int, du: Any, dw: Any) -> Any:
        """Note the momentum that a wall gave disk i; its magnitude."""
        return super().book_wall(i, float(du), float(dw))

    def note_overlap(self, a: int, b: int, distance: Any, reach: Any) -> None:
        """Disks on balls do not overlap."""

    def log(self, t: Any, kind: Kind, a: int, b: int, wall: int, impulse: Any, joint: int) -> None:
        """Count an event, and keep its row if rows are kept."""
        super().log(t, kind, a, b, wall, impulse, joint)
        if self._keep_rows:
            self.rows[-1] = tuple(float(value) if isinstance(value, Ball) else value for value in self.rows[-1])


class CertifiedResolver(Resolver):
    """Resolves on balls; a cluster only while all its numbers are known to be rational."""

    at_once = AT_ONCE
    ledger = CertifiedLedger

    def resolve(self, component: list[Event]) -> list[int]:
        """Resolve contacts that are connected; the disks that fly on changed.

        Raises Undecided, which knows their disks.
        """
        with about({i for event in component for i in disks_of(event)}):
            return super().resolve(component)

    def _time_of(self, component: list[Event]) -> Any:
        """The time of a cluster, which is proven to be that of all its contacts."""
        return component[0].time

    def _shares(self, a: int, b: int) -> tuple[Any, Any]:
        if self._stage.mass is None:
            return 0.5, 0.5
        number, mass_a, mass_b = self._state.number, self._masses.of(a), self._masses.of(b)
        if mass_a in (0.0, math.inf) or mass_b in (0.0, math.inf):
            return mass_fractions(mass_a, mass_b)
        total = number(mass_a) + mass_b
        return mass_a / total, mass_b / total

    def _restitution(self, event: Event, t: Ball, dx: Any, dy: Any, speeds: tuple[tuple[Any, Any], ...]) -> Any:
        found = super()._restitution(event, t, dx, dy, speeds)
        return found if isinstance(found, Ball) else self._state.number(found)

    def _together(self, contacts: list[JointContact], before: list[tuple[Any, Any]], masses: list[float]) -> Outcome:
        exact = [
            contact._replace(
                dx=_rational(contact.dx), dy=_rational(contact.dy), restitution=_rational(contact.restitution)
            )
            for contact in contacts
        ]
        flights = [(_rational(u), _rational(w)) for u, w in before]
        after, impulses, active = resolve_exactly(exact, flights, masses)
        velocities: list[tuple[Any, Any]] = [(of_rational(u), of_rational(w)) for u, w in after]
        return Outcome(velocities, impulses, active)


def _rational(number: Any) -> Any:
    """The number as a Fraction.

    Raises Irrational where it is not known to be rational.
    """
    rational = number.rational if isinstance(number, Ball) else Fraction(number)
    if rational is None:
        raise Irrational("the contacts of a cluster involve numbers that are not known to be rational")
    return rational

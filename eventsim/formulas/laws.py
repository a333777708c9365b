"""The laws of contacts: how much of the approach velocity comes back, and what follows from that for a run.

A law is a tuple of numbers (a NamedTuple), so that compiled engines can take it as it is.  Kernels know a law by its restitutions
and its duration (`impulse.contact_restitution`).  To add a law: a class here, a place in `LAWS`, its keys in `scene`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, Protocol

from eventsim.formulas.impulse import contact_restitution
from eventsim.formulas.real import Real


class Law(Protocol):
    """What every law of contacts knows."""

    @property
    def pair(self) -> float:
        """The restitution between disks."""

    @property
    def wall(self) -> float:
        """The restitution at walls."""

    @property
    def duration(self) -> float | None:
        """How long a contact matters to the next one of its disks; None where it does not."""

    def restitution(self, usual: Real, since_a: Real, since_b: Real) -> Real:
        """The restitution of a contact whose usual one is given, from the times since the previous ones of its disks."""

    def loses_energy(self) -> bool:
        """Whether contacts take energy, so that they can pile up."""

    def comes_to_rest(self) -> bool:
        """Whether bounces become ever lower, so that under gravity disks end up lying on something."""

    def series(self) -> float:
        """The restitution at walls of bounces that follow each other ever faster."""

    def words(self, number: Callable[[float], str]) -> str:
        """What a page on a scene says of its contacts; number: how it writes one."""

    def remedy(self) -> str:
        """What is left to do about contacts that pile up."""


class Elastic(NamedTuple):
    """Contacts conserve energy."""

    pair: float = 1.0
    wall: float = 1.0
    duration: None = None

    def restitution(self, usual: Real, since_a: Real, since_b: Real) -> Real:
        """The usual one."""
        return usual

    def loses_energy(self) -> bool:
        """It does not."""
        return False

    def comes_to_rest(self) -> bool:
        """Bounces keep their height."""
        return False

    def series(self) -> float:
        """1, as ever."""
        return self.wall

    def words(self, number: Callable[[float], str]) -> str:
        """What a page on a scene says of its contacts."""
        return "elastic"

    def remedy(self) -> str:
        """What is left to do about contacts that pile up."""
        return BOUNCE_ON


class Inelastic(NamedTuple):
    """A share of the approach velocity comes back: one between disks, one at walls."""

    pair: float
    wall: float
    duration: None = None

    def restitution(self, usual: Real, since_a: Real, since_b: Real) -> Real:
        """The usual one."""
        return usual

    def loses_energy(self) -> bool:
        """Where a restitution is below 1."""
        return self.pair < 1.0 or self.wall < 1.0

    def comes_to_rest(self) -> bool:
        """Where energy is lost."""
        return self.loses_energy()

    def series(self) -> float:
        """That of every contact with a wall."""
        return self.wall

    def words(self, number: Callable[[float], str]) -> str:
        """What a page on a scene says of its contacts."""
        then = "contacts may pile up at an instant, then the run stops and says so (contact_duration avoids it)"
        return f"{_shares(self, number)}; {then}"

    def remedy(self) -> str:
        """What is left to do about contacts that pile up."""
        return BOUNCE_ON


class TimeOfContact(NamedTuple):
    """The TC model: a contact within the duration of a disk's previous one is elastic.

    Source: Luding, McNamara, Granular Matter 1, 113 (1998), doi:10.1007/s100350050017.
    """

    pair: float
    wall: float
    duration: float

    def restitution(self, usual: Real, since_a: Real, since_b: Real) -> Real:
        """1 soon after a contact of one of the two."""
        return contact_restitution(usual, self.duration, since_a, since_b)

    def loses_energy(self) -> bool:
        """Where a restitution is below 1."""
        return self.pair < 1.0 or self.wall < 1.0

    def comes_to_rest(self) -> bool:
        """Bounces that are short enough keep their height."""
        return False

    def series(self) -> float:
        """1: in the end they are elastic."""
        return 1.0

    def words(self, number: Callable[[float], str]) -> str:
        """What a page on a scene says of its contacts."""
        return (
            f"{_shares(self, number)}; a contact within {number(self.duration)} of a disk's previous one is elastic "
            "(TC model), so contacts cannot pile up without end"
        )

    def remedy(self) -> str:
        """What is left to do about contacts that pile up."""
        return f"contact_duration = {self.duration:g}, as in this scene, did not prevent it; a longer one may"


LAWS: tuple[type[Law], ...] = (Elastic, Inelastic, TimeOfContact)
"""The table of laws."""

BOUNCE_ON = "contact_duration, a time in the scene, lets such a scene go on"


def law_of(restitution: tuple[float, float] | None, duration: float | None) -> Law:
    """The law of a scene with these keys: restitutions (pair, wall), and a contact duration."""
    if restitution is None:
        return Elastic()
    return Inelastic(*restitution) if duration is None else TimeOfContact(*restitution, duration)


def _shares(law: Law, number: Callable[[float], str]) -> str:
    return f"restitution {number(law.pair)} between disks, {number(law.wall)} at walls: energy is lost"

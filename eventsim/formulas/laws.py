"""The laws of contacts: how much of the approach velocity comes back, and what follows from that for a run.

Kernels know a law by its restitutions and its duration (`impulse.contact_restitution`).  To add a law: see `EXTENDING.md`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from eventsim.formulas.impulse import contact_restitution
from eventsim.formulas.real import Real


@dataclass(frozen=True, slots=True)
class Law:
    """What every law knows.

    Attributes:
        pair, wall: the restitution between disks, and at walls.
        duration: how long a contact matters to the next one of its disks; None where it does not.
    """

    pair: float
    wall: float
    duration: float | None

    def restitution(self, usual: Real, since_a: Real, since_b: Real) -> Real:
        """The restitution of a contact whose usual one is given, from the times since the previous ones of its disks."""
        return usual

    def loses_energy(self) -> bool:
        """Whether contacts take energy, so that they can pile up."""
        return self.pair < 1.0 or self.wall < 1.0

    def loss(self) -> float:
        """1 - e of the least inelastic contacts that take energy; 0 where none does."""
        return min((1.0 - e for e in (self.pair, self.wall) if e < 1.0), default=0.0)

    def comes_to_rest(self) -> bool:
        """Whether bounces become ever lower, so that under gravity disks end up lying on something."""
        return self.loses_energy()

    def series(self) -> float:
        """The restitution at walls of bounces that follow each other ever faster."""
        return self.wall

    def words(self, number: Callable[[float], str]) -> str:
        """What a page on a scene says of its contacts; number: how it writes one."""
        return f"restitution {number(self.pair)} between disks, {number(self.wall)} at walls: energy is lost"

    def remedy(self) -> str:
        """What is left to do about contacts that pile up."""
        return "contact_duration, a time in the scene, lets such a scene go on"


class Elastic(Law):
    """Contacts conserve energy."""

    __slots__ = ()

    def words(self, number: Callable[[float], str]) -> str:
        """What a page on a scene says of its contacts."""
        return "elastic"


class Inelastic(Law):
    """A share of the approach velocity comes back: one between disks, one at walls."""

    __slots__ = ()

    def words(self, number: Callable[[float], str]) -> str:
        """What a page on a scene says of its contacts."""
        then = "contacts may pile up at an instant, then the run stops and says so (contact_duration avoids it)"
        return f"{super().words(number)}; {then}"


class TimeOfContact(Law):
    """The TC model: a contact within the duration of a disk's previous one is elastic.

    Source: Luding, McNamara, Granular Matter 1, 113 (1998), doi:10.1007/s100350050017.
    """

    __slots__ = ()

    def restitution(self, usual: Real, since_a: Real, since_b: Real) -> Real:
        """1 soon after a contact of one of the two."""
        return contact_restitution(usual, self.duration, since_a, since_b)

    def comes_to_rest(self) -> bool:
        """Bounces that are short enough keep their height."""
        return False

    def series(self) -> float:
        """1: in the end they are elastic."""
        return 1.0

    def words(self, number: Callable[[float], str]) -> str:
        """What a page on a scene says of its contacts."""
        return (
            f"{super().words(number)}; a contact within {number(self.duration or 0.0)} of a disk's previous one is elastic "
            "(TC model), so contacts cannot pile up without end"
        )

    def remedy(self) -> str:
        """What is left to do about contacts that pile up."""
        return f"contact_duration = {self.duration:g}, as in this scene, did not prevent it; a longer one may"


LAWS: tuple[type[Law], ...] = (Elastic, Inelastic, TimeOfContact)
"""The table of laws."""


def law_of(restitution: tuple[float, float] | None, duration: float | None) -> Law:
    """The law of a scene with these keys: restitutions (pair, wall), and a contact duration."""
    if restitution is None:
        return Elastic(1.0, 1.0, None)
    return (Inelastic if duration is None else TimeOfContact)(*restitution, duration)

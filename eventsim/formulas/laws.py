"""The laws of contacts: how much of the approach velocity comes back, and what follows from that for a run.

A law is asked, and nobody guesses: what it looks at (`by_speed`), what it does (`restitution`), what it keeps (`keeps_energy`),
what follows for contacts that pile up, for rest, for neighbouring runs.  Kernels know it by its `numbers`, which are handed to
`impulse.contact_restitution` as they are here.  To add a law: see `EXTENDING.md`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, ClassVar, NamedTuple, Protocol

from eventsim.formulas.impulse import contact_restitution
from eventsim.formulas.real import Real
from eventsim.formulas.rough import SMOOTH, Roughness


class Numbers(NamedTuple):
    """What `impulse.contact_restitution` looks at besides the contact; None: the scene's law has no such number.

    duration: how long a contact matters to the next one of its disks.  yield_speed: from which on contacts take more.
    own: a law of the user's own, of (restitution, approach, since, mass).
    """

    duration: float | None = None
    yield_speed: float | None = None
    own: Any = None


class Treatment(NamedTuple):
    """What a wall does to disks besides throwing them back.

    temperature: kT of what it draws their velocities from, None where it does not; velocity: along itself; shaking: away from
    itself, a saw-tooth of vanishing amplitude.
    """

    temperature: float | None = None
    velocity: float = 0.0
    shaking: float = 0.0


class Shares(Protocol):
    """The restitution of a scene: its shares, and further numbers of laws."""

    @property
    def pair(self) -> float:
        """Between disks."""

    @property
    def wall(self) -> float:
        """At walls."""

    @property
    def yield_speed(self) -> float | None:
        """From which on contacts take more."""


class UsersLaw(Protocol):
    """A law of the user's own."""

    @property
    def name(self) -> str:
        """What it is called."""

    @property
    def file(self) -> str:
        """Where its lines are."""

    @property
    def refusal(self) -> str | None:
        """Why it cannot be run, a sentence; None where it can."""

    def __call__(self, restitution: Real, approach: Real, since: Real, mass: Real) -> Real:
        """The restitution of a contact."""


@dataclass(frozen=True, slots=True)
class Law:
    """What every law knows.

    Attributes:
        pair, wall: the usual restitution between disks, and at walls.
        duration: how long a contact matters to the next one of its disks; None where it does not.
        walls: the usual restitution of each wall, by its number in the log; None where `wall` is that of all.
        pairs: that of each two species, by their numbers; None where `pair` is that of all.
        treatments: what walls do besides, by their numbers in the log; None where none does anything.
        by_speed: whether it looks at the speed of approach.  Then any contact may take energy, and stepped engines do not
            know it.  Contacts of one instant that share disks are resolved only where each is what it would be alone.
        rough: the tangential restitution, where disks spin; None where they have no spin.
    """

    pair: float
    wall: float
    duration: float | None
    walls: tuple[float, ...] | None = field(default=None, kw_only=True)
    pairs: tuple[tuple[float, ...], ...] | None = field(default=None, kw_only=True)
    treatments: tuple[Treatment, ...] | None = field(default=None, kw_only=True)
    by_speed: ClassVar[bool] = False
    rough: Roughness | None = field(default=None, kw_only=True)

    def of_wall(self, wall: int) -> float:
        """The usual restitution at a wall, by its number in the log."""
        return self.wall if self.walls is None else self.walls[wall]

    def treatment(self, wall: int) -> Treatment:
        """What a wall does besides throwing back, by its number in the log."""
        return Treatment() if self.treatments is None else self.treatments[wall]

    @property
    def heats(self) -> bool:
        """Whether a wall draws velocities by chance."""
        return any(one.temperature is not None for one in self.treatments or ())

    @property
    def drives(self) -> bool:
        """Whether a wall heats or shakes, or drags rough disks along: energy comes and goes there."""
        return self.treatments is not None

    def of_pair(self, one: int, other: int) -> float:
        """The usual restitution between disks of two species."""
        return self.pair if self.pairs is None else self.pairs[one][other]

    def shares(self, pairs: bool = True, walls: bool = True) -> tuple[float, ...]:
        """All usual restitutions: those between disks, those at walls."""
        between = ((self.pair,),) if self.pairs is None else self.pairs
        return (*(share for row in between for share in row if pairs), *((self.walls or (self.wall,)) if walls else ()))

    def numbers(self) -> Numbers | None:
        """What makes its contacts other than usual ones; None where nothing does."""
        return None if self.duration is None else Numbers(self.duration)

    def restitution(self, usual: Real, since_a: Real, since_b: Real, approach: Real, mass: Real) -> Real:
        """The restitution of a contact whose usual one is given; see `impulse.contact_restitution`."""
        return contact_restitution(usual, self.numbers(), since_a, since_b, approach, mass)

    def possible(self, usual: float, approach: float, least: float = 0.0) -> tuple[float, ...] | None:
        """The restitutions that a contact with a speed of approach may have; None: nobody knows.

        least: the least time since the contact before of one of its disks; 0: whatever went before.
        """
        long, soon = (self.restitution(usual, since, since, approach, 1.0) for since in (float("inf"), least))
        return (long,) if long == soon else (long, soon)

    def keeps_energy(self, pairs: bool = True, walls: bool = True) -> bool:
        """Whether contacts conserve energy: those between disks, those at walls."""
        if self.by_speed:
            return not (pairs or walls)
        normal = all(share == 1.0 for share in self.shares(pairs, walls)) and not (walls and self.drives)
        return normal and (self.rough is None or self.rough.keeps_energy(pairs, walls))

    def loses_energy(self) -> bool:
        """Whether contacts take energy, so that they can pile up."""
        if self.by_speed or any(share < 1.0 for share in self.shares()):
            return True
        return self.rough is not None and not self.rough.keeps_energy()

    def loss(self) -> float:
        """1 - e of the least inelastic contacts that take energy, at the lowest speeds; 0 where none does."""
        return min((1.0 - e for e in self.shares() if e < 1.0), default=0.0)

    def comes_to_rest(self) -> bool:
        """Whether bounces become ever lower, so that under gravity disks end up lying on something; with a duration none do."""
        return self.duration is None and any(share < 1.0 for share in self.shares())

    def series(self, usual: float) -> float:
        """The restitution of slow contacts that follow each other ever faster, where this is the usual one; 1 with a duration."""
        return usual if self.duration is None else 1.0

    @property
    def refusal(self) -> str | None:
        """Why no engine can run under it, a sentence; None where engines can."""
        return None

    @property
    def beyond_steps(self) -> str | None:
        """What of it stepped engines do not know; None where they do: `pair` and `wall` are all."""
        if self.rough is not None:
            return "disks that spin"
        if self.drives:
            return "walls that heat, shake or slide"
        if self.by_speed:
            return self.name()
        return "restitution of single walls or species" if self.walls or self.pairs else None

    @property
    def no_tangent(self) -> str | None:
        """Why it is not known how neighbouring runs part at its contacts, a clause; None where it is."""
        if self.heats:
            return "walls draw velocities by chance, whatever these were before"
        return f"{self.name()} hangs on how fast disks meet: no tangent map of it is known here" if self.by_speed else None

    @property
    def grips(self) -> tuple[bool, bool]:
        """Whether contacts turn disks: those between disks, those at walls."""
        return (False, False) if self.rough is None else (self.rough.pair > SMOOTH, self.rough.wall > SMOOTH)

    def name(self) -> str:
        """What a sentence calls it."""
        return "restitution"

    def words(self, number: Callable[[float], str]) -> str:
        """What a page on a scene says of its contacts; number: how it writes one."""
        pairs, walls = (" or ".join(map(number, dict.fromkeys(self.shares(*kind)))) for kind in ((True, False), (False, True)))
        return f"restitution {pairs} between disks, {walls} at walls: energy is lost{self.soon_words(number)}"

    def soon_words(self, number: Callable[[float], str]) -> str:
        """What it says of a contact that follows another one soon; nothing where a contact does not matter to the next."""
        if self.duration is None:
            return ""
        return f"; a contact within {number(self.duration)} of a disk's previous one is elastic (TC model)"

    def driven_words(self, number: Callable[[float], str]) -> str:
        """What it says of walls that heat, shake or slide; nothing where none does."""
        done = self.treatments or ()
        told = (
            ("; walls heat, by chance, at kT = ", [one.temperature for one in done if one.temperature is not None]),
            ("; walls shake at ", [one.shaking for one in done if one.shaking]),
            ("; walls slide at ", [one.velocity for one in done if one.velocity]),
        )
        return "".join(words + " or ".join(map(number, dict.fromkeys(values))) for words, values in told if values)

    def rough_words(self, number: Callable[[float], str]) -> str:
        """What it says of walls that do more than throw back, and of spins; nothing where there are none."""
        if self.rough is None:
            return self.driven_words(number)
        pair, wall = number(self.rough.pair), number(self.rough.wall)
        rough = f"; tangential restitution {pair} between disks, {wall} at walls (-1: smooth, 1: perfectly rough)"
        return rough + self.driven_words(number)

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
        then = "contacts may pile up at an instant: who lies on a wall rests then, else the run stops and says so"
        return f"{super().words(number)}; {then} (contact_duration avoids it)"


class TimeOfContact(Law):
    """The TC model: a contact within the duration of a disk's previous one is elastic.

    Source: Luding, McNamara, Granular Matter 1, 113 (1998), doi:10.1007/s100350050017.
    """

    __slots__ = ()

    def words(self, number: Callable[[float], str]) -> str:
        """What a page on a scene says of its contacts."""
        return f"{super().words(number)}, so contacts cannot pile up without end"

    def remedy(self) -> str:
        """What is left to do about contacts that pile up."""
        return f"contact_duration = {self.duration:g}, as in this scene, did not prevent it; a longer one may"


@dataclass(frozen=True, slots=True)
class Yielding(Law):
    """Fast contacts take more: above a speed v_y the usual restitution falls as (v_y / v)^(1/4).

    Attributes:
        yield_speed: v_y, length / time.
    """

    yield_speed: float
    by_speed: ClassVar[bool] = True

    def numbers(self) -> Numbers:
        """Its speed, and the duration if it has one."""
        return Numbers(self.duration, self.yield_speed)

    def name(self) -> str:
        """What a sentence calls it."""
        return "restitution that falls with the speed"

    def words(self, number: Callable[[float], str]) -> str:
        """What a page on a scene says of its contacts."""
        speed = number(self.yield_speed)
        return f"{Law.words(self, number)}; of an approach v above {speed}, ({speed} / v)^(1/4) of that comes back"


@dataclass(frozen=True, slots=True)
class Own(Law):
    """A law of the user's own says what comes back.

    Attributes:
        own: the function, with a name.
    """

    own: UsersLaw
    by_speed: ClassVar[bool] = True

    def numbers(self) -> Numbers:
        """The function, and the duration if there is one."""
        return Numbers(self.duration, own=self.own)

    def possible(self, usual: float, approach: float, least: float = 0.0) -> tuple[float, ...] | None:
        """Nobody but the function knows."""
        return None

    def comes_to_rest(self) -> bool:
        """What slow bounces do, nobody knows: disks go on bouncing."""
        return False

    def series(self, usual: float) -> float:
        """As if they kept their height."""
        return 1.0

    @property
    def refusal(self) -> str | None:
        """Why the function cannot be called."""
        return self.own.refusal

    def name(self) -> str:
        """What a sentence calls it."""
        return f"the law {self.own.name}"

    def words(self, number: Callable[[float], str]) -> str:
        """What a page on a scene says of its contacts."""
        return f"by {self.name()}, of your own: nobody else knows whether energy is kept{self.soon_words(number)}"


def wrong_share(share: Real) -> str | None:
    """Why a law of the user's own cannot have meant what it returns, a clause; None where it can."""
    if not isinstance(share, int | float) or not share < float("inf"):
        return "is no number that a contact can have"
    if share < -1.0:
        return "is an impulse that pulls"
    return "leaves disks approaching" if share < 0.0 else None


LAWS: tuple[type[Law], ...] = (Elastic, Inelastic, TimeOfContact, Yielding, Own)
"""The table of laws."""


def law_of(restitution: Shares | None, duration: float | None, own: UsersLaw | None = None) -> Law:
    """The law that goes by the numbers of a scene, with nothing of single walls, species and spins.

    Args:
        restitution: of the scene, None where it is elastic.
        duration: a contact duration.
        own: a law of the user's own.
    """
    if own is not None:
        pair, wall = (1.0, 1.0) if restitution is None else (restitution.pair, restitution.wall)
        return Own(pair, wall, duration, own)
    if restitution is None:
        return Elastic(1.0, 1.0, None)
    if restitution.yield_speed is not None:
        return Yielding(restitution.pair, restitution.wall, duration, restitution.yield_speed)
    kind = Inelastic if duration is None else TimeOfContact
    return kind(restitution.pair, restitution.wall, duration)

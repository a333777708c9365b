"""What a meter has gathered when the run is over, in the words that quantities ask in."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from eventsim.measure import sums
from eventsim.measure.blocking import FEWEST_BLOCKS, ErrorBar, ratio_average
from eventsim.measure.correlation import Correlations
from eventsim.measure.ensemble import Ensemble
from eventsim.measure.equilibration import settled_after
from eventsim.measure.profile import Profile
from eventsim.measure.sums import Plan, Sums
from eventsim.record.events import Floats
from eventsim.scene.names import plural

FEWEST_EVENTS = 32
"""Contacts, of all disks together, from which on their scatter says how sure a mean is: some 18 % of the bar itself."""

FADING = 2.0
"""Contacts of a disk in which what the mean speed of a gas has too much fades to 1 / e: long runs in thin gases, to 5 %."""

MEMORY = 3.0 * FADING
"""Contacts of a disk after which nothing is left of its speed."""

FEWEST_CONTACTS = 10.0
"""Contacts of a disk after which it may have forgotten how it began; a few are enough in a gas, at least one in a crowd."""

APART = 50.0
"""Contacts of a disk after which groups that never met are held apart: by chance a disk misses so many once in 1e21."""

NO_SCATTER = 1e-9
"""Share of a value below which its bar is rounding: what repeats itself for ever has no scatter to make a bar of."""

ON_A_LINE = 1e-18
"""Share of the squared energy that the determinant of the mean v v^T has for motion along one line: rounding, squared."""


LINE = "the disks move along one direction only and do not mix"
"""Why they have no temperature then."""

NEVER_MET = "the disks never met each other"
"""The same of those that move so beside each other."""

TOO_FEW = "too few to share the energy"
"""The same of contacts."""


@dataclass(frozen=True)
class Records:
    """Sums of a run, and what follows from them for all quantities alike.

    Attributes:
        ensemble, plan, wall_names, sums: see `Meter`.
        duration: of the run; end: of its last flight, which may be an ulp later.
        discard: what is asked to be left out; None: what the pressure tells.
        correlations, profile: of samples.
        groups: into how many the disks that carry energy fall by their contacts with each other.
        found: the values of quantities so far, by name.
    """

    ensemble: Ensemble
    plan: Plan
    wall_names: tuple[str, ...]
    duration: float
    end: float
    discard: float | None
    sums: Sums
    correlations: Correlations
    profile: Profile | None
    groups: int = 1
    found: dict[str, float] = field(default_factory=dict)

    # --- bins of time

    @property
    def origin(self) -> float:
        """Time at which the bins begin."""
        return float(self.sums.numbers[sums.ORIGIN])

    @property
    def width(self) -> float:
        """Of a bin, time; the last one is cut off by the end of the run."""
        return float(self.sums.numbers[sums.WIDTH])

    @cached_property
    def bins(self) -> Floats:
        """The bins (bins, channels) up to the end of the run; a last one that is not half full is part of the one before."""
        last = int(self.sums.counts[sums.PLACE])
        bins = self.sums.bins[: last + 1].copy()
        if last and self.end - self.origin - last * self.width < 0.5 * self.width:
            bins[-2] += bins[-1]
            bins = bins[:-1]
        return bins

    @property
    def count(self) -> int:
        """Number of bins."""
        return len(self.bins)

    @cached_property
    def all_widths(self) -> Floats:
        """Time of each bin (bins,)."""
        widths = np.full(self.count, self.width)
        widths[-1] = (self.end - self.origin) - (self.count - 1) * self.width
        return widths

    @cached_property
    def skipped(self) -> int:
        """Bins at the beginning that belong to the transient; none where it was said what to leave out."""
        if self.discard is not None or not self.ensemble.steady or self.ensemble.n < 2:
            return 0
        return settled_after(self.bins[:, sums.VIRIAL], float(self.bins[:, sums.PAIRS].sum()), self.ensemble.n)

    @property
    def discarded(self) -> float:
        """Time at the beginning that is left out."""
        return self.origin + self.skipped * self.width

    @cached_property
    def time(self) -> Floats:
        """Time of each bin that is kept."""
        return self.all_widths[self.skipped :]

    def channel(self, place: int) -> Floats:
        """One channel of the bins that are kept."""
        return self.bins[self.skipped :, place]

    # --- channels by what they mean

    def species(self, kind: int, place: int) -> Floats:
        """One channel of a species."""
        return self.channel(sums.GENERAL + sums.PER_SPECIES * kind + place)

    def met(self, kind: int, other: int) -> Floats:
        """Contacts of disks of one species with disks of another; those among themselves count for both."""
        return self.channel(sums.first_pair(self.plan) + self.plan.kinds * kind + other)

    def contacts(self, kind: int) -> Floats:
        """Contacts of disks of a species with disks that deflect it."""
        return sum((self.met(kind, other) for other in self.ensemble.partners), np.zeros_like(self.time))

    def wall(self, place: int, side: int) -> Floats:
        """Momentum across a wall that is given to one side of it."""
        return self.channel(sums.first_wall(self.plan) + sums.SIDES * place + side)

    def shear(self, place: int, side: int) -> Floats:
        """Momentum along a wall, in its direction, that is given to one side of it."""
        return self.channel(sums.first_shear(self.plan) + sums.SIDES * place + side)

    def turning_at(self, time: Floats) -> Floats:
        """Energy of the common rotation in a round container, L^2 / 2 I, at times since the start, (K,)."""
        samples = self.bins[:, sums.SAMPLES]
        if not samples.any():
            return np.zeros_like(time)
        middle = self.origin + np.cumsum(self.all_widths) - 0.5 * self.all_widths
        known = samples > 0.0
        found: Floats = np.interp(time, middle[known], self.bins[known, sums.ROTATION] / samples[known])
        return found

    @cached_property
    def boundary_force(self) -> Floats:
        """Impulse x distance from the middle, (all bins,), at the sides of the domain or a lone round container."""
        levers = self.sums.walls[: self.plan.walls, sums.LEVER]
        first = sums.first_wall(self.plan)
        given = self.bins[:, first : first + sums.SIDES * self.plan.walls].reshape(self.count, -1, sums.SIDES)
        found: Floats = given.sum(axis=2) @ levers
        return found

    @cached_property
    def reach_force(self) -> Floats:
        """Reach x impulse, (all bins,), between disks and at what bounds them: what kinetic energy leaves of P V."""
        at_walls = self.boundary_force - self.bins[:, sums.WALL_VIRIAL]
        found: Floats = self.bins[:, sums.VIRIAL] + at_walls
        return found

    def _over(self, kinds: range, place: int) -> Floats:
        return sum((self.species(kind, place) for kind in kinds), np.zeros_like(self.time))

    @property
    def everyone(self) -> range:
        """The species that carry energy."""
        return range(self.ensemble.kinds)

    @cached_property
    def pair_contacts(self) -> Floats:
        """Contacts of disks that carry energy with such disks (each for both) and with immovable ones."""
        return sum((self.contacts(kind) for kind in self.everyone), np.zeros_like(self.time))

    @cached_property
    def wall_contacts(self) -> Floats:
        """Contacts of disks that carry energy with walls."""
        return self._over(self.everyone, sums.HITS)

    @cached_property
    def path(self) -> Floats:
        """Length of the flights of disks that carry energy."""
        return self._over(self.everyone, sums.PATH)

    @property
    def all_contacts(self) -> Floats:
        """Contacts of all who move with others, in all bins."""
        ensemble, kinds = self.ensemble, self.plan.kinds
        movers = self.everyone if ensemble.n else range(kinds)
        first = sums.first_pair(self.plan)
        places = [first + kinds * k + other for k in movers if k != ensemble.posts for other in ensemble.partners]
        found: Floats = self.bins[:, places].sum(axis=1)
        return found

    # --- what the run was like

    @cached_property
    def pairs(self) -> float:
        """Contacts in what is kept between disks that carry energy: those that share it out."""
        return float(self.channel(sums.PAIRS).sum())

    @property
    def shared(self) -> float:
        """Contacts of a disk in which energy is shared, in what is kept."""
        return 2.0 * self.pairs / max(self.ensemble.n, 1)

    @cached_property
    def exchanged(self) -> tuple[float, int]:
        """The fewest contacts of equal disks that share out as much energy as those of a disk of one species, and which species.

        In a contact of masses m and M a disk gives 4 m M / (m + M)^2 of what it gives to its equal.
        """
        species = self.ensemble.species[: self.ensemble.kinds]
        if len(species) < 2:
            return self.shared, 0
        found = []
        for kind, one in enumerate(species):
            shares = [
                float(self.met(kind, k).sum()) * 4.0 / (2.0 + one.mass / it.mass + it.mass / one.mass)
                for k, it in enumerate(species)
            ]
            found.append((sum(shares) / one.number, kind))
        return min(found)

    @property
    def contacts_seen(self) -> float:
        """Contacts in what is kept, with disks, posts and walls, of disks that carry energy, else of tracers."""
        if not self.ensemble.n:
            return float(self.sums.disks[self.ensemble.movers, sums.HIT].sum())
        return float(self.pair_contacts.sum() + self.wall_contacts.sum()) - self.pairs

    @cached_property
    def on_a_line(self) -> str | None:
        """A clause where all disks moved along one direction, from the first to the last."""
        xx, xy, yy = (float(self.channel(k).sum()) for k in (sums.XX, sums.XY, sums.YY))
        trace = xx + yy
        if self.ensemble.n and trace > 0.0 and (xx / trace) * (yy / trace) - (xy / trace) ** 2 <= ON_A_LINE:
            return LINE if self.pairs else NEVER_MET
        return None

    @cached_property
    def moves(self) -> bool:
        """Whether anything that carries energy moves."""
        return bool(self.channel(sums.ENERGY).any())

    @cached_property
    def no_temperature(self) -> str | None:
        """Why there is no temperature, a clause; None where there is one."""
        lasting = self.ensemble.no_equilibrium if self.ensemble.n and self.moves else None
        return lasting or self.no_sharing

    @cached_property
    def no_sharing(self) -> str | None:
        """Why the disks did not share out their energy, a clause; None where they did, though it may change along the run."""
        ensemble = self.ensemble
        if ensemble.n and not self.moves:
            return "nothing moves"
        if ensemble.no_sharing is not None:
            return ensemble.no_sharing
        if self.on_a_line is not None:
            return self.on_a_line
        if ensemble.n < FEW and self.shared < FEWEST_CONTACTS:
            return f"{plural(int(self.pairs), 'contact')} between disks: {TOO_FEW}"
        if self.groups > 1 and self.shared > APART:
            return f"the disks fall into {self.groups} groups that never meet"
        return None

    @cached_property
    def no_pressure(self) -> str | None:
        """Why there is no pressure of the gas, a clause; None where there is one."""
        return self.no_temperature or self.ensemble.no_pressure

    @property
    def mixed(self) -> bool:
        """Whether every disk has had the contacts to come into equilibrium: else theory has nothing to say yet."""
        enough = self.shared >= FEWEST_CONTACTS and self.exchanged[0] >= FEWEST_CONTACTS
        return self.no_temperature is None and enough and self.groups == 1

    # --- bars

    def ratio(self, above: Floats, below: Floats, remembered: bool = False) -> ErrorBar:
        """sum(above) / sum(below), with an error bar where the run can tell one; see `barred`."""
        return self.barred(above, below, remembered)[0]

    def barred(self, above: Floats, below: Floats, remembered: bool = False) -> tuple[ErrorBar, str | None]:
        """sum(above) / sum(below), with an error bar, or the reason why the run can tell none.

        remembered: of what disks keep from one contact to the next, such as speeds.  Stretches are then at least as long as
        that memory where enough of them are left, and what they still have in common widens the bar: in a short run the scatter
        itself could not tell it.
        """
        step, fading = 1, math.nan
        if remembered and self.shared > 0.0:
            fading = FADING * float(self.time.sum()) / self.shared / self.width
            step = max(min(math.ceil(MEMORY / FADING * fading), len(above) // FEWEST_BLOCKS), 1)
        starts = np.arange(0, len(above), step)
        bar = ratio_average(np.add.reduceat(above, starts), np.add.reduceat(below, starts))
        bar = bar._replace(length=bar.length * step)
        if fading > 0.0:
            # the variance of blocks of length T is that of blocks without memory times 1 - x (1 - exp(-1 / x)), x = fading / T
            x = fading / bar.length
            bar = bar._replace(error=bar.error / math.sqrt(1.0 + x * math.expm1(-1.0 / x)))
        why = self._no_bar(bar, above)
        return (bar, None) if why is None else (bar._replace(error=math.nan), why)

    def _no_bar(self, bar: ErrorBar, above: Floats) -> str | None:
        """Why a ratio of sums has no error bar, a clause; None where it has one.  above: (bins,) the sums above."""
        if not self.ensemble.steady:
            return "an average over this run, which has no steady state"
        if self.contacts_seen < FEWEST_EVENTS:
            return f"{plural(int(self.contacts_seen), 'contact')}: too few for an error bar"
        if np.count_nonzero(above) < FEWEST_BLOCKS:
            return "too few such contacts for an error bar"
        if math.isnan(bar.error):
            return "the run is too short for an error bar"
        if bar.error <= NO_SCATTER * abs(bar.mean):
            return "it is the same at all times: no scatter to make an error bar of"
        return None


FEW = 16
"""Disks below which a temperature needs contacts: the energy that few disks share is not told by how they begin."""

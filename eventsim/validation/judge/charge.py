"""Which contacts are charged to an engine, and as what: found, missed, doubled, false, or a consequence of errors before."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from eventsim.errors import EventsimError
from eventsim.readers.contacts import ToldContacts
from eventsim.record.contacts import Key, contacts_of, keys_of
from eventsim.record.events import Floats, Kind
from eventsim.scene.stage import Stage
from eventsim.validation.judge.faults import Fault, Witness
from eventsim.validation.judge.matching import matched
from eventsim.validation.judge.outcome import named
from eventsim.validation.judge.told import Met
from eventsim.validation.truth import Truth


@dataclass(slots=True)
class Charge:
    """Contacts of disks that were still in place.

    found, missed: of the truth.  doubled, false: of the engine.  elsewhere: of the truth or the engine, where the engine's own
    path, off by errors before, asks for what it did.  unseen: of the truth, too weak to be
    seen in the samples, or too close to other contacts; unseen_at: when they are.
    untold_at: when contacts were found whose impulse the paths do not tell.
    all_at, compared_at: the times of all contacts of the truth, and of those that were found or missed.
    errors: (found, 2) the time of each found contact, and by how much the engine's is later.
    parting: (time, sentence) of the first contact elsewhere.
    """

    found: int = 0
    missed: int = 0
    doubled: int = 0
    false: int = 0
    elsewhere: int = 0
    unseen_at: list[float] = field(default_factory=list)
    untold_at: list[float] = field(default_factory=list)
    all_at: list[float] = field(default_factory=list)
    compared_at: list[float] = field(default_factory=list)
    errors: Floats = field(default_factory=lambda: np.empty((0, 2)))
    faults: list[Fault] = field(default_factory=list)
    parting: tuple[float, str] | None = None

    @property
    def unseen(self) -> int:
        """The contacts of the truth that samples cannot show."""
        return len(self.unseen_at)

    @property
    def untold(self) -> int:
        """The contacts that were found, of which nobody knows what they did."""
        return len(self.untold_at)

    def unchecked(self, before: float) -> int:
        """The contacts of the truth before a time that were neither found nor missed."""
        return sum(time < before for time in self.all_at) - sum(time < before for time in self.compared_at)

    @property
    def ahead(self) -> int:
        """The contacts that the engine had before it: found and missed."""
        return self.found + self.missed


@dataclass(frozen=True, slots=True)
class Window:
    """What may be matched.

    tolerance: of times.  step: between samples; contacts of one pair that are nearer count once.  lost: (n,) from when on a disk
    is not in its place any more.  end: the last time that was compared.
    """

    tolerance: float
    step: float
    lost: Floats
    end: float

    def covers(self, key: Key, time: float) -> bool:
        """Whether a contact counts: its disks are in place, and it cannot be matched with one behind the end."""
        return all(time <= self.lost[disk] for disk in _disks(key)) and time + self.tolerance <= self.end


def charged(truth: Truth, met: Sequence[Met], window: Window, witness: Witness, least: float) -> Charge:
    """Match the contacts of an engine with those of the truth, and charge what is left.

    Args:
        truth: the event-driven run.
        met: what the engine did, in order of time.
        window: what may be matched.
        witness: what looks at the engine's own path.
        least: the smallest change of velocity that is seen; 0 where contacts are told.
    """
    stage, rows = truth.stage, contacts_of(truth.run.rows)
    named_walls = all(one.key[0] == Kind.PAIR or one.key[2] >= 0 for one in met)
    whole = _once(list(zip(keys_of(rows), rows["time"].tolist(), rows["impulse"].tolist(), strict=True)), window.step)
    exact = [(_plain(key, named_walls), time) for key, time, _ in whole]
    match = matched(exact, [(_plain(one.key, named_walls), one.time) for one in met], window.tolerance)
    charge = Charge(all_at=[time for _, time, _ in whole if time <= window.end])
    pairs = [(exact[i][1], met[j].time) for i, j in match.pairs if window.covers(*exact[i])]
    charge.found, charge.compared_at = len(pairs), [time for time, _ in pairs]
    charge.errors = np.array([(time, told - time) for time, told in pairs]).reshape(-1, 2)
    charge.untold_at = [exact[i][1] for i, j in match.pairs if window.covers(*exact[i]) and not witness.tells(met[j])]
    for i in match.missed:
        key, time, impulse = whole[i]
        if not window.covers(key, time):
            continue
        fault, weak = witness.missed(key, time), _change(key, impulse, stage) < 2.0 * least
        if (
            weak
            or (least and (fault is None or not fault.clear) and witness.is_blurred(key, time))
            or (fault is not None and fault.kind != "leak" and _is_answered(exact[i], met, named_walls, window.tolerance))
        ):
            charge.unseen_at.append(time)
        elif fault is not None:
            charge.missed += 1
            charge.compared_at.append(time)
            charge.faults.append(fault)
        else:
            _parts(charge, time, f"its path does not come to the contact of {named(key, stage)} at t = {time:.6g}")
    for j in match.surplus:
        one = met[j]
        if not window.covers(one.key, one.time) or (least and not one.alone):
            continue  # turns of several contacts do not tell who met
        near = _nearest(met, j)
        if near is not None and not least and (_is_any_wall(one.key, stage) or _has_met_between(met, one, near)):
            near = None
        fault = witness.surplus(one, near)
        if fault is None:
            who = named(one.key, stage)
            _parts(charge, one.time, f"its path leads to a contact of {who} at t = {one.time:.6g}, which the true one has not")
            continue
        charge.faults.append(fault)
        if fault.kind == "doubled":
            charge.doubled += 1
        else:
            charge.false += 1
    return charge


def _is_answered(contact: tuple[Key, float], met: Sequence[Met], named_walls: bool, tolerance: float) -> bool:
    """Whether the same two meet then all the same, so that an overlap is that of a late contact of theirs."""
    key, time = contact
    return any(abs(one.time - time) <= tolerance and _plain(one.key, named_walls) == key for one in met)


def _has_met_between(met: Sequence[Met], one: Met, other: Met) -> bool:
    """Whether one of the two has met something else between two contacts of theirs, so that they may meet again."""
    begin, end = sorted((one.time, other.time))
    disks = {disk for disk in _disks(one.key) if disk >= 0}
    return any(begin <= each.time <= end and each.key != one.key and not disks.isdisjoint(_disks(each.key)) for each in met)


def _is_any_wall(key: Key, stage: Stage) -> bool:
    """Whether a wall is meant that is not named, and there are several: the next contact may be with another one."""
    return key[0] == Kind.WALL and key[2] < 0 and len(stage.wall_names) > 1


def _disks(key: Key) -> tuple[int, ...]:
    """The disks of a contact."""
    return key[1:] if key[0] == Kind.PAIR else key[1:2]


def _parts(charge: Charge, time: float, sentence: str) -> None:
    """Note a contact that is elsewhere; the first one is where the paths part."""
    charge.elsewhere += 1
    if charge.parting is None or time < charge.parting[0]:
        charge.parting = (time, sentence)


def _nearest(met: Sequence[Met], place: int) -> Met | None:
    """The contact of the same two that is nearest in time."""
    one = met[place]
    same = [other for number, other in enumerate(met) if other.key == one.key and number != place]
    return min(same, key=lambda other: abs(other.time - one.time), default=None)


def _once(contacts: list[tuple[Key, float, float]], step: float) -> list[tuple[Key, float, float]]:
    """Contacts without those that follow one of the same two within a step: samples cannot tell them apart."""
    last: dict[Key, float] = {}
    kept = []
    for key, time, impulse in contacts:
        if key not in last or time - last[key] > step or not step:
            kept.append((key, time, impulse))
        last[key] = time
    return kept


def _plain(key: Key, named_walls: bool) -> Key:
    """A key to match by: where the engine does not tell which wall, any will do."""
    return key if named_walls or key[0] == Kind.PAIR else (key[0], key[1], -1)


def _change(key: Key, impulse: float, stage: Stage) -> float:
    """By how much a contact changes the velocity of the lighter of its disks."""
    lightest = min(stage.common_mass if stage.mass is None else float(stage.mass[disk]) for disk in _disks(key))
    return impulse / lightest if lightest > 0.0 else float("inf")


def in_our_form(contacts: ToldContacts, stage: Stage) -> list[Met]:
    """Contacts that an engine tells, in our form; walls by their names, the only wall where it tells none."""
    names = {name: number for number, name in enumerate(stage.wall_names)}
    found = []
    for time, a, b, wall in zip(contacts.time.tolist(), contacts.a.tolist(), contacts.b.tolist(), contacts.wall, strict=True):
        if b >= 0:
            found.append(Met((int(Kind.PAIR), a, b), time, 0, 0))
        else:
            if wall and wall not in names:
                raise EventsimError(f"the contacts name a wall {wall!r}; the scene has {', '.join(stage.wall_names) or 'none'}")
            found.append(Met((int(Kind.WALL), a, names.get(wall, -1)), time, 0, 0))
    return found

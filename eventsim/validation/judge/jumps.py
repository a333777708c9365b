"""Jumps: energy or momentum that disks have after a turn and had not before, whatever contacts they may have had in it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from eventsim.record.events import Floats
from eventsim.validation.judge.faults import Fault
from eventsim.validation.judge.flights import Flights, Mask, Turn
from eventsim.validation.judge.outcome import CLEAR
from eventsim.validation.judge.surroundings import Surroundings
from eventsim.validation.judge.told import NEAR, flown_at, is_beside_something

BESIDE = 2
"""Samples before and after turns in which another disk that turns may have been part of them."""


def jumps(
    groups: Sequence[Sequence[Turn]], flights: Flights, around: Surroundings, mass: Floats, known: Sequence[Fault]
) -> Iterator[Fault]:
    """Turns that together change the energy, or away from walls the momentum, as no contacts can.

    Contacts that follow each other faster than samples cannot be told apart, but what they do together can: elastic ones keep
    the energy, others lose some.

    Args:
        groups: turns at one time of disks that are close.
        flights: the paths.
        around: walls, and the law of contacts.
        mass: (n,), inf for immovable disks.
        known: faults that name the contact itself; turns of them are left out.
    """
    held = ~np.isfinite(mass)
    if bool(np.any(np.hypot(*flights.before[0, held].T) > 0.0)):
        return  # a moving obstacle gives energy
    weight = np.where(held, 0.0, mass)
    for group in groups:
        if any(turn.ends for turn in group) or _is_known(group, flights, known) or _may_lack_some(group, flights, around, held):
            continue
        fault = _energy(group, flights, around, weight) or _momentum(group, flights, around, mass)
        if fault is not None:
            yield fault


def _is_known(group: Sequence[Turn], flights: Flights, known: Sequence[Fault]) -> bool:
    """Whether a fault of one of these disks was seen there."""
    first, last = _span(group)
    begin, end = flights.times[max(first - 1, 0)], flights.times[min(last + 1, len(flights.times) - 1)]
    disks = {turn.disk for turn in group}
    return any(begin <= fault.time <= end and not disks.isdisjoint(fault.disks) for fault in known)


def _may_lack_some(group: Sequence[Turn], flights: Flights, around: Surroundings, held: Mask) -> bool:
    """Whether a disk that turns right before or after them is so near that it may have met one of them unseen."""
    first, last = _span(group)
    span = slice(max(first - 1, 0), last + 2)
    others = flights.turned[max(first - BESIDE, 0) : last + 1 + BESIDE].any(axis=0) & ~held
    others[[turn.disk for turn in group]] = False
    radius = around.stage.radius
    for other in np.flatnonzero(others).tolist():
        way = np.hypot(*np.diff(flights.place[span, other], axis=0).T).max(initial=0.0)
        for turn in group:
            margin = NEAR * float(radius[other] + radius[turn.disk]) + float(way) + flown_at(flights, turn)
            if around.gap(turn.disk, other, flights.place[span, turn.disk], flights.place[span, other]) < margin:
                return True
    return False


def _span(group: Sequence[Turn]) -> tuple[int, int]:
    """The first and the last sample of turns."""
    return min(turn.first for turn in group), max(turn.last for turn in group)


def _energy(group: Sequence[Turn], flights: Flights, around: Surroundings, weight: Floats) -> Fault | None:
    gain = whole = doubt = 0.0
    heaviest = float(weight.max())
    for turn in group:
        before, after = math.hypot(*turn.before), math.hypot(*(turn.before + turn.change))
        lag = float(flights.times[turn.last] - flights.times[turn.first])
        m = float(weight[turn.disk])
        gain += 0.5 * m * (after**2 - before**2)
        whole += 0.5 * m * before**2
        doubt += max(m, heaviest) * (before + after) * (flights.least + lag * math.hypot(*flights.pull[turn.disk]))
    loses = around.stage.law.loses_energy()
    if (gain if loses else abs(gain)) <= CLEAR * whole + doubt:
        return None
    first, last, disks = _where(group, flights, weight)
    begin, end = float(flights.times[first]), float(flights.times[last])
    said = (
        f"energy: that of {_named(disks)} changes by {gain:+.3g}, of {whole:.3g}, between t = {begin:.6g} and {end:.6g}, "
        "which no contact does"
    )
    return Fault(end, "energy", said, disks)


def _where(group: Sequence[Turn], flights: Flights, weight: Floats) -> tuple[int, int, tuple[int, ...]]:
    """The samples between which energy changes most, and the disks that turn there; all of a group where none is told."""
    first, last = _span(group)
    disks = sorted({turn.disk for turn in group})
    if flights.told:
        speeds = flights.before[first : last + 1, disks]
        energy = np.sum(weight[disks] * np.sum(speeds**2, axis=-1), axis=1)
        first += int(np.argmax(np.abs(np.diff(energy))))
        last = first + 1
        disks = [disk for disk in disks if flights.turned[first, disk]] or disks
    return first, last, tuple(disks)


def _momentum(group: Sequence[Turn], flights: Flights, around: Surroundings, mass: Floats) -> Fault | None:
    if len(group) < 2 or any(is_beside_something(turn, flights, around, mass) for turn in group):
        return None
    given = [float(mass[turn.disk]) * turn.change for turn in group]
    whole = sum(math.hypot(*one) for one in given)
    lag = sum(
        float(flights.times[turn.last] - flights.times[turn.first]) * math.hypot(*flights.pull[turn.disk]) for turn in group
    )
    doubt = float(mass[np.isfinite(mass)].max()) * (len(group) * flights.least + lag)
    left = math.hypot(*sum(given, np.zeros(2)))
    if left <= CLEAR * whole + doubt:
        return None
    disks = tuple(sorted({turn.disk for turn in group}))
    begin, end = (float(flights.times[sample]) for sample in _span(group))
    said = (
        f"momentum: {_named(disks)} get {left:.3g} of it together between t = {begin:.6g} and {end:.6g}, away from walls: "
        "no contact gives any"
    )
    return Fault(end, "momentum", said, disks)


def _named(disks: tuple[int, ...]) -> str:
    if len(disks) == 1:
        return f"disk {disks[0]}"
    return f"disks {', '.join(map(str, disks[:-1]))} and {disks[-1]}"

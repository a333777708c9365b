"""Contacts without end: inelastic collapse, a bounce that dies out, disks that rest on each other."""

from __future__ import annotations

import math

import numpy as np

from eventsim.scene import Disks, Open, Scene, Segment
from eventsim.scene.gallery import gallery
from eventsim.validation.stress.case import GOES_ON, Bench, Case, GaveUpError, off
from eventsim.validation.stress.catalogue.scenes import in_box, lattice_gas, on_plane

ULP = 2.0**-52
COLLAPSE_TIME = 1.78303658
"""Of e = .0717, from 400 digits."""
WALL_COLLAPSE_TIME = 4.16370644
"""Of a wall and two disks with e = .17, from 400 digits."""


def _eleven(bench: Bench) -> float:
    return abs(bench.run(gallery("collapse", restitution=0.08)).counters.events - 11)


def _collapse(bench: Bench) -> float:
    """How far the end is from the collapse in time; a run may stop before it, where its digits are spent."""
    run = bench.run(gallery("collapse", restitution=0.0717), may_give_up=True)
    if run.stopped in ("collapse", "digits") and run.time < COLLAPSE_TIME:
        raise GaveUpError(run.stopped, run.reason)
    return abs(run.time - COLLAPSE_TIME) if run.stopped == "collapse" else math.inf


def _with_duration(bench: Bench) -> float:
    """0 for a run of 10 contacts a disk that goes through, 1 for one that does not."""
    scene = lattice_gas(100, 0.4, seed=2, restitution=0.6, contact_duration=1e-4)
    run = bench.run(scene, events=500)
    return float(run.counters.events < 500 or not np.isfinite(run.state.velocity).all())


def _bounce(gravity: float = 2.0) -> Scene:
    return in_box(10.0, [[5.0, 1.5]], [[0.0, 0.0]], gravity=(0.0, -gravity), restitution=0.5)


def _zeno(bench: Bench) -> float:
    run = bench.run(_bounce(), events=40, log=True)
    return off(run.log.time[:40], [3.0 - 2.0 ** (2 - n) for n in range(1, 41)])


def _after_zeno(bench: Bench) -> float:
    """How far from the floor the disk is at time 10; a run that stops must do so at time 3."""
    run = bench.run(_bounce(), until=10.0, may_give_up=True)
    height = abs(float(run.state.position[0, 1]) - 0.5)
    if run.stopped not in GOES_ON:
        if height == 0.0 and abs(run.time - 3.0) < 1e-12:
            raise GaveUpError(run.stopped, run.reason)
        return math.inf
    return height


def _rest(bench: Bench) -> float:
    """A disk slides on the floor, meets a wall at t = 1 and slides back."""
    disks = Disks([[5.0, 0.5]], [[1.0, 0.0]], 0.5)
    wall = Segment((6.5, 0.0), (6.5, 3.0))
    floor = Segment((0.0, 0.0), (10.0, 0.0))
    run = bench.run(Scene(disks, Open(), walls=[floor, wall], gravity=(0.0, -1.0)), until=3.0)
    return off(run.state.position, [[4.0, 0.5]])


def _stack(bench: Bench) -> float:
    """Energy and positions of a stack and of a disk in a V; both may be refused."""
    stack = in_box(10.0, [[5.0, 0.5], [5.0, 1.5]], [[0.0, 0.0]] * 2, gravity=(0.0, -1.0), restitution=0.5)
    one = bench.run(stack, until=2.0, may_give_up=True)
    root = math.sqrt(0.5)
    v = [Segment((-4.0, 4.0), (0.0, 0.0)), Segment((0.0, 0.0), (4.0, 4.0))]
    disk = Disks([[0.0, 0.5 / root + 0.25]], [[0.0, 0.0]], 0.5)
    two = bench.run(Scene(disk, Open(), walls=v, gravity=(0.0, -1.0), restitution=0.5), until=20.0, may_give_up=True)
    worst = max(off(one.state.position, stack.disks.position), off(two.state.position, [[0.0, 0.5 / root]]))
    for run in (one, two):
        if run.stopped not in GOES_ON and worst < 1e-9:
            raise GaveUpError(run.stopped, run.reason)
    return worst


def _no_restitution(bench: Bench) -> float:
    pair = on_plane([[-3.0, 0.25], [0.0, 0.0]], [[1.0, 0.0], [0.125, 0.0]], restitution=0.0)
    run = bench.run(pair, until=50.0)
    crowd = lattice_gas(30, 0.3, restitution=0.0, contact_duration=1e-3)
    lost = bench.run(crowd, events=500).counters.events < 500
    return abs(run.counters.events - 1) + float(lost)


def wall_and_two(restitution: float) -> Scene:
    """A wall, a disk at rest, and one that flies onto it; critical restitution 3 - 2 sqrt 2 = .17157."""
    disks = Disks([[1.0, 0.0], [3.0, 0.0]], [[0.0, 0.0], [-1.0, 0.0]], 0.5)
    return Scene(disks, Open(), walls=[Segment((-0.5, -9.0), (-0.5, 9.0))], restitution=restitution)


def bent_three() -> Scene:
    """Three disks, nearly in line, near the critical restitution 7 - 4 sqrt 3 = .0718."""
    place = [[0.0, 0.0], [2.0, 0.001], [3.7, 0.0]]
    return on_plane(place, [[1.0, 0.0], [0.0, 0.0], [-0.7, 0.0]], restitution=0.0728)


def _within_digits(bench: Bench) -> float:
    counts = ((0.19, 11), (0.175, 26))
    return max(abs(bench.run(wall_and_two(e), until=20.0).counters.events - true) for e, true in counts)


def _below_digits(bench: Bench, scene: Scene, known: int, true: float) -> float:
    """Contacts too many or too few; a run that stops must have those that the digits tell, and none that is made up.

    known: contacts that gaps above 1e-13 decide.  true: how many there are.
    """
    run = bench.run(scene, until=40.0, may_give_up=True)
    count = run.counters.events
    if run.stopped not in GOES_ON and known <= count <= true:
        raise GaveUpError(run.stopped, run.reason)
    return abs(count - true)


def _critical_wall(bench: Bench) -> float:
    """Contacts too many or too few, for ever more of them."""
    counts = ((0.172, 74), (0.1717, 137), (0.1716, 297))
    return max(_below_digits(bench, wall_and_two(e), 32, true) for e, true in counts)


def _endless_wall(bench: Bench) -> float:
    """How far the end is from the collapse in time; a run that stops before it must have used its digits."""
    run = bench.run(wall_and_two(0.17), until=5.0, may_give_up=True)
    if run.stopped in ("collapse", "digits") and run.counters.events >= 31 and run.time < WALL_COLLAPSE_TIME:
        raise GaveUpError(run.stopped, run.reason)
    return abs(run.time - WALL_COLLAPSE_TIME) if run.stopped in ("collapse", "digits") else math.inf


def _bent(bench: Bench) -> float:
    return _below_digits(bench, bent_three(), 10, 25)


CASES = (
    Case(
        "f22-eleven",
        "three inelastic disks, e = .08: eleven contacts",
        "The gaps shrink by a factor of twelve a round; contacts are lost or doubled.",
        "11 contacts, from 400 digits (McNamara & Young 1992, doi:10.1063/1.858323).",
        0.0,
        "A count.",
        _eleven,
    ),
    Case(
        "f22-collapse",
        "three inelastic disks, e = .0717: infinitely many",
        "The contacts never end; engines hang, or end by an accident of rounding.",
        "Collapse at 1.78303658, or the statement that the digits are spent.",
        1e-7,
        "The time is known to 1e-8; float gaps end at about 1e-8 before it.",
        _collapse,
        ("digits", "collapse"),
    ),
    Case(
        "f22-duration",
        "a gas with e = .6 and a contact duration",
        "Clusters collapse; the TC model keeps them going.",
        "The run goes on.",
        0.0,
        "Yes or no.",
        _with_duration,
    ),
    Case(
        "f23-zeno",
        "a bounce that dies out: the first forty impacts",
        "Flights halve each time; a step is soon longer than all that remain.",
        "Impacts at 3 - 2^(2-n), bit-exact.",
        0.0,
        "All numbers are dyadic.",
        _zeno,
    ),
    Case(
        "f23-after",
        "a bounce that dies out: after the last impact",
        "The disk sinks through the floor, or the run hangs at t = 3.",
        "On the floor; a run that ends says so at t = 3.",
        1e-12,
        "Heights below the last impacts' 2^-40.",
        _after_zeno,
        ("collapse",),
    ),
    Case(
        "f24-rest",
        "a disk that rests on the floor slides to a wall",
        "At rest under gravity every instant is a contact.",
        "Wall at t = 1, y = r for ever; or a refusal with the remedy.",
        1e-12,
        "A few rounded operations.",
        _rest,
        ("collapse",),
    ),
    Case(
        "f24-stack",
        "a stack of two disks, and a disk in a V",
        "Rest on several supports has no closed form for rigid disks with restitution.",
        "Refused, disks and remedy named, before anything sinks.",
        1e-6,
        "Stepped engines sink by about a step's fall.",
        _stack,
        ("collapse",),
    ),
    Case(
        "f35-no-restitution",
        "e = 0",
        "A pair that has met still rounds to approaching: the same contact for ever.",
        "One contact of a pair; a crowd goes on with a contact duration.",
        0.0,
        "A count.",
        _no_restitution,
    ),
    Case(
        "p4-within",
        "a wall and two disks, e a little above the critical one",
        "The gaps shrink by orders of magnitude before the contacts end.",
        "11 contacts for e = .19, 26 for e = .175, from 400 digits (critical: 3 - 2 sqrt 2).",
        0.0,
        "A count.",
        _within_digits,
    ),
    Case(
        "p4-wall",
        "a wall and two disks, e just above the critical one",
        "The gaps sink below the digits, where rounding makes contacts up, or loses them.",
        "74 contacts for e = .172, 137 for .1717, 297 for .1716, from 400 digits; or the statement that the digits are spent.",
        0.0,
        "A count; who stops must have the 32 contacts whose gaps are above 1e-13.",
        _critical_wall,
        ("digits", "collapse"),
    ),
    Case(
        "p4-endless",
        "a wall and two disks, e = .17, just below the critical one",
        "The contacts never end; rounding ends them.",
        "Collapse at 4.16370644, from 400 digits, or the statement that the digits are spent.",
        1e-7,
        "The time is known to 1e-8; float gaps end at about 1e-8 before it.",
        _endless_wall,
        ("digits", "collapse"),
    ),
    Case(
        "p4-bent",
        "three disks, nearly in line, e = .0728",
        "The gaps sink below the digits before the bend parts the disks; the rest is rounding.",
        "25 contacts, the last gap 7e-22, from 400 digits; or the statement that the digits are spent.",
        0.0,
        "A count; who stops must have the 10 contacts whose gaps are above 1e-13.",
        _bent,
        ("digits", "collapse"),
    ),
)

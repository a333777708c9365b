"""What a scene needs, in words: one short paragraph for each topic."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from eventsim.cli.words import aligned, point, short, title
from eventsim.engines.reference.cells import ENOUGH_DISKS
from eventsim.scene.names import plural
from eventsim.scene.settling import Settling, settling
from eventsim.scene.walls import SHAPES

if TYPE_CHECKING:
    from eventsim.cli.needs import Needs
    from eventsim.scene.origins import Origins
    from eventsim.validation.near_ties import NearTie

DOMAINS = {
    "box": "hard walls left, right, bottom and top",
    "periodic": "what leaves on one side comes in on the other; no walls, no corners",
    "channel": "periodic along x, hard walls bottom and top",
}
MANY = 10
"""Moving disks from which on a temperature is worth a word."""

FEW_BITS = 37
"""So many bits of a gap or fewer, 2^16 diameters or more, are worth a word."""

SHAPE_WORDS = {kind.__name__.lower(): kind.word() for kind in SHAPES}

POINTS = (
    "a point (any radius below a 2^42th of a wall's coordinates is 0 there) stays on its side of a wall, to the last bit; one"
    " that hits a vertex or a free end exactly turns round (the limit of a central hit)"
)
"""What disks without a radius do at walls."""


HOT = 100.0
"""A temperature above which somebody may mean kelvin."""

NEVER_AT_REST = (
    "none under this law: a disk left on a floor or in a pile goes on bouncing. If it does so ever lower, contacts come ever"
    " faster, and a run may not get to its stop time: --events N ends it, a contact_duration avoids it"
)
"""What holds where a law does not say that slow bounces end."""


def page(asked: str, name: str | None, needs: Needs, origins: Origins | None = None) -> str:
    """Return the whole page that `eventsim check` prints."""
    stop = "" if _stops(needs) else "; eventsim run needs --until T or --events N, as the scene has no stop"
    return f"{title(asked, name)}: a valid scene{stop}\n{aligned(list(explanation(needs, origins)))}"


def explanation(needs: Needs, origins: Origins | None = None) -> Iterator[tuple[str, str]]:
    """Yield (topic, words): what may surprise, the scene in the order in which its file is read, the machinery.

    origins: of a file.
    """
    if needs.near_ties:
        yield "warning", _near_ties(needs.near_ties)
    if origins is not None and origins.twins:
        yield "seeds", "; ".join(map(_twins, origins.twins))
    surprising = not needs.law.keeps_energy()
    if surprising:
        yield "contacts", _contacts(needs)
    if needs.gravity is not None and needs.gravity[1] > 0.0:
        yield "gravity", "it points upwards; downwards is gravity = [0.0, -9.81]"
    lands = needs.walls or needs.immovable or needs.domain in ("box", "channel")
    if needs.gravity is not None and lands and needs.disks > needs.immovable:
        if needs.contact_duration is not None:
            yield "rest", _rest(settling(needs.disks - needs.immovable, needs.radii[0], needs.gravity), needs.contact_duration)
        elif needs.law.by_speed and not needs.law.comes_to_rest():
            yield "rest", NEVER_AT_REST
    yield "disks", _disks(needs)
    if origins is not None and len(origins.shares) > 1:
        yield "numbers", _numbers(origins)
    yield "motion", _motion(needs)
    yield "domain", _domain(needs)
    if needs.walls:
        yield "walls", _walls(needs)
    if needs.table is not None:
        yield "table", _table(needs.table)
    yield "flights", _flights(needs)
    if not surprising:
        yield "contacts", _contacts(needs)
    if needs.touching_pairs or needs.touching_notes:
        yield "start", _start(needs)
    yield "stop", _stop(needs)
    yield "search", _search(needs)
    yield "clock", _clock(needs)
    yield "engine", _engine(needs)


def _disks(needs: Needs) -> str:
    if needs.species_count == 1:
        text = f"{plural(needs.disks, 'disk')}, radius {short(needs.radii[0])}, mass {short(needs.masses[0])}"
    else:
        species = [f"{s.count:,} of radius {short(s.radius)}, mass {short(s.mass)}" for s in needs.species]
        rest = needs.species_count - len(species)
        if rest > 0:
            species.append(f"and {plural(rest, 'more kind')}")
        text = f"{plural(needs.disks, 'disk')}: {'; '.join(species)}"
    if needs.packing_fraction is not None:
        covering = "it covers" if needs.disks == 1 else "they cover"
        whole = needs.size is not None and not needs.walls and not needs.immovable
        free = "the domain" if whole else "what walls and posts leave free"
        text += f"; {covering} {100 * needs.packing_fraction:.3g} % of {free}"
    parts = []
    if needs.immovable:
        unmoved = "nothing deflects it" if needs.gravity is None else "neither contacts nor gravity deflect it"
        parts.append(f"mass inf: {unmoved}")
    if needs.tracers:
        parts.append("mass 0: a tracer, which deflects nobody")
    return ". ".join([text, *(part[0].upper() + part[1:] for part in parts)])


def _numbers(origins: Origins) -> str:
    first, blocks = 0, []
    for table, count in origins.shares:
        blocks.append(f"{first:,} is of {table}" if count == 1 else f"{first:,} to {first + count - 1:,} are of {table}")
        first += count
    mixed = origins.shares[0][0].startswith("[[") and len(origins.shares) > 1
    return ", ".join(blocks) + (", whatever their order in the file" if mixed else "")


def _twins(gases: tuple[int, ...]) -> str:
    *others, last = (f"gas[{i}]" for i in gases)
    alike = f"{', '.join(others)} and {last} have one seed and draw the same numbers"
    return f"{alike}: give each its own, or their disks begin alike"


def _motion(needs: Needs) -> str:
    if needs.moving == 0:
        return "all at rest"
    text = f"{needs.moving:,} of {needs.disks:,} move" if needs.moving < needs.disks else "all move"
    text = "it moves" if needs.disks == 1 else text
    text += f", the fastest at {short(needs.fastest)}"
    if needs.temperature is not None and needs.moving >= MANY:
        text += f"; mean m v^2/2 is {short(needs.temperature)}, the temperature kT of a gas"
        if float(needs.temperature) > HOT:
            text += " (kT is an energy in the units of the scene, no kelvin)"
    return text


def _domain(needs: Needs) -> str:
    if needs.size is None:
        return "the open plane: no boundary"
    place = "" if needs.origin == (0.0, 0.0) else f" from {point(*needs.origin)}"
    return f"{needs.domain} {short(needs.size[0])} x {short(needs.size[1])}{place}: {DOMAINS[needs.domain]}"


def _walls(needs: Needs) -> str:
    named = ", ".join(f"{name} ({kind})" for name, kind in needs.walls.items())
    shapes = ", ".join(plural(count, SHAPE_WORDS[shape]) for shape, count in needs.shapes.items())
    images = ", periodic images included" if needs.domain in ("periodic", "channel") else ""
    text = f"{named}; made of {shapes}{images}, each tried by every disk"
    return f"{text}; {POINTS}" if needs.points else text


def _table(table: tuple[float, float, float]) -> str:
    area, perimeter, path = (short(number) for number in table)
    return f"its centre sees area {area}, perimeter {perimeter}; the mean free path, over all ways, is pi A / P = {path}"


def _flights(needs: Needs) -> str:
    if needs.gravity is None:
        return f"straight lines: no gravity, and no term is computed for it{_lost(needs)}"
    text = f"parabolas, gravity {point(*needs.gravity)}; it cancels between disks, so only walls see the curve"
    if needs.shapes.keys() - {"face"}:
        text += "; a parabola against a round wall or a wall's end is a quartic, solved by bracketing"
    if needs.immovable:
        text += "; disks of mass inf fly straight, so others meet them on parabolas too"
    return text + _lost(needs)


def _lost(needs: Needs) -> str:
    if needs.gap_bits is None or needs.gap_bits > FEW_BITS:
        return ""
    return f"; coordinates are so large, beside the disks, that {needs.gap_bits} of the 53 bits of a gap are left"


def _contacts(needs: Needs) -> str:
    law = needs.law
    if not law.keeps_energy():
        return law.words(short) + law.rough_words(short)
    kept = "but a moving disk of mass inf does work, so energy is not conserved"
    if not needs.obstacles:
        kept = "energy is conserved; the run says in the end how far rounding changed it"
    text = f"{law.words(short)}{law.rough_words(short)}{'; ' if needs.obstacles else ': '}{kept}"
    return f"{text}; masses so uneven that velocities carry what their rounding leaves" if needs.low_parts else text


def _rest(told: Settling, duration: float) -> str:
    cost = f"none with a contact_duration: a disk left on a floor or in a pile {told.cost(duration)}, if all are"
    cost += ", and rows of a log"
    is_short = told.duration is not None and duration < told.duration
    return f"{cost}; {told.rule()}" if is_short else cost


def _start(needs: Needs) -> str:
    sentences = list(needs.touching_notes)
    if needs.touching_pairs:
        pairs = "1 pair touches" if needs.touching_pairs == 1 else f"{needs.touching_pairs:,} pairs touch"
        sentences.insert(0, f"{pairs}; contacts of one instant that share disks are resolved together")
    return "; ".join(sentences)


def _near_ties(ties: tuple[NearTie, ...]) -> str:
    first = ties[0]
    one, other = (_contact(*contact) for contact in (first.first, first.second))
    more = f", and {plural(len(ties) - 1, 'more pair')} of contacts like these" if len(ties) > 1 else ""
    return (
        f"{one} meet at time {short(first.time)}, and {other} only {first.apart:.2g} later{more}: the last bits of the start "
        "decide which comes first, and all that follows hangs on it; coordinates of few binary digits make it one time, "
        "and contacts of one time are resolved together"
    )


def _contact(a: int, b: int | str) -> str:
    return f"disks {a} and {b}" if isinstance(b, int) else f"disk {a} and wall {b}"


def _search(needs: Needs) -> str:
    search = needs.search
    if needs.disks == 1:
        text = "a single disk: no pairs"
    elif search.side is None:
        text = f"all pairs: each disk is tried against every other; {_why_all_pairs(needs)}"
    else:
        count = f", {search.columns} x {search.rows} of them (they pay from {ENOUGH_DISKS} disks on)"
        if needs.size is None:
            count += ", the outer ones without end"
        text = (
            f"cells of {short(search.side[0])} x {short(search.side[1])}{count}: a disk is tried against those "
            "in its own cell and in those next to it"
        )
        if search.giants:
            giants = "1 giant disk is" if search.giants == 1 else f"{search.giants:,} giant disks are"
            text += f"; {giants} in no cell and tried against every other"
    if needs.images > 1 and needs.disks > 1:
        if search.side is None:
            text += f"; in each of the {needs.images} periodic images that can be met from inside the domain"
        else:
            text += "; at a periodic boundary the next cell is one of the other side"
    return text


def _why_all_pairs(needs: Needs) -> str:
    if needs.disks < ENOUGH_DISKS:
        return "cells would cost more than they save for so few"
    return "the domain is too small for cells as wide as the largest disks need them"


def _clock(needs: Needs) -> str:
    exponent = math.frexp(needs.epoch_length)[1] - 1
    start = "" if needs.start_time == 0.0 else f"starts at {short(needs.start_time)}; "
    counts = f"{start}counts epochs of 2^{exponent} = {short(needs.epoch_length)} and a remainder"
    return f"{counts} that begins anew after idle time, so late events have the digits of early ones"


def _engine(needs: Needs) -> str:
    return f"{needs.engine} (what auto chooses here)"


def _stops(needs: Needs) -> bool:
    return needs.until is not None or needs.events is not None


def _stop(needs: Needs) -> str:
    stops = []
    if needs.until is not None:
        stops.append(f"at time {short(needs.until)}")
    if needs.events is not None:
        stops.append(f"after {plural(needs.events, 'event')}")
    if not stops:
        return "not said in the scene: give --until or --events to eventsim run"
    first = " or ".join(stops) + (", whichever comes first" if len(stops) == 2 else "")
    return f"{first}; earlier if no event is ahead"

"""Measures for the command line: from a log or a scene, and as text."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from eventsim.cli.output import say
from eventsim.cli.source import is_log, log_of
from eventsim.cli.words import aligned, short
from eventsim.scene.names import plural

if TYPE_CHECKING:
    from eventsim.measure import Measures, Quantity
    from eventsim.measure.structure import Structure


def measured(
    source: str,
    settings: Sequence[str],
    seed: int | None,
    until: float | None,
    events: int | None,
    discard: float | None,
    structure: bool,
    quiet: bool,
) -> tuple[Measures, Structure | None]:
    """The measures of a log file, or of a scene that is simulated now; and the structure of its last state."""
    if structure:
        from eventsim.measure.structure import structure_of
    if is_log(source):
        from eventsim.measure import measure
        from eventsim.replay.replay import Replay

        log = log_of(source, settings, seed, until, events, quiet)
        return measure(log, discard), structure_of(log.scene, Replay(log).final()) if structure else None

    from eventsim.cli.choose import chosen_scene
    from eventsim.cli.exits import INTERRUPTED
    from eventsim.cli.progress import ProgressBar
    from eventsim.cli.signals import interruptible
    from eventsim.simulation import simulate

    scene = chosen_scene(source, settings, seed)
    if until is None and events is None and scene.until is None and scene.events is None:
        raise click.UsageError(
            f"nothing says when to stop {source}: give --until T or --events N, or a key until or events in the scene"
        )
    with ProgressBar(quiet=quiet) as progress, interruptible() as interrupt:
        keep = True if discard is None else discard
        run = simulate(scene, until=until, events=events, measure=keep, progress=progress, interrupt=interrupt)
    if run.stopped == "interrupted":
        say("interrupted", err=True)
        click.get_current_context().exit(INTERRUPTED)
    if run.reason is not None and not quiet:
        say(f"stopped early: {run.reason}", err=True)
    if run.measures is None:
        raise click.UsageError(f"there is nothing to measure: no time passes in this run of {source}")
    return run.measures, structure_of(scene, run.state) if structure else None


def measures_text(asked: str, measures: Measures, structure: Structure | None) -> str:
    """The measures as aligned lines: measured, theory, difference, where the theory comes from."""
    eta = "" if measures.packing_fraction is None else f", packing fraction {short(measures.packing_fraction)}"
    lines = [f"{asked}: {plural(measures.disks, 'disk')}{eta}, over {short(measures.duration)} units of time"]
    how = "as asked" if measures.discard_given else "found from the pressure"
    if measures.steady:
        lines.append(f"  left out at the beginning: {short(measures.discarded)} ({how})")
    rows = [("quantity", "measured", "theory", "difference", "")]
    rows += [_row(quantity) for quantity in measures.quantities]
    widths = [max(len(row[k]) for row in rows) for k in range(4)]
    lines += ["  " + "  ".join(f"{row[k]:<{w}}" for k, w in enumerate(widths)) + f"  {row[4]}" for row in rows]
    for histogram in measures.speeds:
        if histogram.misfit is not None:
            kind = f" of species {histogram.species}" if len(measures.speeds) > 1 else ""
            lines.append(f"  speeds{kind}: {histogram.misfit:.1f} standard errors from Maxwell, root mean square")
    if structure is not None:
        lines.append(aligned([("psi_6", f"{structure.psi_6:.4f} at the end (1: hexagonal, 0: none)")]))
    lines.append(_verdict(measures))
    return "\n".join(line.rstrip() for line in lines)


def _row(quantity: Quantity) -> tuple[str, str, str, str, str]:
    digits = _digits(quantity.value, quantity.error)
    theory = "" if quantity.theory is None else f"{quantity.theory:.{digits}g}"
    name = quantity.name if quantity.plain else f"{quantity.name} [{quantity.unit}]"
    return name, value_with_error(quantity), theory, _difference(quantity), quantity.source or ""


def value_with_error(quantity: Quantity) -> str:
    """A value to the digits that its error leaves: "2.0625 +- 0.0008"."""
    if not math.isfinite(quantity.error):
        return f"{short(quantity.value)} (no error bar)"
    digits = _digits(quantity.value, quantity.error)
    if quantity.error <= 1e-9 * abs(quantity.value):
        return f"{quantity.value:.{digits}g}"
    return f"{quantity.value:.{digits}g} \N{PLUS-MINUS SIGN} {quantity.error:.2g}"


def _digits(value: float, error: float) -> int:
    """Significant digits of a value down to the second digit of its error."""
    if not (math.isfinite(error) and error > 0.0 and value != 0.0):
        return 7
    return min(max(2 + math.floor(math.log10(abs(value))) - math.floor(math.log10(error)), 2), 10)


def _difference(quantity: Quantity) -> str:
    if quantity.theory is None:
        return ""
    if quantity.deviation is None:
        return f"{quantity.value / quantity.theory - 1.0:+.1%}" if quantity.theory else ""
    return f"{quantity.deviation:+.1f} sigma"


def _verdict(measures: Measures) -> str:
    if not measures.steady:
        return f"  no steady state: {measures.doubts[0]}; averages are over the whole run"
    if not measures.doubts:
        return "  equilibrated, as far as this run can tell"
    return "  NOT known to be equilibrated: " + ";\n    ".join(measures.doubts)

"""Measures for the command line: from a log or a scene, and as text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from eventsim.cli.output import say
from eventsim.cli.source import is_log, log_of
from eventsim.cli.words import aligned, short
from eventsim.scene.names import plural

if TYPE_CHECKING:
    from eventsim.measure import Measures
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
    who = [plural(measures.disks, "disk")] if measures.disks or not measures.tracers else []
    who += [plural(measures.tracers, "tracer")] if measures.tracers else []
    lines = [f"{asked}: {' and '.join(who)}{eta}, over {short(measures.duration)} units of time"]
    if measures.table_seen is not None:
        area, perimeter = (short(number) for number in measures.table_seen)
        lines.append(f"  table of the centre: area {area}, perimeter {perimeter}")
    if measures.discarded > 0.0:
        how = "as asked" if measures.discard_given else "found from the pressure"
        lines.append(f"  left out at the beginning: {short(measures.discarded)} ({how})")
    lines.append(measures.table())
    for histogram in measures.speeds:
        if histogram.misfit is not None:
            kind = f" of species {histogram.species}" if len(measures.speeds) > 1 else ""
            lines.append(f"  speeds{kind}: {histogram.misfit:.1f} standard errors from Maxwell, root mean square")
    if structure is not None:
        lines.append(aligned([("psi_6", f"{structure.psi_6:.4f} at the end (1: hexagonal, 0: none)")]))
    lines.append(_verdict(measures))
    return "\n".join(line.rstrip() for line in lines)


def _verdict(measures: Measures) -> str:
    if not measures.steady:
        return f"  no steady state: {measures.doubts[0]}; --series tells it along the run"
    if measures.disks < 2:
        return f"  {measures.doubts[0]}"
    if not measures.doubts:
        return "  equilibrated, as far as this run can tell"
    return "  NOT known to be equilibrated: " + ";\n    ".join(measures.doubts)

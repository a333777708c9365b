"""`eventsim certify`: prove the order of a scene's events, and tell how far float64 has it right."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from eventsim import suffixes
from eventsim.cli.options import Whole, json_option, quiet_option, scene_options, writable
from eventsim.cli.output import INTERRUPTED, STOPPED_EARLY, say, say_data

if TYPE_CHECKING:
    from eventsim.validation.proof import Proof, Rounded

DISKS_SHOWN = 8
USUAL_EVENTS = 1000

STOPPED = {"until": "its next contact is due after the stop", "quiet": "it sees no event ahead"}
"""Why float64 has no further event where it says no more itself."""


@click.command()
@scene_options(required=True)
@click.option("--events", type=Whole(min=1), metavar="N", help="Prove this many events (1000 without a stop).")
@click.option("--until", type=float, metavar="T", help="Prove what happens up to this time.")
@click.option("--log", metavar="FILE", help=f"Keep the certified log in FILE, one of {', '.join(suffixes.LOGS)}.")
@click.option("--bits", type=click.IntRange(64, 2**20), default=1024, show_default=True, help="Of the first attempt.")
@click.option("--most-bits", type=click.IntRange(64, 2**20), default=2**17, show_default=True, help="Of the last one.")
@json_option
@quiet_option
def command(
    scene: str,
    settings: tuple[str, ...],
    seed: int | None,
    events: int | None,
    until: float | None,
    log: str | None,
    bits: int,
    most_bits: int,
    as_json: bool,
    quiet: bool,
) -> None:
    """Prove what happens in SCENE: every number is a ball that the true one lies in, every comparison is certain.

    Where balls overlap, the run begins again with twice as many bits. Ties are decided where the numbers are rational
    or come from equal expressions. Needs the extra `certify`. Points (radius 0) that fall onto walls are refused.

    \b
    Examples:
      eventsim certify gas --events 500
      eventsim certify gas --log certified.csv
      eventsim certify newton-cradle --json
      eventsim certify break         proves 35 events, up to a cluster of irrational numbers

    \b
    Keys of --json:
      scene, name              as typed; the name inside the scene (null without)
      proven, time             events whose order is certain; the scene's clock after them
      bits, traced             of the attempt that came farthest; whether its numbers were traced, for ties
      attempts                 the other ones: [{bits, traced, events}]
      enclosures               of the end: [{x, y, vx, vy, x_error, y_error, vx_error, vy_error}], one a disk;
                               the true number lies within its error
      difference               {event, time}: the first event that float64 has otherwise, or not, since
                               it stopped before (null: none)
      float64_stopped, float64_reason   why it did (collapse, digits, ...); null where it did not
      agreed                   events that float64 has in the same order
      surplus                  events that float64 has beyond the last true one
      near_ties                agreed contacts that share a disk with the next one and that only last bits part from it
      time_deviation           its largest error of a time at the agreed contacts
      deviation                its largest error of a coordinate at these contacts, and
      deviation_share          the same as a part of the scene's largest length
      velocity_deviation       its largest error of a component of a velocity after them, and
      velocity_deviation_share the same as a part of the fastest speed
      stopped, reason          until | events | quiet | collapse | law | undecided tie |
                               interrupted; and why
      elapsed_s, log           seconds of the proof; the file written (null without)

    Exit codes: 0 proven; 2 bad usage, scene or file; 3 an undecided tie or a collapse; 130 interrupted.
    1 is kept for comparisons that fail: where float64 differs from the proof is a result, not a failure.
    """
    path = writable(log, "--log", suffixes.LOGS)
    if most_bits < bits:
        raise click.UsageError(f"--most-bits {most_bits}: the last attempt cannot have fewer bits than the first, --bits {bits}")

    from eventsim.cli.progress import ProgressBar
    from eventsim.cli.signals import interruptible
    from eventsim.cli.source import chosen_scene
    from eventsim.cli.words import as_json_text
    from eventsim.engines import ENGINES
    from eventsim.engines.base import Stop
    from eventsim.errors import EventsimError

    if ENGINES["certified"].missing is not None:
        raise EventsimError(ENGINES["certified"].missing)
    from eventsim.validation.proof import prove

    chosen = chosen_scene(scene, settings, seed)
    stop = Stop(until, events)
    if until is None and events is None:
        stop = Stop(chosen.until, chosen.events)
        if stop.until is None and stop.events is None:
            stop = Stop(None, USUAL_EVENTS)
    typed = click.get_current_context().obj
    with ProgressBar(quiet=quiet) as progress, interruptible() as interrupt:
        proof = prove(chosen, stop, False if path is None else path, bits, most_bits, progress, typed, interrupt)
    if as_json:
        say_data(as_json_text(_data(scene, proof, path)))
    elif not quiet:
        say(_text(scene, proof, path))
    if proof.run.stopped == "interrupted":
        click.get_current_context().exit(INTERRUPTED)
    if proof.run.stopped in ("undecided tie", "collapse", "digits", "law"):
        if as_json or quiet:
            say(f"stopped early: {proof.run.reason or proof.run.stopped}", err=True)
        click.get_current_context().exit(STOPPED_EARLY)


def _data(asked: str, proof: Proof, log: Path | None) -> dict[str, object]:
    state, names = proof.run.state, ("x", "y", "vx", "vy")
    enclosures = []
    for place, speed, errors in zip(state.position, state.velocity, proof.enclosures, strict=True):
        values = dict(zip(names, (*place.tolist(), *speed.tolist()), strict=True))
        enclosures.append(values | {f"{name}_error": error for name, error in zip(names, errors.tolist(), strict=True)})
    float64, difference = proof.float64, None
    if float64.difference is not None:
        difference = {"event": float64.difference, "time": proof.difference_time}
    return {
        "scene": asked,
        "name": proof.run.scene.name,
        "proven": proof.proven,
        "time": state.time,
        "bits": proof.bits,
        "traced": proof.traced,
        "attempts": [attempt._asdict() for attempt in proof.attempts],
        "enclosures": enclosures,
        "difference": difference,
        "float64_stopped": float64.stopped,
        "float64_reason": float64.reason,
        "agreed": float64.agreed,
        "surplus": float64.surplus,
        "near_ties": float64.near_ties,
        "time_deviation": float64.time_deviation,
        "deviation": float64.deviation,
        "deviation_share": float64.deviation_share,
        "velocity_deviation": float64.velocity_deviation,
        "velocity_deviation_share": float64.velocity_deviation_share,
        "stopped": proof.run.stopped,
        "reason": proof.run.reason,
        "elapsed_s": proof.run.elapsed_s,
        "log": None if log is None else str(log),
    }


def _text(asked: str, proof: Proof, log: Path | None) -> str:
    from eventsim.cli.summary import stop_words
    from eventsim.cli.words import aligned, scene_line, short, title
    from eventsim.scene.names import plural

    run = proof.run
    each = f", {run.elapsed_s / proof.proven * 1e3:.2g} ms an event" if proof.proven else ""
    rows = [
        ("proven", f"{plural(proof.proven, 'event')}, to t = {short(run.state.time)}{each}"),
        ("bits", f"{proof.bits}{', numbers traced' if proof.traced else ''}{_attempts(proof)}"),
        ("float64", _float64(proof)),
        ("end", f"every coordinate known {_within(proof.enclosures[:, :2].max(), 'to')}"),
        ("stopped", stop_words(run)),
    ]
    if proof.float64.agreed:
        rows.insert(3, ("errors", _errors(proof.float64)))
    if log is not None:
        rows.append(("log", f"{log}: {plural(proof.proven, 'row')}"))
    lines = [f"{title(asked, run.scene.name)}: {scene_line(run.scene)}", aligned(rows)]
    if len(run.state.position) <= DISKS_SHOWN:
        for i, (place, errors) in enumerate(zip(run.state.position, proof.enclosures, strict=True)):
            x, y = (f"{value!r} {_within(error, '+-')}" for value, error in zip(place.tolist(), errors[:2], strict=True))
            lines.append(f"  disk {i}: x = {x}, y = {y}")
    return "\n".join(lines)


def _attempts(proof: Proof) -> str:
    from eventsim.scene.names import plural

    parts = [f"{a.bits}{' traced' if a.traced else ''}: {plural(a.events, 'event')}" for a in proof.attempts]
    return f" (other attempts: {'; '.join(parts)})" if parts else ""


def _float64(proof: Proof) -> str:
    from eventsim.cli.words import short
    from eventsim.scene.names import plural

    float64 = proof.float64
    close = f"; {plural(float64.near_ties, 'near tie')} among them, which only last bits part" if float64.near_ties else ""
    if float64.difference is None:
        extra = f", and then {plural(float64.surplus, 'event')} that there are not" if float64.surplus else ""
        return f"has {plural(float64.agreed, 'event')} in the same order{close}{extra}"
    assert proof.difference_time is not None
    place = f"event {float64.difference}, t = {short(proof.difference_time)}"
    if float64.stopped is None:
        return f"first differs at {place}{close}"
    why = float64.reason or STOPPED.get(float64.stopped, float64.stopped)
    return f"has {plural(float64.agreed, 'event')} in the same order, then stopped ({float64.stopped}) before {place}: {why}"


def _errors(float64: Rounded) -> str:
    """How far float64 is off where it has the same contacts."""
    if float64.deviation == float64.velocity_deviation == float64.time_deviation == 0.0:
        return "none at these contacts: float64 is right to the last bit"
    places = f"{float64.deviation:.1e} in a coordinate ({float64.deviation_share:.1e} of the largest length)"
    velocities = f"{float64.velocity_deviation:.1e} in a velocity ({float64.velocity_deviation_share:.1e} of the fastest)"
    times = f"{float64.time_deviation:.1e} in a time"
    told = (
        (float64.deviation, places),
        (float64.velocity_deviation, velocities),
        (float64.time_deviation, times),
    )
    return f"of float64 at these contacts: up to {', '.join(text for error, text in told if error)}"


def _within(error: float, sign: str) -> str:
    return f"{sign} {error:.1e}" if error else "exactly"

"""What a run says at its end: the same facts as text for people and as data for programs."""

from __future__ import annotations

from dataclasses import asdict
from shlex import quote
from typing import TYPE_CHECKING

import numpy as np

from eventsim import __version__
from eventsim.cli.words import aligned, scene_line, short, title
from eventsim.record.events import State
from eventsim.scene.names import plural

if TYPE_CHECKING:
    from eventsim.cli.options import Files
    from eventsim.measure.trust import Trust
    from eventsim.run import Run
    from eventsim.runner.outcome import Outcome
    from eventsim.validation.shadows import Horizon


WORTH_A_WORD, MOMENT = 0.01, 1e-3
"""Of the time that simulating took, and seconds: what takes less is left out of the text."""


def summary_data(asked: str, run: Run, files: Files, horizon: Horizon | None = None) -> dict[str, object]:
    """Return the keys that `eventsim run --help` documents."""
    return {
        "scene": asked,
        "name": run.scene.name,
        "version": __version__,
        "engine": run.engine,
        "begun_by": run.begun_by,
        "disks": len(run.scene.disks),
        "start_time": run.start_time,
        "time": run.time,
        "events": run.counters.events,
        "pair_contacts": run.counters.pair_contacts,
        "wall_contacts": run.counters.wall_contacts,
        "counters": asdict(run.counters),
        "elapsed_s": run.elapsed_s,
        "compile_s": run.compile_s,
        "write_s": run.write_s,
        "events_per_s": _rate(run),
        "digest": run.digest,
        "residuals": {key: value for key, value in asdict(run.residuals).items() if key in USUAL or value is not None},
        "horizon": None if horizon is None else asdict(horizon),
        "trust": None if run.trust is None else asdict(run.trust),
        "stopped": run.stopped,
        "reason": run.reason,
        **{name: None if path is None else str(path) for name, path in files._asdict().items()},
    }


def summary_text(asked: str, run: Run, files: Files, horizon: Horizon | None = None, replaced: bool = False) -> str:
    """Return the summary as aligned lines.  replaced: whether the log has taken the place of another one."""
    counters, residuals = run.counters, run.residuals
    rows = [
        ("engine", _engine(run)),
        ("time", f"{short(run.start_time)} to {short(run.time)}"),
        ("events", _events(run)),
        ("energy", _energy(run)),
        ("momentum", _momentum(residuals.momentum)),
        *(() if residuals.angular_momentum is None else [("rotation", _rotation(residuals.angular_momentum))]),
        ("overlap", _overlap(residuals.max_overlap)),
        ("stopped", stop_words(run)),
    ]
    if counters.pair_contacts == 0:
        rows = [row for row in rows if row[0] != "overlap"]
    if run.pace is not None:
        rows.append(("pace", run.pace))
    if run.trust is not None:
        rows.append(("trust", trust_words(run.trust)))
    if horizon is not None:
        rows.append(("horizon", horizon_words(horizon)))
    if run.digest is not None:
        rows.append(("digest", run.digest))
    if files.log is not None:
        rows.append(("log", f"{files.log}: {plural(counters.events, 'row')}{REPLACED if replaced else ''}"))
    if files.state is not None:
        rows.append(("state", str(files.state)))
    if files.checkpoint is not None:
        rows.append(("checkpoint", f"eventsim run --resume {quote(str(files.checkpoint))} goes on from here"))
    return f"{title(asked, run.scene.name)}: {scene_line(run.scene)}\n{aligned(rows)}"


REPLACED = ", in place of the log that was there"

USUAL = ("energy", "momentum", "max_overlap")
"""Residuals that every run has."""


def _rotation(change: float) -> str:
    return f"angular momentum changed by {abs(change):.1g} of the sum of its terms"


def horizon_words(horizon: Horizon) -> str:
    """Return what a reader may believe of a float64 trajectory."""
    ties = f"; {plural(horizon.near_ties, 'near tie')} until then, which only last bits part" if horizon.near_ties else ""
    if horizon.event is not None and horizon.time is not None:
        return (
            f"the trajectory is right until about event {horizon.event:,}, t = {short(horizon.time)}; "
            f"after that only its statistics are; times before it differ by {horizon.apart:.1g} at most{ties}"
        )
    if horizon.events == 0:
        return "no event was there to be compared"
    return (
        f"not reached in {plural(horizon.events, 'event')}, to t = {short(horizon.until)}: "
        f"runs that differ in last bits still tell the same story there, at times that differ by {horizon.apart:.1g} "
        f"at most{ties}"
    )


def trust_words(trust: Trust) -> str:
    """Return until when positions hold."""
    from eventsim.measure.trust import HELD

    if trust.event is not None and trust.time is not None:
        return (
            f"positions hold to {HELD:g} of the smallest reach until event {trust.event:,}, t = {short(trust.time)}; "
            "statistics after that"
        )
    if trust.reason is not None:
        return f"no estimate of how long positions hold: {trust.reason}"
    if trust.error == 0.0:
        return "positions hold to their last digits until the end: nothing was met"
    grown = ", and errors grow as a power of time" if trust.gentle else ""
    return f"positions hold to {trust.error:.0e} of the smallest reach until the end{grown}"


def _rate(run: Outcome) -> float | None:
    """Events per second of simulating; None where there was nothing to time."""
    return run.counters.events / run.elapsed_s if run.elapsed_s > 0 else None


def _events(run: Outcome) -> str:
    counters = run.counters
    pairs = plural(counters.pair_contacts, "pair contact")
    more = [(counters.rests, "rest"), (counters.kicks, "kick")]
    others = "".join(f", {plural(count, name)}" for count, name in more if count)
    text = f"{counters.events:,}: {pairs}, {plural(counters.wall_contacts, 'wall contact')}{others}"
    rate = _rate(run)
    return text if rate is None or counters.events == 0 else f"{text}; {rate:,.0f} events/s"


def _seconds(seconds: float) -> str:
    return f"{seconds * 1e3:.3g} ms" if seconds < 1 else f"{seconds:.3g} s"


def _engine(run: Outcome) -> str:
    """Who simulated, and what that took; times that are not simulating where they are worth a word."""
    name = run.engine if run.begun_by is None else f"{run.begun_by}, then {run.engine}"
    apart = [("compiling", run.compile_s), ("writing", run.write_s)]
    least = max(WORTH_A_WORD * run.elapsed_s, MOMENT)
    worth = [f" + {_seconds(seconds)} {what}" for what, seconds in apart if seconds > least]
    return f"{name}: {_seconds(run.elapsed_s)} simulating{''.join(worth)}"


def _energy(run: Outcome) -> str:
    change = run.residuals.energy
    if change is not None:
        return f"changed by {change:.1e} of itself" if change else "conserved to the last bit"
    scene = run.scene
    falls = scene.gravity is not None and any(g and p for g, p in zip(scene.gravity, scene.domain.periodic, strict=True))
    if falls:  # over periods, which states do not count
        return "not conserved in this scene"
    start = State(run.start_time, scene.disks.position, scene.disks.velocity, scene, scene.disks.spin).energy
    what = ", kinetic and potential" if scene.gravity is not None else ""
    return f"not conserved in this scene: {short(start)} -> {short(run.state.energy)}{what}"


def _momentum(left: float) -> str:
    return f"{left:.1e} of sum m |v| is unaccounted for" if left else "accounted for to the last bit"


def _overlap(deepest: float) -> str:
    return "none at any contact" if deepest <= 0 else f"deepest at a contact {deepest:.1e} of the reach"


def stop_words(run: Outcome) -> str:
    """Return why a run stopped, in words."""
    if run.reason is not None:
        return f"early ({run.stopped}): {run.reason}"
    words = {
        "until": f"at the time asked for, {short(run.time)}",
        "events": "after the number of events asked for",
        "quiet": f"no event is ahead: every disk {_from_here_on(run)}",
        "interrupted": "interrupted; what happened so far is kept",
    }
    return words.get(run.stopped, run.stopped)


def _from_here_on(run: Outcome) -> str:
    """What disks do that meet nothing any more; posts that stand still do nothing."""
    moves = (run.state.velocity != 0.0).sum(axis=1) > 0
    still = np.isfinite(run.scene.disks.mass) & ~moves
    if not moves.any():
        return "is at rest"
    if run.counters.rests:
        return "lies on something or flies free from here on"
    return "is at rest or flies free from here on" if still.any() else "flies free from here on"

"""A soak: one long run, looked at again and again; does anything drift, deepen or grow?

    python -m tests.benchmarks.soak --events 1e9 --out soak

writes soak.csv (a row per look) and soak.png, and prints the verdict: energy drift, deepest overlap, resident memory and the size
of the engine's queue, at the start and at the end.
"""

from __future__ import annotations

import argparse
import csv
import sys
from dataclasses import asdict, dataclass
from pathlib import Path
from time import process_time

import eventsim as es
from eventsim.engines import ENGINES
from eventsim.engines.base import Session, Stop
from eventsim.formulas.clock import clock_time
from eventsim.runner.residuals import residuals_of
from eventsim.scene.stage import stage_of
from tests.benchmarks.table import whole

LOOKS = 200
WARM_UP = 0.01
"""Part of the events before memory is looked at first: compiling and the first windows have their buffers by then."""

MOST_DRIFT, MOST_OVERLAP, MOST_GROWTH = 1e-11, 1e-12, 0.01
"""What counts as sound: of the energy, of the reach, of the resident memory."""


@dataclass(frozen=True, slots=True)
class Look:
    """The run at one moment.

    cpu_s: seconds of this process.  clock: on the scene's clock.  energy: relative change since the start.  momentum: unaccounted
    for, of sum m |v|.  overlap: the deepest at a contact so far, in reaches.  resident: MB.  queue: bytes of the engine's arrays
    (fast), or predictions in the calendar (reference).
    """

    events: int
    cpu_s: float
    clock: float
    epoch: int
    energy: float
    momentum: float
    overlap: float
    resident: float
    queue: int


def look_at(session: Session) -> Look:
    """The run now."""
    stage, residuals = session.stage, residuals_of(session)
    return Look(
        events=session.counters.events,
        cpu_s=process_time(),
        clock=clock_time(*session.clock, stage.epoch_length, stage.start_time),
        epoch=session.clock[0],
        energy=residuals.energy or 0.0,
        momentum=residuals.momentum,
        overlap=residuals.max_overlap,
        resident=resident_megabytes(),
        queue=queue_of(session),
    )


def resident_megabytes() -> float:
    """What this process holds of the machine's memory."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * 4096 / 1e6


def queue_of(session: Session) -> int:
    """How large what waits is: see `Look`."""
    memory = getattr(session, "memory", None)
    return int(memory) if memory is not None else len(session.calendar)  # type: ignore[attr-defined]


def soak(scene: es.Scene, engine: str, events: int, path: Path) -> list[Look]:
    """Run so many events; looks are written to `path` as they come."""
    session = ENGINES[engine].open(stage_of(scene), keep_rows=False)
    marks = sorted({max(1, round(events * WARM_UP)), *(events * (k + 1) // LOOKS for k in range(LOOKS))})
    looks = []
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, list(Look.__slots__))
        writer.writeheader()
        for mark in (0, *marks):
            while session.advance(Stop(events=mark), 1 << 22) is None:
                pass
            looks.append(look_at(session))
            writer.writerow(asdict(looks[-1]))
            file.flush()
    return looks


def verdict(looks: list[Look]) -> tuple[str, bool]:
    """A sentence, and whether all is sound."""
    warm = next(look for look in looks if look.events >= WARM_UP * looks[-1].events)
    last = looks[-1]
    drift = max(abs(look.energy) for look in looks)
    growth = last.resident / warm.resident - 1.0
    sound = drift < MOST_DRIFT and last.overlap < MOST_OVERLAP and growth < MOST_GROWTH
    rate = (last.events - warm.events) / max(last.cpu_s - warm.cpu_s, 1e-9)
    return (
        f"{last.events:,} contacts to t = {last.clock:.6g}: energy drift {drift:.1e}, momentum {last.momentum:.1e}, "
        f"deepest overlap {last.overlap:.1e} of the reach, "
        f"resident {warm.resident:.1f} -> {last.resident:.1f} MB ({growth:+.2%}), queue {warm.queue:,} -> {last.queue:,}; "
        f"{rate:,.0f} contacts per CPU second: {'sound' if sound else 'NOT SOUND'}"
    ), sound


def draw(looks: list[Look], title: str, path: Path) -> None:
    """Chart what should not grow."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9, 9), layout="constrained")
    panels = figure.subplots(5, 1, sharex=True)
    x = [look.events for look in looks]
    series = {
        "energy drift": [abs(look.energy) for look in looks],
        "momentum left / sum m|v|": [look.momentum for look in looks],
        "deepest overlap / reach": [look.overlap for look in looks],
        "resident memory / MB": [look.resident for look in looks],
        "queue": [float(look.queue) for look in looks],
    }
    for panel, (name, values) in zip(panels, series.items(), strict=True):
        panel.plot(x, values, color="#1f5a99", lw=1.2)
        panel.set_ylabel(name, fontsize=8)
        panel.set_ylim(0.0, 1.1 * max(values) or 1.0)
    panels[0].axhline(MOST_DRIFT, color="#aa3333", ls="--", lw=0.8)
    panels[2].axhline(MOST_OVERLAP, color="#aa3333", ls="--", lw=0.8)
    panels[-1].set_xlabel("contacts")
    figure.suptitle(title, fontsize=8, wrap=True)
    figure.savefig(path, dpi=120)


def main() -> int:
    """Read the command line, soak, chart, judge."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--events", type=whole, default=10**6)
    parser.add_argument("--n", type=int, default=10_000)
    parser.add_argument("--packing-fraction", type=float, default=0.5)
    parser.add_argument("--engine", default="fast", choices=("fast", "reference"))
    parser.add_argument("--out", type=Path, default=Path("soak"))
    asked = parser.parse_args()
    scene = es.gallery("periodic-fluid", n=asked.n, packing_fraction=asked.packing_fraction)
    looks = soak(scene, asked.engine, asked.events, asked.out.with_suffix(".csv"))
    sentence, sound = verdict(looks)
    draw(
        looks,
        f"{asked.n} disks, packing fraction {asked.packing_fraction}, {asked.engine}: {sentence}",
        asked.out.with_suffix(".png"),
    )
    print(sentence)
    return 0 if sound else 1


if __name__ == "__main__":
    sys.exit(main())

"""What a run gives when it is over."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from eventsim import __version__
from eventsim.engines.base import Counters, Session, Stop
from eventsim.engines.collapse import diagnosis, diagnosis_of_sunk
from eventsim.engines.trajectory import Trajectory
from eventsim.formulas.clock import clock_time
from eventsim.record.events import Rows, State
from eventsim.record.places import on_scene_axes
from eventsim.record.provenance import Provenance, Recorded
from eventsim.runner.residuals import Residuals
from eventsim.scene import Scene


@dataclass(slots=True)
class Outcome:
    """What a simulation gives: the state it ended in, how good it is and why it stopped.

    begun_by: the engine that handed over to `engine`, where `auto` began with another one.
    log_path: where the log was streamed to.  recorded: the log that was kept in memory.  stopped: `until`, `events`, `quiet` (no
    event ahead), `collapse`, `digits`, `law` (none tells what a contact does), `interrupted`.  reason: a sentence about that
    where there is more to say.  elapsed_s: simulating only; compile_s and write_s (waiting for rows to be written and measured)
    apart, seconds.  trajectory: samples, of a stepped engine, whose motion does not follow from its log.  pace: a sentence where
    contacts came ever faster.
    """

    scene: Scene
    engine: str
    state: State
    counters: Counters
    residuals: Residuals
    stopped: str
    reason: str | None
    digest: str | None
    elapsed_s: float
    write_s: float
    compile_s: float = 0.0
    begun_by: str | None = None
    log_path: Path | None = None
    recorded: Recorded | None = None
    trajectory: Trajectory | None = None
    pace: str | None = None

    @property
    def time(self) -> float:
        """Where the scene's clock stands."""
        return self.state.time

    @property
    def start_time(self) -> float:
        """Where the scene's clock began."""
        return self.scene.start_time


def diagnosed(session: Session, stopped: str, last_rows: Rows) -> tuple[str, str | None]:
    """Why a run stopped, and the sentence about it; a sequence that does not end is told from its last rows."""
    stage = session.stage
    if not (session.sunk or (stopped == "collapse" and stage.law.loses_energy() and not session.refused)):
        return stopped, session.reason
    time = clock_time(*session.clock, stage.epoch_length, stage.start_time)
    if session.sunk:
        return diagnosis_of_sunk(last_rows, stage, time) or (stopped, session.reason)
    return diagnosis(last_rows, stage, session.clock, time) or (stopped, session.reason)


def provenance_of(session: Session, engine: str, scene: Scene, command: str | None = None) -> Provenance:
    """Where the rows of a session come from."""
    stage = session.stage
    return Provenance(
        scene=scene,
        engine=engine,
        version=__version__,
        epoch_length=stage.epoch_length,
        wall_names=stage.wall_names,
        command=command,
        corner=stage.corner,
    )


def state_of(
    session: Session, stop: Stop | None = None, stopped: str | None = None, scene: Scene | None = None
) -> State:
    """The state, of a scene, where a session stands; its time is exactly the stop time where that was reached."""
    stage = session.stage
    motion = session.motion()
    epoch, remainder = session.clock
    time = clock_time(epoch, remainder, stage.epoch_length, stage.start_time)
    if stop is not None and stop.until is not None and stopped in ("until", "quiet"):
        time = max(float(stop.until), stage.start_time)
    position = np.column_stack(
        [
            on_scene_axes(motion.x, stage.corner[0], stage.period[0]),
            on_scene_axes(motion.y, stage.corner[1], stage.period[1]),
        ]
    )
    return State(time, position, np.column_stack([motion.vx, motion.vy]), scene, motion.spin)

"""HOW TIME PASSES: engines behind one contract, by name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from eventsim.engines.base import Run, Session, Stop
from eventsim.engines.drive import Wishes, drive
from eventsim.scene import Scene
from eventsim.scene.stage import stage_of


@dataclass(frozen=True, slots=True)
class Engine:
    """An engine: its name, and how to open a session of it."""

    name: str
    open: Callable[..., Session]

    def run(self, scene: Scene, stop: Stop, wishes: Wishes | None = None, **options: Any) -> Run:
        """Simulate a scene to its stop; options are the engine's own."""
        wishes = Wishes() if wishes is None else wishes
        session = self.open(stage_of(scene), keep_rows=wishes.rows, **options)
        return drive(session, self.name, scene, stop, wishes)


def _reference(*args: Any, **options: Any) -> Session:
    from eventsim.engines.reference import ReferenceSession  # loaded by the run that needs it

    return ReferenceSession(*args, **options)


ENGINES: dict[str, Engine] = {"reference": Engine("reference", _reference)}
"""name -> engine; every engine is run(scene, stop) -> Run."""

"""Which numbers a scene may hold, and which disks may be where."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from eventsim.scene.scene import Scene


def find_problems(scene: Scene) -> list[str]:
    """Every rule that the scene breaks, one sentence each."""
    return [] if len(scene.disks) else ["a scene needs at least one disk"]

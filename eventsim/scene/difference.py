"""In which respect two scenes differ, in words."""

from __future__ import annotations

from dataclasses import fields

from eventsim.scene.scene import Scene


def difference(one: Scene, other: Scene) -> str:
    """The first key in which `other` is not like `one`; O(N)."""
    for item in fields(Scene):
        mine, theirs = getattr(one, item.name), getattr(other, item.name)
        if mine == theirs:
            continue
        if item.name != "disks":
            return f"its {item.name} is {mine!r}, not {theirs!r}"
        if len(mine) != len(theirs):
            return f"it has {len(mine)} disks, not {len(theirs)}"
        return "its disks begin elsewhere, or are others"
    return "none"

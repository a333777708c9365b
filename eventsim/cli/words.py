"""Numbers and plain data as text: the small phrases that summaries and explanations are made of."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from eventsim.scene.names import plural

if TYPE_CHECKING:
    from eventsim.scene import Scene


def file_size(path: Path) -> str:
    """Return the size of a file in kB or MB."""
    size = path.stat().st_size
    return f"{size / 1e6:.1f} MB" if size >= 1e6 else f"{size / 1e3:.0f} kB"


def short(value: float) -> str:
    """Return a number to six significant digits, without a trailing ".0"."""
    return f"{value:.6g}"


def point(x: float, y: float) -> str:
    """Return "(x, y)"."""
    return f"({short(x)}, {short(y)})"


def title(asked: str, name: str | None) -> str:
    """Return what was asked for, and the scene's own name where that says more."""
    plain = Path(asked).stem.replace("-", " ").lower()
    return asked if name is None or name.replace("-", " ").lower() == plain else f"{asked} ({name})"


def scene_line(scene: Scene) -> str:
    """Return what a scene is in half a line: "16 disks in a box 2.54 x 1.27"."""
    disks = plural(len(scene.disks), "disk")
    if scene.domain.size is None:
        return f"{disks} on the open plane"
    width, height = scene.domain.size
    words = {"box": "a box", "periodic": "a periodic domain", "channel": "a channel"}
    return f"{disks} in {words[scene.domain.kind]} {short(width)} x {short(height)}"


def aligned(rows: Sequence[tuple[str, str]]) -> str:
    """Return lines "  label  text" with the texts one below the other."""
    width = max(len(label) for label, _ in rows)
    return "\n".join(f"  {label:<{width}}  {text}".rstrip() for label, text in rows)


def as_json_text(data: Mapping[str, object]) -> str:
    """Return JSON that every reader accepts: inf and nan, which JSON does not have, become null."""
    return json.dumps(_plain(data), indent=2, ensure_ascii=False, allow_nan=False)


def _plain(value: object) -> object:
    if isinstance(value, Mapping):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value

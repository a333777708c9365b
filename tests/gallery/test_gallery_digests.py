"""The log of every gallery scene is known to the last bit.

Run this file as a script after a change that is meant to change logs: it rewrites golden/.
Random starts are stored there as well, so that the digests do not depend on how NumPy draws.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import eventsim as es
from eventsim.scene.gallery import describe, gallery, names

GOLDEN = Path(__file__).parent / "golden"
DIGESTS = GOLDEN / "digests.json"
LIMIT = 20_000  # events: a gallery scene is a story, not a benchmark


def start(name: str) -> Path:
    return GOLDEN / f"{name}.npz"


def is_random(name: str) -> bool:
    return "seed" in describe(name).parameters


def stored(name: str) -> es.Scene:
    """The scene as it was when its digest was taken."""
    if not is_random(name):
        return gallery(name)
    with np.load(start(name), allow_pickle=False) as arrays:
        return replace(gallery(name), disks=es.Disks(**arrays))


def outcome(scene: es.Scene) -> dict[str, int | str]:
    run = es.simulate(scene, engine="reference", log=True)
    return {"events": len(run.log), "stopped": run.stopped, "digest": run.log.digest()}


@pytest.mark.parametrize("name", names())
def test_the_log_of_a_gallery_scene_keeps_its_bits(name: str) -> None:
    known = json.loads(DIGESTS.read_text())
    assert outcome(stored(name)) == known[name]


def test_no_digest_is_left_over_and_no_scene_is_long() -> None:
    known = json.loads(DIGESTS.read_text())
    assert sorted(known) == names()
    assert {path.stem for path in GOLDEN.glob("*.npz")} == {name for name in names() if is_random(name)}
    assert all(0 < each["events"] <= LIMIT for each in known.values())
    assert {each["stopped"] for each in known.values()} <= {"until", "events", "quiet"}


def regenerate() -> None:
    """Draw the random starts anew and write every digest."""
    GOLDEN.mkdir(exist_ok=True)
    for path in GOLDEN.glob("*.npz"):
        path.unlink()
    digests = {}
    for name in names():
        scene = gallery(name)
        if is_random(name):
            disks = scene.disks
            arrays = {key: getattr(disks, key) for key in ("position", "velocity", "radius", "mass")}
            np.savez_compressed(start(name), **arrays)
        digests[name] = outcome(scene)
        print(name, digests[name])
    DIGESTS.write_text(json.dumps(digests, indent=2) + "\n")


if __name__ == "__main__":
    regenerate()

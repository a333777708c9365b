"""Flips single bits of files that eventsim reads, and looks at what comes of it.

    python -m tests.fuzz.flips [--flips N] [--seed S] [--only NAME ...] [--folder PLACE]

Each flip ends in one of: `refused` with an EventsimError, `told` by a LogWarning, `same` (what was read is what was written:
rows, scene, all that loads), `rows` or `scene` (read, another one, and nothing was said), `raised` (any other exception).  The
last line counts them; a flip that raised or was silent is printed with the place and the bit, so that it can be tried again.
"""

from __future__ import annotations

import argparse
import os
import random
import sys
import tempfile
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import eventsim as es
from eventsim.errors import LogWarning
from eventsim.record.files import open_sink
from eventsim.record.provenance import Provenance
from eventsim.scene.disks_file import read_disks_file, write_disks_file
from eventsim.simulation import resume
from eventsim.suffixes import LOGS

EVENTS = 6
"""Of a log, and behind a checkpoint: what is read again a million times has to be short."""


class Target(NamedTuple):
    """A file, and how what it says is read: pairs of a word and something that can be compared."""

    file: Path
    read: Callable[[Path], list[tuple[str, Any]]]


class Flip(NamedTuple):
    """What came of a flip."""

    target: str
    place: int
    bit: int
    outcome: str
    words: str


def small_scene() -> es.Scene:
    """Disks of unlike masses and a wall with a name: some of everything that files tell."""
    walls = (es.Segment((0.1, 0.1), (0.4, 0.2), name="ramp"),)
    disks = es.Disks([(0.3, 0.5), (0.7, 0.5), (0.5, 0.8)], [(1.0, 0.1), (0.0, 0.0), (0.0, -0.5)], 0.05, [1.0, 2.0, 1.0])
    return es.Scene(disks, es.Box((1.0, 1.0)), walls, name="flips")


def targets(place: Path) -> dict[str, Target]:
    """All kinds of files, written into a folder."""
    scene, found = small_scene(), {}
    for suffix in LOGS:
        for compact in (False, True):
            name = f"{'compact' if compact else 'full'}{suffix}"
            es.simulate(scene, events=EVENTS, engine="reference", log=place / name, compact=compact)
            found[name] = Target(place / name, read_log)
    for suffix, name in (("npz", "runs"), ("parquet", "eventsim"), ("npz", "xa"), ("csv", None)):
        part = growing(place / f"growing-{name}.{suffix}", place / "compact.csv")
        found[f"growing {name or suffix}"] = Target(part / name if name else part, read_log if name is None else read_journal)
    es.simulate(scene, events=EVENTS, engine="reference", checkpoint=place / "run.checkpoint")
    found["run.checkpoint"] = Target(place / "run.checkpoint", read_checkpoint)
    write_disks_file(place / "disks.npz", scene.disks)
    found["disks.npz"] = Target(place / "disks.npz", read_disks)
    for suffix in (".toml", ".json"):
        (place / f"scene{suffix}").write_text(_text_of(scene, suffix))
        found[f"scene{suffix}"] = Target(place / f"scene{suffix}", lambda path: [("scene", es.load_scene(path))])
    return found


def _text_of(scene: es.Scene, suffix: str) -> str:
    from eventsim.scene.files import scene_to_json, scene_to_toml

    return scene_to_toml(scene) if suffix == ".toml" else scene_to_json(scene)


def growing(path: Path, log: Path) -> Path:
    """What a run that was killed would leave of a log."""
    whole = es.load_log(log).expand()
    sink = open_sink(path, whole.provenance)
    sink.write(whole.rows)
    sink.leave()
    return sink.part


def read_journal(path: Path) -> list[tuple[str, Any]]:
    return read_log(path.parent)


def read_log(path: Path) -> list[tuple[str, Any]]:
    log = es.load_log(path).expand()
    return [("scene", _story(log.provenance)), ("rows", log.rows.tobytes())]


def _story(provenance: Provenance) -> Any:
    return (provenance.scene, provenance.epoch_length, provenance.wall_names, provenance.kicks, provenance.ending)


def read_checkpoint(path: Path) -> list[tuple[str, Any]]:
    run = resume(path, events=EVENTS + 4, engine="reference")
    return [("scene", run.scene), ("rows", (run.state.position.tobytes(), run.state.velocity.tobytes(), run.state.time))]


def read_disks(path: Path) -> list[tuple[str, Any]]:
    return [("scene", read_disks_file(path).disks)]


def flips(chosen: dict[str, Target], count: int, seed: int) -> Iterator[Flip]:
    """Flip `count` bits in turn over the targets."""
    chance = random.Random(seed)
    wholes = {name: _whole(target) for name, target in chosen.items()}
    for number in range(count):
        name = list(chosen)[number % len(chosen)]
        whole, usual = wholes[name]
        place, bit = chance.randrange(len(whole)), chance.randrange(8)
        with flipped(chosen[name].file, whole, place, bit):
            yield Flip(name, place, bit, *outcome(chosen[name].read, chosen[name].file, *usual))


def _whole(target: Target) -> tuple[bytes, tuple[list[tuple[str, Any]], list[str]]]:
    """The bytes of a file, and what it says; its reader may have gone on from there, so it is written again."""
    whole = target.file.read_bytes()
    usual = _heard(target.read, target.file)
    target.file.write_bytes(whole)
    return whole, usual


@contextmanager
def flipped(path: Path, whole: bytes, place: int, bit: int) -> Iterator[None]:
    """Flip a bit of a file inside: that writes two bytes and not a file."""
    with path.open("r+b", buffering=0) as file:
        file.seek(place)
        file.write(bytes([whole[place] ^ 1 << bit]))
        yield
        file.seek(place)
        file.write(whole[place : place + 1])
        if not os.path.samestat(os.fstat(file.fileno()), path.stat()):  # a run that goes on has put its checkpoint there
            path.write_bytes(whole)


def outcome(
    read: Callable[[Path], list[tuple[str, Any]]], path: Path, right: list[tuple[str, Any]], usual: list[str]
) -> tuple[str, str]:
    """What comes of reading a damaged file, in one word, and what was said; usual: what is said of the whole file as well.

    Of a log that grows it is said that nothing vouches for its rows: that excuses other rows, and no other scene.
    """
    try:
        found, said = _heard(read, path)
    except es.EventsimError as error:
        return "refused", str(error)
    except Exception as error:
        return "raised", f"{type(error).__name__}: {error}"
    if said != usual:
        return "told", str(said[:1])
    differing = [word for (word, here), (_, there) in zip(found, right, strict=True) if not _same(here, there)]
    if differing == ["rows"] and usual:
        return "told", usual[0]
    return differing[0] if differing else "same", ""


def _heard(read: Callable[[Path], list[tuple[str, Any]]], path: Path) -> tuple[list[tuple[str, Any]], list[str]]:
    """What a file says, and the notes that its reader makes."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always", LogWarning)
        found = read(path)
    return found, [str(note.message) for note in said if issubclass(note.category, LogWarning)]


def is_silent(flip: Flip) -> bool:
    """Whether another story was read and nothing said; files of scenes, which people write, may say another one."""
    return flip.outcome in ("rows", "scene") and not flip.target.startswith("scene.")


def _same(one: Any, other: Any) -> bool:
    return bool(np.all(one == other))


def main() -> int:
    """Flip, and print what came of it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--flips", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="+", default=[])
    parser.add_argument("--folder", help="where files are put; in memory (/dev/shm) they cost half the time")
    asked = parser.parse_args()
    counts: dict[str, Counter[str]] = {}
    wrong = 0
    with tempfile.TemporaryDirectory(dir=asked.folder) as folder:
        chosen = {name: target for name, target in targets(Path(folder)).items() if not asked.only or name in asked.only}
        for flip in flips(chosen, asked.flips, asked.seed):
            counts.setdefault(flip.target, Counter())[flip.outcome] += 1
            if flip.outcome == "raised" or is_silent(flip):
                wrong += 1
                print(f"{flip.target} byte {flip.place} bit {flip.bit}: {flip.outcome} {flip.words}", flush=True)
    for name, count in counts.items():
        print(f"{name:16} {dict(sorted(count.items()))}")
    total = sum(counts.values(), Counter())
    print(f"seed {asked.seed}, {asked.flips} flips: {dict(sorted(total.items()))}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

"""Coverage-guided fuzzing of everything that reads what somebody else wrote: scenes, logs, checkpoints, settings.

    python -m tests.fuzz.parsers TARGET [--inputs N] [--corpus FOLDER]

needs atheris (pip install atheris).  An input may be read or be refused with an EventsimError; anything else that is raised, and
every input that takes longer than PATIENCE, is a find, and ends the run with the input that shows it in `crash-*`.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import sys
import tempfile
import tomllib
import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

PATIENCE = 60
"""Seconds, on a machine that is shared; a usual input takes milliseconds."""

WORDS = (
    "1e308", "-1e308", "1e-308", "5e-324", "-0.0", "inf", "nan", "NaN", "Infinity", "null", "true", "[]", "{}", "1000000000",
    "9223372036854775808", "1" * 5000, "[[disk]]", "[[gas]]", "[[wall]]", "[domain]", "position", "velocity", "radius", "mass",
    "count", "packing_fraction", "arrangement", '"random"', '"hexagonal"', '"compressed"', "seed", "kind", '"periodic"',
    '"open"', '"channel"', '"circle"', '"arc"', '"polygon"', "points", "restitution", "gravity", "until", "events", "kick",
    "pair", "wall", "rest", ",,,,", "\\n", "\\x00", "[" * 40, '{"a":' * 40,
)  # fmt: skip
"""What a mutation may put in at once."""


def main() -> None:
    """Read the command line and hand over to the fuzzer, which does not come back."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("target", choices=sorted(TARGETS))
    parser.add_argument("--inputs", type=int, default=10_000)
    parser.add_argument("--corpus", type=Path, default=None)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    import atheris

    with atheris.instrument_imports(include=["eventsim"], exclude=["eventsim.engines.fast"]):
        import eventsim.record.files.csv
        import eventsim.record.files.jsonl
        import eventsim.record.files.npz
        import eventsim.record.files.parquet
        import eventsim.runner.checkpoint
        import eventsim.scene.tables
        import eventsim.simulation  # noqa: F401
    corpus = asked.corpus or Path(tempfile.mkdtemp(prefix=f"fuzz-{asked.target}-"))
    corpus.mkdir(exist_ok=True)
    place = Path(tempfile.mkdtemp(prefix="fuzzed-", dir="/dev/shm" if Path("/dev/shm").is_dir() else None))
    read, seeds = TARGETS[asked.target]
    for number, seed in enumerate(seeds(place)):
        (corpus / f"seed{number}").write_bytes(seed)
    words = place / "words.dict"
    words.write_text("".join(f'"{_escaped(word)}"\n' for word in WORDS if len(word) < 100))
    from eventsim.errors import EventsimError

    warnings.simplefilter("ignore")

    def one(data: bytes) -> None:
        with contextlib.suppress(EventsimError):
            read(data, place)

    options = [
        f"-runs={asked.inputs}",
        f"-dict={words}",
        f"-timeout={PATIENCE}",
        "-max_len=8192",
        f"-seed={asked.seed}",
    ]
    atheris.Setup([sys.argv[0], *options, "-print_final_stats=1", "-rss_limit_mb=4096", str(corpus)], one)
    atheris.Fuzz()


def _escaped(word: str) -> str:
    return "".join(letter if letter.isalnum() else f"\\x{ord(letter):02x}" for letter in word)


def scene_toml(data: bytes, place: Path) -> None:
    """A scene file in TOML; gases of many disks are the rule's business, not the parser's."""
    _scene(data, place / "scene.toml")


def scene_json(data: bytes, place: Path) -> None:
    """A scene file in JSON."""
    _scene(data, place / "scene.json")


def _scene(data: bytes, path: Path) -> None:
    from eventsim.scene.files import load_scene

    if b"compressed" not in data:  # that is a simulation of its own
        path.write_bytes(data)
        load_scene(path)


def setting(data: bytes, place: Path) -> None:
    """What is typed behind --set and --every."""
    from eventsim.errors import EventsimError
    from eventsim.runner.checkpoint import interval
    from eventsim.scene.files import apply_overrides

    text = data.decode("utf-8", "replace")
    with contextlib.suppress(EventsimError):
        interval(text)
    apply_overrides({"disk": [{"radius": 1.0}], "domain": {"kind": "open"}}, [text])


def _log(suffix: str) -> Callable[[bytes, Path], None]:
    def read(data: bytes, place: Path) -> None:
        from eventsim.run import load_log

        path = place / f"log{suffix}"
        path.write_bytes(data)
        log = load_log(path)
        if len(log):
            log.expand()

    return read


def _rows(suffix: str) -> Callable[[bytes, Path], None]:
    """Lines of a compact text log whose metadata are as they should be."""
    heads: list[bytes] = []

    def read(data: bytes, place: Path) -> None:
        from eventsim.record.provenance import provenance_text
        from eventsim.run import load_log

        if not heads:
            _, *lines = _good_log(place, f"good{suffix}", compact=True).splitlines(keepends=True)
            open_ended = replace(load_log(place / f"good{suffix}").provenance, rows=None)
            prefix, header = (b"# ", lines[0]) if suffix == ".csv" else (b"", b"")
            heads.append(prefix + provenance_text(open_ended).encode() + b"\n" + header)
        path = place / f"rows{suffix}"
        path.write_bytes(heads[0] + data)
        log = load_log(path)
        if len(log):
            log.expand()

    return read


def checkpoint(data: bytes, place: Path) -> None:
    """A checkpoint, which is not run."""
    from eventsim.runner.checkpoint import load_checkpoint

    path = place / "run.checkpoint"
    path.write_bytes(data)
    load_checkpoint(path)


def _good_log(place: Path, name: str, compact: bool) -> bytes:
    import eventsim as es

    walls = (es.Segment((0.1, 0.1), (0.4, 0.2), name="ramp"),)
    disks = es.Disks([(0.3, 0.5), (0.7, 0.5)], [(1.0, 0.1), (0.0, 0.0)], 0.05)
    es.simulate(es.Scene(disks, es.Box((1.0, 1.0)), walls), events=12, log=place / name, compact=compact)
    return (place / name).read_bytes()


def _log_seeds(suffix: str) -> Callable[[Path], list[bytes]]:
    return lambda place: [_good_log(place, f"seed{suffix}", compact) for compact in (False, True)]


def _row_seeds(suffix: str) -> Callable[[Path], list[bytes]]:
    def seeds(place: Path) -> list[bytes]:
        whole = _good_log(place, f"seed{suffix}", True)
        mark = b"\n{" if suffix == ".jsonl" else b"\n0,"
        return [mark[1:] + whole.split(mark, 1)[1]]

    return seeds


def _scene_seeds(form: str) -> Callable[[Path], list[bytes]]:
    def seeds(place: Path) -> list[bytes]:
        texts = [SCENE, *(path.read_text() for path in sorted(Path(__file__).parents[2].glob("examples/**/*.toml")))]
        if form == "toml":
            return [text.encode() for text in texts]
        return [json.dumps(tomllib.loads(text), default=str).encode() for text in texts]

    return seeds


def _checkpoint_seeds(place: Path) -> list[bytes]:
    import eventsim as es

    disks = es.Disks([(0.3, 0.5), (0.7, 0.5)], [(1.0, 0.1), (0.0, 0.0)], 0.05)
    es.simulate(es.Scene(disks, es.Box((1.0, 1.0))), events=12, checkpoint=place / "seed.checkpoint")
    return [(place / "seed.checkpoint").read_bytes()]


SCENE = """\
name = "all"
until = 4.0
gravity = [0.0, -9.81]
restitution = {pair = 0.9, wall = 1.0}
contact_duration = 1e-6
[domain]
kind = "box"
size = [2.54, 1.27]
[[disk]]
position = [0.6, 0.635]
velocity = [3.0, 0.0]
radius = 0.028
mass = inf
[[gas]]
count = 20
packing_fraction = 0.01
temperature = 1.0
arrangement = "random"
region = [0.0, 0.0, 1.0, 0.3]
seed = 7
[[wall]]
kind = "segment"
start = [1.0, 1.0]
end = [1.5, 1.1]
[[wall]]
kind = "arc"
start = [2.0, 0.2]
through = [2.1, 0.3]
end = [2.2, 0.2]
"""

SETTINGS = [b"restitution=0.9", b"gas.0.count=500", b"disk[0].radius = {a = [1, 2]}", b"5min", b"1000"]

Target = tuple[Callable[[bytes, Path], None], Callable[[Path], list[bytes]]]
TARGETS: dict[str, Target] = {
    "scene-toml": (scene_toml, _scene_seeds("toml")),
    "scene-json": (scene_json, _scene_seeds("json")),
    "setting": (setting, lambda place: SETTINGS),
    "csv": (_log(".csv"), _log_seeds(".csv")),
    "jsonl": (_log(".jsonl"), _log_seeds(".jsonl")),
    "npz": (_log(".npz"), _log_seeds(".npz")),
    "parquet": (_log(".parquet"), _log_seeds(".parquet")),
    "csv-rows": (_rows(".csv"), _row_seeds(".csv")),
    "jsonl-rows": (_rows(".jsonl"), _row_seeds(".jsonl")),
    "checkpoint": (checkpoint, _checkpoint_seeds),
}


if __name__ == "__main__":
    main()

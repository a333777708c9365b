"""What a file holds, by its first bytes: a wrong suffix is told as such, not as damage."""

from __future__ import annotations

from pathlib import Path

from eventsim.errors import LogError

MARKS = {".csv": b"# {", ".jsonl": b'{"', ".npz": b"PK", ".parquet": b"PAR1"}
BINARY = (".npz", ".parquet")
BYTE_ORDER_MARK = b"\xef\xbb\xbf"


def demand_looks(path: Path, suffix: str) -> None:
    """Raise LogError where a file begins like a log of another format than its suffix says, or like no file of a binary one."""
    try:
        with path.open("rb") as file:
            head = file.read(8).removeprefix(BYTE_ORDER_MARK)
    except OSError as error:
        raise LogError(f"{path}: cannot be read ({error.strerror or error})") from None
    found = next((form for form, mark in MARKS.items() if head.startswith(mark)), None)
    if found != suffix and (found is not None or suffix in BINARY):
        hint = "" if found is None else f"; it looks like a {found} file, so give it that suffix"
        raise LogError(f"{path}: not a {suffix} file{hint}")

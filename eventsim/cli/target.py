"""Files that a verb is to write: refused before any work is done for them."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import click


class Files(NamedTuple):
    """What a run writes; None: that is not wanted."""

    log: Path | None
    state: Path | None
    checkpoint: Path | None


def writable(path: str | None, option: str, suffixes: Sequence[str] | None, source: str | None = None) -> Path | None:
    """Return `path` as one that can be written, None if there is none.  source: a file that is read, and must stay.
    suffixes: None where any will do.

    Raises:
        click.UsageError: naming the option, the path and what is wrong with it.
    """
    if path is None:
        return None
    target = Path(path)
    if suffixes is not None and target.suffix.lower() not in suffixes:
        raise click.UsageError(f"{option} {path}: the file's name must end in {', '.join(suffixes)}")
    if source is not None and target.exists() and Path(source).exists() and target.samefile(source):
        raise click.UsageError(f"{option} {path}: this is the file that is read; write to another one")
    if target.is_dir():
        raise click.UsageError(f"{option} {path}: is a directory")
    if not target.parent.is_dir():
        raise click.UsageError(f"{option} {path}: there is no directory {target.parent}")
    if not os.access(target.parent, os.W_OK) or (target.exists() and not os.access(target, os.W_OK)):
        raise click.UsageError(f"{option} {path}: no permission to write there")
    return target

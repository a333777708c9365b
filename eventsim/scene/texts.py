"""From the text of a scene file to its tables, and from problems to the lines of the text that they speak of."""

from __future__ import annotations

import codecs
import json
import tomllib
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

from eventsim.errors import SceneError
from eventsim.reading import NO_TEXT, no_text, reading
from eventsim.scene.overrides import is_shallow

MOST_BYTES = 1 << 30
"""Of a scene file: some ten million disks."""


def tables_of_file(path: Path) -> tuple[dict[str, Any], str]:
    """The tables of a .json or .toml file, and its text.

    Raises:
        SceneError: naming the file.
    """
    text = _text(path)
    return _whole_tables_of(path, text), text


def tables_of_toml(text: str) -> dict[str, Any]:
    """The tables of a TOML text.

    Raises:
        SceneError: a sentence, the line, a caret, and the line that would be right.
    """
    return _tables_of(text, ".toml")


def _tables_of(text: str, suffix: str) -> dict[str, Any]:
    """The tables of a text: of JSON, if the suffix says so, else of TOML."""
    try:
        return json.loads(text, object_pairs_hook=_once) if suffix == ".json" else tomllib.loads(text)
    except json.JSONDecodeError as error:
        from eventsim.scene import json_slips

        raise SceneError(f"is not valid JSON: {json_slips.problem_of(text, error)}") from None
    except tomllib.TOMLDecodeError as error:
        from eventsim.scene.slips import problem_of

        raise SceneError(f"is not valid TOML: {problem_of(text, error)}") from None
    except RecursionError:
        raise SceneError("is nested too deeply for a scene file") from None
    except ValueError:  # Python reads no whole number of thousands of digits
        raise SceneError("holds a number with too many digits") from None


def with_lines(
    error: SceneError, text: str, data: Mapping[str, Any], settings: Collection[str] = (), is_json: bool = False
) -> SceneError:
    """The problems of the scene of a text, followed by the lines that they speak of; see `quoting.with_lines`."""
    from eventsim.scene import quoting  # only who errs pays for it

    return quoting.with_lines(error, text, data, settings, is_json)


def _text(path: Path) -> str:
    """The text of a file; marks of byte order, as editors put before it, are no part of it."""
    with reading(path, SceneError, "is not a scene file", MOST_BYTES) as file:
        data = file.read()
    wide = data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    try:
        text = data.decode("utf-16" if wide else "utf-8-sig").replace("\r\n", "\n")
        return text if "\n" in text else text.replace("\r", "\n")  # as old Macs end lines
    except UnicodeDecodeError as error:
        raise SceneError(f"{path}: {NO_TEXT if wide else no_text(data, error)}") from None


def _whole_tables_of(path: Path, text: str) -> dict[str, Any]:
    """The tables of a file with this text."""
    try:
        data = _tables_of(text, path.suffix.lower())
        if not isinstance(data, dict):
            raise SceneError("must be a JSON object with the keys of a scene")
        if not is_shallow(data):
            raise SceneError("is nested too deeply for a scene file")
    except SceneError as error:
        raise SceneError(f"{path}: {error}") from None
    return data


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """A table, each key of which is given once, as TOML demands."""
    table: dict[str, Any] = {}
    for key, value in pairs:
        if key in table:
            raise SceneError(f"gives the key {key!r} twice in one table")
        table[key] = value
    return table

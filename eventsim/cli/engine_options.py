"""Options of an engine as the command line gives them: --dt DT, --option KEY=VALUE; the table of engines has them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import click

from eventsim.engines import ENGINES, STEPPED, TABLE, engine_named
from eventsim.engines.options import read_option, words_of

EXACT = [name for name, engine in TABLE.items() if not engine.stepped]
ENGINE_HELP = f"Which engine simulates: {', '.join(EXACT)}; with time steps: {', '.join(STEPPED)}."
DT_HELP = (
    "Step of a time-stepped engine. Default: 1/60 (frames); else a twentieth of the time in which a typical disk flies, "
    "or falls, its radius."
)
OPTION_HELP = (
    "An option of an engine: "
    + "; ".join(f"{name}: {', '.join(words)}" for name in ENGINES if (words := words_of(ENGINES[name].options)))
    + "."
)


def engine_options(engine: str, dt: float | None, given: Sequence[str]) -> dict[str, Any]:
    """The options for `simulate`; click.UsageError for what the engine does not have or what cannot be read."""
    texts = {} if dt is None else {"dt": repr(dt)}
    for setting in given:
        key, equals, text = setting.partition("=")
        if not equals:
            raise click.UsageError(f"--option {setting!r}: must be KEY=VALUE, like memory=frame")
        texts[key.strip()] = text.strip()
    if not texts:
        return {}
    row = engine_named(engine)
    words = words_of(row.options)
    read = {}
    for key, text in texts.items():
        if key not in words:
            raise click.UsageError(row.without(key))
        try:
            read[key] = read_option(row.options, key, text)
        except ValueError:
            raise click.UsageError(f"--option {key}={text}: must be {words[key]}") from None
    return read

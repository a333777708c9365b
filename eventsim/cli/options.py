"""The arguments and options that several verbs share, those of engines, and the files that a verb is to write."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from decimal import Decimal, InvalidOperation
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import click
from click.shell_completion import CompletionItem

from eventsim.engines import ENGINES, STEPPED, TABLE, engine_named
from eventsim.engines.options import read_option, words_of
from eventsim.suffixes import FIGURES

Verb = TypeVar("Verb", bound=Callable[..., Any])

MOST_DIGITS = 18
"""Of a number written with an exponent: more than can be counted."""


class Whole(click.IntRange):
    """A whole number, which may be written as 1e6."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the number; refuse what is none, or outside the range."""
        try:
            number = Decimal(str(value))
            if number.is_finite() and number.adjusted() < MOST_DIGITS and number == int(number):
                value = int(number)
        except InvalidOperation:
            pass  # no number at all: the message is the usual one
        return super().convert(value, param, ctx)


def _tell_schema(context: click.Context, option: click.Parameter, asked: bool) -> None:
    """Print the schema of the verb and end."""
    if not asked or context.resilient_parsing:
        return
    from eventsim.cli.output import say_data
    from eventsim.cli.schemas import schema_of
    from eventsim.cli.words import as_json_text

    assert context.info_name is not None
    say_data(as_json_text(schema_of(context.info_name)))
    context.exit()


def json_option(verb: Verb) -> Verb:
    """Add --json, and --json-schema, which tells what that prints."""
    schema = click.option(
        "--json-schema",
        is_flag=True,
        is_eager=True,
        expose_value=False,
        callback=_tell_schema,
        help="Print the JSON Schema of that, and nothing else.",
    )
    return click.option("--json", "as_json", is_flag=True, help="Print JSON on stdout instead of text.")(schema(verb))


quiet_option = click.option("-q", "--quiet", is_flag=True, help="Print no summary and no progress.")


def complete_scene(context: click.Context, argument: click.Parameter, begun: str) -> list[CompletionItem]:
    """Complete the name of a built-in scene; else a file."""
    from eventsim.scene.gallery import names

    found = [CompletionItem(name) for name in names() if name.startswith(begun)]
    return [*found, CompletionItem(begun, type="file")]


def scene_options(required: bool, metavar: str = "SCENE") -> Callable[[Verb], Verb]:
    """Add the argument SCENE and the options --set and --seed that shape it."""

    def decorate(verb: Verb) -> Verb:
        for add in (
            click.option("--seed", type=click.IntRange(min=0), metavar="S", help=SEED_HELP),
            click.option("--set", "settings", multiple=True, metavar="KEY=VALUE", help=SET_HELP),
            click.argument(
                "scene",
                required=required,
                metavar=metavar if required else f"[{metavar}]",
                shell_complete=complete_scene,
            ),
        ):
            verb = add(verb)
        return verb

    return decorate


SET_HELP = (
    "Override a key of the scene (restitution=0.9, gas.0.count=500) or a parameter of a built-in one "
    "(mass_ratio=10000). May be given several times."
)
SEED_HELP = "Seed chance: the i-th table that draws random numbers is seeded from (S, i)."


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


def drawable(path: str | None, option: str, suffixes: Sequence[str] = FIGURES) -> Path | None:
    """Return `path` as a picture that can be drawn and written, None if there is none.

    Raises:
        click.UsageError: as `writable`.
        EventsimError: where nothing can draw; that is told before anything is run.
    """
    target = writable(path, option, suffixes)
    if target is not None:
        import eventsim.show  # noqa: F401 - its import is the question
    return target


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

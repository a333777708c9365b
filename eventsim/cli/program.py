"""The command `eventsim`: its verbs, what it says on its own, and how every failure ends."""

from __future__ import annotations

import os
import re
import shlex
import sys
import warnings
from importlib import import_module
from inspect import cleandoc

import click

from eventsim import __version__
from eventsim.cli.folding import WIDTH, folded
from eventsim.cli.output import (
    BAD_INPUT,
    DONE,
    INTERRUPTED,
    keep_in_line,
    say,
    visible,
    write_what_is_known,
)
from eventsim.cli.signals import terminable
from eventsim.errors import EventsimError, LogWarning, SceneError

VERBS = {
    "run": "Simulate a scene from event to event; print a summary, keep a log.",
    "check": "Validate a scene; explain what it needs and what will be used.",
    "gallery": "List, show or copy the built-in scenes.",
    "state": "Positions and velocities at any times, from a log.",
    "measure": "Pressure, temperature, collision rates, free paths, ... with error bars and theory.",
    "sweep": "Run a scene for many values and seeds; one table of measures.",
    "animate": "Draw a run as a movie, a strip of moments, or a page that plays it.",
    "validate": "Compare the event-driven run of a scene with time-stepped engines, or yours.",
    "chart": "Chart speed against accuracy, all engines.",
    "stress": "Run every engine on the scenes where methods fail; print the atlas of verdicts.",
    "certify": "Prove the order of events with ball arithmetic; tell where float64 first differs.",
    "figure": "Draw what a log says: trajectories, speeds, free paths, residuals, ...",
    "warm": "Compile the fast engine's kernels for scenes, so that no run has to wait for them.",
    "selftest": "Compare what this machine computes with what every machine must compute.",
    "live": "Open the live view in the browser: play, throw, measure, compare.",
}

BEGIN = """\
eventsim: event-driven hard disks in two dimensions. Three commands to begin:

  eventsim run break --log break.csv   simulate a built-in scene, keep a log
  eventsim gallery                     see which other scenes are built in
  eventsim check break                 read what a scene needs and will get

eventsim --help lists all verbs, eventsim VERB --help explains one."""

DISPLAY = {"help_option_names": ["-h", "--help"], "max_content_width": WIDTH}


class Help(click.HelpFormatter):
    """Help whose lines fit a terminal, tables and examples too."""

    def getvalue(self) -> str:
        """The whole text."""
        return folded(super().getvalue())


class Context(click.Context):
    """The context of every verb."""

    formatter_class = Help


def complete_files(verb: click.Command) -> None:
    """Let shells complete the names of files, where a parameter is one."""
    for parameter in verb.params:
        shown = parameter.metavar or (parameter.name or "").upper()
        if parameter.type is click.STRING and ("FILE" in shown or shown == "LOG"):
            parameter.type = click.Path(readable=False)


def tell_keys_last(verb: click.Command) -> None:
    """Let the help of a verb tell its options before the keys of its JSON."""
    text = cleandoc(verb.help or "")
    keys = re.search(r"\n\n(?:\x08\n)?Keys of --json", text)
    if keys is not None:
        verb.help, verb.epilog = text[: keys.start()], text[keys.start() :].strip("\n")


class Program(click.Group):
    """The verbs, each imported when it is called: `eventsim --help` loads none of them."""

    context_class = Context

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Name the verbs in the order in which a user meets them."""
        return list(VERBS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import one verb; a misspelt one is answered with the nearest."""
        if cmd_name in VERBS:
            verb = import_module(f"eventsim.cli.{cmd_name}").command
            assert isinstance(verb, click.Command)
            verb.context_class = Context
            complete_files(verb)
            tell_keys_last(verb)
            return verb
        if not cmd_name.startswith("-"):
            from eventsim.cli.guesses import verb_hint  # only who errs pays for it

            ctx.fail(f"there is no verb {cmd_name!r}{verb_hint(cmd_name, tuple(VERBS))}")
        return None

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the list of verbs from the table, without importing them."""
        with formatter.section("Verbs"):
            formatter.write_dl(list(VERBS.items()))

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Keep the command line as it was typed: logs say by which they were written."""
        ctx.obj = shlex.join(["eventsim", *args])
        keep_in_line(args)
        return super().parse_args(ctx, args)

    def invoke(self, ctx: click.Context) -> object:
        """Call the verb; turn what goes wrong into a sentence on stderr and an exit code."""
        write_what_is_known()
        try:
            with terminable(), warnings.catch_warnings():
                warnings.simplefilter("always", LogWarning)
                warnings.showwarning = lambda message, *place: say(f"warning: {message}", err=True)
                result: object = super().invoke(ctx)
            sys.stdout.flush()  # a closed pipe must show itself here, not while Python shuts down
            return result
        except EventsimError as error:
            raise Failure(_message(error)) from error
        except click.BadParameter as error:
            from eventsim.cli.guesses import kind_hint  # only who errs pays for it

            hint = _decimal_point(error.message) or kind_hint(error.message)
            if not hint:
                raise
            raise click.BadParameter(error.message + hint, error.ctx, error.param, error.param_hint) from error
        except click.NoSuchOption as error:
            from eventsim.cli.guesses import option_hint  # only who errs pays for it

            meant = option_hint(error.option_name, error.ctx)
            if meant is None:
                raise
            raise click.UsageError(meant, error.ctx) from error
        except BrokenPipeError:
            # The reader had enough (| head): nothing may be written to the pipe any more, not even at exit.
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            ctx.exit(DONE)
        except KeyboardInterrupt:
            say("interrupted", err=True)
            ctx.exit(INTERRUPTED)
        except OSError as error:
            place = "" if error.filename is None else f"{error.filename}: "
            raise Failure(f"{place}{error.strerror or error}") from error
        except MemoryError:
            raise Failure("there is not enough memory for this") from None


def _decimal_point(message: str) -> str:
    """What to write where a number was refused for its decimal comma; else nothing."""
    found = re.search(r"'([-+]?\d*),(\d+)' is not a valid (float|integer)", message)
    if found is None:
        return ""
    if found[3] == "integer":
        return f" A whole number has no marks between thousands: {found[1]}{found[2]}" if len(found[2]) == 3 else ""
    from eventsim.scene.remedies import two_ways  # only who errs pays for it

    ways = two_ways(f"{found[1]},{found[2]}".lstrip("-+"))
    return f" A number has a decimal point, not a comma: {ways or f'{found[1] or 0}.{found[2]}'}"


def _message(error: EventsimError) -> str:
    """The text of an error; several problems of a scene below each other."""
    if isinstance(error, SceneError) and len(error.problems) > 1:
        return "\n  ".join([f"{len(error.problems)} problems", *error.problems])
    return str(error)


class Failure(click.ClickException):
    """Ends the command for bad usage, scene or file with nothing but a message."""

    exit_code = BAD_INPUT

    def format_message(self) -> str:
        """Say it without what would control a terminal."""
        return visible(super().format_message())


@click.group(cls=Program, invoke_without_command=True, context_settings=DISPLAY)
@click.version_option(__version__, "-V", "--version", message="eventsim %(version)s")
@click.pass_context
def main(context: click.Context) -> None:
    """Event-driven hard disks in two dimensions: a scene in, an event log out that replays bit for bit.

    A SCENE is a file (TOML or JSON) or the name of a built-in scene. Every verb explains itself:
    eventsim VERB --help.

    Exit codes: 0 done; 1 event-driven engines or a proof failed a comparison; 2 bad usage, scene or file;
    3 stopped early for a reason of physics or digits; 130 interrupted. What happened before an early stop is kept.
    """
    if context.invoked_subcommand is None:
        say(BEGIN)

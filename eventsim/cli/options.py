"""The arguments and options that several verbs share."""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal, InvalidOperation
from typing import Any, TypeVar

import click

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


json_option = click.option("--json", "as_json", is_flag=True, help="Print JSON on stdout instead of text.")
quiet_option = click.option("-q", "--quiet", is_flag=True, help="Print no summary and no progress.")


def scene_options(required: bool, metavar: str = "SCENE") -> Callable[[Verb], Verb]:
    """Add the argument SCENE and the options --set and --seed that shape it."""

    def decorate(verb: Verb) -> Verb:
        for add in (
            click.option("--seed", type=click.IntRange(min=0), metavar="S", help=SEED_HELP),
            click.option("--set", "settings", multiple=True, metavar="KEY=VALUE", help=SET_HELP),
            click.argument("scene", required=required, metavar=metavar if required else f"[{metavar}]"),
        ):
            verb = add(verb)
        return verb

    return decorate


SET_HELP = (
    "Override a key of the scene (restitution=0.9, gas.0.count=500) or a parameter of a built-in one "
    "(mass_ratio=10000). May be given several times."
)
SEED_HELP = "Seed chance: the i-th table that draws random numbers is seeded from (S, i)."

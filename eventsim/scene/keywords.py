"""Which keywords a part of a scene takes: one that it does not is told with the nearest one that it does."""

from __future__ import annotations

from collections.abc import Mapping
from functools import wraps
from inspect import Parameter, signature
from typing import Any

from eventsim.errors import SceneError, did_you_mean


def tell_keywords(kind: type) -> None:
    """Let a class raise a SceneError for a keyword that it does not take, and for one that it needs and does not get."""
    made = kind.__init__  # type: ignore[misc]

    @wraps(made)
    def make(self: object, *values: object, **given: object) -> None:
        try:
            made(self, *values, **given)
        except TypeError:
            problems = _problems(kind, values, given)
            if not problems:
                raise
            raise SceneError(problems) from None

    kind.__init__ = make  # type: ignore[misc]


def _problems(kind: type, values: tuple[object, ...], given: Mapping[str, Any]) -> list[str]:
    """What is wrong with the keywords of a call; nothing where that is not what has failed."""
    parameters = signature(kind).parameters
    takes = f"it takes {', '.join(parameters)}"
    unknown = [key for key in given if key not in parameters]
    if unknown or len(values) > len(parameters):
        return [f"{kind.__name__} has no keyword {key!r}{_hint(key, parameters)}; {takes}" for key in unknown]
    rest = list(parameters.values())[len(values) :]
    missing = [one.name for one in rest if one.default is Parameter.empty and one.name not in given]
    return [f"{kind.__name__} lacks {' and '.join(missing)}; {takes}"] if missing else []


def _hint(key: str, known: Mapping[str, Any]) -> str:
    """What is meant by a keyword."""
    from eventsim.scene.remedies import meant  # only who errs pays for it

    other = meant(key)
    return f" (did you mean {other!r}?)" if other in known else did_you_mean(key, known)

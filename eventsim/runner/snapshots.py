"""Nested tuples of numbers as arrays, and back: how a snapshot is kept in a file without a word about its fields.

A number, a text or None stays as it is.  A tuple of floats, or of whole numbers, is one array.  A tuple of tuples is the array
of their lengths, and what they hold one behind the other, packed in turn.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import chain
from typing import Any, TypeAlias

import numpy as np

Packed: TypeAlias = Any
"""What JSON can hold: {"value": ...}, {"numbers": name of an array} or {"lengths": name of an array, "items": packed}."""

Arrays: TypeAlias = dict[str, np.ndarray[Any, Any]]

DEEPEST = 8
"""Tuples within tuples; nothing that is packed here comes near."""


def packed(name: str, value: Any, arrays: Arrays) -> Packed:
    """Pack a value; what does not fit into JSON goes into `arrays`, under names that begin with `name`.

    Raises TypeError for what is neither a number, a text, None nor a tuple of one kind of these.
    """
    if value is None or type(value) in (bool, int, float, str):
        return {"value": value}
    if type(value) is not tuple:
        raise TypeError(f"{name}: a {type(value).__name__} cannot be packed")
    kinds = set(map(type, value))
    if kinds <= {int} or kinds <= {float}:
        arrays[name] = np.array(value, np.float64 if float in kinds else np.int64)
        return {"numbers": name}
    if kinds == {tuple}:
        arrays[name] = np.fromiter(map(len, value), np.int64, len(value))
        return {"lengths": name, "items": packed(f"{name}.items", tuple(chain.from_iterable(value)), arrays)}
    raise TypeError(f"{name}: a tuple of {', '.join(sorted(kind.__name__ for kind in kinds))} cannot be packed")


def unpacked(form: Packed, arrays: Mapping[str, np.ndarray[Any, Any]], depth: int = 0) -> Any:
    """What was packed, of the same types.

    Raises KeyError, TypeError or ValueError for what `packed` does not give.
    """
    if "value" in form:
        return form["value"]
    if depth > DEEPEST:
        raise ValueError("tuples are nested too deeply")
    if "numbers" in form:
        return tuple(_numbers(arrays[form["numbers"]]).tolist())
    lengths = _numbers(arrays[form["lengths"]])
    items = unpacked(form["items"], arrays, depth + 1)
    ends = np.cumsum(lengths)
    if lengths.dtype.kind != "i" or np.any(lengths < 0) or len(items) != (ends[-1] if len(ends) else 0):
        raise ValueError("the lengths of tuples do not fit what they hold")
    return tuple(items[end - length : end] for end, length in zip(ends.tolist(), lengths.tolist(), strict=True))


def _numbers(array: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    if array.ndim != 1 or array.dtype not in (np.dtype(np.float64), np.dtype(np.int64)):
        raise ValueError(f"an array of {array.dtype} and shape {array.shape} is not expected")
    return array

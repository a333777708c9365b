"""How numbers and points given by a user become floats."""

from __future__ import annotations

from collections.abc import Iterable
from numbers import Integral, Real
from typing import TypeAlias

from eventsim.errors import SceneError

Point: TypeAlias = tuple[float, float]

# Squares of lengths must be numbers too, neither infinite nor 0.
SHORTEST, LONGEST = 1e-150, 1e150
# Energies are squares of speeds, and their errors squares of these.
SLOWEST, FASTEST = 1e-75, 1e75
SPEEDS = f"must be two finite numbers, the larger {SLOWEST} to {FASTEST}, or both 0: else choose other units of length or time"
SPEED = f"must be 0 or from {SLOWEST} to {FASTEST}"
LENGTHS = f"must be above 0 (at least {SHORTEST}) and at most {LONGEST}"
RADII = f"must be at least 0 and at most {LONGEST} (0 is a point, no other below {SHORTEST})"


def is_place(numbers: Iterable[float]) -> bool:
    """Whether lengths are finite and small enough to be squared."""
    return all(abs(value) <= LONGEST for value in numbers)


def is_velocity(vx: float, vy: float) -> bool:
    """Whether a disk may have that velocity: its square, and the square of that, are numbers."""
    return vx == vy == 0.0 or SLOWEST <= max(abs(vx), abs(vy)) <= FASTEST


def is_length(value: float) -> bool:
    """Whether a length is one whose square is a number."""
    return SHORTEST <= value <= LONGEST


def as_number(value: object) -> float:
    """The real number that a value is.

    Raises:
        TypeError: if it is none; OverflowError: if no float is as large. Both say the rule.
    """
    if type(value) is float:
        return value  # nearly always; long lists of disks are read much faster
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError("must be a number")
    try:
        return float(value)
    except OverflowError:
        raise OverflowError("is too large for a number") from None


def number(value: object, key: str) -> float:
    """The value as a float.

    Raises:
        SceneError: if the value is not a real number; `key` says which one it is.
    """
    try:
        return as_number(value)
    except TypeError as error:
        raise SceneError(f"{key} = {value!r}: {error}") from None
    except OverflowError as error:
        raise SceneError(f"{key}: {error}") from None


def optional_number(value: object, key: str) -> float | None:
    """The value as a float, or None where there is none."""
    return None if value is None else number(value, key)


def optional_whole(value: object, key: str) -> int | None:
    """The value as an int, or None where there is none.

    Raises:
        SceneError: if the value is not a whole number.
    """
    if value is None:
        return None
    whole = as_whole(value)
    if whole is None:
        raise SceneError(f"{key} = {value!r}: must be a whole number")
    return whole


def as_whole(value: object) -> int | None:
    """The whole number that a value is, also where it is written as 1e6; None where it is none."""
    if isinstance(value, bool):
        return None
    if isinstance(value, Integral):
        return int(value)
    return int(value) if isinstance(value, float) and value.is_integer() else None


def point(value: object, key: str) -> Point:
    """The value as a pair of floats (x, y); any sequence of two numbers will do.

    Raises:
        SceneError: if the value is not a sequence of two real numbers.
    """
    pair = tuple(value) if isinstance(value, Iterable) else ()
    if len(pair) != 2:
        raise SceneError(f"{key} = {value!r}: must be two numbers, x and y")
    x, y = pair
    return number(x, f"{key}[0]"), number(y, f"{key}[1]")

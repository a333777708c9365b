"""Straight walls that disks may rest on, as in `stage.supports`."""

from __future__ import annotations

from eventsim.engines.fast.compiled import inline
from eventsim.engines.fast.layout import SUPPORT, SUPPORT_FACE, SUPPORT_HIGH, SUPPORT_LINE, SUPPORT_LOW
from eventsim.engines.fast.memory import real
from eventsim.engines.fast.shapes import face_at


@inline
def is_support(m, place):
    """Whether a wall supports disks."""
    return real(m.supports, SUPPORT * place + SUPPORT_LOW) < real(m.supports, SUPPORT * place + SUPPORT_HIGH)


@inline
def support_face(m, place):
    """The face of a wall that supports disks."""
    return face_at(m.supports, SUPPORT * place + SUPPORT_FACE)


@inline
def are_in_line(m, one, other):
    """Whether two walls support disks, and are in line."""
    same = real(m.supports, SUPPORT * one + SUPPORT_LINE) == real(m.supports, SUPPORT * other + SUPPORT_LINE)
    return same and is_support(m, one) and is_support(m, other)

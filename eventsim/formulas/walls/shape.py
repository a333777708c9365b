"""For each shape of a wall, the function that says when a disk meets it: one table for engines and replay."""

from collections.abc import Callable
from typing import TypeVar

from eventsim.formulas.real import Real
from eventsim.formulas.walls.face import Face, face_delay
from eventsim.formulas.walls.round import Arc, Container, Post, arc_delay, container_delay, post_delay

DELAYS: dict[type, Callable[..., tuple[Real, int]]] = {
    Face: face_delay,
    Post: post_delay,
    Container: container_delay,
    Arc: arc_delay,
}

Shape = TypeVar("Shape", bound=Face | Post | Container | Arc)


def at_origin(shape: Shape) -> Shape:
    """The same shape with the point (x, y) that it is told from in the origin."""
    if isinstance(shape, Arc):
        return shape._replace(x=0.0, y=0.0, x0=shape.x0 - shape.x, y0=shape.y0 - shape.y)
    return shape._replace(x=0.0, y=0.0)  # type: ignore[return-value]

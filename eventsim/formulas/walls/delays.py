"""For each shape of a wall, the function that says when a disk meets it: one table for engines and replay."""

from collections.abc import Callable

from eventsim.formulas.real import Real
from eventsim.formulas.walls.face import Face, face_delay
from eventsim.formulas.walls.round import Arc, Container, Post, arc_delay, container_delay, post_delay

DELAYS: dict[type, Callable[..., tuple[Real, int]]] = {
    Face: face_delay,
    Post: post_delay,
    Container: container_delay,
    Arc: arc_delay,
}

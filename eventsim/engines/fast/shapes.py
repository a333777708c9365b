"""Wall shapes as rows of a table of numbers, and the formulas that each kind asks for."""

from __future__ import annotations

from eventsim.engines.fast.compiled import inline, part
from eventsim.engines.fast.memory import real
from eventsim.engines.fast.met import side_met
from eventsim.formulas.real import NEVER
from eventsim.formulas.walls.face import Face, face_delay, face_normal
from eventsim.formulas.walls.round import Arc, Container, Post, arc_delay, container_delay, post_delay, round_normal

KINDS = (Face, Post, Container, Arc)
"""The kinds of shapes, by the number that stands for them in the table."""

WIDTH, CENTER = 13, 11
"""Numbers in a row: the kind, the number of the wall, then the shape's own; where the point (x, y) that it is told from is, which
for its own numbers is the origin where places have low parts."""

FACE, POST, CONTAINER, ARC = 0.0, 1.0, 2.0, 3.0


@inline
def face_at(numbers, k):
    """The face whose numbers begin at number k of a table."""
    return Face(
        real(numbers, k),
        real(numbers, k + 1),
        real(numbers, k + 2),
        real(numbers, k + 3),
        real(numbers, k + 4),
        real(numbers, k + 5),
        real(numbers, k + 6),
        real(numbers, k + 7),
        real(numbers, k + 8),
    )


@part
def shape_delay(m, rules, i, k, place, x, y, vx, vy, gx, gy, radius):
    """(delay, side) of the next contact with the k-th shape; `place` is its place among all walls."""
    faces, posts, containers, arcs = rules.faces, rules.posts, rules.containers, rules.arcs
    return _delay(m, i, k, place, x, y, vx, vy, gx, gy, radius, faces, posts, containers, arcs)


@inline
def _delay(m, i, k, place, x, y, vx, vy, gx, gy, radius, faces, posts, containers, arcs):
    met = side_met(m, i, place)
    row = m.features
    s = WIDTH * k
    kind = real(row, s)
    a, b = real(row, s + 2), real(row, s + 3)
    x, y = _seen_from(m, i, s, x, y, m.low_places)
    if faces is not None and kind == FACE:
        return face_delay(face_at(row, s + 2), x, y, vx, vy, gx, gy, radius, met)
    if posts is not None and kind == POST:
        return post_delay(Post(a, b), x, y, vx, vy, gx, gy, radius, met)
    if containers is not None and kind == CONTAINER:
        return container_delay(Container(a, b, real(row, s + 4)), x, y, vx, vy, gx, gy, radius, met)
    if arcs is not None:
        b4, b5, b6, b7 = real(row, s + 4), real(row, s + 5), real(row, s + 6), real(row, s + 7)
        arc = Arc(a, b, b4, b5, b6, b7, real(row, s + 8), real(row, s + 9))
        return arc_delay(arc, x, y, vx, vy, gx, gy, radius, met)
    return NEVER, 0


@inline
def _seen_from(m, i, s, x, y, low):
    """The place of disk i as a shape sees it: relative to its center where places have low parts."""
    if low is None:
        return x, y
    row = m.features
    return (x - real(row, s + CENTER)) + real(low, 2 * i), (y - real(row, s + CENTER + 1)) + real(low, 2 * i + 1)


@part
def shape_normal(m, i, k, side, x, y):
    """The normal, of any length, of the k-th shape, towards disk i at (x, y), where its flight begins."""
    row = m.features
    s = WIDTH * k
    if real(row, s) == FACE:
        face = Face(0.0, 0.0, 0.0, 0.0, real(row, s + 6), real(row, s + 7), 0.0, 0.0, 0.0)
        return face_normal(face, side)
    x, y = _seen_from(m, i, s, x, y, m.low_places)
    return round_normal(Post(real(row, s + 2), real(row, s + 3)), side, x, y)

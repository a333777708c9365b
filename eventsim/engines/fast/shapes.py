"""Wall shapes as rows of a table of numbers, and the formulas that each kind asks for: the switches of the kernels."""

from __future__ import annotations

from eventsim.engines.fast.compiled import inline, part, real, word
from eventsim.engines.fast.last_contact import side_met
from eventsim.engines.fast.layout import CONTACT_TIME, REALS, T
from eventsim.formulas.parabola import stays_open
from eventsim.formulas.real import NEVER
from eventsim.formulas.walls.arc import Arc, arc_delay, arc_normal, arc_touching
from eventsim.formulas.walls.container import Container, container_delay, container_touching
from eventsim.formulas.walls.ellipse import Ellipse, ellipse_delay, ellipse_normal, ellipse_side
from eventsim.formulas.walls.face import Face, face_delay, face_normal, face_touching, hangs_below, is_in_line
from eventsim.formulas.walls.point import is_point
from eventsim.formulas.walls.post import Post, post_delay, post_normal, post_touching

KINDS = (Face, Post, Container, Arc, Ellipse)
"""The shapes that the switches know, by the number that stands for them in the table."""

FACE, POST, CONTAINER, ARC, ELLIPSE = 0.0, 1.0, 2.0, 3.0, 4.0

WIDTH, CENTER, CORNERS = 23, 2, 19
"""Numbers in a row: the kind, the number of the wall, then the shape's own, first the point (x, y) that it is told from; what
makes corners with it (`Feature.corners`)."""

END_X, END_Y, SIZE, ENDS = 11, 12, 13, 14
"""Where the second end of faces and arcs is, what their size is, and what their ends are to points; the first end is CENTER."""

POST_SIZE = 8
"""Where the size of a post is."""


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
        real(numbers, k + 9),
        real(numbers, k + 10),
        real(numbers, k + 11),
        real(numbers, k + 12),
        real(numbers, k + 13),
        real(numbers, k + 14),
        real(numbers, k + 15),
        real(numbers, k + 16),
    )


@inline
def post_at(numbers, k):
    """The post whose numbers begin at number k of a table."""
    return Post(
        real(numbers, k),
        real(numbers, k + 1),
        real(numbers, k + 2),
        real(numbers, k + 3),
        real(numbers, k + 4),
        real(numbers, k + 5),
        real(numbers, k + 6),
    )


@inline
def container_at(numbers, k):
    """The container whose numbers begin at number k of a table."""
    return Container(real(numbers, k), real(numbers, k + 1), real(numbers, k + 2))


@inline
def arc_at(numbers, k):
    """The arc whose numbers begin at number k of a table."""
    return Arc(
        real(numbers, k),
        real(numbers, k + 1),
        real(numbers, k + 2),
        real(numbers, k + 3),
        real(numbers, k + 4),
        real(numbers, k + 5),
        real(numbers, k + 6),
        real(numbers, k + 7),
        real(numbers, k + 8),
        real(numbers, k + 9),
        real(numbers, k + 10),
        real(numbers, k + 11),
        real(numbers, k + 12),
        real(numbers, k + 13),
        real(numbers, k + 14),
        real(numbers, k + 15),
        real(numbers, k + 16),
    )


@inline
def ellipse_at(numbers, k):
    """The ellipse whose numbers begin at number k of a table."""
    return Ellipse(
        real(numbers, k),
        real(numbers, k + 1),
        real(numbers, k + 2),
        real(numbers, k + 3),
        real(numbers, k + 4),
        real(numbers, k + 5),
        real(numbers, k + 6),
        real(numbers, k + 7),
    )


@inline
def is_closed(kind):
    """Whether a shape of this kind is a closed wall, hard on both sides."""
    return kind == ELLIPSE


@part
def side_of_closed(m, s, x, y, vx, vy):
    """The side of a closed wall that a point is on; s: where its row begins."""
    return ellipse_side(ellipse_at(m.features, s + 2), x, y, vx, vy)


@inline
def beside(m, rules, i, k):
    """What disk i, if it is a point close to the k-th shape, remembers of its side; None where no disk is a point."""
    if m.sides is None:
        return None
    return word(m.sides, i * rules.features + k)


@part
def shape_delay(m, rules, i, k, place, x, y, vx, vy, gx, gy, radius):
    """(delay, side) of the next contact with the k-th shape; `place` is its place among all walls."""
    touches = rules.still is not None and _touches(m, i, place)
    faces, posts, containers, arcs, ellipses = rules.shapes
    close = beside(m, rules, i, k)
    return _delay(
        m, i, k, place, x, y, vx, vy, gx, gy, radius, faces, posts, containers, arcs, ellipses, touches, close
    )


@inline
def _touches(m, i, place):
    """Whether the flight of disk i begins on contact with a wall: told where disks settle."""
    since = real(m.disks, i * REALS + T) - real(m.disks, i * REALS + CONTACT_TIME)
    return since == 0.0 and side_met(m, i, place) != 0


@inline
def _delay(m, i, k, place, x, y, vx, vy, gx, gy, radius, faces, posts, containers, arcs, ellipses, touches, close):
    met = side_met(m, i, place)
    row = m.features
    s = WIDTH * k
    kind = real(row, s)
    if faces is not None and kind == FACE:
        return face_delay(face_at(row, s + 2), x, y, vx, vy, gx, gy, radius, met, touches, close)
    if posts is not None and kind == POST:
        return post_delay(post_at(row, s + 2), x, y, vx, vy, gx, gy, radius, met, touches, close)
    if containers is not None and kind == CONTAINER:
        return container_delay(container_at(row, s + 2), x, y, vx, vy, gx, gy, radius, met, touches, close)
    if arcs is not None and kind == ARC:
        return arc_delay(arc_at(row, s + 2), x, y, vx, vy, gx, gy, radius, met, touches, close)
    if ellipses is not None and kind == ELLIPSE:
        return ellipse_delay(ellipse_at(row, s + 2), x, y, vx, vy, gx, gy, radius, met, touches, close)
    return NEVER, 0


@part
def is_clear(m, rules, k, x, y, u, w, pull, radius, delay):
    """Whether a falling disk, at (x, y) with velocity (u, w), surely does not meet the k-th shape within a delay.

    pull: its acceleration; along a slope it is not that of gravity.  So nobody asks when its parabola meets a circle; other
    shapes are not looked at.  What rounding does is far less than 2^-40 of places and 2^-20 of what is compared.
    """
    _, posts, containers, arcs, _ = rules.shapes
    row = m.features
    s = WIDTH * k
    kind, dx, dy, size = real(row, s), x - real(row, s + CENTER), y - real(row, s + CENTER + 1), 0.0
    if containers is not None and kind == CONTAINER:
        size = real(row, s + CENTER + 2)
    elif arcs is not None and kind == ARC:
        dx, dy, size = dx - real(row, s + CENTER + 2), dy - real(row, s + CENTER + 3), real(row, s + CENTER + 4)
    elif posts is None or kind != POST:
        return False
    square = dx * dx + dy * dy
    side = 1.0 if square > size * size else -1.0
    reach = size + side * radius
    margin = 2.0**-20 * (square + size * size) + 2.0**-40 * (abs(x) + abs(y)) * (abs(dx) + abs(dy) + size)
    gx, gy = pull
    return reach >= 0.0 and stays_open(dx, dy, u, w, gx, gy, reach, side, delay, margin)


@part
def laid_on_shape(m, k, side, x, y, r):
    """The place of a disk of radius r on the k-th shape, on contact but for the last bits: of no ellipse, where nothing falls."""
    row = m.features
    s = WIDTH * k
    kind = real(row, s)
    if kind == FACE:
        return face_touching(face_at(row, s + 2), side, x, y, r)
    if kind == POST:
        return post_touching(post_at(row, s + 2), side, x, y, r)
    if kind == CONTAINER:
        return container_touching(container_at(row, s + 2), side, x, y, r)
    return arc_touching(arc_at(row, s + 2), side, x, y, r)


@part
def shape_normal(m, k, side, x, y):
    """The normal, of any length, of the k-th shape, towards a disk at (x, y)."""
    row = m.features
    s = WIDTH * k
    kind = real(row, s)
    if kind == FACE:
        return face_normal(face_at(row, s + 2), side, x, y)
    if kind == ARC:
        return arc_normal(arc_at(row, s + 2), side, x, y)
    if kind == ELLIPSE:
        return ellipse_normal(ellipse_at(row, s + 2), side, x, y)
    return post_normal(Post(real(row, s + 2), real(row, s + 3), 0.0, 0.0, 0.0, 0.0, 0.0), side, x, y)  # a container is alike


@inline
def wall_normal(m, rules, wall, side, x, y):
    """The normal, of any length, of a wall of the domain or a shape, by its place among all walls."""
    if rules.wall_x is not None and rules.wall_x <= wall < rules.wall_x + 2:
        return float(side), 0.0
    if rules.wall_y is not None and rules.wall_y <= wall < rules.wall_y + 2:
        return 0.0, float(side)
    if m.features is None:
        return 0.0, 0.0
    return shape_normal(m, wall - rules.first_feature, side, x, y)


@inline
def lies_on(m, k, line):
    """Whether the k-th shape is on the line of a face, so that a disk which slides there passes it."""
    row = m.features
    s = WIDTH * k
    kind = real(row, s)
    x, y = real(row, s + 2), real(row, s + 3)
    if kind == FACE:
        return is_in_line(line, x, y) and is_in_line(line, real(row, s + END_X), real(row, s + END_Y))
    return kind == POST and is_in_line(line, x, y)


@inline
def is_passed(m, k, line, side):
    """Whether the k-th shape is a face that a disk passes which slides on a side of a line."""
    row, s = m.features, WIDTH * k
    if real(row, s) != FACE:
        return False
    return hangs_below(line, side, real(row, s + 2), real(row, s + 3), real(row, s + END_X), real(row, s + END_Y))


@inline
def is_exact_hit(m, k, radius):
    """Whether the k-th shape is a post and a disk of this radius a point to it."""
    if m.sides is None:
        return False
    s = WIDTH * k
    return real(m.features, s) == POST and is_point(radius, real(m.features, s + POST_SIZE))


@inline
def is_straight(m, k):
    """Whether the k-th shape is a face."""
    return real(m.features, WIDTH * k) == FACE


@inline
def is_hollow(m, k):
    """Whether the k-th shape is round, so that a disk may creep along it."""
    return real(m.features, WIDTH * k) >= CONTAINER


@inline
def is_post(m, k):
    """Whether the k-th shape is a post."""
    return real(m.features, WIDTH * k) == POST

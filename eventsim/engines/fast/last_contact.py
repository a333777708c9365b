"""Whom a disk met last: a pair or a face that met last is not predicted again while both say so and fly straight."""

from __future__ import annotations

from eventsim.engines.fast.compiled import inline, part, store, word
from eventsim.engines.fast.layout import FLAGS, MET, MET_KX, MET_KY, NOBODY, RESTING, SEVERAL, WORDS, WRAPS_X, WRAPS_Y


@inline
def remember(m, i, partner, kx, ky):
    """Let disk i remember a contact: a disk and its image, or -1 - number of a surface and the side."""
    store(m.disks, i * WORDS + MET, partner)
    store(m.disks, i * WORDS + MET_KX, kx)
    store(m.disks, i * WORDS + MET_KY, ky)


@inline
def forget_shapes(m, rules, i):
    """Let disk i forget the shapes that it met last: on the other side of the domain it can meet them again.

    A wall of the domain, or one that it rests on, goes on there.
    """
    if m.supports is not None and word(m.disks, i * WORDS + FLAGS) & RESTING:
        return
    met = word(m.disks, i * WORDS + MET)
    if met == SEVERAL:
        _forget_among_several(m, rules, i)
    elif NOBODY < met <= -1 - rules.first_feature:
        store(m.disks, i * WORDS + MET, NOBODY)


@part
def _forget_among_several(m, rules, i):
    row = word(m.disks, i * WORDS + MET_KX)
    while row >= 0:
        if NOBODY < word(m.several, 4 * row) <= -1 - rules.first_feature:
            store(m.several, 4 * row, NOBODY)
        row = word(m.several, 4 * row + 3)


@part
def _among_several(m, i, partner, kx, ky):
    row = word(m.disks, i * WORDS + MET_KX)
    while row >= 0:
        same_image = word(m.several, 4 * row + 1) == kx and word(m.several, 4 * row + 2) == ky
        if same_image and word(m.several, 4 * row) == partner:
            return True
        row = word(m.several, 4 * row + 3)
    return False


@inline
def remembers(m, i, partner, kx, ky):
    """Whether disk i met that disk, in that image between unwrapped disks, last."""
    met = word(m.disks, i * WORDS + MET)
    if met == partner:
        return word(m.disks, i * WORDS + MET_KX) == kx and word(m.disks, i * WORDS + MET_KY) == ky
    if met == SEVERAL:
        return _among_several(m, i, partner, kx, ky)
    return False


@inline
def unwrapped_x(m, i, j, kx):
    """The image along x between unwrapped disks, from the one between the disks where they are."""
    return kx + word(m.disks, i * WORDS + WRAPS_X) - word(m.disks, j * WORDS + WRAPS_X)


@inline
def unwrapped_y(m, i, j, ky):
    """The image along y between unwrapped disks."""
    return ky + word(m.disks, i * WORDS + WRAPS_Y) - word(m.disks, j * WORDS + WRAPS_Y)


@inline
def just_met(m, i, j, kx, ky):
    """Whether both remember each other, in this image, as what they met last."""
    ux, uy = unwrapped_x(m, i, j, kx), unwrapped_y(m, i, j, ky)
    return remembers(m, i, j, ux, uy) and remembers(m, j, i, -ux, -uy)


@part
def side_met(m, i, place):
    """The side of a wall that disk i met last, 0 if it met another one since."""
    met = word(m.disks, i * WORDS + MET)
    if met == -1 - place:
        return word(m.disks, i * WORDS + MET_KX)
    if met == SEVERAL:
        row = word(m.disks, i * WORDS + MET_KX)
        while row >= 0:
            if word(m.several, 4 * row) == -1 - place:
                return word(m.several, 4 * row + 1)
            row = word(m.several, 4 * row + 3)
    return 0


@inline
def partner_just_met(m, rules, i, kx, ky):
    """The disk that i met last if it says so as well and is seen in that image, else -1; (kx, ky): the image that it has now.

    Where each of two disks remembers the other one, both remember the same contact: one image is enough to look at.
    """
    j = word(m.disks, i * WORDS + MET)
    met = word(m.disks, j * WORDS + MET)
    if met == SEVERAL:
        return j if just_met(m, i, j, kx, ky) else -1
    same = met == i
    if rules.length_x is not None or rules.length_y is not None:
        same &= word(m.disks, i * WORDS + MET_KX) == unwrapped_x(m, i, j, kx)
        same &= word(m.disks, i * WORDS + MET_KY) == unwrapped_y(m, i, j, ky)
    return j if same else -1

"""The tables of walls and shapes: whoever adds one and forgets a piece of it is told so here, and not by a wrong answer."""

import inspect
import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pytest

import eventsim as es
from eventsim.formulas.walls.shape import Shape
from eventsim.scene.files import scene_from_dict, scene_to_dict
from eventsim.scene.stage import stage_of
from eventsim.scene.walls import SHAPES, WALLS, Part, parts_of

EXAMPLES = {
    "segment": es.Segment((1.0, 1.0), (3.0, 2.0)),
    "polygon": es.Polygon(((1.0, 1.0), (3.0, 1.0), (2.0, 3.0))),
    "polyline": es.Polyline(((1.0, 1.0), (3.0, 1.0), (2.0, 3.0))),
    "arc": es.Arc((1.0, 1.0), (2.0, 2.5), (3.0, 1.0)),
    "circle": es.Circle((2.0, 2.0), 2.0),
    "ellipse": es.Ellipse((2.0, 2.0), (2.0, 1.0), (3.0, 4.0)),
}


INSIDE = (2.0, 1.6)
"""A place in every wall that holds disks."""


def missing(shape: type) -> set[str]:
    """What a shape lacks of all that is asked of one."""
    asked = {name for name in vars(Shape) if not name.startswith("_") or name == "__iter__"}
    return {name for name in asked if not hasattr(shape, name)}


def walls_within(position=INSIDE, kind="segment"):
    disks = es.Disks([position], [(0.3, 0.1)], 0.0 if WALLS[kind].for_points else 0.05)
    return es.Scene(disks, es.Box((4.0, 4.0)), [EXAMPLES[kind]], until=1.0)


def test_every_kind_of_wall_has_an_example_here():
    assert EXAMPLES.keys() == WALLS.keys()


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.__name__)
def test_a_shape_knows_all_that_is_asked_of_one(shape):
    assert missing(shape) == set()


def test_a_shape_that_lacks_a_piece_is_found():
    class Dummy(NamedTuple):
        x: float
        y: float

        def normal(self, side, x, y):
            return 1.0, 0.0

    assert missing(Dummy) == {
        "delay", "in_numbers", "lies_on", "line", "moment", "nearest", "touching", "word"
    }  # fmt: skip


@pytest.mark.parametrize("forgotten", sorted(Part.__abstractmethods__))
def test_a_wall_that_lacks_a_piece_cannot_be_made(forgotten):
    def nothing(self, *_):
        return ()

    pieces = dict.fromkeys(Part.__abstractmethods__ - {forgotten}, nothing)
    dummy = dataclass(frozen=True)(type("Dummy", (Part,), {"kind": "dummy", "made_of": (), **pieces}))
    with pytest.raises(TypeError, match=forgotten):
        dummy()


def test_kernels_know_every_shape():
    pytest.importorskip("numba")
    from eventsim.engines.fast import shapes

    assert set(shapes.KINDS) == set(SHAPES)
    numbers = max(len(shape._fields) for shape in SHAPES)
    assert 2 + numbers <= shapes.CORNERS == shapes.WIDTH - 4
    assert {shape._fields[:2] for shape in SHAPES} == {("x", "y")}  # where the switches look for the center


def test_stepped_engines_know_every_shape():
    from eventsim.engines.stepped import ground

    assert set(ground.KINDS) == set(SHAPES)
    assert max(len(shape._fields) for shape in SHAPES) <= ground.WIDTH


@pytest.mark.parametrize("kind", WALLS)
def test_a_wall_gives_the_shapes_that_it_is_made_of(kind):
    pieces = EXAMPLES[kind].pieces(lambda point: point)
    assert {type(shape) for shape, _ in pieces} == set(WALLS[kind].made_of)
    assert {number for _, number in pieces} == set(range(len(EXAMPLES[kind].parts("w"))))


@pytest.mark.parametrize("kind", WALLS)
def test_a_wall_survives_a_scene_file(kind):
    scene = walls_within(INSIDE if WALLS[kind].holds else (0.5, 0.5), kind)
    assert scene_from_dict(scene_to_dict(scene)) == scene


def test_what_has_a_default_may_be_left_out_of_a_scene_file():
    scene = es.Scene(es.Disks([(0.5, 0.5)], radius=0.0), es.Open(), [es.Ellipse((2.0, 2.0), (2.0, 1.0))], until=1.0)
    tables = scene_to_dict(scene)
    del tables["wall"][0]["direction"]
    assert scene_from_dict(tables) == scene


@pytest.mark.parametrize("kind", WALLS)
def test_the_outline_of_a_wall_is_where_its_depth_and_its_shapes_begin(kind):
    """Bounds, depth, outline and the shapes in numbers speak of one and the same line."""
    wall = EXAMPLES[kind]
    shapes = [shape for shape, _ in wall.pieces(lambda point: point)]
    for part in parts_of([wall]):
        outline = part.outline()
        (x0, y0), (x1, y1) = part.bounds()
        assert np.all((outline >= (x0 - 1e-12, y0 - 1e-12)) & (outline <= (x1 + 1e-12, y1 + 1e-12)))
        middle = outline[:-1] + 0.5 * (outline[1:] - outline[:-1])
        assert part.depth(middle, 0.0) == pytest.approx(np.zeros(len(middle)), abs=2e-3)  # chords of a circle
        for x, y in outline.tolist():
            assert min(shape.nearest(x, y)[2] for shape in shapes) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("kind", WALLS)
def test_engines_meet_the_outline_of_a_wall(kind):
    """A point that flies onto the outline meets it where it is drawn, in the direction of the normal."""
    wall = EXAMPLES[kind]
    aims = {"segment": (2.0, 1.5), "arc": (2.0, 2.5), "polygon": (2.0, 1.0), "polyline": (2.0, 1.0)}
    x, y = aims[kind] if kind in aims else parts_of([wall])[0].outline()[1].tolist()
    start = (2.0, 1.7)
    disks = es.Disks([start], [(x - start[0], y - start[1])], 0.0)
    run = es.simulate(es.Scene(disks, es.Open(), [wall]), events=1, engine="reference", log=True)
    assert run.log.time[0] == pytest.approx(1.0, rel=1e-12)
    assert math.hypot(run.log.vxa[0], run.log.vya[0]) == pytest.approx(math.hypot(*(disks.velocity[0])), rel=1e-12)


def test_every_shape_on_a_stage_has_the_number_of_a_wall():
    for kind in WALLS:
        stage = stage_of(walls_within(INSIDE if WALLS[kind].holds else (0.5, 0.5), kind))
        named = {stage.wall_names[surface.wall] for surface in stage.surfaces}
        assert named == set(stage.wall_names)


def test_the_contract_of_shapes_is_asked_of_no_other_names():
    """What the protocol asks has the same parameters in every shape."""
    for shape in SHAPES:
        for name, asked in vars(Shape).items():
            if inspect.isfunction(asked) and not name.startswith("_"):
                assert inspect.signature(getattr(shape, name)).parameters.keys() == inspect.signature(asked).parameters.keys()

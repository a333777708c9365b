"""Scenes built in code: valid once they exist, and never changing."""

import dataclasses
import math
import pickle

import numpy as np
import pytest

from eventsim.errors import SceneError
from eventsim.scene import (
    Arc,
    Box,
    Channel,
    Circle,
    Disks,
    Open,
    Periodic,
    Polygon,
    Polyline,
    Restitution,
    Scene,
    Segment,
    feature_names,
    wall_names,
)
from eventsim.scene.disks import named_species
from eventsim.scene.roughness import TangentialRestitution, as_tangential
from eventsim.scene.scene import difference, touching_by_rounding
from eventsim.scene.stage import stage_of
from eventsim.scene.walls import Ellipse

ONE = Disks([[1, 1]], radius=0.5)


def test_disks_are_read_only_copies_with_defaults():
    position = np.array([[1.0, 2.0], [3.0, 4.0]])
    disks = Disks(position, radius=0.5)
    position[0, 0] = 9.0
    assert len(disks) == 2
    assert disks.position.tolist() == [[1, 2], [3, 4]]
    assert disks.velocity.tolist() == [[0, 0], [0, 0]]
    assert disks.radius.tolist() == [0.5, 0.5]
    assert disks.mass.tolist() == [1, 1]
    with pytest.raises(ValueError, match="read-only"):
        disks.position[0, 0] = 1.0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"position": [[1, 2]]}, "radius is missing"),
        ({"position": [[1, 2, 3]], "radius": 1}, "must be \\(N, 2\\)"),
        ({"position": [[1, 2]], "velocity": [1, 2], "radius": 1}, "velocity has the shape"),
        ({"position": [[1, 2]], "radius": [1, 2]}, "radius has the shape"),
        ({"position": [["a", 2]], "radius": 1}, "every entry must be a number"),
        ({"position": [[1, 2]], "radius": 10**400}, "radius: an entry is too large for a number"),
        ({"position": [[1, 2]], "radius": 1, "species": [3]}, "species: every entry must be a text"),
        ({"position": [[1, 2]], "radius": 1, "species": ["a", "b"]}, r"has the shape \(2,\): must be \(1,\) or a single text"),
    ],
)
def test_disks_of_wrong_shape_are_refused(arguments, words):
    with pytest.raises(SceneError, match=words):
        Disks(**arguments)


def test_a_replaced_scene_is_checked_again():
    scene = Scene(ONE, Box((4, 3)))
    later = dataclasses.replace(scene, until=2.0)
    assert later.until == 2.0
    assert dataclasses.replace(later, until=None) == scene
    assert hash(dataclasses.replace(later, until=None)) == hash(scene)
    assert pickle.loads(pickle.dumps(scene)) == scene
    with pytest.raises(SceneError, match="beyond the right side"):
        dataclasses.replace(scene, domain=Box((1, 3)))


def test_what_a_scene_does_not_need_is_none():
    scene = Scene(ONE, Open(), gravity=(0, 0), restitution={"pair": 1})
    assert scene.gravity is None
    assert scene.restitution is None
    assert scene.domain.size is None


@pytest.mark.parametrize("given", [0.5, {"pair": 0.5, "wall": 0.5}, Restitution(0.5, 0.5)])
def test_restitution_may_be_a_number_a_mapping_or_itself(given):
    assert Scene(ONE, Open(), restitution=given).restitution == Restitution(0.5, 0.5)


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ({"domain": (3, 3)}, "must be a Box"),
        ({"walls": Segment((3, 0), (3, 1))}, "sequence of walls"),
        ({"walls": ["ramp"]}, "must be one of Segment"),
        ({"walls": [Segment((3, 0), (3, 1), name=3)]}, "must be a text"),
        ({"restitution": {"wal": 1}}, "unknown key"),
        ({"events": 2.5}, "whole number"),
        ({"events": -1}, "at least 0"),
        ({"gravity": (0, math.nan)}, "finite"),
        ({"contact_duration": -1.0}, "at least 0"),
        ({"start_time": math.inf}, "finite"),
        ({"until": "soon"}, "must be a number"),
        ({"disks": 3}, r"disks = 3: must be Disks\(position, velocity, radius, mass\)"),
        ({"name": 3}, "name = 3: must be a text"),
        ({"restitution": Restitution(pairs=[("a", "b", 2.0)])}, "restitution.pairs.a-b = 2.0: must be from 0 to 1"),
    ],
)
def test_a_part_of_the_wrong_kind_is_refused_in_a_sentence(parts, words):
    with pytest.raises(SceneError, match=words):
        Scene(**({"disks": ONE, "domain": Open()} | parts))


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Circle(centre=(0, 0), radius=1), "no keyword 'centre' \\(did you mean 'center'\\?\\); it takes center, "),
        (lambda: Circle((0, 0)), "Circle lacks radius; it takes center, radius"),
        (lambda: Circle(3, 1), "wall.center = 3: must be two numbers, x and y"),
        (lambda: Box((4, 3), walls=3), 'domain.walls = 3: must be a table of sides, as {"bottom": {"restitution": 0.5}}'),
        (lambda: Box((4, 3), walls={"top": 3}), "domain.walls.top = 3: must be a table with restitution, shaking"),
        (lambda: Restitution(pairs=3), 'restitution.pairs = 3: must be a table of pairs of species, as {"a-b" = 0.5}'),
        (lambda: TangentialRestitution("much"), "tangential_restitution.pair = 'much': must be a number"),
        (lambda: as_tangential({"pear": 1}), r"tangential_restitution.pear: unknown key \(known: pair, wall\)"),
    ],
)
def test_a_part_that_cannot_be_made_says_what_it_takes(make, words):
    with pytest.raises(SceneError, match=words):
        make()


def test_too_many_values_are_an_error_of_the_call():
    with pytest.raises(TypeError, match="positional arguments"):
        Circle((0, 0), 1, "ring", 3, 4, 5, 6, 7)


def test_a_scene_says_in_short_what_it_has():
    walls, shares = [Segment((3, 0), (3, 1))], {"pair": 0.5}
    scene = Scene(ONE, Box((4, 3)), walls, gravity=(0, -1), restitution=shares, name="ramp", law=lambda approach: 0.5)
    assert repr(scene).startswith("Scene(name: ramp, 1 disk, domain: box 4 x 3, walls: 1, gravity: (0.0, -1.0), restitution: ")
    assert repr(scene).endswith("<lambda>)")
    assert repr(Scene(ONE, Open())) == "Scene(1 disk, domain: open)"
    assert Scene(ONE, Open(), name="plane")._repr_html_().count("<td>plane</td>") == 1


def test_the_first_difference_of_two_scenes_is_told():
    scene = Scene(ONE, Box((4, 3)), until=1.0)
    two = Disks([[1, 1], [3, 2]], radius=0.5)
    assert difference(scene, dataclasses.replace(scene, name="other")) == "none"
    assert difference(scene, dataclasses.replace(scene, name="other", until=2.0)) == "its until is 1.0, not 2.0"
    assert difference(scene, dataclasses.replace(scene, disks=two)) == "it has 1 disks, not 2"
    moved = Disks([[1, 1.5]], radius=0.5)
    assert difference(scene, dataclasses.replace(scene, disks=moved)) == "its disks begin elsewhere, or are others"


def test_one_name_is_that_of_all_disks():
    disks = Disks([[1, 1], [3, 1]], radius=0.5, species="a")
    assert list(disks.species) == ["a", "a"]


def test_smooth_points_may_have_spins_that_nothing_changes():
    points = Disks([[1, 1]], radius=0.0, spin=2.0)
    assert Scene(points, Open(), tangential_restitution=-1).disks.spins().tolist() == [2.0]


def test_a_side_may_be_given_as_it_is_kept():
    box = Box((4, 3), walls={"left": {"shaking": 1.0}, "top": {"restitution": 0.5}})
    assert Box((4, 3), walls=dict(box.walls)) == Box((4, 3), walls=box.walls) == box


def test_an_arc_whose_bulge_is_below_the_digits_of_its_place_is_told():
    near, far = Box((4, 3)), Box((2e9, 3), origin=(-1e9, 0))
    arc = Arc((0, 2), (1, 2 + 1e-6), (2, 2), name="bow")
    assert len(stage_of(Scene(ONE, near, [arc])).surfaces) > 4
    with pytest.raises(SceneError, match=r"its points are on a line.*: up to 1e\+09 away \(leave less room"):
        stage_of(Scene(ONE, far, [arc]))


@pytest.mark.parametrize(("a", "b"), [(2.0, 1.0), (1.0, 2.0), (1.0, 1.0), (1.0, 1e-3)])
def test_the_perimeter_of_an_ellipse_is_that_of_a_polygon_of_many_corners(a, b):
    angle = np.linspace(0.0, 2.0 * np.pi, 100_001)
    sides = np.hypot(np.diff(a * np.cos(angle)), np.diff(b * np.sin(angle)))
    assert Ellipse((3, 4), (a, b)).length() == pytest.approx(sides.sum(), rel=1e-7)


def test_disks_are_equal_to_disks_alone():
    assert ONE != 3
    assert Disks([[1, 1]], radius=0.5) == ONE


def test_species_without_names_are_numbered_in_the_order_of_the_scene():
    disks = Disks([[1, 1], [2, 1], [3, 1], [4, 1], [5, 1]], radius=[0.5, 0.25, 0.5, 0.25, 0.125], species=["", "b", "", "b", "b"])
    names, number = named_species(disks)
    assert names == ("0", "b")
    assert number.tolist() == [0, 1, 0, 1, 1]


def test_walls_are_named_by_their_place_and_edges_by_their_chain():
    walls = (
        Segment((0, 0), (1, 0)),
        Polygon([(0, 0), (1, 0), (0, 1)], name="tri"),
        Polyline([(0, 0), (1, 0), (0, 1)]),
        Arc((0, 0), (1, 1), (2, 0)),
        Circle((0, 0), 3),
    )
    assert wall_names(walls) == ("wall0", "tri", "wall2", "wall3", "wall4")
    assert feature_names(walls) == (
        "wall0",
        "tri.0",
        "tri.1",
        "tri.2",
        "wall2.0",
        "wall2.1",
        "wall3",
        "wall4",
    )


def test_an_edge_and_another_wall_cannot_share_a_name():
    walls = [Polyline([(5, 0), (6, 0)], name="a"), Segment((7, 0), (8, 0), name="a.0")]
    with pytest.raises(SceneError, match=r"'a\.0' is taken by wall\[0\]"):
        Scene(ONE, Open(), walls)


@pytest.mark.parametrize("domain", [Open(), Box((2e6, 1)), Channel((2e6, 1)), Periodic((2e6, 1))])
def test_an_overlap_of_a_few_ulp_counts_as_touching_and_is_told(domain):
    # F10: 1e-9 is 8.6 ulp of 1e6; 2e-9 is more than 16.
    near = Disks([[1e6, 0.5], [1e6 + 1 - 1e-9, 0.5]], radius=0.5)
    told = touching_by_rounding(Scene(near, domain))
    assert len(told) == 1
    assert "disk[0] and disk[1]" in told[0]
    with pytest.raises(SceneError, match="overlap by"):
        Scene(Disks([[1e6, 0.5], [1e6 + 1 - 2e-9, 0.5]], radius=0.5), domain)


def test_the_search_for_overlaps_ends_when_there_are_enough(monkeypatch):
    monkeypatch.setattr("eventsim.scene.overlaps.ENOUGH", 10)
    monkeypatch.setattr("eventsim.scene.validate.ENOUGH", 10)
    with pytest.raises(SceneError, match=r"and at least \d+ more pairs of disks that overlap"):
        Scene(Disks(np.full((40, 2), 1.0), radius=0.5), Open())


def test_touching_exactly_is_no_overlap():
    scene = Scene(Disks([[0.5, 0.5], [1.5, 0.5]], radius=0.5), Box((2, 1)), [Segment((0, 1), (2, 1), name="lid")])
    assert touching_by_rounding(scene) == []


@pytest.mark.parametrize("mass", [0.0, math.inf])
def test_disks_that_do_not_meet_may_overlap(mass):
    Scene(Disks([[0, 0], [0.1, 0]], radius=1.0, mass=mass), Open())
    with pytest.raises(SceneError, match="overlap by"):
        Scene(Disks([[0, 0], [0.1, 0]], radius=1.0, mass=[mass, 1.0]), Open())


def test_a_wall_has_images_in_a_periodic_domain():
    wall = Segment((3.9, 1), (3.9, 2))
    with pytest.raises(SceneError, match="across segment wall0"):
        Scene(Disks([[0.1, 1.5]], radius=0.25), Periodic((4, 4)), [wall])
    Scene(Disks([[0.1, 1.5]], radius=0.25), Box((4, 4), origin=(-1, 0)), [wall])


@pytest.mark.parametrize(
    ("center", "clear"),
    [((0.0, 1.5), True), ((0.0, 0.8), False), ((1.2, -0.1), False), ((0.0, -1.0), True), ((0.0, 0.0), True)],
)
def test_only_the_drawn_part_of_a_circle_is_an_arc(center, clear):
    upper_half = Arc((1, 0), (0, 1), (-1, 0))
    disks = Disks([center], radius=0.3)
    if clear:
        Scene(disks, Open(), [upper_half])
    else:
        with pytest.raises(SceneError, match="across arc wall0"):
            Scene(disks, Open(), [upper_half])


def test_a_container_must_fit_into_the_period():
    with pytest.raises(SceneError, match="reach beyond the period in x"):
        Scene(ONE, Channel((2, 4)), [Circle((1, 2), 1.5)])


def test_a_circle_in_the_middle_of_a_period_has_no_images():
    scene = Scene(ONE, Periodic((4, 3)), [Circle((1.5, 1.5), 1.5)])
    assert scene.walls[0].bounds() == ((0, 0), (3, 3))


def test_a_wall_must_not_stretch_over_too_many_periods():
    with pytest.raises(SceneError, match="more than 1000 periods in x"):
        Scene(ONE, Periodic((2, 4)), [Segment((-1e6, 3), (1e6, 3))])
    edges = [(900.0 * k, 3.0 + 0.1 * (k % 2)) for k in range(4)]
    with pytest.raises(SceneError, match="more than 1000 periods in x"):  # all of its images are looked at
        Scene(ONE, Periodic((2, 4)), [Polyline(edges)])


@pytest.mark.parametrize(
    ("domain", "wall", "times"),
    [
        (Periodic((2, 4)), Segment((0.5, -1), (0.5, 11)), "3"),
        (Channel((2, 4)), Segment((-1, 3), (1.5, 3)), "1.25"),
        (Periodic((2, 4)), Segment((0, 3), (-3, -3)), "1.5"),
        (Periodic((2, 4)), Segment((0, 3), (9, 9)), "1.5"),
        (Periodic((2, 4)), Polyline(((0, 3), (1, 2), (1, -3))), "1.25"),
    ],
)
def test_a_wall_must_not_lie_on_its_own_image(domain, wall, times):
    with pytest.raises(SceneError, match=rf"it is {times} times as long as the way to its own image"):
        Scene(ONE, domain, [wall])


def test_a_wall_may_close_around_the_domain_or_wind_around_it():
    Scene(ONE, Periodic((2, 4)), [Segment((-1, 3), (1, 3))])
    Scene(Disks([[0.0, 1.0]], radius=0.01), Periodic((2, 4)), [Segment((0, 3), (6.3, 9))])
    Scene(ONE, Channel((2, 4)), [Segment((1.5, 0.5), (1.5, 3.5))])

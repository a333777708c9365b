"""Walls and disks drawn by mouse in the page, and what the page says of the last contact, in a real browser at three sizes."""

import numpy as np
import pytest

import eventsim as es
from tests.live.driven import SIZES, Page
from tests.show.browser import said

pytest.importorskip("aiohttp", reason="aiohttp is not installed (the extra live brings it)")

EVERY_SIZE = pytest.mark.parametrize("page", [(1280, 800), (844, 390), (390, 844)], indirect=True, ids="{0[0]}x{0[1]}".format)


@pytest.fixture(params=SIZES, ids="{0[0]}x{0[1]}".format)
def page(request, chromium, address):
    chromium.set_window_size(*request.param)
    yield Page(chromium, address)
    chromium.set_window_size(1280, 800)
    assert said(chromium) == []


def drag(page, start, end):
    """Drag on the picture from one place to another, both as shares of it; start alone: a click."""
    from selenium.webdriver.common.action_chains import ActionChains

    settled = "live.player.canvas.width === Math.round(live.player.canvas.getBoundingClientRect().width * devicePixelRatio)"
    page.wait(settled + " && live.size().every((side, axis) => Math.abs(side - live.asked[axis]) < 2) && live.link.pending === 0")
    box = page.js(
        "scrollTo(0, 0); const b = live.part('canvas').getBoundingClientRect(); return [b.left, b.top, b.width, b.height]"
    )
    points = [(int(box[0] + x * box[2]), int(box[1] + y * box[3])) for x, y in (start, end or start)]
    hand = ActionChains(page.driver)
    pointer = hand.w3c_actions.pointer_action
    pointer.move_to_location(*points[0]).pointer_down()
    if end:
        middle = [(a + b) // 2 for a, b in zip(*points, strict=True)]
        pointer.move_to_location(*middle).move_to_location(*points[1])
    pointer.pointer_up()
    hand.perform()
    return [page.js("return live.player.drawing.placeAt(...arguments)", *point) for point in points]


def drawn(page, tool, start, end=None):
    """Draw with a tool and wait for the new world; return the places on the scene's axes."""
    edition = page.js("live.part('drag').value = arguments[0]; return live.edition", tool)
    places = drag(page, start, end)
    page.wait(f"live.edition > {edition} && live.link.pending === 0 && live.player.duration > 0")
    return places


def saved(page, tmp_path):
    return es.load_scene(page.fetch("scene-file", tmp_path / "scene.toml"))


@EVERY_SIZE
def test_a_wall_and_disks_are_drawn_saved_and_taken_back(page, tmp_path):
    page.open("count=1&speed=50&packing=0.001&seed=3")
    start, end = drawn(page, "wall", (0.3, 0.7), (0.6, 0.8))
    drawn(page, "disk", (0.85, 0.75))  # a click: as large as the others
    middle, edge = drawn(page, "disk", (0.75, 0.25), (0.8, 0.25))
    scene = saved(page, tmp_path)
    (wall,) = scene.walls
    assert isinstance(wall, es.Segment)
    np.testing.assert_allclose([wall.start, wall.end], [start, end], atol=1.5)
    assert len(scene.disks) == 3
    np.testing.assert_allclose(scene.disks.position[2], middle, atol=1.5)
    assert scene.disks.radius[2] == pytest.approx(edge[0] - middle[0], abs=2.0)
    assert scene.disks.radius[1] == scene.disks.radius[0]
    assert scene.disks.mass.tolist() == [1, 1, 1]
    assert not scene.disks.velocity[1:].any()
    for left in (2, 1, 1):
        edition = page.js("return live.edition")
        page.js("live.undo()")
        page.wait(f"live.edition > {edition} && live.link.pending === 0 && live.player.duration > 0")
        assert len(saved(page, tmp_path).disks) == left
    assert not saved(page, tmp_path).walls
    assert page.js("return live.part('undo').disabled")


def test_a_disk_drawn_onto_another_is_refused_in_a_sentence_and_is_nothing_to_take_back(page):
    page.open("count=1&speed=0&packing=0.02&seed=3")
    box, at = page.js(
        """
        live.part('drag').value = 'disk'; scrollTo(0, 0);
        const d = live.player.drawing, b = d.canvas.getBoundingClientRect(), s = live.player.world.state(0);
        return [[b.width, b.height], [d._x(s.x[0]) / d.ratio, d._y(s.y[0]) / d.ratio]];
        """
    )
    drag(page, (at[0] / box[0], at[1] / box[1]), None)
    page.wait("!live.part('notice').hidden")
    assert "overlap" in page.js("return live.part('notice').textContent")
    page.wait("live.link.pending === 0")
    assert page.js("return live.part('undo').disabled && live.player.world.count === 1 && !live.player.playing")


def test_an_end_that_is_drawn_near_another_joins_it(page, tmp_path):
    page.open("count=1&speed=0&packing=0.001&seed=3")
    drawn(page, "wall", (0.1, 0.5), (0.4, 0.5))
    drawn(page, "wall", (0.405, 0.505), (0.4, 0.998))
    first, second = saved(page, tmp_path).walls
    assert second.start == first.end
    assert second.end[1] == 0.0  # the floor


def test_the_last_contact_shows_velocities_before_and_after_it(page):
    page.open("gallery=two-disks")
    page.wait("live.player.duration > 0 && live.player.world.event.time.length > 0")
    assert page.js("return live.part('told').hidden")
    page.js("document.body.dispatchEvent(new KeyboardEvent('keydown', {key: 'c', bubbles: true}))")
    assert page.js("return live.part('told').hidden")  # nothing has met yet
    before = page.js(
        """
        live.player.step(1); const t = live.player.world.event.time.values[0];
        live.player.seek(t / 2); const state = live.player.state(); live.player.seek(t);
        return state;
        """
    )
    found = page.js("return live.player.world.contact(live.player.view.time)")
    after = page.js("return live.player.state()")
    for side in found["sides"]:
        disk = side["disk"]
        assert side["before"] == [before["vx"][disk], before["vy"][disk]]
        assert side["after"] == [after["vx"][disk], after["vy"][disk]] != side["before"]
    told = page.js("return live.part('told').textContent")
    assert told.startswith("event 0, t = ")
    assert "momentum exchanged" in told
    margins = page.js(
        """
        const [a, b] = ["told", "canvas"].map((name) => live.part(name).getBoundingClientRect());
        return [a.left - b.left, b.right - a.right, b.bottom - a.bottom, a.top - b.top];
        """
    )
    assert min(margins) >= 0


def test_contacts_at_one_time_are_shown_together(page):
    page.open("gallery=newton-cradle")
    page.js("live.part('impulse').click()")
    page.wait("live.player.world.event.time.length > 4")
    page.js("live.player.step(1)")
    found = page.js("return live.player.world.contact(live.player.view.time)")
    moving = [side["disk"] for side in found["sides"] if any(side["after"])]
    still = [side["disk"] for side in found["sides"] if not any(side["before"])]
    assert len(found["sides"]) > 2
    assert len(moving) == 1
    assert moving[0] in still

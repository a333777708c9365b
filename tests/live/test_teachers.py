"""What a teacher needs of the page, in a real browser: real time, undo, keys, read-outs in view, colours, links that are gone."""

import pytest

from tests.live.driven import SIZES, Page
from tests.show.browser import said

pytest.importorskip("aiohttp", reason="aiohttp is not installed (the extra live brings it)")


EVERY_SIZE = pytest.mark.parametrize("page", SIZES, indirect=True, ids="{0[0]}x{0[1]}".format)


@pytest.fixture
def page(request, chromium, address):
    chromium.set_window_size(*getattr(request, "param", (1280, 800)))
    yield Page(chromium, address)
    chromium.set_window_size(1280, 800)
    assert said(chromium) == []


def key_on_page(page, name):
    page.js("document.body.dispatchEvent(new KeyboardEvent('keydown', {key: arguments[0], bubbles: true}))", name)


@EVERY_SIZE
def test_times_one_is_real_time(page):
    page.open("gallery=galperin")
    key_on_page(page, "1")
    assert page.js("return live.player.view.speed") == pytest.approx(1.0)
    assert page.js("return live.part('rate').textContent") == "× 1"
    page.press("play")
    page.wait("live.player.view.time > 0.5")
    ticks = "return [performance.now(), live.player.view.time]"
    begin = page.js(ticks)
    page.wait(f"live.player.view.time > {begin[1]} + 0.5")
    end = page.js(ticks)
    # what is shown is at most a frame old on either side, and frames may take long on a busy machine
    assert (end[1] - begin[1]) == pytest.approx((end[0] - begin[0]) / 1000, abs=0.3)


@EVERY_SIZE
def test_a_throw_is_undone_and_reset_forgets_it(page):
    page.open("count=5&speed=100&packing=0.05&seed=3")
    start = page.js("live.player.seek(0); return live.player.state()")
    assert page.js("return live.part('undo').disabled")
    for undo in ("undo", "reset"):
        page.js("live.player.pause(); live.player.seek(0); live._act({type: 'throw', time: 0, disk: 0, velocity: [250, 125]})")
        page.wait("live.link.pending === 0 && live.player.world.event.time.length > 0 && live.player.state().vx[0] === 250")
        edition = page.js("return live.edition")
        page.press(undo)
        page.wait(f"live.edition > {edition} && live.link.pending === 0 && live.player.duration > 0")
        assert page.js("live.player.seek(0); return live.player.state()") == start
        assert page.js("return live.part('undo').disabled")


@pytest.mark.slow  # the page may take on the size of the window meanwhile
def test_the_size_of_the_window_is_nothing_to_take_back(page):
    page.open("count=5&speed=100&packing=0.05&seed=3")
    size = page.js("return live.player.stage.size.map((length) => length + 40)")
    page.js("live._act({type: 'throw', time: 0, disk: 0, velocity: [250, 125]})")
    page.js("live._act({type: 'resize', time: 0.25, size: arguments[0]})", size)
    page.wait(f"live.link.pending === 0 && live.player.stage.size[0] === {size[0]}")
    edition = page.js("return live.edition")
    page.press("undo")
    page.wait(f"live.edition > {edition} && live.link.pending === 0 && live.player.stage.size[0] === {size[0]}")
    assert page.js("return live.acts.map((act) => act.type)") == ["resize"]
    assert page.js("return live.part('undo').disabled")
    assert page.js(
        "live.player.seek(0); return Math.hypot(live.player.state().vx[0], live.player.state().vy[0])"
    ) == pytest.approx(100)


def test_energy_temperature_and_speeds_are_in_view(page):
    page.open("count=50&speed=150")
    for size in ((1280, 800), (1100, 760)):
        page.driver.set_window_size(*size)
        for part in ("readouts", "histogram", "series"):
            edges = "const b = live.part(arguments[0]).getBoundingClientRect(); return [b.top, b.bottom, innerHeight]"
            box = page.js(edges, part)
            assert 0 <= box[0] < box[1] <= box[2], (part, size)
    page.press("play")
    page.wait("live.player.view.time > 0.6")
    page.press("play")
    points = page.js("return live.series.points")
    assert len(points) > 2
    assert points == sorted(points, key=lambda point: point["time"])
    assert max(p["energy"] for p in points) == pytest.approx(min(p["energy"] for p in points), rel=1e-9)
    drawn = page.js(
        "const c = live.part('series'); return c.getContext('2d').getImageData(0, 0, c.width, c.height).data.some((v) => v > 0)"
    )
    assert drawn


def test_a_question_mark_shows_the_keys(page):
    page.open("count=3")
    assert page.js("return live.part('keys').hidden")
    key_on_page(page, "?")
    assert "reverse time" in page.js("return live.part('keys').textContent")
    assert not page.js("return live.part('keys').hidden")
    for size in ((1280, 800), (844, 390), (390, 844)):
        page.driver.set_window_size(*size)
        edges = "const b = live.part('keys').getBoundingClientRect(); return [b.left, b.top, b.right, b.bottom]"
        box = page.js(edges) + page.js("return [innerWidth, innerHeight]")
        assert box[0] >= 0
        assert box[1] >= 0
        assert box[2] <= box[4]
        assert box[3] <= box[5]
        assert box[2] - box[0] > 0.8 * min(box[4], 500)
    page.driver.set_window_size(1280, 800)
    key_on_page(page, "Escape")
    assert page.js("return live.part('keys').hidden")
    page.press("help")
    assert not page.js("return live.part('keys').hidden")
    page.press("help")


@pytest.mark.slow
@EVERY_SIZE
def test_the_page_fills_the_screen_and_leaves_it_again(page):
    page.open("count=5")
    page.js("live.root.addEventListener('fullscreenchange', () => { window.changed = (window.changed || 0) + 1; })")
    full = page.driver.find_element("css selector", "[data-part=full]")
    full.click()
    page.wait("document.fullscreenElement === live.root && window.changed === 1")
    edges = "const b = live.part('canvas').getBoundingClientRect(); return [b.left, b.top, b.right, b.bottom]"
    left, top, right, bottom = page.js(edges)
    width, height = page.js("return [innerWidth, innerHeight]")
    assert left >= 0
    assert top >= 0
    assert right <= width
    assert bottom <= height
    assert max((right - left) / width, (bottom - top) / height) > 0.5
    full.click()
    page.wait("document.fullscreenElement === null && window.changed === 2")


@EVERY_SIZE
def test_equal_disks_have_colours_of_their_own(page):
    page.driver.get("about:blank")
    page.open("count=6&masses=equal")
    assert page.js("return live.player.view.colour") == "index"


@EVERY_SIZE
def test_a_link_whose_world_is_gone_says_so(page):
    page.open("world=00000000")
    page.wait("!live.part('notice').hidden")
    assert "is gone" in page.js("return live.part('notice').textContent")


@pytest.mark.parametrize("size", [(844, 390), (390, 844)])
def test_on_a_phone_the_picture_and_its_buttons_fit_the_width(page, size):
    page.open("count=10")
    page.driver.set_window_size(*size)
    page.wait("true")
    width = page.js("return [document.documentElement.scrollWidth, innerWidth]")
    assert width[0] <= width[1]
    box = page.js("const b = live.part('canvas').getBoundingClientRect(); return [b.width, b.height, innerHeight]")
    assert box[0] > 0.8 * min(size[0], width[1]) * 0.9
    assert box[1] > 0.4 * box[2]

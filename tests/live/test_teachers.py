"""What a teacher needs of the page, in a real browser: real time, undo, keys, read-outs in view, colours, links that are gone."""

from itertools import pairwise

import numpy as np
import pytest

import eventsim as es
from eventsim.replay.replay import Replay
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


RIGHT = "\ue014"
"""The right arrow, as WebDriver calls it."""


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


def press_key(page, key):
    """Press a real key, wherever the keyboard is."""
    from selenium.webdriver.common.action_chains import ActionChains

    ActionChains(page.driver).send_keys(key).perform()


@pytest.mark.parametrize("part", ["init", "reset", "fold", "forward", "play"])
def test_the_space_bar_plays_and_pauses_whatever_button_was_pressed(page, part):
    page.open("count=5&speed=100&packing=0.05&seed=3")
    page.press(part)
    page.wait("live.link.pending === 0 && live.player.duration > 0")
    if part == "play":
        press_key(page, " ")  # it was pressed by hand
        assert page.js("return !live.player.playing")
    edition = page.js("return live.edition")
    press_key(page, " ")
    assert page.js("return live.player.playing")
    press_key(page, " ")
    assert page.js("return !live.player.playing")
    assert page.js("return live.edition") == edition
    count = page.js("return live.player.world.eventsUntil(live.player.view.time)")
    press_key(page, RIGHT)
    page.wait(f"live.player.world.eventsUntil(live.player.view.time) > {count}")


def test_a_space_in_a_field_is_a_space(page):
    page.open("count=5&speed=100&packing=0.05&seed=3")
    page.js("live.menu.field('count').focus()")
    press_key(page, " ")
    assert page.js("return !live.player.playing")


def test_a_scene_that_is_chosen_is_shown_at_once_and_other_changes_are_marked(page):
    from selenium.webdriver.support.select import Select

    page.open("count=5&speed=100&packing=0.05&seed=3")
    edition = page.js("return live.edition")
    Select(page.driver.find_element("name", "scene")).select_by_value("galperin")
    page.wait(f"live.edition > {edition} && live.player.duration > 0")
    assert page.js("return live.player.world.count") == 2
    changed = "return live.menu.form.classList.contains('changed')"
    assert not page.js(changed)
    page.driver.find_element("name", "parameter.mass_ratio").send_keys("0")
    assert page.js(changed)
    page.press("init")
    assert not page.js(changed)


@pytest.mark.parametrize("played", [False, True])
def test_energy_steps_at_contacts_and_is_level_between_them(page, tmp_path, played):
    page.open("count=6&speed=300&packing=0.2&seed=3&restitution=0.7&gravity=200")
    page.wait("live.player.duration > 1.5")
    if played:
        page.press("play")
        page.wait("live.player.view.time > 1.0")
        page.press("play")
    else:
        for _ in range(8):
            press_key(page, RIGHT)
    curve = page.js(
        "const { series, player, readouts } = live, { world, tally } = player;"
        "return series.curve('energy', world, tally, readouts.steps.energy, 1e6)"
    )
    shown = page.time
    log = es.load_log(page.fetch("log-file", tmp_path / "log.csv"))
    assert len(set(log.time[log.time <= shown])) >= 8
    scale = curve[0][1]
    for (t, e), (later, other) in pairwise(curve):  # no slant: it is level, or goes down at a contact
        assert later == t or abs(other - e) <= 1e-9 * scale
    down = np.array([t for (t, e), (later, other) in pairwise(curve) if abs(other - e) > 1e-6 * scale and later == t])
    assert len(down) >= 5
    assert np.abs(down[:, None] - log.time[None, :]).min(axis=1).max() < 1e-9
    replay = Replay(log)
    for moment in np.linspace(0.0, shown, 40):
        state = replay.state_at(moment)
        energy = float((log.scene.disks.mass * (0.5 * (state.velocity**2).sum(axis=1) + 200.0 * state.position[:, 1])).sum())
        told = [e for t, e in curve if t <= moment][-1]
        assert told == pytest.approx(energy, abs=1e-6 * scale)


def test_all_of_the_colours_of_a_few_disks_are_told(page):
    page.open("count=6&masses=equal")
    page.driver.set_window_size(1366, 768)
    for colour in ("index", "species", "speed", "contacts"):
        page.js("const c = live.part('colour'); c.value = arguments[0]; c.dispatchEvent(new Event('change'))", colour)
        key = page.js(
            "const k = live.part('key'), dots = [...k.children].map((i) => i.offsetWidth);"
            "return [k.scrollWidth, k.clientWidth, Math.min(...dots), k.title]"
        )
        assert key[0] <= key[1], colour
        assert key[2] >= 11
        assert key[3]
    left, width = page.js("const r = document.querySelector('.controls').getBoundingClientRect(); return [r.right, innerWidth]")
    assert left <= width


def test_a_throw_tells_its_speed_while_the_disk_is_dragged(page):
    from selenium.webdriver.common.action_chains import ActionChains

    page.open("count=5&packing=0.05&speed=100&seed=3")
    page.js("live.player.seek(0.5)")
    x, y = page.js(
        "const d = live.player.drawing, b = d.canvas.getBoundingClientRect(), s = live.player.world.state(0.5);"
        "return [d._x(s.x[2]) / d.ratio + b.left, d._y(s.y[2]) / d.ratio + b.top]"
    )
    hand = ActionChains(page.driver)
    pointer = hand.w3c_actions.pointer_action
    pointer.move_to_location(int(x), int(y)).pointer_down()
    pointer.move_to_location(int(x) + 15, int(y) - 20).move_to_location(int(x) + 30, int(y) - 40)
    hand.perform()
    assert not page.js("return live.part('tip').hidden")
    assert "thrown at  50   (30, 40)" in page.js("return live.part('tip').textContent")
    ActionChains(page.driver).w3c_actions.pointer_action.pointer_up()
    ActionChains(page.driver).release().perform()
    page.wait("live.player.state().vx[2] === 30 && live.player.state().vy[2] === 40")
    assert "thrown" not in page.js("return live.part('tip').textContent")


@pytest.mark.parametrize("size", [(1100, 760), (1366, 768), (1280, 800), (1920, 1080)])
def test_the_picture_keeps_its_size_once_the_page_is_filled(page, size):
    """A row of buttons that broke anew would change the size of the window, which is the world."""
    page.driver.set_window_size(*size)
    page.open("count=40&speed=300&packing=0.2&seed=5")
    asked = page.js("return live.asked")
    for rate in (1 / 64, 1, 64):
        page.js("live.player.setSpeed(arguments[0])", rate)
        for colour in ("index", "species", "speed", "contacts", "mass"):
            page.js("const c = live.part('colour'); c.value = arguments[0]; c.dispatchEvent(new Event('change'))", colour)
            assert page.js("return live.size()") == asked

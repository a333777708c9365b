"""The page in a real browser: what it shows is what the engine says, and its buttons do what they say."""

import time
from urllib.parse import urlsplit

import numpy as np
import pytest

import eventsim as es
from eventsim.measure.ensemble import ensemble_of
from eventsim.replay.passage import Passage
from eventsim.replay.replay import Replay
from eventsim.scene.gallery import names
from eventsim.show.frames import frames_at
from eventsim.validation.judge.matching import assigned
from tests.live.driven import CLOSE, Page
from tests.live.running import live_server
from tests.show.browser import said

pytest.importorskip("aiohttp", reason="aiohttp is not installed (the extra live brings it)")


@pytest.fixture
def page(chromium, address):
    """The page of a server; in the end the console must have said nothing."""
    chromium.set_window_size(1100, 760)
    yield Page(chromium, address)
    assert said(chromium) == []


@pytest.mark.parametrize(("masses", "radii"), [("equal", "equal"), ("different", "different")])
def test_fifty_disks_are_where_the_engine_says(page, tmp_path, masses, radii):
    page.open()
    page.fill(count=50, masses=masses, radii=radii, speed=400, packing=0.25)
    page.press("play")
    page.wait("live.player.view.time > 1.0")
    page.press("play")
    log = es.load_log(page.fetch("log-file", tmp_path / "log.csv"))
    assert len(log.scene.disks) == 50
    assert len(set(log.scene.disks.mass)) == (5 if masses == "different" else 1)
    assert len(log) > 100
    page.assert_true_to(Replay(log))
    scene = es.load_scene(page.fetch("scene-file", tmp_path / "scene.toml"))
    again = es.simulate(scene, events=len(log), log=True).log
    assert again.rows[: len(log)].tobytes() == log.rows.tobytes()


def test_start_pause_resume_step_and_reverse(page):
    page.open("count=40&speed=300&packing=0.2&seed=5")
    page.press("play")
    time.sleep(0.6)
    page.press("play")
    reached = page.time
    assert 0.2 < reached < 2.0
    time.sleep(0.2)
    assert page.time == reached
    page.press("forward")
    after = page.time
    assert after == page.js("return live.player.world.previousEvent(live.player.view.time + 1e-12)") > reached
    page.press("back")
    assert page.time < after
    page.press("play")
    page.wait(f"live.player.view.time > {reached} + 0.3")
    page.press("reverse")
    page.wait(f"live.player.view.time < {reached}")
    page.press("play")
    page.press("reset")
    assert page.time == 0.0
    for _ in range(5):
        page.press("forward")
    assert page.js("return live.player.world.eventsUntil(live.player.view.time)") == 5


def test_a_step_beyond_what_is_known_waits_for_the_server(page):
    page.open("gallery=two-disks")
    page.js("live.player.seek(live.player.duration)")
    known = page.js("return live.player.world.event.time.length")
    page.press("forward")
    page.wait(f"live.player.awaited === null && live.player.world.event.time.length >= {known}")


def test_the_window_is_the_world(page):
    page.open("")
    page.fill(count=30, packing=0.05, speed=200)
    page.js("live.player.seek(1.0)")
    before = page.js("return [live.player.stage.size, live.player.state()]")
    edition = page.js("return live.edition")
    page.driver.set_window_size(1000, 640)
    page.wait(f"live.edition > {edition}")
    size, state = page.js("return [live.player.stage.size, live.player.state()]")
    assert size[0] < before[0][0]
    assert size[1] < before[0][1]
    for name, values in before[1].items():  # the disks are where they were, at the time that was shown
        assert state[name] == pytest.approx(values, rel=CLOSE)
    window = page.js("return live.size()")
    assert size[0] >= window[0]
    assert size[1] >= window[1]
    page.fill(count=31)
    assert page.js("return live.player.stage.size") == window
    assert page.js("return live.player.world.count") == 31


def test_a_built_in_scene_with_its_parameters(page, tmp_path):
    page.open()
    edition = page.js("return live.edition")
    page.js(
        "live.menu.field('scene').value = 'periodic-fluid'; live.menu.field('scene').dispatchEvent(new Event('change'))"
    )
    page.wait(f"live.edition > {edition} && live.link.pending === 0 && live.player.duration > 0")  # it is shown at once
    assert "gallery=periodic-fluid" in page.driver.current_url
    page.fill(**{"parameter.n": 64, "parameter.packing_fraction": 0.3})
    assert page.js("return live.player.world.count") == 64
    assert "gallery=periodic-fluid" in page.driver.current_url
    page.assert_true_to(Replay(es.load_log(page.fetch("log-file", tmp_path / "log.csv"))), 5)
    page.open("gallery=galperin&mass_ratio=10000")
    page.js("live.player.seek(0)")
    page.js("live.player.await(arguments[0], false)", 10.0)
    page.wait("live.player.awaited === null")
    assert page.js("return live.player.world.event.time.length") == 314


@pytest.mark.parametrize("name", ["gas", "mixture", "periodic-fluid", "jar", "cooling"])
def test_read_outs_are_what_measure_says(page, tmp_path, name):
    page.open(f"gallery={name}")
    moment = 0.9 * page.js("return live.player.duration")
    told = page.js(
        "live.player.seek(arguments[0]); live.tell(live.player);"
        "const texts = [...live.readouts.values].map(([name, value]) => [name, value.textContent.replaceAll(',', '')]);"
        "return Object.fromEntries(texts)",
        moment,
    )
    log = es.load_log(page.fetch("log-file", tmp_path / "log.csv"))
    ensemble, velocity = ensemble_of(log.scene), Replay(log).state_at(moment).velocity
    kinetic = 0.5 * float((log.scene.disks.mass * (velocity**2).sum(axis=1)).sum())
    if ensemble.no_temperature is None:
        assert float(told["temperature"]) == pytest.approx(ensemble.temperature(kinetic), rel=1e-3)
    else:
        assert told["temperature"] == "\N{EN DASH}"
    if ensemble.no_pressure is not None or not ensemble.box:
        assert told["p V / N kT"] == "\N{EN DASH}"
        return
    since = max(moment - 5.0 * page.js("return live.player.view.speed"), 0.0)  # the last seconds that were played
    taken = log.impulse[(log.kinds == "wall") & (log.time > since) & (log.time <= moment)].sum()
    pressure = taken / (2.0 * sum(log.scene.domain.size) * (moment - since))
    z = pressure * ensemble.area / (ensemble.n * ensemble.temperature(kinetic))
    assert float(told["p V / N kT"]) == pytest.approx(z, rel=1e-2)
    assert "V is all of the box" in page.js("return live.readouts.values.get('p V / N kT').title")


def test_the_pressure_at_sides_that_grip_is_of_the_momentum_across_them(page, tmp_path):
    page.open("count=40&speed=100&packing=0.2&roughness=0.8&seed=3")
    moment = 0.9 * page.js("return live.player.duration")
    taken = page.js("return live.player.tally.impulse(live.player.world.eventsUntil(arguments[0]))", moment)
    log = es.load_log(page.fetch("log-file", tmp_path / "log.csv"))
    velocity, mass, across, whole = log.scene.disks.velocity.copy(), log.scene.disks.mass, 0.0, 0.0
    for event in log:
        if event.kind == "wall" and event.time <= moment:
            axis = 0 if event.wall in {"left", "right"} else 1
            across += mass[event.a] * abs((event.vxa, event.vya)[axis] - velocity[event.a, axis])
            whole += event.impulse
        velocity[event.a] = event.vxa, event.vya
        if event.kind == "pair":
            velocity[event.b] = event.vxb, event.vyb
    assert taken == pytest.approx(across, rel=1e-9)
    assert across < 0.99 * whole


@pytest.mark.parametrize(
    ("scene", "why"),
    [("gallery=two-disks", "along one direction only"), ("count=2&speed=100&packing=0.05&seed=3", "too few to share the energy")],
)
def test_two_disks_have_neither_temperature_nor_pressure(page, scene, why):
    page.open(scene)
    page.js("live.player.seek(0.5 * live.player.duration); live.tell(live.player)")
    for quantity in ("temperature", "pressure", "p V / N kT"):
        assert page.js("return live.readouts.values.get(arguments[0]).textContent", quantity) == "\N{EN DASH}"
        assert why in page.js("return live.readouts.values.get(arguments[0]).title", quantity)


def test_a_momentum_of_which_rounding_is_left_is_shown_as_none(page):
    """0.1 x 3 is not 0.3; of 3e-17 and nothing else all digits are known."""
    page.open("gallery=galperin")
    added = "const sum = new Sum(); arguments[0].forEach((term) => sum.add(term)); return sum.known(live.player.gas.lastDigits)"
    assert page.js(added, [3 * 0.1, -0.3]) == 0
    assert page.js(added, [3e-17]) == 3e-17
    assert page.js(added, [1.0, -1.0 + 2.0**-30]) == 2.0**-30


@pytest.mark.slow
def test_every_built_in_scene_plays(page, tmp_path):
    for name in names():
        page.open(f"gallery={name}")
        assert page.js("return live.part('notice').hidden"), name
        page.js(
            "for (const part of ['trails', 'flash', 'arrows']) if (!live.player.view[part]) live.part(part).click()"
        )
        page.js("live.player.play()")
        page.wait("live.player.script.frames > 5")
        page.js("live.player.pause()")
        page.assert_true_to(Replay(es.load_log(page.fetch("log-file", tmp_path / "log.csv"))), 3)


def test_an_address_restores_its_scene(page):
    page.open()
    page.fill(count=17, masses="different", seed=9, gravity=300)
    state, link = page.js("return live.player.state()"), page.driver.current_url
    page.driver.set_window_size(900, 700)
    page.open(link.partition("#")[2])
    assert page.js("return live.player.state()") == state
    assert page.js("return live.menu.field('masses').value") == "different"


def test_a_disk_is_thrown_and_moved(page, tmp_path):
    from selenium.webdriver.common.action_chains import ActionChains

    page.open()
    page.fill(count=5, packing=0.05, speed=100)
    page.js("live.player.seek(0.5)")

    def drag(disk, dx, dy):
        x, y = page.js(
            """
            const d = live.player.drawing, box = d.canvas.getBoundingClientRect();
            const s = live.player.world.state(live.player.view.time);
            return [d._x(s.x[arguments[0]]) / d.ratio + box.left, d._y(s.y[arguments[0]]) / d.ratio + box.top];
            """,
            disk,
        )
        hand = ActionChains(page.driver)
        pointer = hand.w3c_actions.pointer_action
        pointer.move_to_location(int(x), int(y)).pointer_down()
        pointer.move_to_location(int(x + dx / 2), int(y + dy / 2)).move_to_location(
            int(x + dx), int(y + dy)
        ).pointer_up()
        hand.perform()

    drag(2, 60, -40)
    page.wait("live.player.world.event.kind.values.subarray(0, live.player.world.event.kind.length).includes(3)")
    state = page.js("return live.player.state()")
    assert (state["time"], state["vx"][2], state["vy"][2]) == (0.5, 60.0, 40.0)
    page.wait("live.player.duration > 1")
    log = es.load_log(page.fetch("log-file", tmp_path / "log.csv"))
    assert (log.kinds == "kick").sum() == 1
    page.assert_true_to(Replay(log))
    page.js("live.part('drag').value = 'move'; live.player.seek(0.5)")
    place = page.js("return live.player.state()")
    edition = page.js("return live.edition")
    drag(2, 12, 12)
    page.wait(f"live.edition > {edition} || !live.part('notice').hidden")
    if page.js("return live.part('notice').hidden"):
        moved = page.js("return live.player.state()")
        assert (moved["time"], moved["x"][2] - place["x"][2]) == (0.5, pytest.approx(12.0))
        assert moved["x"][1] == place["x"][1]


def test_side_by_side_with_the_per_frame_engine(page):
    page.open("count=40&speed=600&packing=0.3&seed=2&rate=30")
    page.wait("live.player.comparison && live.player.duration > 1.5")
    page.js("live.player.seek(1.5)")
    page.wait("live.player.comparison.matching && live.player.view.time === 1.5 && live.part('differences').textContent")
    told = page.js("return live.part('differences').textContent")
    assert "per frame" in told
    assert "energy unchanged" in told  # it keeps all but last bits: that is no -0.00 %
    astray, overlapping = page.js("const c = live.player.comparison; return [c.astray.size, c.overlapping]")
    assert f"{astray} of 40 astray" in told
    assert f"{overlapping} pairs overlap" in told
    assert astray > 0
    counts = page.js(
        "const m = live.player.comparison.matching, t = live.player.view.time;"
        "return [0.2, 0.5, 0.8, 1.0].map((share) => m.counts(share * t))"
    )
    for name in ("found", "missed", "surplus", "astray"):  # what was missed stays missed
        assert [count[name] for count in counts] == sorted(count[name] for count in counts)
    assert counts[-1]["found"] > 0
    assert counts[-1]["missed"] > 0
    page.fill(compare=False)
    assert page.js("return live.player.comparison === null && live.part('beside').hidden")


@pytest.mark.parametrize("opponent", [pytest.param("stepped", marks=pytest.mark.slow), "pymunk"])
def test_another_opponent_knows_restitution_and_gravity(page, opponent):
    if opponent == "pymunk":
        pytest.importorskip("pymunk")
    page.open(f"count=12&speed=200&gravity=300&restitution=0.9&seed=2&rate=240&opponent={opponent}")
    page.wait("live.player.comparison && live.player.duration > 0.5")
    page.js("live.player.seek(0.4)")
    assert {"stepped": "fixed steps", "pymunk": "Chipmunk"}[opponent] in page.js("return live.part('differences').textContent")
    assert "a contact within 0.02 of a disk's previous one is elastic" in page.js("return live.part('settings').textContent")
    assert "(TC model)" in page.js("return live.part('exact').textContent")
    assert page.js("return live.menu.field('opponent').value") == opponent


def test_the_page_matches_contacts_as_the_judgement_does(page):
    page.open("count=2")
    numbers = np.random.default_rng(5)
    for _ in range(20):
        exact, told = (sorted(numbers.integers(0, 30, numbers.integers(0, 5)).tolist()) for _ in range(2))
        assert [tuple(pair) for pair in page.js("return assigned(arguments[0], arguments[1], 4)", exact, told)] == assigned(
            exact, told, 4
        )


def test_two_windows_on_one_world(page):
    page.open("count=20&seed=4")
    page.js("live.player.seek(0.25)")
    link = page.js("return live.part('world').href").partition("#")[2]
    first = page.driver.current_window_handle
    page.driver.switch_to.new_window("window")
    try:
        page.driver.get(f"{page.address}#{link}")
        page.wait("window.live && live.player && live.player.duration > 0")
        second = page.js("return live.player.world.count")
        assert second == 20
        page.driver.switch_to.window(first)
        page.js("live.player.seek(0.5); live.controlled()")
        page.driver.switch_to.window(page.driver.window_handles[-1])
        page.wait("live.player.view.time === 0.5")
    finally:
        page.driver.switch_to.window(page.driver.window_handles[-1])
        page.driver.close()
        page.driver.switch_to.window(first)


def test_a_page_whose_server_is_gone_says_so_and_takes_no_other_for_it(chromium):
    """A server that comes back on the same port has another key in its address."""
    with live_server() as (address, process):
        port = urlsplit(address).port
        page = Page(chromium, address).open("count=25&seed=6&speed=300")
        page.wait("live.player.duration > 2")
        process.kill()
        process.wait()
        page.wait("!live.part('notice').hidden")
        assert "lost" in page.js("return live.part('notice').textContent")
    with live_server(port=port) as (another, _):
        assert another != address
        page.wait("live.part('notice').textContent.includes('started anew')")
        time.sleep(2.0)  # more than one try of the page
        assert not page.js("return live.link.open")
        assert not page.js("return live.part('notice').hidden")
        said(chromium)  # that there is no connection


@pytest.mark.slow
def test_two_thousand_disks_play_for_a_minute_without_starving(page):
    page.open("count=2000&packing=0.3&seed=1", seconds=90)  # the engine may have to be compiled first
    page.wait("live.player.duration > 2.9", 60)
    page.js("live.player.script.starved = 0")
    page.press("play")
    lead = []
    for _ in range(60):
        time.sleep(1.0)
        lead.append(page.js("return live.player.duration - live.player.view.time"))
    script, events, shown = page.js(
        "return [live.player.script, live.player.world.event.time.length, live.player.view.time]"
    )
    print(
        f"{events / shown:.0f} events/s; lead {min(lead):.2f} to {max(lead):.2f} s; {script['frames'] / 60:.0f} frames/s, "
        f"{script['spent'] / script['frames']:.2f} ms of script each, at most {script['worst']:.0f}; "
        f"starved {script['starved']:.0f} ms"
    )
    assert shown > 55
    assert script["starved"] < 100


def test_walls_heat_and_shake_and_disks_grip(page, tmp_path):
    page.open("count=30&speed=0&packing=0.2&temperature=20000&seed=4")
    assert "walls heat, by chance, at kT = 20000" in page.js("return live.part('settings').textContent")
    assert page.js("return live.player.world.state(0).angle") is None
    page.fill(speed=100, shaking=40, roughness=0.5)
    assert page.js("return live.part('notice').hidden")
    for words in (
        "walls heat, by chance, at kT = 20000",
        "walls shake at 40",
        "tangential restitution 0.5 between disks",
    ):
        assert words in page.js("return live.part('settings').textContent")
    page.press("play")
    page.wait("live.player.view.time > 1.0")
    page.press("play")
    log = es.load_log(page.fetch("log-file", tmp_path / "log.csv"))
    assert np.abs(log.spin_a).max() > 0.0
    page.assert_true_to(Replay(log))
    angles = page.js("return Array.from(live.player.world.state(1).angle)")
    (frame,) = frames_at(Passage(log), np.array([1.0]), 0.1)
    assert angles == pytest.approx(frame.angle, abs=1e-9)

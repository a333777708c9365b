"""The player in a real browser: what it shows is what the log says."""

import json
import re
import sys
import time

import numpy as np
import pytest

import eventsim as es
from eventsim.replay.passage import Passage
from eventsim.replay.replay import Replay
from eventsim.scene.files import scene_from_dict
from eventsim.show.frames import frames_at
from eventsim.show.player.page import notebook_frame, page
from tests.show.browser import said

CLOSE = 1e-9
"""Of the scene's size: the bound that positions keep; what is reached is nearer to 1e-14."""


@pytest.fixture
def opened(chromium, tmp_path):
    """Open a log in the player; in the end the console must have said nothing."""

    def open_log(log, **options):
        path = tmp_path / "player.html"
        path.write_text(page(log, **options), encoding="utf-8")
        chromium.get(path.as_uri())
        return chromium

    yield open_log
    assert said(chromium) == []


def shown(driver, moment):
    return driver.execute_script("player.seek(arguments[0]); return player.state()", float(moment))


def assert_shows(found, replay):
    state = replay.state_at(found["time"])
    x, y = np.array(found["x"]), np.array(found["y"])
    apart = np.column_stack([x, y]) - state.position
    for axis, length in enumerate(replay.stage.period):
        if length is not None:
            apart[:, axis] -= length * np.round(apart[:, axis] / length)
    assert np.abs(apart).max() <= CLOSE * max(1.0, np.abs(state.position).max())
    velocity = np.column_stack([found["vx"], found["vy"]])
    assert np.abs(velocity - state.velocity).max() <= CLOSE * max(1.0, np.abs(state.velocity).max())


@pytest.mark.parametrize("name", ["break", "funnel", "periodic-fluid", "channel", "bounce", "stadium", "brownian"])
def test_positions_are_those_of_state_at(opened, name):
    log = es.simulate(es.gallery(name), events=1500, log=True).log
    replay, driver = Replay(log), opened(log)
    start, end = replay.span
    for moment in np.random.default_rng(1).uniform(0.0, end - start, 20):
        assert_shows(shown(driver, moment), replay)


def test_spokes_turn_as_their_disks_do(opened):
    """By the angles, and by the pixels: halfway out from each middle there is ink where the angle says, and none beside it."""
    log = es.simulate(es.gallery("rough", n=25, spin=3.0), events=300, engine="reference", log=True).log
    start, end = Replay(log).span
    driver, moments = opened(log), np.linspace(0.0, end - start, 5)
    for moment, frame in zip(moments, frames_at(Passage(log), start + moments, 0.1), strict=True):
        angles = driver.execute_script("return Array.from(player.world.state(arguments[0]).angle)", float(moment))
        assert angles == pytest.approx(frame.angle, abs=1e-9)
    pairs = driver.execute_script(
        """
        player.seek(player.duration);
        const d = player.drawing, s = player.world.state(player.duration), r = player.world.disks.radius, [lx, ly] = d.stage.size;
        const { width, height } = d.canvas, { data } = d.context.getImageData(0, 0, width, height);
        const ink = (i, angle) => {
          const x = s.x[i] + 0.5 * r[i] * Math.cos(angle), y = s.y[i] + 0.5 * r[i] * Math.sin(angle);
          if (x < 0 || x > lx || y < 0 || y > ly) return null; // it is drawn on the other side
          const place = 4 * (Math.floor(d._y(y)) * width + Math.floor(d._x(x)));
          return Array.from(data.subarray(place, place + 3)).join();
        };
        return Array.from(s.angle, (a, i) => [ink(i, a), ink(i, a + 1.5)]).filter((both) => !both.includes(null));
        """
    )
    assert len(pairs) > 15
    assert all(one != other for one, other in pairs)


def test_a_late_clock_and_a_kick_are_shown_too(opened):
    scene = scene_from_dict(
        {
            "start_time": 1e6,
            "domain": {"kind": "channel", "size": [3.0, 2.0], "origin": [-5.0, 7.0]},
            "gravity": [0.0, -1.0],
            "disk": [
                {"position": [-4.0, 8.0], "velocity": [1.3, 0.1], "radius": 0.2},
                {"position": [-3.0, 8.5], "radius": 0.3, "mass": float("inf"), "velocity": [0.3, 0.0]},
            ],
        },
        source="test",
    )
    simulation = es.Simulation(scene)
    simulation.advance_to(1e6 + 5.0)
    simulation.set_velocity(0, (-2.0, 0.5))
    simulation.advance_to(1e6 + 20.0)
    replay = Replay(simulation.log)
    driver = opened(simulation.log)
    for moment in np.linspace(0.0, 20.0, 33):
        assert_shows(shown(driver, moment), replay)


def test_a_kick_is_no_contact(opened):
    scene = es.Scene(es.Disks([(0.0, 0.0), (4.0, 0.0)], [(1, 0), (0, 0)], radius=0.5), es.Open(), name="kicked")
    simulation = es.Simulation(scene)
    simulation.advance_to(1.0)
    simulation.set_velocity(0, (2.0, 0.0))
    simulation.advance_to(4.0)
    assert simulation.log.kinds.tolist() == ["kick", "pair"]
    driver = opened(simulation.log, color="contacts")
    count = "player.seek(arguments[0]); return [0, 1].map((i) => player.world.contactsUntil(i, player.view.time))"
    assert driver.execute_script(count, 1.5) == [0, 0]
    assert driver.execute_script(count, 3.0) == [1, 1]
    (frame,) = frames_at(Passage(simulation.log), np.array([3.0]), 0.1)
    assert frame.contacts.tolist() == [1, 1]


def test_steps_land_on_event_times_forwards_and_backwards(opened, broken):
    driver = opened(broken)
    times = np.unique(np.maximum.accumulate(broken.time))
    driver.execute_script("player.seek(0)")
    step = "player.step(arguments[0]); return player.state().time"
    forwards = [driver.execute_script(step, 1) for _ in times]
    assert forwards == times.tolist()
    assert driver.execute_script(step, 1) == pytest.approx(Replay(broken).span[1])
    backwards = [driver.execute_script(step, -1) for _ in times]
    assert backwards == times[::-1].tolist()
    assert driver.execute_script(step, -1) == 0.0


def test_scrubbing_back_gives_the_same_bits(opened, fluid):
    driver = opened(fluid)
    duration = driver.execute_script("return player.duration")
    moments = (np.array([0.1, 0.9, 0.4, 0.0, 1.0]) * duration).tolist()
    first = [shown(driver, moment) for moment in moments]
    again = [shown(driver, moment) for moment in moments[::-1]][::-1]
    assert first == again


def test_rows_that_come_one_by_one_give_the_same_world(opened, fluid):
    driver = opened(fluid)
    same = driver.execute_script(
        """
        const whole = player.world, text = document.getElementById("numbers").textContent.trim();
        const { x, y, vx, vy, radius, mass, species, ...rows } =
            unpacked(text, JSON.parse(document.getElementById("description").textContent).columns);
        const grown = new World({ count: whole.count, epochLength: whole.epochLength, period: whole.period,
                                  gravity: whole.gravity, disks: { x, y, vx, vy, radius, mass } });
        for (let k = 0; k < rows.a.length; k++) {
          grown.append(Object.fromEntries(Object.entries(rows).map(([name, column]) => [name, column.slice(k, k + 1)])));
        }
        const time = 0.7 * player.duration;
        return JSON.stringify(grown.state(time)) === JSON.stringify(whole.state(time));
        """
    )
    assert same


def test_it_plays_pauses_and_runs_backwards(opened, broken):
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys

    driver = opened(broken)

    def now():
        return driver.execute_script("return player.state().time")

    body = driver.find_element(By.TAG_NAME, "body")
    body.send_keys(Keys.SPACE)
    time.sleep(0.6)
    body.send_keys(Keys.SPACE)
    reached = now()
    # One second of the scene in ten: 0.6 s of play are 0.06, give or take a frame and the machine.
    assert 0.01 < reached < 0.3
    time.sleep(0.2)
    assert now() == reached
    body.send_keys("r")
    driver.find_element(By.CSS_SELECTOR, '[data-part="play"]').click()
    time.sleep(0.3)
    driver.execute_script("player.pause()")
    assert now() < reached
    body.send_keys(Keys.END)
    assert now() == pytest.approx(1.0)
    body.send_keys(Keys.ARROW_LEFT)
    assert now() == broken.time.max()
    body.send_keys(Keys.ARROW_UP)
    assert driver.find_element(By.CSS_SELECTOR, '[data-part="rate"]').text == "× 0.2"  # of the clock, in a second


def test_hovering_a_disk_tells_its_state(opened, broken):
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By

    driver = opened(broken)
    x, y = driver.execute_script(
        """
        player.seek(0); const d = player.drawing, s = player.world.state(0), box = d.canvas.getBoundingClientRect();
        return [d._x(s.x[0]) / d.ratio + box.left, d._y(s.y[0]) / d.ratio + box.top];
        """
    )
    move = ActionChains(driver)
    move.w3c_actions.pointer_action.move_to_location(int(x), int(y))
    move.perform()
    tip = driver.find_element(By.CSS_SELECTOR, '[data-part="tip"]')
    assert tip.is_displayed()
    assert "disk 0" in tip.text
    assert re.search(r"velocity\s+6, 0", tip.text)


@pytest.mark.parametrize("color", ["speed", "species", "mass", "contacts", "index"])
def test_every_colouring_draws_without_a_word(opened, color):
    log = es.simulate(es.gallery("mixture"), events=100, log=True).log
    driver = opened(log, color=color, dark=True, trails=True, velocities=True, flash=True)
    driver.execute_script("for (let k = 0; k <= 10; k++) player.seek((player.duration * k) / 10)")
    assert driver.execute_script("return player.view.colour") == color


@pytest.mark.slow
def test_a_thousand_disks_and_1e5_events_are_smooth_and_small(opened, tmp_path):
    """Measures the drawing function: 60 frames must take less than a second of script time."""
    scene = es.gallery("gas", n=1000)
    log = es.simulate(scene, events=100_000, log=True).log
    text = page(log, trails=True)
    assert len(text) < 10e6
    driver = opened(log, trails=True)
    spent = driver.execute_script(
        """
        player.seek(player.duration / 2);
        const begun = performance.now();
        for (let k = 0; k < 60; k++) player.seek((player.duration * k) / 60);
        return performance.now() - begun;
        """
    )
    print(f"{len(text) / 1e6:.1f} MB; {spent / 60:.2f} ms a frame")
    assert spent < 1000
    assert_shows(shown(driver, 0.9 * Replay(log).span[1]), Replay(log))


def test_the_page_asks_the_network_for_nothing(broken):
    text = page(broken)
    assert not re.search(r"(src|href)=[\"']?(?!data:)\w", text)
    assert "http" not in text
    assert "import " not in re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)


def test_a_scene_name_cannot_break_the_page(opened):
    scene = es.Scene(es.Disks([(1, 1)], [(1, 0)], radius=0.5), es.Box((4, 2)), until=3.0, name="</script><b>&\"'</b>")
    driver = opened(es.simulate(scene, log=True).log)
    assert driver.title == scene.name


def test_a_notebook_shows_the_player_and_a_long_log_as_text(broken, monkeypatch):
    run = es.simulate(es.gallery("two-disks"), log=True)
    assert "<iframe srcdoc=" in run._repr_html_()
    assert es.simulate(es.gallery("two-disks"))._repr_html_() is None
    monkeypatch.setattr(sys.modules["eventsim.show.player.page"], "MOST_EVENTS", 3)
    assert notebook_frame(broken) is None


def test_the_description_is_strict_json(broken):
    found = re.search(r'id="description">(.*?)</script>', page(broken))
    assert json.loads(found[1])["scene"]["count"] == 16


def test_it_says_from_which_event_on_places_are_beyond_the_digits(opened):
    log = es.simulate(es.gallery("gas", n=16), events=600, log=True).log
    driver = opened(log)

    def said(share):
        driver.execute_script("player.seek(player.duration * arguments[0])", share)
        return driver.execute_script("return player.part('trust').textContent")

    assert re.fullmatch(r"positions hold until event \d+", said(0.1))
    assert re.fullmatch(r"beyond the digits since event \d+: statistics hold", said(1.0))


def test_the_last_contact_is_told_with_velocities_on_both_sides_of_it(opened, fluid):
    driver = opened(fluid)
    replay, row = Replay(fluid), 17
    found = driver.execute_script(
        """
        player.part("impulse").click();
        player.seek(player.world.event.time.values[arguments[0]]);
        return [player.world.contact(player.view.time), player.part("told").textContent];
        """,
        row,
    )
    contact, told = found
    before = replay.state_at(0.5 * (fluid.time[row - 1] + fluid.time[row])).velocity
    after = replay.state_at(fluid.time[row]).velocity
    assert contact["events"] == [row, row]
    assert [side["disk"] for side in contact["sides"]] == [fluid.rows["a"][row], fluid.rows["b"][row]]
    for side in contact["sides"]:
        assert side["before"] == pytest.approx(before[side["disk"]].tolist(), abs=1e-12)
        assert side["after"] == pytest.approx(after[side["disk"]].tolist(), abs=1e-12)
    (told_impulse,) = re.findall(r"momentum exchanged  ([\d.e-]+)", told)
    assert float(told_impulse) == pytest.approx(fluid.rows["impulse"][row], rel=1e-3)


def test_a_wall_is_told_by_its_name_and_a_bounce_back_has_two_arrows(opened):
    disks = es.Disks([(0.5, 1.0)], radius=0.05)
    log = es.simulate(es.Scene(disks, es.Box((1.0, 2.0)), gravity=(0.0, -9.81)), events=1, engine="reference", log=True).log
    driver = opened(log)
    told, aside = driver.execute_script(
        """
        player.part("impulse").click();
        player.seek(player.duration);
        return [player.part("told").textContent, player.drawing._aside(player.world.contact(player.view.time).sides[0])];
        """
    )
    assert "disk 0 at bottom" in told
    assert abs(aside[0]) > 0.0

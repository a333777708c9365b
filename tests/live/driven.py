"""The page of the live view, driven by a test."""

import time
from urllib.request import urlopen

import numpy as np
import pytest

CLOSE = 1e-9
"""Of the scene's size: the bound that positions keep; what is reached is nearer to 1e-13."""

PATIENT = 90
"""Seconds for what takes one on a machine that does nothing else."""

SIZES = [(1280, 800), *(pytest.param(size, marks=pytest.mark.slow) for size in ((844, 390), (390, 844)))]
"""A screen, and a phone held both ways, which is left to the slow tests."""


class Page:
    """The page, driven."""

    def __init__(self, driver, address):
        self.driver = driver
        self.address = address

    def js(self, script, *values):
        return self.driver.execute_script(script, *values)

    def wait(self, condition, seconds=PATIENT):
        """Wait until an expression of the page is true."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if self.js(f"return Boolean({condition})"):
                return
            time.sleep(0.05)
        raise AssertionError(f"not within {seconds} s: {condition}")

    def open(self, hash_="", seconds=PATIENT):
        self.driver.get("about:blank")
        self.driver.get(f"{self.address}#{hash_}")
        self.wait("window.live && live.player && live.player.duration > 0", seconds)
        return self

    def fill(self, **fields):
        """Type into the menu and press init; wait for the new scene."""
        edition = self.js("return live.edition")
        for name, value in fields.items():
            self.js(
                """
                const field = live.menu.field(arguments[0]);
                if (field.type === "checkbox") field.checked = arguments[1]; else field.value = arguments[1];
                field.dispatchEvent(new Event("change"));
                """,
                name,
                value,
            )
        self.press("init")
        self.wait(f"live.edition > {edition} && live.player.duration > 0")

    def press(self, part):
        from selenium.webdriver.common.by import By

        self.driver.find_element(By.CSS_SELECTOR, f'[data-part="{part}"]').click()

    @property
    def time(self):
        return self.js("return live.player.view.time")

    def fetch(self, part, path):
        """Download what a link of the page points to."""
        with urlopen(self.js("return live.part(arguments[0]).href", part), timeout=20) as answer:
            path.write_bytes(answer.read())
        return path

    def assert_true_to(self, replay, count=12):
        """The page shows the states of the log, at times of the run that it knows."""
        moments = np.random.default_rng(1).uniform(0.0, self.js("return live.player.duration"), count)
        for moment in moments:
            found = self.js("live.player.seek(arguments[0]); return live.player.state()", moment)
            state = replay.state_at(found["time"])
            apart = np.column_stack([found["x"], found["y"]]) - state.position
            for axis, length in enumerate(replay.stage.period):
                if length is not None:
                    apart[:, axis] -= length * np.round(apart[:, axis] / length)
            assert np.abs(apart).max() <= CLOSE * np.abs(state.position).max()
            velocity = np.column_stack([found["vx"], found["vy"]])
            assert np.abs(velocity - state.velocity).max() <= CLOSE * np.abs(state.velocity).max()

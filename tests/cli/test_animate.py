"""`eventsim animate` and `eventsim figure`: from a scene or a log to a file."""

import json
import signal
import subprocess
import sys
import time

import pytest


@pytest.fixture
def log_file(eventsim, scene_file, tmp_path):
    path = tmp_path / "two.csv"
    assert eventsim("run", scene_file, "--log", path, "--quiet").exit_code == 0
    return path


def test_a_scene_is_simulated_and_drawn(eventsim, scene_file, tmp_path):
    out = tmp_path / "two.png"
    result = eventsim("animate", scene_file, "--out", out, "--size", "200x160", "--moments", 2, "--dark")
    assert result.exit_code == 0
    assert "2 events drawn to" in result.stdout
    assert out.read_bytes().startswith(b"\x89PNG")


def test_a_log_is_drawn_and_reported_as_json(eventsim, log_file, tmp_path):
    out = tmp_path / "two.gif"
    result = eventsim("animate", log_file, "--out", out, "--duration", 0.5, "--size", "200x160", "--json")
    data = json.loads(result.stdout)
    assert (data["events"], data["format"], data["bytes"]) == (2, "gif", out.stat().st_size)


def test_a_page_holds_the_player(eventsim, log_file, tmp_path):
    out = tmp_path / "two.html"
    assert eventsim("animate", log_file, "--out", out, "--quiet").stdout == ""
    assert "openPlayer" in out.read_text(encoding="utf-8")


def test_a_figure_is_drawn_from_a_log(eventsim, log_file, tmp_path):
    out = tmp_path / "two.svg"
    result = eventsim("figure", log_file, "--kind", "trajectories", "--out", out)
    assert result.exit_code == 0
    assert "trajectories drawn to" in result.stdout
    assert out.read_text().startswith("<?xml")


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["animate", "two.csv"], "--out"),
        (["animate", "two.csv", "--out", "a.avi"], ".mp4, .gif, .html, .png"),
        (["animate", "two.csv", "--out", "none/a.gif"], "no directory"),
        (["animate", "two.csv", "--out", "a.gif", "--size", "big"], "1280x720"),
        (["animate", "two.csv", "--out", "a.gif", "--speed", "1", "--duration", "1"], "exclude"),
        (["animate", "two.csv", "--out", "a.gif", "--from", "5"], "the log tells the time"),
        (["animate", "two.csv", "--out", "a.gif", "--moments", "5"], ".png"),
        (["animate", "two.csv", "--out", "a.html", "--size", "200x200"], "--size is for .mp4, .gif, .png"),
        (["animate", "two.csv", "--out", "a.html", "--speed", "0"], "speed = 0.0"),
        (["animate", "two.csv", "--out", "a.gif", "--fps", "0"], "fps = 0.0"),
        (["animate", "two.csv", "--out", "a.gif", "--until", "5"], "is a log"),
        (["animate", "two.csv", "--out", "a.gif", "--color", "mood"], "'mass'"),
        (["animate", "none.csv", "--out", "a.gif"], "none.csv"),
        (["animate", "brake", "--out", "a.gif"], "break"),
        (["figure", "two.csv", "--out", "a.png"], "--kind"),
        (["figure", "two.csv", "--kind", "speed", "--out", "a.png"], "'speeds'"),
        (["figure", "two.csv", "--kind", "speeds", "--out", "a.gif"], ".png, .svg, .pdf"),
        (["figure", "two.csv", "--kind", "free-paths", "--out", "a.png"], "at least 20"),
    ],
)
def test_bad_usage_is_one_clear_message(eventsim, log_file, scene_file, tmp_path, monkeypatch, words, expected):
    monkeypatch.chdir(tmp_path)
    result = eventsim(*words)
    assert result.exit_code == 2
    assert expected in result.stderr
    assert result.stdout == ""
    assert sorted(tmp_path.iterdir()) == sorted([log_file, scene_file])


@pytest.mark.skipif(sys.platform == "win32", reason="signals are those of POSIX")
def test_an_interrupt_ends_it_with_130_and_no_file(log_file, tmp_path):
    words = [sys.executable, "-m", "eventsim", "animate", log_file, "--out", tmp_path / "a.gif", "--duration", "5000"]
    process = subprocess.Popen(words, stderr=subprocess.PIPE, text=True)
    try:
        while not list(tmp_path.glob("a.gif.*.part")) and process.poll() is None:
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=60)
    finally:
        process.kill()
    assert (process.returncode, said) == (130, "interrupted\n")
    assert not list(tmp_path.glob("a.gif*"))

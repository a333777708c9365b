"""What the command line prints: names and paths of others do nothing to a terminal, and streams may be closed."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest

import eventsim as es
from eventsim.cli.output import visible
from tests.cli.conftest import SCENE

RED = "\x1b[31m"
ODD = (f"a{RED}b", "line\nend", "bell\x07", "half a pair \ud800", "next\x85line", "\u2028", "turned \u202e round")


@pytest.mark.parametrize("name", ODD, ids=ascii)
def test_a_name_that_would_control_a_terminal_is_refused(eventsim, tmp_path, name):
    path = tmp_path / "scene.json"
    disk = {"position": [0, 0], "radius": 1}
    walls = [{"kind": "segment", "start": [0, 5], "end": [1, 5], "name": name}]
    path.write_text(json.dumps({"name": name, "domain": {"kind": "open"}, "disk": [disk], "wall": walls}))
    result = eventsim("check", path)
    assert result.exit_code == 2
    assert "name = " in result.stderr
    assert "wall[0].name" in result.stderr
    assert result.stderr.replace("\n", "").isprintable()
    with pytest.raises(es.SceneError, match="must be one line without control characters"):
        es.Scene(es.Disks([(0.0, 0.0)], [(0.0, 0.0)], 1.0), es.Open(), name=name)


def test_names_in_any_script_are_names():
    name = "Stöße über α, 弾性衝突, 👩‍🔬"  # the last one holds a joiner
    assert es.Scene(es.Disks([(0.0, 0.0)], [(0.0, 0.0)], 1.0), es.Open(), name=name).name == name


def test_a_path_with_control_characters_is_shown_and_not_obeyed(eventsim, tmp_path):
    result = eventsim("state", tmp_path / f"{RED}gone\udcff.csv", "--at", 1)
    assert result.exit_code == 2
    assert "\\x1b[31mgone\\udcff.csv: no such file" in result.stderr
    place = tmp_path / f"{RED}two.toml"
    place.write_text(SCENE)
    result = eventsim("run", place)
    assert result.exit_code == 0
    assert "\\x1b[31mtwo.toml" in result.stdout
    assert RED not in result.output


def test_a_line_break_in_a_path_breaks_no_line(eventsim, tmp_path):
    place = tmp_path / "two\nall is well.toml"
    place.write_text(SCENE)
    log = tmp_path / "log\nmore.csv"
    result = eventsim("run", place, f"--log={log}")
    assert result.exit_code == 0
    assert log.exists()
    assert "two\\nall is well.toml" in result.stdout
    assert "log\\nmore.csv: " in result.stdout
    gone = eventsim("state", tmp_path / "gone\nand lost.csv", "--at", 1)
    assert "gone\\nand lost.csv: no such file" in gone.stderr
    assert visible("two\nlines") == "two\nlines"


def test_what_is_printed_keeps_its_lines_and_letters():
    assert visible("two\nlines, ü, 弾") == "two\nlines, ü, 弾"
    assert visible("\t\r\x9b\udcff") == "\\x09\\x0d\\x9b\\udcff"


@pytest.mark.parametrize("text", ["a" + ".a" * 2000 + " = 1", "[[disk" + ".a" * 2000 + "]]\nx = 1", "[" + "a." * 900 + "a]"])
def test_a_scene_nested_too_deeply_is_refused(eventsim, tmp_path, text):
    path = tmp_path / "deep.toml"
    path.write_text(text)
    result = eventsim("check", path)
    assert (result.exit_code, "nested too deeply" in result.stderr) == (2, True)


def test_a_setting_nested_too_deeply_is_refused(eventsim, scene_file):
    result = eventsim("run", scene_file, "--set", "a" + ".a" * 5000 + "=1")
    assert (result.exit_code, "nested too deeply" in result.stderr) == (2, True)


@pytest.mark.skipif(sys.platform == "win32", reason="the shell of the test")
def test_streams_that_are_closed_are_no_place_for_files(scene_file):
    """The first file that is opened would get the number of stdout."""
    log = scene_file.with_name("log.csv")
    for command, code in ((f"run {scene_file} --log {log}", 0), (f"state {log} --at 1", 0), ("state gone.csv --at 1", 2)):
        words = [sys.executable, "-m", "eventsim", *command.split()]
        closed = "exec 0<&- 1>&-; exec " + " ".join(words)
        done = subprocess.run(["/bin/sh", "-c", closed], stderr=subprocess.PIPE, text=True, env=os.environ, check=False)
        assert (done.returncode, "Traceback" in done.stderr) == (code, False)
    assert len(es.load_log(log)) == 2

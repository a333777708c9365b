"""A file that is not there is answered with the one of a like name beside it; a sweep whose keys are none is refused at once."""

import pytest

TEXT = """
until = 1.0
[domain]
kind = "box"
size = [2.0, 1.0]
[[gas]]
count = 4
radius = 0.05
temperature = 1.0
arrangement = "random"
seed = 1
"""


@pytest.fixture
def here(tmp_path, monkeypatch):
    (tmp_path / "headon.toml").write_text(TEXT, encoding="utf-8")
    (tmp_path / "notes.txt").write_text("none", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    "words",
    [
        "run headonn.toml",
        "run head-on.toml",
        "check Headon.toml",
        "check headonn",
        "live headon.tml --no-browser",
        "measure heaadon.toml --events 10",
        "animate headn.toml --out a.gif",
        "sweep headonn.toml --set gas.0.count=2,3 --out a.csv",
    ],
)
def test_a_file_that_is_not_there_is_answered_with_a_near_one(here, eventsim, words):
    result = eventsim(*words.split())
    assert result.exit_code == 2
    assert "did you mean headon.toml?" in " ".join(result.stderr.split())


def test_a_log_that_is_not_there_is_answered_with_a_near_one(here, eventsim):
    eventsim("run", "headon.toml", "--log", "run1.csv")
    assert "did you mean run1.csv?" in eventsim("state", "run2.csv", "--at", "0.5").stderr
    assert "did you mean" not in eventsim("state", "quite-another.csv", "--at", "0.5").stderr


@pytest.mark.parametrize(
    ("scene", "setting", "words"),
    [
        ("headon.toml", "gas.0.temperatur=1,2", 'unknown key (did you mean "temperature"?)'),
        ("headon.toml", "gas.5.count=1,2", "there is no gas.5"),
        ("gas", "temperatur=1,2", "unknown key (did you mean 'temperature'?)"),
        ("gsa", "temperature=1,2", "did you mean 'gas'?"),
    ],
)
def test_a_sweep_whose_keys_are_none_is_refused_before_its_first_run(here, eventsim, scene, setting, words):
    result = eventsim("sweep", scene, "--set", setting, "--out", "a.csv")
    assert result.exit_code == 2
    assert words in " ".join(result.stderr.split())
    assert not list(here.glob("a.csv*"))
    if setting.startswith("gas.0"):
        *_, typed, caret = (line for line in result.stderr.splitlines() if line.strip())
        assert typed.index("gas.0") == caret.index("^")


def test_a_run_of_a_sweep_that_fails_says_why_on_one_line(here, eventsim):
    result = eventsim("sweep", "headon.toml", "--set", "gas.0.count=4,1e9", "--events", "10", "--out", "a.csv")
    assert result.exit_code == 0
    row = next(line for line in (here / "a.csv").read_text().splitlines() if line.startswith(("1e9", "1000000000")))
    assert "must be at most" in row
    assert "typed" not in row
    assert "^" not in row

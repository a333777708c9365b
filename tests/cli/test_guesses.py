"""What people type who guess verbs, options and kinds is answered with what these are called here."""

import pytest

from eventsim.cli.guesses import KINDS, OPTIONS, VERBS
from eventsim.cli.program import VERBS as OURS
from eventsim.cli.program import main
from eventsim.kinds import TITLES


def told(eventsim, *words):
    result = eventsim(*words)
    assert result.exit_code == 2
    return " ".join(result.stderr.split())


@pytest.mark.parametrize(
    ("words", "meant"),
    [
        ("run break --out a.csv", "--log FILE: Keep every event"),
        ("run break --output a.csv", "--log FILE"),
        ("run break --time 3", "--until T"),
        ("run break --duration 3", "--until T"),
        ("run break --steps 3", "--events N"),
        ("state a.csv --time 3", "--at T"),
        ("figure break --output a.png", "--out FILE"),
        ("figure break --type speeds --out a.png", "--kind KIND"),
        ("animate break --out a.gif --colour speed", "--color"),
    ],
)
def test_an_option_that_one_guesses_is_answered_with_the_one_there_is(eventsim, words, meant):
    assert f"Here it is {meant}" in told(eventsim, *words.split())


def test_an_option_nobody_knows_is_answered_with_near_ones(eventsim):
    assert "--until" in told(eventsim, "run", "break", "--untill", "3")


@pytest.mark.parametrize(
    ("word", "answer"),
    [
        ("plot", "eventsim figure;"),
        ("list", "eventsim gallery;"),
        ("simulate", "eventsim run;"),
        ("help", "eventsim --help lists the verbs, eventsim VERB --help explains one"),
        ("two.toml", "a verb comes first, as in eventsim run two.toml"),
        ("break", "a verb comes first, as in eventsim run break"),
        ("two.csv", "a verb comes first, as in eventsim measure two.csv"),
        ("anmate", "did you mean 'animate'?"),
    ],
)
def test_a_verb_that_one_guesses_is_answered_with_the_one_there_is(eventsim, word, answer):
    assert answer in told(eventsim, word)


@pytest.mark.parametrize(("kind", "meant"), [("trajectory", "trajectories"), ("energy", "series"), ("velocities", "speeds")])
def test_a_kind_of_figure_that_one_guesses_is_answered_with_the_one_there_is(eventsim, kind, meant):
    text = told(eventsim, "figure", "break", "--kind", kind, "--out", "a.png")
    assert text.count(f"'{meant}'") == 2


def test_what_is_answered_is_there():
    assert set(VERBS.values()) <= OURS.keys()
    assert not VERBS.keys() & OURS.keys()
    assert set(KINDS.values()) <= TITLES.keys()
    there = {name for verb in OURS for one in main.get_command(None, verb).params for name in one.opts}
    assert {name for names in OPTIONS.values() for name in names} <= there


def test_a_setting_that_a_built_in_scene_does_not_have_is_answered_with_those_that_it_has(eventsim):
    text = told(eventsim, "run", "break", "--set", "n=100")
    assert "its own are speed, aim; those of every scene are name, until" in text
    assert "did you mean 'restitution'?" in told(eventsim, "run", "break", "--set", "restitutoin=0.5")


def test_check_says_first_what_may_surprise_and_what_run_will_ask_for(eventsim, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text('restitution = 0.5\n[domain]\nkind = "open"\n[[disk]]\nposition = [0, 0]\nradius = 1\n')
    first, *rest = eventsim("check", path).stdout.splitlines()
    assert "a valid scene; eventsim run needs --until" in " ".join([first, rest[0]])
    topics = [line.split()[0] for line in rest if line[2:3].strip() and line[:2] == "  "]
    order = ("contacts", "disks", "motion", "domain", "flights", "stop", "search", "clock", "engine")
    assert tuple(topics[topics.index("contacts") :]) == order
    assert "needs --until" not in eventsim("check", "break").stdout


def test_run_says_how_much_energy_was_lost(eventsim, tmp_path):
    path = tmp_path / "scene.toml"
    disks = "".join(f"[[disk]]\nposition = [{x}, 0]\nvelocity = [{v}, 0]\nradius = 1\n" for x, v in ((0, 1), (4, -1)))
    path.write_text(f'until = 5\nrestitution = 0.5\n[domain]\nkind = "open"\n{disks}')
    assert "not conserved in this scene: 1 -> 0.25\n" in eventsim("run", path).stdout


@pytest.mark.parametrize("verb", OURS)
def test_help_tells_the_options_before_the_keys_of_json(eventsim, verb):
    text = eventsim(verb, "--help").stdout
    assert "Options:" in text
    assert "Keys of --json" not in text.split("Options:")[0]

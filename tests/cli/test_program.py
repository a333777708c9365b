"""The frame of the command line: help, misspelt verbs, failures, pipes."""

import re
import subprocess
import sys

import click
import pytest

import eventsim as es
from eventsim import suffixes
from eventsim.cli import program
from eventsim.replay.states import write_states


def test_alone_it_prints_three_commands_to_begin_with(eventsim):
    result = eventsim()
    commands = [line for line in result.stdout.splitlines() if line.startswith("  eventsim ")]
    assert result.exit_code == 0
    assert len(commands) == 3


def test_help_lists_every_verb_and_imports_none():
    code = (
        "import sys\nfrom eventsim.cli import main\n"
        "try: main(['--help'])\nexcept SystemExit: pass\n"
        "loaded = [m for m in sys.modules if m == 'numpy' or m == 'eventsim.cli.run']\n"
        "sys.exit(str(loaded) if loaded else 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    for verb in program.VERBS:
        assert f"  {verb} " in done.stdout


@pytest.mark.parametrize("verb", program.VERBS)
def test_each_verb_teaches_with_examples_and_json_keys(eventsim, verb):
    result = eventsim(verb, "--help")
    assert result.exit_code == 0
    assert f"eventsim {verb}" in result.stdout
    assert "Examples:" in result.stdout
    assert "Keys of --json:" in result.stdout
    assert "Exit codes:" in result.stdout


@pytest.mark.parametrize("verb", [[], ["run"], ["certify"], ["validate"], ["stress"]])
def test_help_says_what_exit_code_1_means(eventsim, verb):
    page = eventsim(*verb, "--help").stdout
    assert re.search(r"\b1 ", page.partition("Exit codes:")[2])


def test_a_misspelt_verb_is_answered_with_the_nearest(eventsim):
    result = eventsim("rnu")
    assert result.exit_code == 2
    assert "did you mean 'run'" in result.stderr


def test_the_version_is_that_of_the_package(eventsim):
    from eventsim import __version__

    assert eventsim("--version").stdout == f"eventsim {__version__}\n"


@pytest.mark.parametrize(
    ("failure", "exit_code", "words"),
    [
        (KeyboardInterrupt(), 130, "interrupted"),
        (OSError(28, "No space left on device", "a.csv"), 2, "a.csv: No space left on device"),
        (MemoryError(), 2, "not enough memory"),
    ],
)
def test_what_goes_wrong_ends_in_a_sentence_and_an_exit_code(eventsim, monkeypatch, failure, exit_code, words):
    @click.command()
    def fails():
        raise failure

    monkeypatch.setattr(program.Program, "get_command", lambda self, context, name: fails)
    result = eventsim("run")
    assert result.exit_code == exit_code
    assert words in result.stderr
    assert result.stdout == ""


def test_a_reader_who_has_had_enough_is_no_error():
    command = f"{sys.executable} -m eventsim gallery --json | head -c 1; echo ${{PIPESTATUS[0]}}"
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True)
    assert done.stdout.endswith("0\n")
    assert done.stderr == ""


def test_the_suffixes_that_are_offered_are_those_that_can_be_written(tmp_path):
    run = es.simulate(es.gallery("two-disks"), events=5, log=True)
    for suffix in suffixes.LOGS:
        run.log.save(tmp_path / f"log{suffix}")
        assert len(es.load_log(tmp_path / f"log{suffix}")) == 5
    for suffix in suffixes.STATES:
        write_states(tmp_path / f"state{suffix}", run.scene, [run.state])
    assert {path.suffix for path in tmp_path.iterdir()} == {*suffixes.LOGS, *suffixes.STATES}

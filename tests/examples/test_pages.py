"""The pages of the examples do what they say: their commands and their Python run as they stand there."""

import re
import shlex
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import eventsim as es
from eventsim.cli import main
from eventsim.record.events import ROW

EXAMPLES = Path(__file__).parents[2] / "examples"
PAGES = sorted(path.relative_to(EXAMPLES).as_posix() for path in EXAMPLES.rglob("*.md"))


def blocks(page, language):
    return re.findall(rf"^```{language}\n(.*?)^```", (EXAMPLES / page).read_text(), flags=re.DOTALL | re.MULTILINE)


@pytest.mark.parametrize("page", PAGES)
def test_the_commands_of_a_page_run(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for line in "".join(blocks(page, "bash")).splitlines():
        words = shlex.split(line, comments=True)
        if words[0] == "python":  # a lesson, or what makes them; their own tests run both
            script = words[2].replace(".", "/") + ".py" if words[1] == "-m" else words[1]
            assert (EXAMPLES.parent / script).is_file()
            continue
        assert words[0] == "eventsim"
        told = CliRunner().invoke(main, words[1:])
        assert told.exit_code == 0, (line, told.output)


def test_a_log_is_read_and_its_digest_computed_from_the_page_alone(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run = es.simulate(es.gallery("break"), events=300, log="two-disks.csv")
    with redirect_stdout(StringIO()) as said:
        exec("\n".join(blocks("log-format.md", "python")), {})
    first, digest = said.getvalue().splitlines()
    assert first == f"{run.counters.events} rows of 16 disks"
    assert digest == es.load_log("two-disks.csv").digest()


def test_the_page_has_every_column_with_its_type():
    found = {}
    for names, kind, _ in re.findall(
        r"^\| (`.*?`) \| (.*?) \| (.*?) \|$", (EXAMPLES / "log-format.md").read_text(), flags=re.MULTILINE
    ):
        types = kind.split(", ")
        for place, name in enumerate(re.findall(r"`(\w+)`", names)):
            found[name] = types[place % len(types)]
    for name in ROW.names:
        assert found[name] == ("text" if name in ("kind", "wall") else np.dtype(ROW[name]).name), name


def test_what_a_page_points_to_is_there():
    for page in PAGES:
        for target in re.findall(r"\]\((?!http)([^)#]+)\)", (EXAMPLES / page).read_text()):
            assert ((EXAMPLES / page).parent / target).exists(), (page, target)

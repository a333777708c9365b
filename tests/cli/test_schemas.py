"""What `--json` prints is what its schema says, key by key; and shells complete what can be typed."""

import json

import pytest
from click.shell_completion import ShellComplete
from click.testing import CliRunner

from eventsim.cli import main
from eventsim.cli.program import VERBS
from eventsim.cli.schemas import FORMS, schema_of
from eventsim.scene.gallery import names

jsonschema = pytest.importorskip("jsonschema", reason="jsonschema is not installed (the extra test brings it)")

PRINTED = (
    "run break --events 20 --horizon --log b.csv --state s.csv", "run galperin", "run collapse --set restitution=0.01",
    "run ellipse --events 5", "check gas", "check sculpture", "check stadium", "check cooling", "check m.csv", "check brownian",
    "gallery", "gallery tie", "gallery tie --copy t.toml", "state m.csv --at 0", "state m.csv --at 0 --out s.csv",
    "measure m.csv", "measure gas --set n=20 --events 200 --profile y", "measure sinai --until 20 --lyapunov 1 --recurrence",
    "sweep two-disks --set restitution=0.1,0.3 --out z.csv", "animate two-disks --out a.png --moments 1",
    "figure m.csv --kind raster --out s.png", "validate two-disks --against stepped --dt 0.01", "certify two-disks",
    "validate six.toml --trajectory javascript.csv", "stress --soak 1 --engine reference",
)  # fmt: skip


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    from pathlib import Path
    from shutil import copy

    folder = tmp_path_factory.mktemp("schemas")
    examples = Path(__file__).parents[2] / "examples"
    for name in ("six.toml", "javascript.csv"):
        copy(examples / name, folder)
    patch = pytest.MonkeyPatch()
    patch.chdir(folder)
    assert CliRunner().invoke(main, ["run", "mixture", "--events", "50", "--log", "m.csv", "-q"]).exit_code == 0
    yield folder
    patch.undo()


@pytest.mark.parametrize("line", PRINTED)
def test_what_is_printed_fits_the_schema(place, line):
    told = CliRunner().invoke(main, [*line.split(), "--json"])
    assert told.exit_code in (0, 3), told.output
    jsonschema.validate(json.loads(told.stdout), schema_of(line.split()[0]))


def test_what_does_not_fit_is_refused_by_it(place):
    told = json.loads(CliRunner().invoke(main, ["figure", "m.csv", "--kind", "raster", "--out", "s.png", "--json"]).stdout)
    for wrong in ({**told, "more": 1}, {**told, "bytes": "9"}, {key: value for key, value in told.items() if key != "out"}):
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(wrong, schema_of("figure"))


def test_every_verb_tells_its_schema():
    assert set(FORMS) == set(VERBS)
    for verb in VERBS:
        told = CliRunner().invoke(main, [verb, "--json-schema"])
        assert told.exit_code == 0, told.output
        schema = json.loads(told.stdout)
        jsonschema.Draft202012Validator.check_schema(schema)
        assert schema == schema_of(verb)


@pytest.mark.parametrize("verb", [verb for verb in VERBS if verb not in ("warm", "live")])
def test_the_help_tells_what_each_key_of_the_schema_means(verb):
    told = CliRunner().invoke(main, [verb, "--help"]).stdout
    keys = {key for one in FORMS[verb] for key in one["properties"]}
    assert sorted(key for key in keys if key not in told) == []


def completed(arguments, begun):
    complete = ShellComplete(main, {}, "eventsim", "_EVENTSIM_COMPLETE")
    return [(one.type, one.value) for one in complete.get_completions(arguments, begun)]


def test_shells_complete_verbs_scenes_files_and_kinds():
    assert ("plain", "measure") in completed([], "me")
    for verb in ("run", "check", "gallery", "sweep", "animate", "live"):
        assert {("plain", name) for name in names() if name.startswith("co")} <= set(completed([verb], "co")), verb
    assert completed(["run", "break", "--log"], "b") == [("file", "b")]
    assert completed(["state"], "b") == [("file", "b")]
    assert ("plain", "raster") in completed(["figure", "m.csv", "--kind"], "r")


def test_a_shell_is_told_how_to_complete():
    told = CliRunner().invoke(main, [], prog_name="eventsim", env={"_EVENTSIM_COMPLETE": "bash_source"})
    assert "_eventsim_completion" in told.output
    assert told.exit_code == 0

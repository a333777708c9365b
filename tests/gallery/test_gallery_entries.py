"""The gallery tells what it holds, and refuses what it does not."""

import inspect
import re
from importlib import import_module
from pathlib import Path

import pytest

from eventsim.errors import SceneError
from eventsim.scene import gallery as gallery_package
from eventsim.scene.files import scene_to_dict
from eventsim.scene.gallery import describe, gallery, names

FOLDER = Path(gallery_package.__path__[0])
EXAMPLES = Path(__file__).parents[2] / "examples"
SECTIONS = ("What happens", "Why", "Source", "A question")
PROMISED = [
    *("two-disks", "oblique", "newton-cradle", "galperin", "corridor", "corner", "break", "gas", "mixture"),
    *("brownian", "sinai", "stadium", "bounce", "funnel", "channel", "cooling", "periodic-fluid"),
]


def test_the_promised_scenes_are_there() -> None:
    assert set(PROMISED) <= set(names())


def test_every_file_of_the_folder_is_a_scene() -> None:
    files = [path.stem for path in FOLDER.glob("*.py") if not path.stem.startswith("_")]
    assert sorted(stem.strip("_").replace("_", "-") for stem in files) == names()


@pytest.mark.parametrize("name", names())
def test_each_scene_is_told_in_four_sections(name: str) -> None:
    entry = describe(name)
    assert entry.name == name
    assert entry.title
    assert "\n" not in entry.title
    assert re.findall(r"^(\S.*)$", entry.text, re.MULTILINE) == list(SECTIONS)
    for said in re.split("|".join(f"^{section}$" for section in SECTIONS), entry.text, flags=re.MULTILINE)[1:]:
        assert said.strip()
    assert entry.text.rstrip().endswith(("?", ".")), "the question comes last"
    for parameter in entry.parameters:
        assert f"`{parameter}`" in entry.about or parameter in entry.about, f"{parameter} is not explained"


@pytest.mark.parametrize("name", names())
def test_each_scene_has_a_name_a_stop_and_defaults(name: str) -> None:
    scene = gallery(name)
    assert scene.name
    assert scene.until is not None or scene.events is not None
    assert gallery(name, **describe(name).parameters) == scene


def test_an_unknown_scene_is_answered_with_the_nearest_name() -> None:
    with pytest.raises(SceneError, match="did you mean 'newton-cradle'"):
        gallery("newton_cradel")


def test_an_unknown_parameter_is_answered_with_those_there_are() -> None:
    with pytest.raises(
        SceneError, match=r"galperin has no parameter 'massratio', did you mean 'mass_ratio'.*mass_ratio = 100\.0"
    ):
        gallery("galperin", massratio=4)


@pytest.mark.parametrize(
    ("name", "parameters", "said"),
    [
        ("gas", {"n": 2.5}, "n = 2.5: must be a whole number"),
        ("gas", {"n": True}, "n = True: must be a whole number"),
        ("gas", {"temperature": "hot"}, "temperature = 'hot': must be a number"),
        ("periodic-fluid", {"arrangement": 3}, "arrangement = 3: must be a text"),
        ("periodic-fluid", {"arrangement": "cubic"}, "cubic"),
        ("newton-cradle", {"moving": 5}, "moving = 5: must be from 1 to n - 1 = 4"),
        ("corridor", {"n": 300}, "length = 100.0: must be above the 150"),
        ("galperin", {"mass_ratio": -1}, "mass_ratio = -1.0: must be finite and above 0"),
        ("gas", {"packing_fraction": 0.95}, "packing_fraction"),
    ],
)
def test_a_wrong_value_is_refused_with_the_scene_the_value_and_the_rule(
    name: str, parameters: dict[str, bool | int | float | str], said: str
) -> None:
    with pytest.raises(SceneError) as refusal:
        gallery(name, **parameters)
    assert said in str(refusal.value)
    assert name in str(refusal.value)


def test_all_wrong_parameters_are_told_at_once() -> None:
    with pytest.raises(SceneError) as refusal:
        gallery("gas", n="many", seeds=3)
    assert len(refusal.value.problems) == 2


def test_whole_numbers_do_where_numbers_are_wanted() -> None:
    assert gallery("galperin", mass_ratio=10000).disks.mass[1] == 10000.0


def test_parameters_are_keywords_with_plain_defaults() -> None:
    for name in names():
        module = import_module(f"eventsim.scene.gallery.{'break_' if name == 'break' else name.replace('-', '_')}")
        for parameter in inspect.signature(module.scene).parameters.values():
            assert parameter.kind is inspect.Parameter.KEYWORD_ONLY
            assert isinstance(parameter.default, bool | int | float | str)


def test_every_key_of_the_scene_file_is_used() -> None:
    realised = " ".join(f"{scene_to_dict(gallery(name))}" for name in names())
    keys = [
        "name",
        "until",
        "events",
        "start_time",
        "gravity",
        "restitution",
        "pair",
        "wall",
        "contact_duration",
        "kind",
        "size",
        "origin",
        "position",
        "velocity",
        "radius",
        "mass",
        "start",
        "end",
        "points",
        "through",
        "center",
        "box",
        "periodic",
        "channel",
        "open",
        "segment",
        "polygon",
        "polyline",
        "arc",
        "circle",
        "inf",
    ]
    assert [key for key in keys if f"'{key}'" not in realised and f": {key}" not in realised] == []
    written = "".join(path.read_text() for path in [*FOLDER.glob("*.py"), *EXAMPLES.glob("*.toml")])
    rules = [
        "count",
        "packing_fraction",
        "temperature",
        "speed",
        "arrangement",
        "random",
        "square",
        "hexagonal",
        "region",
        "seed",
        "disks_file",
        "path",
    ]
    assert [key for key in rules if not re.search(rf'"{key}"|\b{key}\b *=|\[\[{key}\]\]', written)] == []

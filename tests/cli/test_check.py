"""`eventsim check`: a true explanation, and all problems at once.

`python -m tests.cli.test_check` writes the pages of the built-in scenes anew, to be read before they are committed.
"""

import json
from pathlib import Path

import numpy as np
import pytest

import eventsim as es
from eventsim.cli.explain import explanation, page
from eventsim.cli.folding import folded
from eventsim.cli.needs import needs_of
from eventsim.scene.gallery import names
from tests.gallery.test_gallery_digests import stored

PAGES = Path(__file__).parent / "pages"


def page_of(name):
    """The page of a built-in scene, from its stored start: what NumPy draws may change, what is said may not."""
    scene = stored(name)
    return folded(page(name, scene.name, needs_of(scene))) + "\n"


def test_a_valid_scene_is_explained(eventsim, scene_file):
    result = eventsim("check", scene_file)
    assert result.exit_code == 0
    for words in ("a valid scene", "2 disks", "straight lines", "elastic", "all pairs", "at time 4"):
        assert words in result.stdout


@pytest.mark.parametrize("name", names())
def test_each_built_in_scene_is_explained_and_says_how_it_is_searched(eventsim, name):
    facts = json.loads(eventsim("check", name, "--json").stdout)
    cells = facts["search"]["kind"] == "cells"
    assert ("cells of" in facts["explanation"]["search"]) == cells
    assert ("parabolas" in facts["explanation"]["flights"]) == (facts["gravity"] is not None)
    special = [facts["law"]["treatments"], facts["law"]["rough"]]
    conserved = facts["restitution"] is None and facts["obstacles"] == 0 and special == [None, None]
    assert ("energy is conserved" in facts["explanation"]["contacts"]) == conserved
    assert ("walls" in facts["explanation"]) == bool(facts["walls"])
    assert facts["until"] is not None or facts["events"] is not None


@pytest.mark.parametrize("name", names())
def test_the_page_of_a_built_in_scene_is_the_one_that_was_read_and_found_true(name):
    assert page_of(name) == (PAGES / f"{name}.txt").read_text()


def test_no_page_is_left_over():
    assert sorted(path.stem for path in PAGES.iterdir()) == names()


def test_lines_are_short_enough_to_read():
    for name in names():
        assert max(map(len, page_of(name).splitlines())) <= 80


def test_json_documents_each_of_its_keys(eventsim):
    facts = json.loads(eventsim("check", "break", "--json").stdout)
    page = eventsim("check", "--help").stdout
    assert [key for key in facts if key not in page] == []


def test_touching_by_rounding_is_said(eventsim, scene_file):
    scene_file.write_text(
        'until = 1.0\n[domain]\nkind = "open"\n'
        "[[disk]]\nposition = [0.0, 0.0]\nradius = 0.5\n"
        "[[disk]]\nposition = [1000000.0, 0.0]\nvelocity = [1.0, 0.0]\nradius = 0.5\n"
        "[[disk]]\nposition = [1000000.999999999, 0.0]\nradius = 0.5\n"
    )
    result = eventsim("check", scene_file)
    assert result.exit_code == 0
    assert "touching, but for rounding" in result.stdout


@pytest.mark.parametrize(("size", "bits"), [(8, 50), (2**16, 37), (2**20, 33)])
def test_check_says_how_many_bits_of_a_gap_are_left(eventsim, scene_file, size, bits):
    scene_file.write_text(
        f'until = 1.0\n[domain]\nkind = "box"\nsize = [{size}, 8]\n[[disk]]\nposition = [2, 2]\nvelocity = [1, 0]\nradius = 0.5\n'
    )
    assert json.loads(eventsim("check", scene_file, "--json").stdout)["gap_bits"] == bits
    told = f"{bits} of the 53 bits of a gap are left" in " ".join(eventsim("check", scene_file).stdout.split())
    assert told == (size >= 2**16)


def test_an_outcome_that_hangs_on_the_last_bit_is_told(eventsim):
    hanging = eventsim("check", "tie", "--set", "delay=1e-15")
    assert hanging.exit_code == 0
    told = " ".join(hanging.stdout.split())
    assert (
        "warning disks 0 and 1 meet at time 3, and disks 0 and 2 only 1.3e-15 later: the last bits of the start" in told
    )
    for delay in ("0", "1e-9"):  # an exact tie is resolved jointly; a billionth is no rounding
        assert "warning" not in eventsim("check", "tie", "--set", f"delay={delay}").stdout
    facts = json.loads(eventsim("check", "tie", "--set", "delay=1e-15", "--json").stdout)
    assert [(tie["first"], tie["second"]) for tie in facts["near_ties"]] == [([0, 1], [0, 2])]


def test_all_problems_come_at_once(eventsim, scene_file):
    scene_file.write_text(scene_file.read_text().replace("radius = 0.25", "radius = -1.0\nswirl = 2"))
    result = eventsim("check", scene_file)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert result.stderr.count("swirl: unknown key") == 2


def test_a_missing_scene_argument_is_named(eventsim):
    result = eventsim("check")
    assert result.exit_code == 2
    assert "SCENE" in result.stderr


def test_quiet_lets_the_exit_code_speak(eventsim, scene_file):
    result = eventsim("check", scene_file, "--quiet")
    assert (result.exit_code, result.output) == (0, "")


def test_check_says_where_velocities_carry_what_rounding_leaves(eventsim):
    page = eventsim("check", "galperin", "--set", "mass_ratio=1e6").stdout
    assert "velocities carry what their rounding leaves" in " ".join(page.split())
    assert "rounding leaves" not in eventsim("check", "galperin").stdout


GAS = "[[gas]]\ncount = 5\nradius = 0.02\ntemperature = 1.0\n"
MIXED = f"""
[domain]
kind = "box"
size = [4.0, 2.0]
{GAS}seed = 7
region = [0.0, 0.0, 1.0, 1.0]
[[disk]]
position = [2.5, 1.0]
radius = 0.25
{GAS}seed = 7
region = [1.0, 0.0, 2.0, 1.0]
[[disks_file]]
path = "start.csv"
"""


def told_of_file(eventsim, file, *options):
    """The page of a scene file, as one line."""
    result = eventsim("check", file, *options)
    assert result.exit_code == 0, result.output
    return " ".join(result.stdout.split())


def test_a_file_is_told_which_disks_have_which_numbers(eventsim, tmp_path):
    (tmp_path / "start.csv").write_text("x,y,radius\n3.5,0.5,0.1\n3.5,1.5,0.1\n")
    (tmp_path / "mixed.toml").write_text(MIXED)
    scene = es.load_scene(tmp_path / "mixed.toml")
    words = "0 is of [[disk]], 1 to 2 are of [[disks_file]], 3 to 7 are of gas[0], 8 to 12 are of gas[1]"
    assert scene.disks.radius.tolist() == [0.25, *2 * [0.1], *10 * [0.02]]
    assert f"numbers {words}, whatever" in told_of_file(eventsim, tmp_path / "mixed.toml")


def test_gases_of_one_seed_are_told(eventsim, tmp_path):
    (tmp_path / "start.csv").write_text("x,y,radius\n3.5,0.5,0.1\n")
    words = "gas[0] and gas[1] have one seed and draw the same numbers"
    file = tmp_path / "mixed.toml"
    file.write_text(MIXED)
    assert words in told_of_file(eventsim, file)
    assert "one seed" not in told_of_file(eventsim, file, "--seed", "1")
    assert "one seed" not in told_of_file(eventsim, file, "--set", "gas.1.seed=8")
    file.write_text(MIXED.replace("temperature = 1.0", 'arrangement = "square"'))
    assert "one seed" not in told_of_file(eventsim, file)


def test_under_a_law_of_ones_own_check_tells_that_nothing_rests_and_what_avoids_ever_faster_contacts():
    def told(**keys):
        scene = es.Scene(es.Disks([[1.0, 2.0]], radius=0.5), es.Box((4.0, 4.0)), law=lambda approach: 0.5, **keys)
        return dict(explanation(needs_of(scene))).get("rest", "")

    assert "may not get to its stop time: --events N ends it" in told(gravity=(0.0, -1.0))
    assert "none with a contact_duration" in told(gravity=(0.0, -1.0), contact_duration=0.01)
    assert told() == ""


if __name__ == "__main__":
    PAGES.mkdir(exist_ok=True)
    for each in names():
        (PAGES / f"{each}.txt").write_text(page_of(each))


def test_all_pairs_that_overlap_are_told_on_request(eventsim, scene_file):
    disks = "".join(f"[[disk]]\nposition = [{k / 8}, 0.0]\nradius = 0.5\n" for k in range(6))
    scene_file.write_text('[domain]\nkind = "open"\n' + disks)
    assert eventsim("check", scene_file).stderr.count("overlap by") == 3
    assert eventsim("check", scene_file, "--all").stderr.count("overlap by") == 15
    assert eventsim("check", scene_file).stderr.count("overlap by") == 3


def test_disks_that_nothing_deflects_are_explained():
    disks = es.Disks([[0.5, 0.5], [1.5, 0.5]], [[1.0, 0.0], [0.0, 1.0]], 0.1, np.inf)
    scene = es.Scene(disks, es.Box((2.0, 1.0)))
    assert "nothing deflects it" in page("still", "still", needs_of(scene))


@pytest.mark.parametrize(("gravity", "temperature", "told"), [(9.81, 300.0, True), (-9.81, 1.0, False)])
def test_gravity_upwards_and_a_temperature_in_kelvin_are_remarked(eventsim, tmp_path, gravity, temperature, told):
    path = tmp_path / "a.toml"
    gas = f"[[gas]]\ncount = 40\nradius = 0.01\nseed = 1\ntemperature = {temperature}\n"
    path.write_text(f'until = 1.0\ngravity = [0.0, {gravity}]\n[domain]\nkind = "box"\nsize = [1, 1]\n{gas}')
    words = " ".join(eventsim("check", path).stdout.split())
    assert ("it points upwards" in words) is told
    assert ("kT is an energy" in words) is told

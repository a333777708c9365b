"""`check` never crashes: it explains a scene, or a sentence says what is wrong with it."""

import copy
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

import eventsim as es
from eventsim.cli.explain import page
from eventsim.cli.needs import needs_of
from eventsim.errors import EventsimError
from eventsim.scene.files import scene_from_dict, scene_to_dict
from eventsim.scene.gallery import names
from eventsim.validation.stress.case import Bench, GaveUpError
from eventsim.validation.stress.catalogue import CASES
from eventsim.validation.stress.soak import random_scene
from tests.oracle.families import FAMILIES, case_of

EXAMPLES = [path for path in (Path(__file__).parents[2] / "examples").iterdir() if path.suffix in (".toml", ".json")]

LARGE = ("c2-lattice", "f18-one-large", "f19-jammed", "f30-cell-ties")
"""Cases whose first scene has hundreds of disks."""

ODD = (0.0, -0.0, 5e-324, 1e-310, 1e-300, 1e-160, 1e-75, 1e-16, 1.0, 1e16, 1e75, 1e150, 1e200, 1e300, -1e300, -1.0)
FACTORS = (1e-300, 1e-150, 1e-20, 1e-3, 1.0 - 2.0**-53, 1.0 + 2.0**-52, 2.0, 1e3, 1e20, 1e150, 1e300, -1.0)


def explained(scene):
    """Whether `check` explains a scene; otherwise a sentence refuses it."""
    try:
        text = page("scene", scene.name, needs_of(scene))
    except EventsimError:
        return False
    assert "a valid scene" in text
    return True


def scenes_of_the_catalogue(chosen):
    """The first scene of each case; of one that is refused before it is a scene, none."""

    class Reading(Bench):
        def run(self, scene, *_args, **_keys):
            found.append(scene)
            raise GaveUpError("read", None)

        def run_kicked(self, scene, *_args, **_keys):
            self.run(scene)

    found = []
    for name in chosen:
        with suppress(GaveUpError):
            CASES[name].judge(Reading("reference", 1.0))
    return found


def as_lists(value):
    if isinstance(value, dict):
        return {key: as_lists(one) for key, one in value.items()}
    return [as_lists(one) for one in value] if isinstance(value, list | tuple) else value


def numbers_in(value, path=()):
    """Where the numbers of a scene are."""
    if isinstance(value, dict | list):
        for key, one in value.items() if isinstance(value, dict) else enumerate(value):
            yield from numbers_in(one, (*path, key))
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield path


def spoiled(rng, data):
    """A scene's keys with a few numbers replaced by odd ones; None where that is no scene any more."""
    data = copy.deepcopy(data)
    places = list(numbers_in(data))
    for _ in range(rng.integers(1, 4)):
        *path, last = places[rng.integers(len(places))]
        node = data
        for key in path:
            node = node[key]
        if last == "events":
            node[last] = int(rng.choice([0, 1, 10**12]))
        else:
            node[last] = float(rng.choice(ODD)) if rng.random() < 0.4 else float(node[last]) * float(rng.choice(FACTORS))
    try:
        return scene_from_dict(data, Path())
    except EventsimError:
        return None


def fuzzed(seed, count, sources):
    rng = np.random.default_rng(seed)
    scenes = [spoiled(rng, sources[rng.integers(len(sources))]) for _ in range(count)]
    good = [scene for scene in scenes if scene is not None]
    assert len(good) > count / 10
    for scene in good:
        explained(scene)


def keys_of(scenes):
    return [as_lists(scene_to_dict(scene)) for scene in scenes]


def test_examples_hard_scenes_and_random_ones_are_explained():
    scenes = [es.load_scene(path) for path in EXAMPLES]
    scenes += scenes_of_the_catalogue([name for name in list(CASES)[::2] if name not in LARGE])
    scenes += [case_of(family, 3, 0).scene for family in list(FAMILIES)[::2]] + [random_scene(seed) for seed in range(8)]
    for scene in scenes:
        assert explained(scene)


def test_odd_numbers_are_explained_or_refused():
    fuzzed(1, 60, keys_of([case_of(family, 3, 1).scene for family in ("kicks", "arcs", "wedges", "slopes", "posts")]))


@pytest.mark.slow
@pytest.mark.timeout(3600)
def test_all_of_them_are_explained_or_refused():
    scenes = [es.gallery(name) for name in names()] + scenes_of_the_catalogue(CASES)
    scenes += [case_of(family, seed, 0).scene for family in FAMILIES for seed in range(20)]
    scenes += [random_scene(seed) for seed in range(300)]
    for scene in scenes:
        assert explained(scene)
    fuzzed(2, 20_000, keys_of([scene for scene in scenes if len(scene.disks) < 60]))


@pytest.mark.parametrize(
    ("walls", "position", "velocity"),
    [
        ([es.Ellipse((0.0, 0.0), (5.0, 3.0))], (1.0, 1e-310), (0.28, 0.96)),
        ([es.Arc((0.0, 0.0), (1.0, 0.1), (2.0, 0.0))], (0.0, 1e20), (0.0, -1.0)),
        ([], (1.0, 1.0), (1e-75, 0.0)),
    ],
    ids=["on the axis of an ellipse, but for 1e-310", "so far that an arc is below the digits", "the slowest there is"],
)
def test_numbers_at_the_end_of_the_range_crash_nothing(walls, position, velocity):
    explained(es.Scene(es.Disks([position], [velocity], radius=0.0), es.Open(), walls))

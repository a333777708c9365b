"""What the command line says of scenes at the ends of the range of speeds."""

import json
import warnings

import pytest

from eventsim.scene.files import scene_to_dict
from tests.engines.scenes import lattice_gas
from tests.engines.test_speeds import faster

KT = 0.747667
"""mean m v^2 / 2 of the scene, times 4**-k."""


@pytest.fixture(params=[-240, 240])
def fast(request, tmp_path):
    """(power of two, scene file, log file)."""
    path = tmp_path / "fast.json"
    scene = scene_to_dict(faster(lattice_gas(30, 0.3, seed=1), request.param))
    path.write_text(json.dumps(scene | {"events": 400}))
    return request.param, path, tmp_path / "log.csv"


@pytest.fixture(autouse=True)
def no_warnings():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield


def test_a_very_fast_or_slow_scene_is_checked_run_measured_and_drawn(eventsim, fast, tmp_path):
    k, scene, log = fast
    checked = json.loads(eventsim("check", scene, "--json").stdout)
    assert checked["temperature"] == pytest.approx(KT * 4.0**k, rel=1e-5)
    ran = json.loads(eventsim("run", scene, "--log", log, "--json").stdout)
    assert (ran["events"], ran["stopped"]) == (400, "events")
    assert abs(ran["residuals"]["energy"]) < 1e-14
    measured = json.loads(eventsim("measure", log, "--json").stdout)["quantities"]
    temperature = measured["temperature"]
    assert temperature["value"] == pytest.approx(KT * 4.0**k, rel=1e-5)
    assert temperature["unit"] == "energy"
    text = eventsim("measure", log).stdout
    for word in ("inf", "nan"):
        assert f" {word}" not in text
    for kind in ("speeds", "msd", "residuals"):
        assert eventsim("figure", log, "--kind", kind, "--out", tmp_path / f"{kind}.png").exit_code == 0
    for name in ("film.gif", "strip.png", "page.html"):
        assert (
            eventsim(
                "animate", log, "--out", tmp_path / name, *(["--duration", "0.2"] * (name == "film.gif"))
            ).exit_code
            == 0
        )

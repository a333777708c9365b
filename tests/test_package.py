"""The package as a whole: its public names, and how little it takes to import it."""

import importlib.metadata
import json
import subprocess
import sys
from operator import attrgetter
from pathlib import Path

import pytest

import eventsim

HEAVY = ("matplotlib", "numba", "pyarrow", "rich", "flint", "pandas", "click", "voluptuous")


def modules_after(code: str) -> set[str]:
    """The top-level modules that a fresh Python has loaded after running some code."""
    report = "import json, sys; print(json.dumps(sorted({name.partition('.')[0] for name in sys.modules})))"
    done = subprocess.run([sys.executable, "-c", f"{code}\n{report}"], capture_output=True, text=True, check=True)
    return set(json.loads(done.stdout))


def test_importing_the_package_loads_no_library_at_all():
    assert not modules_after("import eventsim") & {*HEAVY, "numpy", "sortedcontainers"}


def test_simulating_a_small_scene_loads_nothing_heavy():
    code = "import eventsim as es; es.simulate(es.gallery('two-disks'), log=True)"
    assert not modules_after(code) & set(HEAVY)


@pytest.mark.parametrize("name", eventsim.__all__)
def test_every_public_name_is_there(name):
    assert getattr(eventsim, name) is not None
    assert name in dir(eventsim)


def test_no_public_name_is_hidden_by_a_module_of_the_same_name():
    # Importing eventsim.NAME binds the module to eventsim.NAME, whatever the package says.
    folder = Path(eventsim.__path__[0])
    modules = {path.stem for path in folder.iterdir()}
    assert not modules & set(eventsim.__all__)


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'simulat'"):
        attrgetter("simulat")(eventsim)


def test_the_distribution_has_the_version_of_the_package():
    try:
        version = importlib.metadata.version("eventsim-disks")
    except importlib.metadata.PackageNotFoundError:
        pytest.skip("eventsim-disks is not installed here: the package is on PYTHONPATH alone")
    assert version == eventsim.__version__

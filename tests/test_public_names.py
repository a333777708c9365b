"""Every public name can be read with help(): what it is, what it takes, what it raises."""

from __future__ import annotations

import inspect
import re

import pytest

import eventsim as es

NAMES = sorted(set(es.__all__) - {"__version__", "ENGINES"})


def members():
    """(name, object) of the public names and of their public methods and properties."""
    for name in NAMES:
        value = getattr(es, name)
        yield name, value
        if inspect.isclass(value):
            own = [base for base in value.__mro__ if base.__module__.startswith("eventsim")]
            for key, member in {key: member for base in reversed(own) for key, member in vars(base).items()}.items():
                if not key.startswith("_") and (callable(member) or isinstance(member, property | classmethod)):
                    yield f"{name}.{key}", member


MEMBERS = dict(members())


@pytest.mark.parametrize("name", MEMBERS)
def test_a_public_name_says_what_it_is(name):
    member = MEMBERS[name]
    text = inspect.getdoc(member.fget if isinstance(member, property) else member) or ""
    assert len(text) > 15, f"{name} has no docstring"
    assert re.search(r"[.:]($|\s)", text), f"the docstring of {name} has no sentence"


@pytest.mark.parametrize("name", [name for name in MEMBERS if inspect.isfunction(MEMBERS[name])])
def test_a_public_function_says_what_it_takes(name):
    function = MEMBERS[name]
    text = inspect.getdoc(function) or ""
    unknown = [
        parameter
        for parameter in inspect.signature(function).parameters
        if parameter != "self" and not re.search(rf"\b{parameter}\b", text) and parameter not in USUAL.get(name, ())
    ]
    assert not unknown, f"the docstring of {name} does not speak of {unknown}"


USUAL = {
    "EventLog.save": ("path",),
    "load_log": ("path",),
    "gallery": ("name", "parameters"),
    "simulate": ("scene", "command"),
    "Simulation.set_velocity": ("velocity",),
    "Simulation.restore": ("saved",),
}
"""Parameters that their names and types say all about."""


@pytest.mark.parametrize("name", ["Disks", "State", "Scene", "EventLog", "Run"])
def test_what_holds_arrays_tells_their_shapes_or_units(name):
    assert re.search(r"\(N|\(rows|seconds|length", inspect.getdoc(getattr(es, name)) or "")


@pytest.mark.parametrize(
    "name",
    ["load_scene", "load_log", "simulate", "resume", "Simulation.step", "Simulation.advance_to", "Simulation.set_velocity",
     "Simulation.restore", "EventLog.save", "Run.state_at", "Run.animate"],
)  # fmt: skip
def test_what_can_be_refused_tells_the_errors(name):
    assert re.search(r"[Rr]aises?\b", inspect.getdoc(MEMBERS[name]) or "")


def test_errors_have_one_family():
    for name in NAMES:
        value = getattr(es, name)
        if inspect.isclass(value) and issubclass(value, Exception):
            assert issubclass(value, es.EventsimError) or issubclass(value, Warning)


def test_the_engines_tell_their_contract():
    assert {"reference", "fast", "certified"} <= set(es.ENGINES)
    assert "Raises EventsimError" in (inspect.getdoc(type(es.ENGINES["reference"]).run) or "")

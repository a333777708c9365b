"""Short logs to draw."""

import pytest

import eventsim as es
from eventsim.measure.studies import structure


def log_of(name, **stop):
    return es.simulate(es.gallery(name), log=True, **stop).log


@pytest.fixture(scope="session")
def broken():
    """The first second of the break."""
    return log_of("break", until=1.0)


@pytest.fixture(scope="session")
def fluid():
    """A periodic fluid."""
    return log_of("periodic-fluid", events=600)


@pytest.fixture(autouse=True)
def few_states(monkeypatch):
    """Structure is looked at in few states: what it says is tested elsewhere."""
    monkeypatch.setattr(structure, "FEWEST", 2)
    monkeypatch.setattr(structure, "MOST", 2)


@pytest.fixture(scope="session")
def shown_in(fluid):
    """The log that a kind of figure is tried on."""
    billiard = log_of("stadium", events=200)

    def shown(kind):
        if kind == "structure":
            pytest.importorskip("freud", reason="freud is not installed (the extra structure brings it)")
        return billiard if kind == "boundary" else fluid

    return shown


@pytest.fixture(scope="session")
def still():
    """A log in which no time passes."""
    return log_of("break", events=0)

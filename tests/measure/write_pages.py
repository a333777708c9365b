"""Writes what `eventsim measure` says of every gallery scene to tests/measure/pages/: python -m tests.measure.write_pages."""

from pathlib import Path

import eventsim as es
from eventsim.cli.measure import measures_text
from eventsim.scene.gallery import names

PAGES = Path(__file__).parent / "pages"
EVENTS = 600


def page(name):
    """The page of a short run of a scene."""
    measures = es.simulate(es.gallery(name), events=EVENTS, engine="reference", measure=True).measures
    return measures_text(name, measures) + "\n"


if __name__ == "__main__":
    PAGES.mkdir(exist_ok=True)
    for name in names():
        (PAGES / f"{name}.txt").write_text(page(name))

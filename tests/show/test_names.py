"""Names are drawn as they are, letter by letter; dollars make no formula of them."""

import pytest
from matplotlib.text import Text

import eventsim as es
from eventsim.kinds import TITLES
from eventsim.show.animate import animate
from eventsim.show.figures.write import write_figure
from eventsim.show.output import as_written

NAMES = (r"$\frac$", "costs $5 or $6", r"a\$b$", "$", r"$x_1$ and \$", "{$_^$}", "plain")


@pytest.mark.parametrize("name", NAMES)
def test_a_name_is_drawn_letter_by_letter(name):
    text = as_written(name)
    assert Text(text=text)._preprocess_math(text) == (name, False)


@pytest.mark.parametrize("name", [r"$\frac$", "$_^$ and $5"])
def test_no_figure_takes_a_name_for_a_formula(tmp_path, name):
    disks = es.Disks([(1.0, 1.0), (3.0, 1.0)], [(1.0, 0.3), (0.0, 0.0)], 0.5)
    log = es.simulate(es.Scene(disks, es.Box((6.0, 3.0)), name=name), events=60, log=True).log
    for kind in set(TITLES) - {"boundary", "structure"}:  # these are of billiards and of periodic domains
        write_figure(log, kind, tmp_path / f"{kind}.svg")
    animate(log, tmp_path / "a.png")
    animate(log, tmp_path / "a.html")

"""The figure of the series says what is known: energies at their moments, means as steps over their stretches, or a reason."""

import numpy as np
import pytest
from matplotlib.patches import StepPatch

import eventsim as es
from eventsim.measure import measure
from eventsim.show.figures import msd, residuals, series
from eventsim.show.figures.style import falls_by_decades, new_figure

NONE = "1 contact between disks: too few to share the energy"


@pytest.fixture(scope="module")
def pucks():
    """Two disks that meet once in a box."""
    disks = es.Disks([(0.3, 0.5), (1.0, 0.53)], [(0.8, 0.0), (0.0, 0.0)], 0.04, mass=[0.15, 0.25])
    return es.simulate(es.Scene(disks, es.Box((2.0, 1.0))), until=3.0, engine="reference", log=True)


@pytest.fixture(scope="module")
def ball():
    """A ball that falls by one length and bounces without loss."""
    disks = es.Disks([(0.5, 1.05)], radius=0.05, mass=0.1)
    scene = es.Scene(disks, es.Box((1.0, 2.0)), gravity=(0.0, -9.81))
    return es.simulate(scene, until=10.0, engine="reference", log=True)


def drawn(kind, log):
    figure = new_figure()
    kind.draw(figure, log)
    return figure


def words(axes):
    return [text.get_text() for text in axes.texts]


def test_the_energy_of_a_short_run_is_that_of_its_moments(ball):
    axes = drawn(series, ball.log).axes[0]
    kinetic, potential, total = (line.get_ydata() for line in axes.lines)
    assert kinetic.max() == pytest.approx(0.1 * 9.81 * 1.0, rel=1e-9)  # m g h, just before a bounce
    assert potential.min() == pytest.approx(0.1 * 9.81 * 0.05, rel=1e-9)
    assert total == pytest.approx(np.full(len(total), 0.1 * 9.81 * 1.05), rel=1e-9)
    assert axes.get_yscale() == "linear"
    assert "potential, 0 at y = 0" in [text.get_text() for text in axes.get_legend().get_texts()]


def test_means_are_steps_over_their_stretches(pucks):
    figure = drawn(series, pucks.log)
    (steps,) = (patch for patch in figure.axes[1].patches if isinstance(patch, StepPatch))
    values, edges, _ = steps.get_data()
    found = measure(pucks.log, discard=0.0).series
    assert edges.tolist() == [0.0, *found.time]
    (seen,) = np.flatnonzero(values)
    assert edges[seen] < pucks.log.time[pucks.log.b >= 0][0] <= edges[seen + 1]
    assert f"means over stretches of {edges[1]:.3g} time units" in figure.get_suptitle()


def test_a_figure_has_no_temperature_pressure_or_d_where_measure_has_none(pucks, ball):
    figure = drawn(series, pucks.log)
    assert [axes.get_ylabel() for axes in figure.axes] == ["kinetic energy", "contacts of a disk\nwith others / time"]
    assert f"no temperature and no pressure: {NONE}" in figure.get_suptitle()
    below = drawn(msd, pucks.log).axes[1]
    assert not below.lines[0].get_ydata().size
    assert words(below) == ["no D: 1 contact between disks: too few to share the energy"]
    figure = drawn(series, ball.log)
    assert len(figure.axes) == 1
    assert "no collision rate: a disk has no others to meet" in figure.get_suptitle()


@pytest.mark.parametrize(
    ("values", "falls"),
    [([8.0, 2.0, 0.5, 0.1], True), ([8.0, 0.1, 8.0, 0.1], False), ([8.0, 4.0, 2.0], False), ([8.0, 0.1, 0.0], False)],
)
def test_a_logarithmic_axis_is_for_what_falls_by_decades(values, falls):
    assert falls_by_decades(np.array(values)) is falls


def test_residuals_end_with_what_the_run_says(pucks, ball):
    for run in (pucks, ball):
        above, below = drawn(residuals, run.log).axes
        assert above.lines[0].get_ydata()[-1] == run.residuals.energy
    assert f"changed by {run.residuals.energy:.1e} of itself" in above.get_title(loc="left")
    assert words(below) == ["no contacts between disks"]
    assert not below.get_yticks().size


def test_a_fall_along_a_period_has_a_kinetic_energy_alone():
    """Places jump by a period there, and an energy of places with them."""
    scene = es.Scene(es.Disks([(0.5, 0.5)], radius=0.05), es.Periodic((1.0, 1.0)), gravity=(0.0, -1.0))
    log = es.simulate(scene, until=3.0, engine="reference", log=True).log
    (kinetic,) = drawn(series, log).axes[0].lines
    assert kinetic.get_ydata()[-1] == pytest.approx(4.5)  # m g^2 t^2 / 2
    assert "kinetic energy from 0 to 4.5" in drawn(residuals, log).axes[0].get_title(loc="left")

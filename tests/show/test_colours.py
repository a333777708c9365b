"""A disk has one colour in films, figures, pages and the live view, and its species one name."""

import numpy as np
import pytest
from matplotlib.colors import to_rgba

import eventsim as es
from eventsim.show.colouring import colouring_of, measured_labels, own_colours, shades_of, species_labels
from eventsim.show.figures import space_time, speeds, trajectories
from eventsim.show.figures.style import new_figure
from eventsim.show.overview import overview_of
from eventsim.show.player.pack import packed


def log_of(mass, species=None):
    """Disks in a row of which the first comes to the others."""
    place = [(0.3 + k, 0.5) for k in range(len(mass))]
    velocity = [(0.8, 0.1), *[(0.0, 0.0)] * (len(mass) - 1)]
    disks = es.Disks(place, velocity, 0.04, mass=mass, species=species)
    return es.simulate(es.Scene(disks, es.Box((len(mass) + 1.0, 1.0))), until=3.0, engine="reference", log=True).log


@pytest.mark.parametrize("mass", [[0.15, 0.25], [1.0, 1.0, 1.0]], ids=["species", "equal disks"])
def test_films_and_figures_have_the_same_colours(mass):
    log = log_of(mass)
    stage = packed(log)[0]["stage"]
    film = colouring_of(stage["own"], log.scene.disks, overview_of(log)).paint(None)
    assert film.tolist() == own_colours(log.scene.disks).tolist()
    figure = new_figure()
    trajectories.draw(figure, log)
    ends = figure.axes[0].collections[3]  # behind them rings mark the starts
    assert ends.get_facecolor()[:, :3].tolist() == film[:, :3].tolist()
    figure = new_figure()
    space_time.draw(figure, log)
    drawn = {tuple(colour) for colour in figure.axes[0].collections[0].get_colors()}
    assert drawn == {tuple(colour) for colour in film.tolist()}
    # the page takes the same of its kinds
    species = np.array([1, 0]) if stage["own"] == "species" else np.arange(len(mass))
    assert [to_rgba(stage["kinds"][k]) for k in species] == [tuple(colour) for colour in film.tolist()]


def test_a_species_is_called_as_it_was_declared_or_by_radius_and_mass():
    log = log_of([0.15, 0.25])
    figure = new_figure()
    speeds.draw(figure, log)
    assert measured_labels(log.scene) == list(species_labels(log.scene.disks))[::-1]  # the lightest first, as `measure` has it
    told = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert told == ["r 0.04, m 0.15", "r 0.04, m 0.25"]
    named = log_of([0.15, 0.25], ["light", "heavy"])
    assert [name for name, _ in species_labels(named.scene.disks)] == ["heavy", "light"]


def test_many_disks_share_a_scale():
    shades = shades_of(50)
    assert len(np.unique(shades, axis=0)) == 50
    log = log_of([1.0] * 9)
    assert colouring_of("index", log.scene.disks, overview_of(log)).key.high == 8.0

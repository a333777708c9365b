"""Pictures of the open plane hold all flights: tops of parabolas, and what happens until the end of the run."""

import numpy as np
import pytest

import eventsim as es
from eventsim.replay.passage import Passage
from eventsim.show.figures import trajectories
from eventsim.show.figures.style import new_figure
from eventsim.show.picture import Look, Picture
from eventsim.show.player.pack import packed
from eventsim.show.window import FAR, window_of

THROWN = es.Disks([(0.0, 0.0)], [(3.0, 4.0)], 0.05)
FLOOR = es.Segment((-1.0, -0.05), (8.0, -0.05))
SCENES = {
    "free throw": (es.Scene(THROWN, es.Open(), gravity=(0.0, -9.81)), 1.0),
    "throw onto a floor": (es.Scene(THROWN, es.Open(), [FLOOR], gravity=(0.0, -9.81), restitution=0.7), 1.5),
    "a miss": (es.Scene(es.Disks([(0.0, 0.0), (1.0, 0.5)], [(1.0, 0.0), (-1.0, 0.0)], 0.05), es.Open()), 5.0),
}


@pytest.mark.parametrize("name", SCENES)
def test_the_window_holds_all_disks_at_all_times(name):
    scene, until = SCENES[name]
    log = es.simulate(scene, until=until, engine="reference", log=True).log
    passage = Passage(log)
    x0, y0, x1, y1 = window_of(passage)
    places = np.concatenate([state.position for state in passage.states(np.linspace(0.0, until, 301).tolist())])
    low, high = places.min(axis=0) - 0.05, places.max(axis=0) + 0.05
    assert (low > (x0, y0)).all()
    assert (high < (x1, y1)).all()
    assert y1 - high[1] < 0.2  # and little more
    assert packed(log)[0]["stage"]["shown"] == (x0, y0, x1, y1)
    width, height = Picture(passage, Look(), (520, 440), np.array([0.0, until])).layout.scene[2:]
    assert width / height == pytest.approx((x1 - x0) / (y1 - y0))
    figure = new_figure()
    trajectories.draw(figure, log)
    assert (*figure.axes[0].get_xlim(), *figure.axes[0].get_ylim()) == (x0, x1, y0, y1)


def test_disks_that_leave_after_many_contacts_do_not_make_the_rest_small():
    """Between two walls a disk bounces many times; the other one leaves through the open ends."""
    walls = [es.Segment((0.0, 0.0), (2.0, 0.0)), es.Segment((0.0, 1.0), (2.0, 1.0))]
    disks = es.Disks([(0.5, 0.5), (1.5, 0.5)], [(0.0, 1.0), (1.0, 0.0)], 0.1)
    passage = Passage(es.simulate(es.Scene(disks, es.Open(), walls), until=40.0, engine="reference", log=True).log)
    x0, _, x1, _ = window_of(passage)
    assert x0 > -0.2
    assert 3.0 < x1 < 2.0 + FAR * 2.0 + 0.2
    assert window_of(passage, until=2.0)[2] == pytest.approx(3.6, abs=0.1)

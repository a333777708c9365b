"""Figures: every kind of every scene, and the numbers in them."""

import itertools
from contextlib import suppress

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import eventsim as es
from eventsim.errors import EventsimError
from eventsim.kinds import TITLES
from eventsim.measure import measure
from eventsim.measure.free_paths import free_paths, path_density
from eventsim.replay.flight_table import flight_table, flights
from eventsim.replay.replay import Replay
from eventsim.scene.gallery import names
from eventsim.show.figures import equation_of_state, msd, swept, trajectories
from eventsim.show.figures.residuals import gaps_at_contact
from eventsim.show.figures.style import new_figure
from eventsim.show.figures.write import write_figure
from eventsim.show.images import wrapped_pieces
from eventsim.show.output import name_of
from tests.measure.ways import displacements

DRAWN = [
    (suffix, kind) if suffix == ".png" or kind in ("speeds", "space-time") else pytest.param(suffix, kind, marks=pytest.mark.slow)
    for suffix in (".png", ".svg", ".pdf")
    for kind in TITLES
]


@pytest.mark.parametrize(("suffix", "kind"), DRAWN)
def test_every_kind_is_written_in_every_format(shown_in, tmp_path, kind, suffix):
    path = tmp_path / f"a{suffix}"
    write_figure(shown_in(kind), kind, path)
    first = path.read_bytes()
    write_figure(shown_in(kind), kind, path)
    assert path.read_bytes() == first  # a figure depends on the log alone
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.slow
@pytest.mark.parametrize("kind", TITLES)
@pytest.mark.parametrize("name", names())
def test_every_scene_gives_a_figure_or_a_sentence(tmp_path, kind, name):
    log = es.simulate(es.gallery(name), events=200, log=True).log
    with suppress(EventsimError):
        write_figure(log, kind, tmp_path / "a.png")
        return
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("kind", TITLES)
def test_an_empty_log_is_one_sentence(still, tmp_path, kind):
    with pytest.raises(EventsimError, match="nothing to draw"):
        write_figure(still, kind, tmp_path / "a.png")
    assert list(tmp_path.iterdir()) == []


def test_an_unknown_kind_or_suffix_is_one_sentence(fluid, tmp_path):
    with pytest.raises(EventsimError, match="speeds"):
        write_figure(fluid, "speed", tmp_path / "a.png")
    with pytest.raises(EventsimError, match=r"\.svg"):
        write_figure(fluid, "speeds", tmp_path / "a.jpg")


def test_flights_lead_from_contact_to_contact(fluid):
    replay = Replay(fluid)
    table = flight_table(replay)
    assert len(table.disk) == len(fluid) + (fluid.b >= 0).sum() + replay.stage.n
    assert table.duration.sum() == pytest.approx(replay.stage.n * (replay.span[1] - replay.span[0]), rel=1e-12)
    reached = table.place + table.duration[:, None] * table.velocity
    inner = np.flatnonzero(~table.first)
    size = np.array(fluid.scene.domain.size)
    apart = reached[inner - 1] - table.place[inner]
    assert np.abs(apart - size * np.round(apart / size)).max() < 1e-12


def test_displacements_are_those_of_the_states(broken):
    replay = Replay(broken)
    times = np.linspace(*replay.span, 9)
    table = flight_table(replay)
    for disk in (0, 3, 15):
        way = displacements(table, disk, times)
        states = np.array([replay.state_at(time).position[disk] for time in times])
        assert np.abs(way - (states - states[0])).max() < 1e-12


def test_a_piece_across_a_periodic_boundary_is_drawn_in_both_images():
    ends, disk = wrapped_pieces(np.array([[[8.0, 1.0], [13.0, 2.0]]]), np.array([4]), (10.0, None), (0.0, 0.0))
    assert ends[:, :, 0].tolist() == [[8.0, 13.0], [-2.0, 3.0]]
    assert disk.tolist() == [4, 4]


def test_theory_of_free_paths_is_a_density_with_mean_one():
    x = np.linspace(0.0, 60.0, 6001)
    density = path_density(x)
    assert density.sum() * 0.01 == pytest.approx(1.0, abs=1e-2)
    assert (x * density).sum() * 0.01 == pytest.approx(1.0, abs=2e-2)


def test_measured_free_paths_agree_with_kinetic_theory():
    log = es.simulate(es.gallery("periodic-fluid"), events=6000, log=True).log
    paths = np.concatenate(list(free_paths(flights(Replay(log)), len(log.scene.disks))))
    told = measure(log)["mean_free_path"]
    error = paths.std() / np.sqrt(len(paths))
    # flights that the run cuts off are not among the paths: about one in 50
    assert paths.mean() == pytest.approx(told.theory, abs=3 * error + 0.02 * paths.mean())


def test_gaps_at_contact_are_nought_to_rounding(fluid):
    time, gap = (np.concatenate(parts) for parts in zip(*gaps_at_contact(Replay(fluid)), strict=True))
    assert len(time) == (fluid.b >= 0).sum()
    assert np.abs(gap).max() < 1e-12


@pytest.mark.parametrize("kind", TITLES)
def test_no_text_is_cut_off_or_printed_over_another(shown_in, kind):
    from importlib import import_module

    from matplotlib.backends.backend_agg import FigureCanvasAgg

    from eventsim.show.figures.style import new_figure

    figure: Figure = new_figure()
    canvas = FigureCanvasAgg(figure)
    import_module(f"eventsim.show.figures.{kind.replace('-', '_')}").draw(figure, shown_in(kind))
    canvas.draw()
    shown = figure.bbox
    for axes in figure.axes:
        texts = [axes.xaxis.label, axes.yaxis.label, axes.title, axes._left_title]
        for text in (text for text in texts if text.get_text()):
            box = text.get_window_extent()
            assert box.x0 >= shown.x0 - 1
            assert box.x1 <= shown.x1 + 1
            assert box.y0 >= shown.y0 - 1
            assert box.y1 <= shown.y1 + 1


def sweep_row(eta, z, error, theory, accuracy):
    given = {"packing_fraction": eta, "replica": 0, "disks": 64, "Z": z, "Z_error": error, "equilibrated": True}
    return given | {"Z_theory": theory, "Z_accuracy": accuracy}


def swept_row(count, eta, disks):
    return {"packing_fraction": eta, "n": count, "replica": 0, **sweep_row(eta, 2.0, 0.1, None, None), "disks": disks}


def test_a_title_names_the_scene_or_else_the_file(still, tmp_path):
    assert name_of(still) == still.scene.called
    run = es.simulate(es.Scene(es.Disks([(1.0, 1.0)], [(1.0, 0.5)], 0.5), es.Box((4.0, 3.0))), until=20.0, log=True)
    assert name_of(run.log) == "a scene without a name"
    run.log.save(tmp_path / "mine.csv")
    read = es.load_log(tmp_path / "mine.csv")
    assert name_of(read) == "mine"
    figure = new_figure()
    trajectories.draw(figure, read)
    assert f"{len(read)} events (dots)" in figure.axes[0].get_title(loc="left")


@pytest.mark.parametrize("size", [(400_000.0, 3.0), (3.0, 400_000.0), (40.0, 1.5)])
def test_ticks_of_a_very_flat_or_narrow_box_do_not_overlap(size):
    scene = es.Scene(es.Disks([(1.0, 0.8)], [(1.0, 0.5)], 0.5), es.Box(size))
    figure = new_figure()
    FigureCanvasAgg(figure)
    trajectories.draw(figure, es.simulate(scene, until=2.0, log=True).log)
    figure.canvas.draw()
    axes = figure.axes[0]
    for axis, (low, high) in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
        shown = [one.label1.get_window_extent() for one in axis.get_major_ticks() if low <= one.get_loc() <= high]
        assert shown
        assert not any(one.overlaps(other) for one, other in itertools.pairwise(shown))


def test_a_second_key_of_a_sweep_has_its_own_series():
    rows = [swept_row(n, eta, n) for eta in (0.1, 0.2) for n in (16, 64)]
    assert [words for words, _ in equation_of_state.series_of(rows)] == ["n = 16", "n = 64"]
    figure = Figure()
    equation_of_state.draw(figure, rows)
    above = figure.axes[0]
    assert [text.get_text() for text in above.get_legend().get_texts()][1:] == ["n = 16", "n = 64"]
    assert "the curve is that of the fluid without walls" in above.get_title(loc="left")
    assert [words for words, _ in equation_of_state.series_of(rows[::2])] == [""]


def test_replicas_are_averaged_and_theory_keeps_its_accuracy():
    rows = [
        sweep_row(0.3, 2.0, 0.1, 2.06, 0.01),
        sweep_row(0.3, 2.2, 0.1, 2.06, 0.01),
        sweep_row(0.7, 9.0, 0.1, 9.1, np.nan),
    ]
    eta, z, error, theory, accuracy, settled = equation_of_state.averages(rows)
    assert eta.tolist() == [0.3, 0.7]
    assert z == pytest.approx([2.1, 9.0])
    assert error == pytest.approx([0.1 / np.sqrt(2.0), 0.1])
    assert theory == pytest.approx([2.06, 9.1])
    assert accuracy[0] == 0.01
    assert np.isnan(accuracy[1])
    assert settled.all()
    figure = Figure()
    equation_of_state.draw(figure, rows)
    (off,) = figure.axes[1].lines[1].get_ydata()  # a guide is not compared with
    assert off == pytest.approx((2.1 - 2.06) / np.hypot(0.1 / np.sqrt(2.0), 0.01))


def test_any_measure_of_a_sweep_is_drawn_against_any_key():
    rows = [
        {"e": e, "n": n, "replica": k, "rate": n * e + k, "energy": 10.0 * e + 2.0 * k, "rate_error": 1.0 + k}
        for e in (0.9, 0.8)
        for n in (16, 64)
        for k in (0, 1)
    ]
    figure = Figure()
    swept.draw(figure, rows, None, "rate", "mine")
    (axes,) = figure.axes
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["n = 16", "n = 64"]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("e", "rate")
    series = [line for line in axes.lines if line.get_marker() == "o"]
    assert series[0].get_xdata().tolist() == [0.8, 0.9]
    assert series[0].get_ydata() == pytest.approx([16 * 0.8 + 0.2, 16 * 0.9 + 0.2])  # weights 1 and 1 / 4
    e, mean, error, theory = swept.averages(rows[:2], "e", "energy")
    assert (e.tolist(), mean.tolist(), error.tolist()) == ([0.9], [10.0], [pytest.approx(1.0)])  # the scatter of 9 and 11
    assert np.isnan(theory).all()
    with pytest.raises(EventsimError, match=r"--y energi: .*did you mean 'energy'\?.* there are e, n, rate, energy$"):
        swept.draw(Figure(), rows, None, "energi")
    with pytest.raises(EventsimError, match="has both e and late"):
        swept.draw(Figure(), [*rows, {"late": 1.0}], "e", "late")


def test_disks_that_nothing_deflects_have_no_mean_squared_displacement(tmp_path):
    scene = es.Scene(es.Disks([[1.0, 1.0]], [[1.0, 0.0]], 0.1, mass=np.inf), es.Box((2.0, 2.0)))
    log = es.simulate(scene, until=3.0, log=True).log
    with pytest.raises(EventsimError, match="0 finite masses"):
        write_figure(log, "msd", tmp_path / "a.png")


@pytest.mark.parametrize("unit", [1e-100, 1e100])
def test_displacements_are_squared_in_any_unit_of_length(tmp_path, unit):
    disks = es.Disks(unit * np.array([[0.2, 0.3], [0.7, 0.6]]), [[1.0, 0.3], [-1.0, 0.2]], 0.1 * unit)
    log = es.simulate(es.Scene(disks, es.Periodic((unit, unit))), until=30.0 * unit, log=True).log
    write_figure(log, "msd", tmp_path / "a.png")


def test_displacements_in_the_figure_are_those_that_are_measured():
    fluid = es.simulate(es.gallery("periodic-fluid"), events=3000, log=True).log  # mixed, so that theory stands beside
    figure = new_figure()
    msd.draw(figure, fluid)
    found = measure(fluid).correlations
    above, below = figure.axes
    assert above.lines[0].get_xydata().tolist() == np.column_stack([found.lag, found.msd]).tolist()
    assert set(below.lines[0].get_ydata()) <= set(found.diffusion)
    assert [text.get_text() for text in below.get_legend().get_texts()] == ["Enskog, kT / (m rate)"]


def test_one_event_is_called_one_event():
    disks = es.Disks([[0.0, 0.0], [10.0, 0.0]], [[1.0, 0.0], [0.0, 0.0]], 0.5)
    figure = new_figure()
    trajectories.draw(figure, es.simulate(es.Scene(disks, es.Open()), until=20.0, log=True).log)
    assert ", 1 event (" in figure.axes[0].get_title(loc="left")


def test_trajectories_mark_where_disks_began_and_say_which_are_drawn():
    n = 40
    disks = es.Disks([[0.3 + 0.2 * k, 0.5] for k in range(n)], [[0.0, 0.3 + 0.01 * k] for k in range(n)], 0.05)
    figure = new_figure()
    trajectories.draw(figure, es.simulate(es.Scene(disks, es.Box((9.0, 1.0))), until=5.0, log=True).log)
    axes = figure.axes[0]
    assert "the paths of disks 0, 2, 5, ..., 39 (16 of 40)" in axes.get_title(loc="left")
    rings = next(one for one in axes.collections if one.get_zorder() == 3.5)
    middles = [path.get_extents().get_points().mean(axis=0) for path in rings.get_paths()]
    chosen = np.unique(np.linspace(0, n - 1, 16).astype(int))
    assert np.allclose(middles, disks.position[chosen], atol=1e-12)


BALL = {
    "gravity": [0.0, -1.0],
    "restitution": 0.9,
    "until": 6.0,
    "domain": {"kind": "box", "size": [1.0, 2.0]},
    "disk": [{"position": [0.5, 1.0], "radius": 0.1}],
}


def test_a_single_ball_has_no_temperature_in_a_profile_as_in_measure():
    from eventsim.scene.files import scene_from_dict

    log = es.simulate(scene_from_dict(BALL), log=True).log
    measures = measure(log, profile="y")
    (refused,) = [one.doubt for one in measures.quantities if one.name == "temperature"]
    assert measures.profile.no_temperature is not None
    assert np.isnan(measures.profile.species[0].temperature).all()
    figure = drawn(log, "profile")
    above, below = figure.axes
    assert not below.containers
    told = " ".join(" ".join(text.get_text() for text in below.texts).split())
    assert refused in told
    assert "temperature" not in above.get_title()


def test_space_time_of_a_ball_is_its_height_and_of_few_disks_has_a_legend():
    from eventsim.scene.files import scene_from_dict

    ball = drawn(es.simulate(scene_from_dict(BALL), log=True).log, "space-time").axes[0]
    assert ball.get_ylabel().startswith("y")
    assert "between disks" not in ball.get_title()
    assert ball.get_legend() is None
    pair = drawn(es.simulate(es.gallery("two-disks"), events=20, log=True).log, "space-time").axes[0]
    assert [text.get_text() for text in pair.get_legend().get_texts()] == ["disk 0", "disk 1"]


def drawn(log, kind):
    from importlib import import_module

    figure = new_figure()
    import_module(f"eventsim.show.figures.{kind.replace('-', '_')}").draw(figure, log)
    return figure

"""A comparison and a chart from end to end, on scenes that take seconds; and what they come to."""

import csv
import json
import math
import re
import struct
import time
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from click.testing import CliRunner
from matplotlib.figure import Figure

import eventsim as es
from eventsim.cli.program import main
from eventsim.engines import ENGINES
from eventsim.engines.stepped.stepped import FixedStepSession
from eventsim.scene.stage import stage_of
from eventsim.scene.writing import scene_to_toml
from eventsim.show.versus.losses import NONE, draw_energy, draw_missed
from eventsim.validation.advantages import Advantage, advantages, cell, table
from eventsim.validation.chart import Chaos, Chart, chart_of
from eventsim.validation.compare import compare
from eventsim.validation.competitors import COMPETITORS, able, chosen_competitors
from eventsim.validation.conclusions import conclusions
from eventsim.validation.pile import pile, unrest
from eventsim.validation.precision import Curves, Point, Task, _event_driven, curves
from eventsim.validation.table import chart_rows, comparison_rows, write_csv
from eventsim.validation.verdict import verdict
from tests.benchmarks.stopwatches import own_loop


@pytest.fixture(scope="module", autouse=True)
def no_compiler():
    """The reference engine alone: these scenes are small, and its log is that of the fast one."""
    with pytest.MonkeyPatch.context() as patch:
        for home in ("eventsim.engines.auto", "eventsim.validation.truth", "eventsim.validation.precision"):
            patch.setattr(f"{home}.has_compiler", lambda: False)
        yield


@pytest.fixture(scope="module")
def gas(no_compiler):
    scene = es.gallery("gas", n=60)
    return compare(
        scene, chosen_competitors(["frames", "stepped", "stepped-located"]), steps=(0.02, 0.002, 0.0005), until=0.4
    )


def test_a_comparison_is_its_verdict_in_print(gas, monkeypatch):
    assert len(repr(gas)) < 200
    monkeypatch.setattr("eventsim.judged.compare", lambda *asked: gas)
    found = es.validate(es.gallery("gas", n=60), against="frames")
    assert str(found).splitlines() == verdict(gas)
    assert verdict(gas)[0] in repr(found)
    assert chosen_competitors("frames") == chosen_competitors(["frames"])


def test_energy_looks_perfect_while_contacts_go_missing(gas):
    coarse = next(line for line in gas.lines if line.label == "frames")
    assert abs(coarse.energy) < 1e-13
    assert coarse.census.share(coarse.census.missed) > 0.05
    assert coarse.census.angle > 1.0
    assert verdict(gas)[0].startswith("Energy hides it")


def test_finer_steps_find_more_contacts_and_stay_nearer_to_the_truth(gas):
    for label in ("frames", "stepped", "stepped-located"):
        lines = [line for line in gas.lines if line.label == label]
        shares = [line.census.share(line.census.found) for line in lines]
        assert shares[0] < shares[-1]
        assert shares[-1] > 0.97
        assert lines[-1].errors[1] < lines[0].errors[1]
    assert gas.agrees
    assert gas.truth.horizon > 0.0


def test_located_impacts_have_exact_angles(gas):
    located = [line for line in gas.lines if line.label == "stepped-located"]
    assert all(line.census.angle < 1e-8 for line in located)


def test_the_table_has_a_row_for_each_run_and_plain_numbers(gas, tmp_path):
    rows = comparison_rows(gas)
    assert len(rows) == 1 + 9
    write_csv(tmp_path / "gas.csv", rows, ["# scene: gas"])
    text = (tmp_path / "gas.csv").read_text().splitlines()
    read = list(csv.DictReader(line for line in text if not line.startswith("#")))
    assert [row["engine"] for row in read] == [row["engine"] for row in rows]
    assert float(read[1]["dt"]) == 0.02


def test_patience_bounds_the_event_driven_run_too():
    """A scene of years: what comes after the first seconds of computing is left out, and said to be."""
    scene = es.gallery("gas", n=60)
    whole = compare(scene, chosen_competitors(["stepped"]), steps=(0.02,), until=0.05)
    assert not any("event-driven" in sentence for sentence in whole.left_out)
    cut = compare(scene, chosen_competitors(["stepped"]), steps=(0.02,), until=1e9, patience_s=0.01)
    assert cut.truth.times[-1] < 1e3
    assert (
        f"what comes after t = {cut.truth.times[-1]:g} is left out: the event-driven run took 0.1 s" in cut.left_out[0]
    )


def test_what_a_library_does_first_is_charged_to_nobody(monkeypatch):
    """An engine that loads for 0.3 s in its first step keeps all its steps, and its true time."""
    step, loaded = FixedStepSession._run, []

    def slow_at_first(session, steps, most_events):
        if steps and not loaded:
            loaded.append(True)
            begun = time.thread_time()
            while time.thread_time() < begun + 0.3:
                pass
        return step(session, steps, most_events)

    monkeypatch.setattr(FixedStepSession, "_run", slow_at_first)
    found = compare(es.gallery("two-disks"), chosen_competitors(["stepped"]), steps=(0.2, 0.1), until=12.0, patience_s=0.2)
    assert loaded
    assert found.left_out == []
    assert [line.dt for line in found.lines] == [0.2, 0.1]
    assert all(line.elapsed * 12.0 < 0.1 for line in found.lines)
    assert all(0.0 < line.timing.least <= line.elapsed <= line.timing.most for line in found.lines)


def test_positions_are_looked_at_from_the_first_contact_on():
    """Galperin's disks meet late and all at once: who misses most of 31 contacts is not where the others are."""
    found = compare(es.gallery("galperin"), chosen_competitors(["frames"]), steps=(1.0,))
    (line,) = found.lines
    first = found.truth.run.rows["time"][0]
    assert all(check > first for check in found.checks)
    assert line.census.share(line.census.missed) > 0.5
    assert min(line.errors[1:]) > 0.01


def test_no_step_is_dropped_without_a_line():
    found = compare(es.gallery("gas", n=60), chosen_competitors(["stepped"]), steps=(0.02, 1e-6), until=0.2, patience_s=0.05)
    (sentence,) = found.left_out
    assert "stepped with dt = 1e-06 is left out" in sentence
    assert found.settings == {"stepped": "locate False"}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scene", "dt", "until"),
    [(es.gallery("break"), 1.0 / 240.0, 4.0), (es.gallery("gas", n=100), 0.02, 0.08)],
    ids=["many steps", "four steps"],
)
def test_the_time_of_pymunk_is_that_of_a_loop_of_ones_own(scene, dt, until):
    """What is asked of an engine before and after its steps was charged to it: of four steps up to .8 of their time."""
    pytest.importorskip("pymunk")
    own = min(own_loop(scene, dt, round(until / dt)))  # the least: others who use the machine only add to it
    (line,) = compare(scene, chosen_competitors(["pymunk"]), steps=(dt,), until=until).lines
    assert line.timing.least == pytest.approx(own, rel=0.3)
    found = curves(Task("own", scene, "trajectory", until), [COMPETITORS["pymunk"]], patience_s=1.0).of("pymunk")
    nearest = min(found, key=lambda point: abs(math.log(point.value / dt)))
    if until > 10.0 * dt:  # then its time goes with the number of steps
        assert nearest.least * nearest.value == pytest.approx(own * dt, rel=0.3)


def test_a_contact_at_the_very_end_is_nobodys_mistake():
    disks = es.Disks([[0.5, 0.5], [1.5, 0.5]], [[1.0, 0.0], [0.0, 0.0]], 0.1)
    scene = es.Scene(disks, es.Box((2.0, 1.0)))
    rows = es.simulate(scene, until=10.0, log=True).log
    end = float(rows.time[rows.b >= 0][2])  # a pair meets just then
    comparison = compare(scene, chosen_competitors(["stepped"]), [0.03], end)
    (line,) = comparison.lines
    assert comparison.exact.pair_contacts == line.pair_contacts + 1
    assert (line.rate, line.ratio) == (0.0, 1.0)
    whole = compare(scene, chosen_competitors(["stepped"]), [0.03], end + 0.5)
    assert whole.lines[0].pair_contacts == whole.exact.pair_contacts == 3
    assert whole.lines[0].ratio == 1.0


def test_an_interrupt_leaves_what_was_reached():
    """The second step is not begun; before the first one is over there is nothing to tell."""

    def interrupt(after):
        begun = iter(range(10))

        def tell(text):
            if "dt =" in text and next(begun) == after:
                raise KeyboardInterrupt

        return tell

    scene = es.gallery("two-disks")
    found = compare(scene, chosen_competitors(["stepped"]), (0.1, 0.05), tell=interrupt(1), keeps=True)
    assert found.interrupted
    assert [line.dt for line in found.lines] == [0.1]
    assert found.left_out[-1] == "what was not reached is left out: it was interrupted"
    assert verdict(found)
    for after, keeps in ((0, True), (1, False)):
        with pytest.raises(KeyboardInterrupt):
            compare(scene, chosen_competitors(["stepped"]), (0.1, 0.05), tell=interrupt(after), keeps=keeps)


@pytest.mark.parametrize("compiles", [True, False])
def test_both_event_driven_engines_are_charted_however_small_the_scene(compiles, monkeypatch):
    """One that is left out is told."""
    monkeypatch.setattr("eventsim.validation.precision.has_compiler", lambda: compiles)
    monkeypatch.setitem(ENGINES, "fast", ENGINES["reference"])  # which needs no time to be loaded
    found = Curves(Task("two", es.gallery("two-disks"), "trajectory", 6.0))
    labels = [runner.label for (runner,) in _event_driven(stage_of(found.task.scene), lambda run, session: 0.0, found)]
    assert labels == ["reference", "fast"][: 1 + compiles]
    assert [text.partition(":")[0] for text in found.left_out] == ([] if compiles else ["fast is left out"])


def interrupt_at(beginning):
    def tell(text):
        if text.startswith(beginning):
            raise KeyboardInterrupt

    return tell


def test_an_interrupted_chart_keeps_the_engines_that_were_timed(monkeypatch):
    two = {name: COMPETITORS[name] for name in ("stepped", "stepped-located")}
    monkeypatch.setattr("eventsim.validation.chart.COMPETITORS", two)
    monkeypatch.setattr("eventsim.validation.timing.WARM_S", 0.01)
    task = Task("two", es.gallery("two-disks"), "trajectory", 6.0)
    chart = chart_of([task, replace(task, name="later")], 0.01, False, interrupt_at("two: stepped-located, dt"), keeps=True)
    (found,) = chart.tasks
    assert {"reference", "stepped"} <= set(found.labels)
    assert "stepped-located" not in found.labels
    assert all(math.isfinite(point.most) for point in found.points)
    assert chart.interrupted
    assert chart.left_out[-1] == "what was not reached is left out: it was interrupted"
    with pytest.raises(KeyboardInterrupt):
        chart_of([task], 0.01, False, interrupt_at("two: reference"), keeps=True)
    with pytest.raises(KeyboardInterrupt):
        chart_of([task], 0.01, False, interrupt_at("two: stepped,"))


@pytest.mark.parametrize(("reached", "said"), [(True, "what was not reached is left out"), (False, "nothing is written")])
def test_ctrl_c_while_a_chart_measures_is_told(reached, said, tmp_path, monkeypatch):
    def measure(*_, keeps, **__):
        if not reached:
            raise KeyboardInterrupt
        return replace(a_chart(), interrupted=keeps)

    monkeypatch.setattr("eventsim.validation.chart.chart_of", measure)
    done = CliRunner().invoke(main, ["chart", "two-disks", "--out", str(tmp_path / "two.png")])
    assert done.exit_code == 130
    assert said in done.output
    assert sorted(path.name for path in tmp_path.iterdir()) == (["two.csv", "two.png"] if reached else [])


def test_an_unknown_engine_is_named_with_those_that_there_are():
    with pytest.raises(es.EventsimError, match="no engine 'step' to compare with; there are frames"):
        chosen_competitors(["step"])


def test_who_cannot_take_part_is_left_out_with_one_sentence():
    ready, sentences = able(list(COMPETITORS.values()), stage_of(es.gallery("periodic-fluid", n=16)))
    assert "frames" not in [competitor.label for competitor in ready]
    assert len([text for text in sentences if "frames" in text]) == 1


def test_a_scene_without_contacts_has_nothing_to_compare():
    scene = es.Scene(es.Disks([(0, 0)], [(1, 0)], radius=1.0), es.Open(), until=1.0)
    with pytest.raises(es.EventsimError, match="there is nothing to compare"):
        compare(scene, chosen_competitors(["stepped"]))


def test_a_pile_at_rest_has_no_unrest():
    stage = stage_of(pile())
    assert unrest(stage, pile().disks.position, np.zeros((stage.n, 2))) < 1e-15
    assert unrest(stage, pile().disks.position, np.ones((stage.n, 2))) == pytest.approx(math.sqrt(2.0))
    assert unrest(stage, pile().disks.position - (0.0, 0.5), np.zeros((stage.n, 2))) == pytest.approx(0.3)


def test_the_truth_of_a_chart_is_certified_where_it_can_be():
    pytest.importorskip("flint")
    task = Task("two", es.gallery("two-disks", mass_ratio=3.0), "trajectory", 6.0)
    found = curves(task, [COMPETITORS["stepped"]], patience_s=0.3)
    assert {"reference", "certified", "stepped"} <= set(found.labels)
    assert all(point.error < 1e-12 for point in found.of("reference"))
    stepped = found.of("stepped")
    assert stepped[-1].error < stepped[0].error
    assert all(point.steps > 0 and point.elapsed > 0.0 for point in stepped)


def test_without_flint_its_curve_is_left_out_with_one_sentence(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "flint", None)
    for name in [name for name in __import__("sys").modules if name.startswith("eventsim.engines.certified")]:
        monkeypatch.delitem(__import__("sys").modules, name)
    task = Task("two", es.gallery("two-disks", mass_ratio=3.0), "trajectory", 6.0)
    found = curves(task, [COMPETITORS["stepped"]], patience_s=0.1)
    assert "certified" not in found.labels
    assert len([text for text in found.left_out if "certify" in text]) == 1


def test_without_pymunk_its_curve_is_left_out_with_one_sentence(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "pymunk", None)
    found = curves(Task("two", es.gallery("two-disks"), "trajectory", 6.0), [COMPETITORS["pymunk"]], patience_s=0.01)
    assert "reference" in found.labels
    assert "pymunk" not in found.labels
    assert [text for text in found.left_out if "pymunk" in text] == [
        "pymunk is left out: the engine pymunk needs the Chipmunk engine, which is not installed: "
        "pip install 'eventsim-disks[pymunk]'"
    ]


def a_chart():
    """A chart by hand: the event-driven engine wins on the gas by 10 and loses on the pile by 5."""

    def points(name, measure, label, *pairs):
        return [Point(name, measure, label, "dt", 0.1, error, elapsed) for elapsed, error in pairs]

    box = es.gallery("two-disks")
    gas = Curves(Task("gas", box, "trajectory", 1.0))
    gas.points = points("gas", "trajectory", "fast", (0.1, 1e-12)) + points(
        "gas", "trajectory", "stepped", (0.05, 1.0), (0.1, 0.1), (1.0, 0.001)
    )
    gas.points += points("gas", "trajectory", "frames", (0.2, 1.0), (3.0, 0.1))
    heap = Curves(Task("pile", pile(), "unrest", 1.0))
    heap.points = points("pile", "unrest", "reference", (1.0, 0.1)) + points("pile", "unrest", "penalty", (0.2, 0.05))
    contacts = np.arange(1.0, 4.0)
    chaos = Chaos(contacts, {"event-driven": 1e-15 * 2.0**contacts}, 1.0, 30.0)
    return Chart([gas, heap], chaos=chaos, rates={"fast": [(30, 1e6), (100, 2e6)]})


def test_advantages_are_numbers_at_equal_error_and_at_equal_time():
    stepped, frames, heap = advantages(a_chart())
    assert (stepped.time_ratio, stepped.bound) == (pytest.approx(10.0), "")
    assert stepped.error_ratio == pytest.approx(0.1 / 1e-12)
    assert (frames.time_ratio, frames.bound) == (pytest.approx(30.0), ">")  # not reached in 30 times the time
    assert math.isnan(frames.error_ratio)  # its coarsest run takes longer
    assert math.isnan(heap.time_ratio)  # neither reaches the error


@pytest.mark.parametrize(
    ("advantage", "text"),
    [
        (Advantage("gas", "frames", 1e-3, 38.4, "", 2.3e14), "38 | 2e14"),
        (Advantage("gas", "frames", 1e-3, 1234.0, ">", math.nan), ">1200 | -"),
        (Advantage("pile", "penalty", 1e-2, 0.148, "", 0.39), "0.15 | 0.39"),
        (None, "left out"),
    ],
)
def test_a_cell_says_both_numbers(advantage, text):
    assert cell(advantage) == text


def test_the_table_has_a_row_for_each_stepped_engine_and_a_column_for_each_scene():
    head, rows = table(a_chart())
    assert head == ["engine", "gas: 0.001", "pile: 0.01"]
    assert [row[0] for row in rows] == ["stepped", "frames", "penalty"]
    assert rows[2][1] == "left out"


def test_each_question_is_answered_with_numbers_of_the_chart(gas):
    chart = a_chart()
    chart.losses = gas
    engine, steps, energy, float64, wins = (answer.answer for answer in conclusions(chart))
    assert engine == "Event-driven: on gas the next, stepped, takes 10 x the time."
    assert "radii a step every engine loses more than 1 in 100" in steps
    assert energy.startswith("Lost contacts: ")
    assert "After 30 contacts of each disk" in float64
    assert "on pile penalty comes to rest 5 x sooner" in wins


def test_a_chart_without_stepped_engines_answers_nothing():
    assert conclusions(Chart()) == []


def test_figures_are_drawn(gas, tmp_path):
    from eventsim.show.versus.comparison import write_comparison
    from eventsim.show.versus.precision import write_chart
    from eventsim.show.versus.summary import write_summary

    write_comparison(gas, tmp_path / "gas.png")
    chart = a_chart()
    chart.losses = gas
    write_chart(chart, tmp_path / "chart.svg")
    write_summary(chart, tmp_path / "summary.png")
    assert struct.unpack(">II", (tmp_path / "summary.png").read_bytes()[16:24]) == (1600, 900)
    assert (tmp_path / "gas.png").stat().st_size > 20_000
    assert (tmp_path / "chart.svg").read_text().startswith("<?xml")
    assert {row["panel"] for row in chart_rows(chart)} == {"precision", "losses", "chaos", "rate", "advantage"}


def test_titles_of_panels_end_before_the_next_panel(gas):
    """All of them, on the page that is read in a minute."""
    from eventsim.show.versus.summary import draw_summary

    chart = a_chart()
    chart.losses = gas
    words = "100 disks, packing 0.3, after 3 contacts a disk"
    chart.tasks = [replace(curves, task=replace(curves.task, words=words)) for curves in chart.tasks]
    figure = Figure(figsize=(16.0, 9.0), layout="constrained")
    draw_summary(figure, chart)
    figure.draw_without_rendering()
    panels = [axes for part in figure.subfigs for axes in part.axes if axes.get_title(loc="left")]
    titles = [axes._left_title.get_window_extent() for axes in panels]
    assert len(titles) >= 4
    for place, box in enumerate(titles):
        assert not any(box.overlaps(other) for other in titles[place + 1 :])
        assert box.x1 < figure.bbox.x1


def assert_apart(axes):
    """No words of a panel overlap others, nor the legend."""
    axes.figure.canvas.figure.draw_without_rendering()
    boxes = [text.get_window_extent() for text in axes.texts if text.get_text()] + [axes.get_legend().get_window_extent()]
    assert len(boxes) > 3
    assert not any(one.overlaps(other) for place, one in enumerate(boxes) for other in boxes[:place])


def test_words_of_a_chart_do_not_run_into_each_other():
    """Of one scene: its answers, the table beside the panel, and the legend."""
    from eventsim.show.versus.precision import HEAD_WIDTH, answer_lines, draw_head
    from eventsim.show.versus.summary import draw_summary

    chart = Chart(a_chart().tasks[:1])
    figure = Figure(figsize=(16.0, 9.0), layout="constrained")
    draw_summary(figure, chart)
    (words,) = figure.subfigs[0].axes
    assert {"stepped", "10 x", ">30 x"} <= {text.get_text() for text in words.texts}
    assert_apart(words)
    head = Figure(figsize=(HEAD_WIDTH, 2.0)).add_axes((0.07, 0.0, 0.93, 1.0))
    draw_head(head, chart, answer_lines(chart), 2.0)
    assert_apart(head)


def test_notes_lie_above_the_curves_on_a_back_that_hides_them(gas):
    axes = Figure().subplots()
    draw_energy(axes, gas)
    (note,) = axes.texts
    assert note.zorder > max(line.zorder for line in axes.lines)
    assert note.get_bbox_patch().get_alpha() in (None, 1.0)


def test_runs_that_miss_nothing_are_drawn_below_one_in_a_hundred(gas):
    few = [replace(line, census=replace(line.census, exact=10, missed=0)) for line in gas.lines]
    axes = Figure().subplots()
    draw_missed(axes, replace(gas, lines=few))
    (none,) = (tick for tick in axes.yaxis.get_minor_ticks() if tick.label1.get_text() == "none")
    assert none.get_loc() == NONE < 1.0
    assert axes.get_ylim()[0] < none.get_loc()


@pytest.mark.parametrize("steps", [(0.0080, 0.0089), (0.016, 0.08, 0.4), (1e-4, 1e-2, 1.0)])
def test_labels_of_steps_do_not_run_into_each_other(gas, steps):
    near = [replace(gas.lines[0], step=step) for step in steps]
    figure = Figure(figsize=(3.4, 3.0))
    axes = figure.subplots()
    draw_missed(axes, replace(gas, lines=near))
    figure.draw_without_rendering()
    boxes = [label.get_window_extent() for label in axes.get_xticklabels(which="both") if label.get_text()]
    low, high = axes.get_xlim()
    assert boxes
    assert low < min(steps) < max(steps) < high
    boxes.sort(key=lambda box: box.x0)
    assert all(one.x1 < other.x0 for one, other in pairwise(boxes))


def test_a_comparison_without_pairs_is_drawn(tmp_path):
    from eventsim.show.versus.comparison import write_comparison

    alone = compare(es.gallery("corner"), chosen_competitors(["stepped"]), steps=(0.1, 0.01), until=20.0)
    write_comparison(alone, tmp_path / "alone.png")
    assert (tmp_path / "alone.png").stat().st_size > 10_000


def test_validate_prints_a_table_a_verdict_and_json(tmp_path):
    arguments = ["validate", "two-disks", "--dt", "0.031", "--dt", "0.0072", "--against", "stepped", "--until", "12"]
    done = CliRunner().invoke(main, [*arguments, "--csv", str(tmp_path / "two.csv")])
    assert done.exit_code == 0, done.output
    assert "found missed doubled spurious" in done.output
    assert "Measured orders" in done.output
    assert (tmp_path / "two.csv").read_text().startswith("# eventsim:")
    data = json.loads(CliRunner().invoke(main, [*arguments, "--json"]).stdout)
    assert data["agrees"] is True
    assert [row["engine"] for row in data["rows"]] == ["event-driven", "stepped", "stepped"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["validate", "gas", "--dt", "0"], "a step must be a finite time above 0"),
        (["validate", "gas", "--against", "unity"], "there is no engine 'unity'"),
        (["chart", "gas", "--out", "chart.bmp"], "must end in .png, .svg, .pdf"),
        (["chart", "no-such-scene"], "neither a scene file"),
    ],
)
def test_bad_usage_is_a_sentence_and_exit_code_2(arguments, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(main, arguments)
    assert done.exit_code == 2
    assert message in done.output
    assert not list(tmp_path.iterdir())


def test_chart_of_a_scene_writes_figure_and_table(tmp_path):
    target = tmp_path / "two.png"
    done = CliRunner().invoke(main, ["chart", "two-disks", "--out", str(target), "--patience", "0.02"])
    assert done.exit_code == 0, done.output
    assert target.stat().st_size > 10_000
    assert "elapsed_per_time" in (tmp_path / "two.csv").read_text()


def test_a_scene_of_ones_own_is_called_by_its_name(tmp_path):
    from eventsim.cli.chart import seeded_task

    text = scene_to_toml(es.gallery("two-disks"))
    (tmp_path / "file.toml").write_text(re.sub(r"(?m)^name = .*$", 'name = "a duel"', text))
    assert seeded_task(str(tmp_path / "file.toml")).name == "a duel"
    (tmp_path / "file.toml").write_text(re.sub(r"(?m)^name = .*$", "", text))
    assert seeded_task(str(tmp_path / "file.toml")).name == "file"


def test_a_comparison_of_nothing_draws_no_verdict(gas):
    assert verdict(replace(gas, lines=[]))[0].startswith("Nothing was compared")


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("rough", "stepped cannot simulate this scene: it knows no disks that spin"),
        ("sheared", "stepped cannot simulate this scene: it knows no disks that spin"),
        ("heat-flow", "stepped cannot simulate this scene: it knows no walls that heat, shake or slide"),
    ],
)
def test_a_scene_that_no_engine_with_steps_can_simulate_is_refused_before_any_run(name, words):
    with pytest.raises(es.EventsimError, match="there is nothing to compare with: ") as refused:
        compare(es.gallery(name), chosen_competitors(()), tell=pytest.fail)
    assert words in str(refused.value)

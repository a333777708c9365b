"""The atlas: processes that come back, that end, that hang; tables and figures of verdicts."""

import csv
import json
import math
import re
from contextlib import nullcontext

import pytest
from click.testing import CliRunner

from eventsim.cli import main
from eventsim.validation.stress import case as stress_case
from eventsim.validation.stress.case import Case, GaveUpError
from eventsim.validation.stress.catalogue import CASES
from eventsim.validation.stress.catalogue.clusters import diagonal
from eventsim.validation.stress.verdict import Word, hung, judge
from eventsim.validation.stress.workers import Silence


def case(answer, refusals=()):
    """A case whose judge gives a number, or raises."""

    def judged(bench):
        if isinstance(answer, Exception):
            raise answer
        return answer

    return Case("f0-made-up", "t", "w", "o", 0.01, "b", judged, refusals)


@pytest.mark.parametrize(
    ("answer", "word", "fault"),
    [
        (0.0, Word.RIGHT, False),
        (0.01, Word.RIGHT, False),
        (0.05, Word.INACCURATE, True),
        (3.0, Word.WRONG, True),
        (math.inf, Word.WRONG, True),
        (math.nan, Word.WRONG, True),
        (GaveUpError("digits", "spent"), Word.REFUSED, True),
        (ZeroDivisionError("division by zero"), Word.WRONG, True),
    ],
)
def test_an_error_has_a_verdict(answer, word, fault):
    verdict = judge(case(answer), "reference", limit=1.0)
    assert (verdict.word, verdict.fault) == (word, fault)
    assert not judge(case(answer), "stepped", limit=1.0).fault


def test_a_documented_refusal_is_no_fault():
    verdict = judge(case(GaveUpError("digits", "spent"), ("digits",)), "reference", limit=1.0)
    assert (verdict.word, verdict.fault) == (Word.REFUSED, False)
    assert verdict.sentence == "stopped by digits: spent"


def test_an_engine_with_far_to_go_is_not_waited_for():
    """A flight of 1e8 diameters in frames of 1/60: 6e9 of them."""
    verdict = judge(CASES["f12-far"], "frames", limit=1.0)
    assert (verdict.word, verdict.fault) == (Word.SLOW, False)
    assert re.fullmatch(r"not done before [0-9.e+]+ s, at its pace", verdict.sentence)


@pytest.mark.parametrize(("engine", "steady"), [("stepped", True), ("reference", False), ("certified", False)])
def test_only_steps_go_at_a_steady_pace(monkeypatch, engine, steady):
    clock = iter([0.0, 2.0])
    monkeypatch.setattr(stress_case, "process_time", lambda: next(clock))
    bench = stress_case.Bench(engine, 10.0)
    bench._watch(0.0, 0, 0.0)
    with pytest.raises(stress_case.TimeUpError, match="at its pace") if steady else nullcontext():
        bench._watch(1e-4, 0, 0.0)


def test_an_engine_that_has_no_time_left_is_not_done(monkeypatch):
    clock = iter(range(100))
    monkeypatch.setattr(stress_case, "process_time", lambda: float(next(clock)))
    bench = stress_case.Bench("reference", 2.5)
    bench.run(diagonal(), until=1.0)  # begins its count
    bench._watch(None, 0, 0.0)
    bench._watch(None, 0, 0.0)
    with pytest.raises(stress_case.TimeUpError, match=r"not done after 2\.5 s"):
        bench._watch(None, 0, 0.0)


def test_an_engine_that_does_not_come_back_has_hung():
    verdict = hung(CASES["f2-miss"], "fast", Silence(190.0, ended=False))
    assert (verdict.word, verdict.fault) == (Word.SLOW, True)
    assert verdict.sentence == "did not come back after 190.0 s"
    assert not hung(CASES["f2-miss"], "stepped", Silence(1.0, ended=True)).fault


def test_stress_prints_a_table_and_writes_figure_and_csv(tmp_path):
    out, table = tmp_path / "atlas.png", tmp_path / "atlas.csv"
    args = ["stress", "f2", "f9", "--engine", "reference", "--out", str(out), "--csv", str(table), "--json"]
    result = CliRunner().invoke(main, args)
    assert result.exit_code == 0, result.output
    data = json.loads(result.stdout)
    assert data["scenes"] == ["f2-miss", "f9-touching"]
    assert [v["verdict"] for v in data["verdicts"]] == ["right", "right"]
    assert data["faults"] == 0
    assert out.stat().st_size > 10_000
    with table.open() as file:
        rows = list(csv.DictReader(file))
    assert [(row["scene"], row["engine"], row["verdict"]) for row in rows] == [
        ("f2-miss", "reference", "right"),
        ("f9-touching", "reference", "right"),
    ]


def test_stress_lists_the_catalogue_and_says_what_it_does_not_know():
    listed = CliRunner().invoke(main, ["stress", "--list", "f6"])
    assert listed.exit_code == 0
    assert "f6-break: a disk meets two at once" in listed.output
    assert "40/57" in listed.output
    unknown = CliRunner().invoke(main, ["stress", "f99"])
    assert unknown.exit_code == 2
    assert "there is no scene 'f99'" in unknown.output

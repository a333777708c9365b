"""The atlas: processes that come back, that end, that hang; tables and figures of verdicts."""

import csv
import json
import math
import os
import time

import pytest
from click.testing import CliRunner

import eventsim.validate.stress.atlas as atlas
from eventsim.cli import main
from eventsim.validate.stress.case import Case, GaveUpError
from eventsim.validate.stress.catalogue import CASES
from eventsim.validate.stress.verdict import Word, judge


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


def ends_or_hangs(names, engine, limit, pipe):
    """In place of `judge_all`: one case ends the process, another one hangs."""
    for name in names:
        if name == "f2-miss":
            os._exit(1)
        if name == "f8-two-pairs":
            time.sleep(60.0)
        pipe.send(judge(CASES[name], engine, limit))


def test_a_process_that_ends_or_hangs_costs_only_its_own_case(monkeypatch):
    monkeypatch.setattr(atlas, "judge_all", ends_or_hangs)
    monkeypatch.setattr(atlas, "PATIENCE", 4.0)
    names = ("f2-miss", "f8-two-pairs", "f9-touching")
    verdicts = atlas.atlas_of([CASES[name] for name in names], ["reference"], 0.5, 1)
    assert [v.word for v in verdicts] == [Word.SLOW, Word.SLOW, Word.RIGHT]
    assert "its process ended" in verdicts[0].sentence
    assert "did not come back" in verdicts[1].sentence


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

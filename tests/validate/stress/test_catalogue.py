"""Every case of the catalogue: the reference engine is right, or refuses with the documented reason."""

import pytest

from eventsim.validation.stress.catalogue import CASES, chosen
from eventsim.validation.stress.verdict import Word, judge

LONG = ("c2-lattice", "f19-jammed")


def judged(name, engine="reference"):
    verdict = judge(CASES[name], engine, limit=20.0)
    assert not verdict.fault, verdict.sentence
    return verdict


@pytest.mark.parametrize("name", [name for name in CASES if name not in LONG])
def test_the_reference_engine_is_right_or_refuses_with_the_documented_reason(name):
    judged(name)


@pytest.mark.slow
@pytest.mark.parametrize("name", LONG)
def test_the_reference_engine_is_right_on_large_cases(name):
    judged(name)


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_the_fast_engine_is_right_or_refuses_with_the_documented_reason(name):
    pytest.importorskip("numba")
    judged(name, "fast")


def test_every_case_says_why_methods_fail_and_what_is_true():
    for case in CASES.values():
        assert all((case.title, case.why, case.oracle, case.because)), case.name
        assert case.tolerance >= 0.0
        assert case.name == case.name.lower()


def test_the_catalogue_covers_the_hard_scenes():
    numbers = {name.partition("-")[0] for name in CASES}
    assert {f"f{k}" for k in range(1, 39)} <= numbers
    assert {f"t{k}" for k in range(1, 6)} <= numbers
    assert {f"p{k}" for k in range(1, 8)} <= numbers


def test_a_family_is_chosen_by_its_number():
    assert {case.name for case in chosen(("f23",))} == {"f23-zeno", "f23-after"}
    assert [case.name for case in chosen(("f6-break",))] == ["f6-break"]


@pytest.mark.parametrize(("name", "words"), [("t1-tunnelling", (Word.WRONG,)), ("t4-order", (Word.INACCURATE,))])
def test_frames_fail_where_frames_must(name, words):
    assert judge(CASES[name], "frames", limit=10.0).word in words

"""What a long run says while it goes on."""

import pytest

from eventsim.cli import progress


@pytest.mark.parametrize(("patience", "words"), [(0.0, "3 events, none since clock 1.5, clock 9"), (60.0, "3 events, clock 9")])
def test_a_run_without_events_says_since_when(monkeypatch, patience, words):
    bar, said = progress.ProgressBar(), []
    monkeypatch.setattr(progress, "IDLE", patience)
    monkeypatch.setattr(bar, "show", lambda fraction, text: said.append(text))
    bar(None, 3, 1.5)
    bar(None, 3, 9.0)
    assert said[-1] == words

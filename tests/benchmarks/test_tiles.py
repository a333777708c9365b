"""Tiles, small ones: right to the last bit, also where halos are too narrow and where the ordinary loop has to help."""

import pytest

from tests.benchmarks.tiles import Tiles, advance_ordinary, check, pace, warm_session

pytestmark = pytest.mark.slow  # they compile kernels that nothing else needs


@pytest.mark.parametrize(("eta", "near", "halo", "window"), [(0.2, 4, 9, 0.5), (0.5, 3, 9, 1.0), (0.7, 3, 9, 1.0)])
def test_tiles_log_what_the_ordinary_loop_logs(eta, near, halo, window):
    session = warm_session(4000, eta, 3.0)
    step, windows = window * pace(session), 16
    turnover = float(session.state.window_end)
    advance_ordinary(session, session.state.epoch, turnover - 8 * step, False)
    tiles = Tiles(session, 16, halo, near)
    rows = check(tiles, session, step, windows)
    assert tiles.epoch > 0
    assert rows > 0.25 * windows * window * tiles.n


def test_a_halo_that_is_too_narrow_is_noticed():
    session = warm_session(4000, 0.5, 3.0)
    tiles = Tiles(session, 16, 5, 3)
    check(tiles, session, pace(session), 6)
    assert tiles.redone["tiles"] > 0
    assert tiles.redone["windows"] > 0


def test_a_window_is_taken_back_and_done_by_the_ordinary_loop(monkeypatch):
    session = warm_session(4000, 0.5, 3.0)
    tiles = Tiles(session, 16, 9, 3)
    step = pace(session)
    check(tiles, session, step, 2)
    with monkeypatch.context() as patch:
        patch.setattr(tiles, "_try", lambda end, halo: None)
        check(tiles, session, step, 2)
    assert tiles.redone["ordinary"] == 2
    check(tiles, session, step, 2)

"""Kernels on disk: what several processes compile at one time."""

import pytest

pytest.importorskip("numba")

from eventsim.engines.fast import numba_compiler as compiled


def half(x):
    return x / 2


def test_two_processes_that_compile_at_one_time_do_not_mix_up_their_kernels(tmp_path, monkeypatch):
    """Both read the index before either writes, and the first one's machine code comes last."""
    monkeypatch.setattr(compiled, "_FOLDER", tmp_path)
    one = compiled.kernel(half)
    monkeypatch.setattr(compiled, "_THIS_PROCESS", "another")
    another = compiled.kernel(half)
    files, late = one._cache._cache_file, []
    write = files._save_data
    monkeypatch.setattr(files, "_save_data", lambda *what: late.append(what))
    one(7)
    monkeypatch.setattr(another._cache._cache_file, "_load_index", dict)
    another(7.0)
    write(*late[0])
    monkeypatch.undo()
    monkeypatch.setattr(compiled, "_FOLDER", tmp_path)
    fresh = compiled.kernel(half)
    assert fresh(7.5) == 3.75
    assert fresh(7) == 3.5

"""Disks that only wrap: when it is known that they will never meet anything, and when it is not."""

import pytest

import eventsim as es

BOX = es.Periodic((4.0, 3.0))
POST = es.Segment((0.5, 2.0), (0.6, 2.0))

NEVER = {
    "one disk": ([[1.0, 1.0]], [[1.0, 0.3]], BOX, ()),
    "one disk under a wall": ([[1.0, 1.0]], [[1.0, 0.0]], BOX, (POST,)),
    "one disk along a channel": ([[1.0, 1.0]], [[1.0, 0.0]], es.Channel((4.0, 3.0)), ()),
    "lanes": ([[1.0, 1.0], [1.0, 2.0]], [[1.0, 0.0], [-0.5, 0.0]], BOX, ()),
    "lanes upwards": ([[1.0, 1.0], [2.0, 1.0], [3.0, 2.0]], [[0.0, 1.0], [0.0, -0.5], [0.0, 0.0]], BOX, (POST,)),
}
SOME_TIME = {
    "one disk and a wall ahead": ([[1.0, 1.0]], [[1.0, 0.003]], BOX, (es.Segment((0.5, 1.5), (0.6, 1.5)),)),
    "one lane": ([[1.0, 1.0], [3.0, 1.1]], [[1.0, 0.0], [0.999, 0.0]], BOX, ()),
    "a slow one meets a wall": ([[1.0, 1.0], [1.0, 2.0]], [[1.0, 0.0], [-0.0001, 0.0]], BOX, (POST,)),
}
ENGINES = ["reference", "certified", pytest.param("fast", marks=pytest.mark.slow)]


def run(engine, position, velocity, domain, walls):
    if engine != "reference":
        pytest.importorskip({"certified": "flint", "fast": "numba"}[engine])
    return es.simulate(es.Scene(es.Disks(position, velocity, 0.2), domain, walls), events=1, engine=engine)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", NEVER)
def test_disks_that_never_meet_anything_are_quiet(engine, name):
    ended = run(engine, *NEVER[name])
    assert (ended.stopped, ended.counters.events) == ("quiet", 0)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", SOME_TIME)
def test_disks_that_meet_something_after_many_rounds_are_waited_for(engine, name):
    ended = run(engine, *SOME_TIME[name])
    assert (ended.stopped, ended.counters.events) == ("events", 1)
    assert ended.counters.wraps > 16

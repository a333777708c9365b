"""The contract that every engine of the table keeps; a row that is added is tested here without being named."""

from dataclasses import fields

import numpy as np
import pytest

import eventsim as es
from eventsim import engines
from eventsim.engines import TABLE, Engine
from eventsim.engines.base import Motion, Session, Stop
from eventsim.engines.options import read_option, words_of
from eventsim.record.events import blank_rows
from eventsim.run import ENGINES
from eventsim.scene.stage import stage_of

TWO = es.gallery("two-disks")
EVERY = pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.kernels) if name == "fast" else name for name in TABLE]
)


def opened(name, **options):
    row = TABLE[name]
    if row.missing is not None:
        pytest.skip(row.missing)
    return row.open(stage_of(TWO), options=row.options_from(options))


def advanced(session, until):
    while (stopped := session.advance(Stop(until=until), 1000)) is None:
        pass
    return stopped


@EVERY
def test_a_session_answers_all_that_is_asked(name):
    session = opened(name)
    assert isinstance(session, Session)
    assert advanced(session, 6.0) == "until"
    assert session.counters.pair_contacts > 0
    assert (session.reason, session.refused, session.begun_by) == (None, False, None)
    assert session.at_work in ("reference", "fast") if name == "auto" else session.at_work == name
    assert session.compile_s >= 0.0
    assert not session.prepares
    assert (session.trajectory is None) == (not TABLE[name].stepped)
    assert len(session.take_rows()) == session.counters.events
    assert all(len(column) == 2 for column in session.motion() if column is not None)  # there are no spins
    session.break_off()


@EVERY
def test_energy_and_momentum_are_kept_between_elastic_disks(name):
    if TABLE[name].missing is not None:
        pytest.skip(TABLE[name].missing)
    run = es.simulate(TWO, until=6.0, engine=name)
    assert run.residuals.momentum < 1e-9
    assert abs(run.residuals.energy) < (1e-2 if name == "penalty" else 1e-9)


@EVERY
def test_a_run_goes_back_to_a_snapshot_with_the_same_bits_or_says_that_it_cannot(name):
    session = opened(name)
    advanced(session, 1.0)
    if name == "certified":
        with pytest.raises(es.EventsimError, match="snapshot"):
            session.snapshot()
        return
    saved = session.snapshot()
    advanced(session, 6.0)
    first = session.motion()
    session.restore(saved)
    advanced(session, 6.0)
    assert all(np.array_equal(one, two) for one, two in zip(first, session.motion(), strict=True))


@EVERY
def test_what_replay_computes_can_be_left_out_where_the_engine_says_so(name, tmp_path):
    if TABLE[name].missing is not None:
        pytest.skip(TABLE[name].missing)
    compact = {"engine": name, "until": 2.0, "log": tmp_path / "a.csv", "compact": True}
    keep = {"engine": name, "until": 2.0, "checkpoint": tmp_path / "a.checkpoint"}
    if TABLE[name].replays:
        assert es.simulate(TWO, **compact).log.compact
        assert es.simulate(TWO, **keep).time == 2.0
        return
    with pytest.raises(es.EventsimError, match="has to be a full one"):
        es.simulate(TWO, **compact)
    with pytest.raises(es.EventsimError, match="has no checkpoints"):
        es.simulate(TWO, **keep)


@pytest.mark.parametrize("name", [name for name, row in TABLE.items() if row.replays])
def test_engines_that_replay_write_the_one_log(name):
    if TABLE[name].missing is not None:
        pytest.skip(TABLE[name].missing)
    expected = es.simulate(TWO, until=20.0, engine="reference", digest=True)
    assert es.simulate(TWO, until=20.0, engine=name, digest=True).digest == expected.digest


@EVERY
def test_every_option_has_words_of_its_own_or_is_for_python_alone(name):
    kind = TABLE[name].options
    assert all(words_of(kind).values())
    assert {item.name for item in fields(kind)} >= set(words_of(kind))
    for option in words_of(kind):
        with pytest.raises(es.EventsimError, match=f"{name}: {option} = .*must be"):
            TABLE[name].options_from({option: object()})


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: es.simulate(TWO, dt=0.1), "the engine auto has no option 'dt'; dt belongs to frames, stepped, penalty, pymunk"),
        (lambda: es.simulate(TWO, untl=3), r"the engine auto has no option 'untl' \(did you mean 'until'\?\); it has check"),
        (lambda: es.simulate(TWO, engine="stepped", dtt=0.1), r"no option 'dtt' \(did you mean 'dt'\?\); it has dt, locate"),
        (lambda: es.simulate(TWO, engine="stepped", dt="fast"), "stepped: dt = 'fast': must be a time"),
        (lambda: es.simulate(TWO, engine="stepped", dt=True), "stepped: dt = True: must be a time"),
        (lambda: es.simulate(TWO, engine="pymunk", iterations=2.5), "pymunk: iterations = 2.5: must be a whole number"),
        (lambda: es.simulate(TWO, engine="pymunk", iterations=0), "pymunk: iterations = 0: must be at least 1"),
        (lambda: es.simulate(TWO, engine="pymunk", slop=float("nan")), "pymunk: slop = nan: must be finite"),
        (lambda: es.simulate(TWO, engine="certified", bits=0), "certified: bits = 0: must be at least 64"),
        (lambda: es.simulate(TWO, engine="steped"), r"engine 'steped' does not exist \(did you mean 'stepped'\?\)"),
        (lambda: es.Simulation(TWO, dt=0.1), "the engine auto has no option 'dt'"),
        (lambda: ENGINES["fast"].run(TWO, 1.0, check=True), "no option 'check'; check belongs to reference"),
        (lambda: es.simulate(TWO, log=True, compact=True), "compact is a form of log files"),
        (lambda: es.simulate(TWO, compact=True), "compact is a form of log files"),
    ],
)  # fmt: skip
def test_options_and_wishes_that_do_not_fit_are_errors_with_a_sentence(call, sentence):
    for extra in ("pymunk", "certified"):
        if extra in sentence and TABLE[extra].missing is not None:
            pytest.skip(TABLE[extra].missing)
    with pytest.raises(es.EventsimError, match=sentence):
        call()


@pytest.mark.parametrize(
    ("name", "option", "text", "value"),
    [
        ("stepped", "dt", "0.5", 0.5),
        ("stepped", "locate", "TRUE", True),
        ("stepped", "locate", "false", False),
        ("certified", "bits", "128", 128),
        ("frames", "memory", "frame", "frame"),
    ],
)
def test_an_option_is_read_from_text(name, option, text, value):
    read = read_option(TABLE[name].options, option, text)
    assert (type(read), read) == (type(value), value)


@pytest.mark.parametrize(
    ("name", "option", "text"),
    [("stepped", "locate", "yes"), ("stepped", "dt", "fast"), ("certified", "bits", "1.5"), ("frames", "memory", "none")],
)
def test_text_that_is_no_value_of_an_option_is_an_error(name, option, text):
    with pytest.raises(ValueError, match=text):
        read_option(TABLE[name].options, option, text)


def test_numbers_of_numpy_are_numbers():
    assert es.simulate(TWO, until=1.0, engine="stepped", dt=np.float32(0.125)).counters.steps == 8
    assert es.simulate(TWO, until=1.0, engine="stepped", dt=1).counters.steps == 1


class Idle(Session):
    """An engine that says no more than it must: nothing ever happens."""

    name = "idle"

    def __init__(self, stage, keep_rows, options):
        super().__init__(stage)
        self.now = 0.0

    @property
    def clock(self):
        return 0, self.now

    def advance(self, stop, budget):
        self.now = stop.until
        return "until"

    def take_rows(self):
        return blank_rows(0)

    def motion(self):
        s, none = self.stage, np.zeros(self.stage.n, np.int64)
        return Motion(s.x, s.y, s.vx, s.vy, none, none)

    def kick(self, i, vx, vy):
        raise es.EventsimError("it takes no kicks")

    def snapshot(self):
        raise es.EventsimError("it has no snapshots")

    def restore(self, saved):
        raise es.EventsimError("it has no snapshots")


def test_an_engine_that_says_no_more_than_it_must_can_be_run(monkeypatch):
    monkeypatch.setitem(engines.TABLE, "idle", Engine("idle", "nothing happens", f"{__name__}:Idle"))
    monkeypatch.setitem(__import__("sys").modules, __name__, __import__("types").SimpleNamespace(Idle=Idle))
    run = es.simulate(TWO, until=2.0, engine="idle", log=True, digest=True)
    assert (run.engine, run.time, run.counters.events, run.stopped) == ("idle", 2.0, 0, "until")
    assert len(run.log) == 0
    with pytest.raises(es.EventsimError, match="the engine idle has no option 'dt'; dt belongs to"):
        es.simulate(TWO, until=2.0, engine="idle", dt=0.1)

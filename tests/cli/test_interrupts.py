"""Whatever breaks into a run, what it wrote can be read, no broken file has a final name, and the run can go on."""

from __future__ import annotations

import ctypes
import json
import multiprocessing
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import eventsim as es
from eventsim.cli.signals import interruptible, terminable
from eventsim.engines.base import BrokenOffError
from eventsim.suffixes import LOGS

LONG = 2400
"""Events of a run that is killed: a second or so."""


def scene():
    return es.gallery("gas", n=30)


def run_in_child(log, checkpoint, compact, engine):
    """Begin the run, or go on with it; in a process that is killed sooner or later."""
    if checkpoint.exists():
        es.resume(checkpoint)
    else:
        es.simulate(scene(), events=LONG, engine=engine, log=log, compact=compact, checkpoint=checkpoint, every=200)


def kill_again_and_again(place, suffix, compact, engine, kills, seed):
    """Kill a run so often at random moments, going on in between; a look at its files after each."""
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(["eventsim.simulation", "eventsim.engines.reference", "eventsim.record.files.npz"])
    rng = np.random.default_rng(seed)
    log, checkpoint = place / f"run{suffix}", place / "run.checkpoint"
    part = place / f"run{suffix}.part"
    whole = es.simulate(scene(), events=LONG, engine=engine, log=place / f"whole{suffix}", compact=compact)
    rows = es.load_log(whole.log_path).rows
    longest, killed = 1.0, 0
    while killed < kills:
        child = context.Process(target=run_in_child, args=(log, checkpoint, compact, engine))
        began = time.monotonic()
        child.start()
        child.join(rng.uniform(0.0, longest))
        alive = child.is_alive()
        child.kill()
        child.join()
        killed += alive
        # Killed before the metadata had been written there is no row to lose, and no checkpoint either.
        if log.exists() or checkpoint.exists():
            found = es.load_log(log if log.exists() and not part.exists() else part).rows
            assert found["remainder"].tobytes() == rows["remainder"][: len(found)].tobytes()
        if log.exists():
            assert es.load_log(log).provenance.ending is not None
        if not alive:  # it came to its end: begin anew
            assert child.exitcode == 0
            longest = max(longest, 1.2 * (time.monotonic() - began))
            assert log.read_bytes() == whole.log_path.read_bytes()
            log.unlink()
            checkpoint.unlink()
    if checkpoint.exists():
        assert es.resume(checkpoint).digest == whole.digest
        assert log.read_bytes() == whole.log_path.read_bytes()


CASES = [(suffix, compact) for suffix in LOGS for compact in (False, True)]


@pytest.mark.parametrize(("suffix", "compact"), [(".csv", False), (".npz", True), (".parquet", False)])
def test_killed_at_any_moment_a_run_goes_on_as_if_nothing_had_been(tmp_path, suffix, compact):
    kill_again_and_again(tmp_path, suffix, compact, "reference", 4, seed=1)


@pytest.mark.slow
@pytest.mark.timeout(1800)
@pytest.mark.parametrize("engine", ["reference", "fast"])
@pytest.mark.parametrize(("suffix", "compact"), CASES)
def test_killed_two_hundred_times_a_run_goes_on_as_if_nothing_had_been(tmp_path, suffix, compact, engine):
    kill_again_and_again(tmp_path, suffix, compact, engine, 25 if engine == "reference" else 5, seed=2)


def command(*words):
    return [sys.executable, "-m", "eventsim", *map(str, words)]


def limited(size):
    """What a full disk does: no file grows beyond so many bytes."""

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    return limit


@pytest.mark.parametrize("suffix", LOGS)
def test_a_full_disk_ends_a_run_with_a_readable_part_from_which_it_goes_on(tmp_path, suffix, eventsim):
    log, checkpoint = tmp_path / f"run{suffix}", tmp_path / "run.checkpoint"
    words = ("run", "gas", "--set", "n=30", "--events", 6000, "--engine", "reference", "--log", log)
    keep = ("--checkpoint", checkpoint, "--every", 500)
    size = 500_000 if suffix in (".csv", ".jsonl") else 30_000
    full = subprocess.run(command(*words, *keep), capture_output=True, text=True, preexec_fn=limited(size), timeout=60)
    assert full.returncode == 2, full.stderr
    assert "File too large" in full.stderr
    assert "Traceback" not in full.stderr
    assert "can be read" in full.stderr
    assert not log.exists()
    part = f"{log}.part"
    rows = es.load_log(part)
    assert 500 < len(rows) < 6000
    assert eventsim("state", part, "--at", rows.time[-1]).exit_code == 0
    assert json.loads(eventsim("measure", part, "--json").stdout)["disks"] == 30
    assert eventsim("run", "--resume", checkpoint, "--quiet").exit_code == 0
    whole = tmp_path / f"whole{suffix}"
    assert eventsim(*words[:-1], whole, "--quiet").exit_code == 0
    assert es.load_log(log).rows.tobytes() == es.load_log(whole).rows.tobytes()


def test_a_disk_that_is_too_full_for_checkpoints_does_not_end_a_run(tmp_path, eventsim):
    checkpoint = tmp_path / "a"
    words = ("run", "gas", "--set", "n=30", "--set", "restitution=0.99", "--events", 4000)
    keep = ("--checkpoint", checkpoint, "--every", 1000)
    # The first checkpoint fits; the rows that later ones keep for a diagnosis do not.
    done = subprocess.run(
        command(*words, *keep), capture_output=True, text=True, preexec_fn=limited(60_000), timeout=60
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr.count("the run goes on with the checkpoint before") == 4
    assert eventsim("run", "--resume", checkpoint, "--quiet").exit_code == 0


def test_a_vanished_directory_ends_a_run_with_a_sentence(tmp_path, eventsim):
    place, checkpoint = tmp_path / "place", tmp_path / "run.checkpoint"
    place.mkdir()
    words = ("run", "gas", "--until", "1e9", "--log", place / "run.csv", "--checkpoint", checkpoint, "--every", 200)
    running = subprocess.Popen(command(*words), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    part = place / "run.csv.part"
    wait_for(lambda: part.exists() and part.stat().st_size > 300_000)
    shutil.rmtree(place)
    _, stderr = running.communicate(timeout=30)
    assert running.returncode == 2
    assert "its directory has vanished" in stderr
    assert "Traceback" not in stderr
    again = eventsim("run", "--resume", checkpoint)
    assert again.exit_code == 2
    assert "run.csv" in again.stderr


def wait_for(seen, patience=30.0):
    end = time.monotonic() + patience
    while not seen():
        assert time.monotonic() < end, "it did not come"
        time.sleep(0.02)


def test_an_interrupt_while_the_command_is_imported_ends_quietly():
    code = """
import sys
class Interrupt:
    def find_spec(self, name, path, target=None):
        if name == "eventsim.cli.program":
            exec("raise KeyboardInterrupt")  # as in a module that makes a dataclass
sys.meta_path.insert(0, Interrupt())
from eventsim.__main__ import main
main()
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "interrupted\n")


def test_a_signal_that_is_heard_inside_a_function_called_by_machine_code_is_not_lost(capfd):
    """As inside LLVM while it compiles: a traceback was written, and the run went on for a minute."""

    def heard_inside(number):
        ctypes.CFUNCTYPE(None)(lambda: signal.raise_signal(number))()
        for _ in range(2000):
            time.sleep(0.01)

    class Preparing:
        prepares = True

    with interruptible() as interrupt:
        interrupt.session = Preparing()
        with pytest.raises(BrokenOffError):
            heard_inside(signal.SIGINT)
    with pytest.raises(KeyboardInterrupt), terminable():
        heard_inside(signal.SIGTERM)
    assert capfd.readouterr().err == ""


ENDING = [signal.SIGINT, signal.SIGTERM, *([signal.SIGHUP] if hasattr(signal, "SIGHUP") else [])]


@pytest.mark.parametrize("number", ENDING)
def test_an_interrupted_run_keeps_its_log_and_goes_on(tmp_path, eventsim, number):
    log, checkpoint = tmp_path / "run.jsonl", tmp_path / "run.checkpoint"
    words = ("run", "gas", "--set", "n=30", "--until", "1e9", "--log", log, "--checkpoint", checkpoint)
    running = subprocess.Popen(command(*words, "--json"), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wait_for(lambda: Path(f"{log}.part").exists() and Path(f"{log}.part").stat().st_size > 100_000)
    running.send_signal(number)
    stdout, stderr = running.communicate(timeout=30)
    assert running.returncode == 130, stderr
    summary = json.loads(stdout)
    assert summary["stopped"] == "interrupted"
    before = es.load_log(log)
    assert len(before) == summary["events"]
    more = summary["events"] + 500
    again = json.loads(eventsim("run", "--resume", checkpoint, "--events", more, "--json").stdout)
    expected = es.simulate(scene(), events=more, digest=True)
    assert again["digest"] == expected.digest == es.load_log(log).digest()


@pytest.mark.parametrize(
    "words",
    [("gallery",), ("run", "break"), ("run", "break", "--json"), ("check", "gas"), ("state", "LOG", "--frames", 2000)],
)
def test_a_reader_that_has_had_enough_is_no_error(tmp_path, words):
    log = tmp_path / "run.csv"
    es.simulate(es.gallery("gas", n=50), events=2000, log=log)
    typed = [log if word == "LOG" else word for word in words]
    running = subprocess.Popen(command(*typed), stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert running.stdout is not None
    running.stdout.read(1)
    running.stdout.close()
    assert running.stderr is not None
    stderr = running.stderr.read().decode()
    assert running.wait(timeout=60) == 0, stderr
    assert stderr == ""


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="a place where nobody may write")
@pytest.mark.parametrize("option", ["--log", "--state", "--checkpoint"])
def test_a_place_where_nobody_may_write_is_told(eventsim, option):
    result = eventsim("run", "two-disks", option, "/proc/run.csv")
    assert result.exit_code == 2
    assert "/proc/run.csv" in result.stderr
    assert not os.path.exists("/proc/run.csv")


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="there is no such signal")
def test_a_run_whose_terminal_goes_keeps_its_log_and_ends_as_interrupted(tmp_path):
    """Its last words, to a terminal that is gone, ended in an error."""
    pty = pytest.importorskip("pty")
    mine, theirs = pty.openpty()
    log = tmp_path / "run.jsonl"
    words = command("run", "gas", "--set", "n=30", "--until", "1e9", "--engine", "reference", "--log", log)
    running = subprocess.Popen(words, stdin=theirs, stdout=theirs, stderr=theirs, start_new_session=True)
    os.close(theirs)
    wait_for(lambda: Path(f"{log}.part").exists() and Path(f"{log}.part").stat().st_size > 10_000)
    os.close(mine)
    running.send_signal(signal.SIGHUP)
    assert running.wait(timeout=30) == 130
    assert es.load_log(log).provenance.ending.reason == "interrupted"


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="there is no such signal")
def test_a_run_under_nohup_outlives_its_terminal(tmp_path):
    log = tmp_path / "run.jsonl"
    words = command("run", "gas", "--set", "n=30", "--until", "1e9", "--engine", "reference", "--log", log)
    running = subprocess.Popen(
        words, stdout=subprocess.DEVNULL, preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN)
    )
    wait_for(lambda: Path(f"{log}.part").exists() and Path(f"{log}.part").stat().st_size > 10_000)
    running.send_signal(signal.SIGHUP)
    before = Path(f"{log}.part").stat().st_size
    wait_for(lambda: Path(f"{log}.part").stat().st_size > before)
    running.terminate()
    assert running.wait(timeout=30) == 130


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="looks for children in /proc")
def test_workers_of_a_sweep_that_is_killed_end_with_it(tmp_path):
    words = ("sweep", "gas", "--set", "n=30,40,50,60", "--until", "1e9", "--engine", "reference", "--workers", 2)
    running = subprocess.Popen(command(*words, "--out", tmp_path / "t.csv"), stderr=subprocess.DEVNULL)
    wait_for(lambda: len(children_of(running.pid)) >= 3, 30)  # two workers, and what tracks their resources
    workers = children_of(running.pid)
    running.kill()
    running.wait()
    wait_for(lambda: not any(is_alive(pid) for pid in workers), 15)


def children_of(pid: int) -> list[int]:
    return [int(other.name) for other in Path("/proc").glob("[0-9]*") if _stat(other)[1:2] == [str(pid)]]


def is_alive(pid: int) -> bool:
    return _stat(Path(f"/proc/{pid}"))[:1] not in ([], ["Z"])


def _stat(process: Path) -> list[str]:
    """State, parent, ... of a process; nothing of one that has ended."""
    try:
        return (process / "stat").read_text().rpartition(") ")[2].split()
    except OSError:
        return []

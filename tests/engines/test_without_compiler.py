"""Where numba is told not to compile, everything runs as plain Python or says so in a sentence."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest

pytest.importorskip("numba")


def interpreted(*words: str) -> dict[str, object]:
    environment = os.environ | {"EVENTSIM_INTERPRET": "1"}
    command = [sys.executable, "-m", "eventsim", "run", *words, "--json", "--digest"]
    done = subprocess.run(command, capture_output=True, text=True, env=environment, check=True)
    return dict(json.loads(done.stdout))


@pytest.mark.parametrize("words", [("bounce", "--until", "2"), ("gas", "--set", "n=30", "--events", "60")])
def test_kernels_run_as_plain_python_with_the_same_bits(words):
    kernels, reference = (interpreted(*words, "--engine", engine) for engine in ("fast", "reference"))
    assert (kernels["engine"], kernels["compile_s"]) == ("fast", 0.0)
    assert kernels["digest"] == reference["digest"]


def without_compiler(*words: str) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {"NUMBA_DISABLE_JIT": "1", "EVENTSIM_INTERPRET": ""}
    command = [sys.executable, "-m", "eventsim", *words]
    return subprocess.run(command, capture_output=True, text=True, env=environment, check=False)


def test_the_fast_engine_says_that_it_may_not_compile():
    done = without_compiler("run", "two-disks", "--events", "5", "--engine", "fast")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == (
        "Error: the engine fast is compiled, and NUMBA_DISABLE_JIT is set: unset it, take the engine reference, "
        "or set EVENTSIM_INTERPRET to run kernels as plain Python\n"
    )


def test_auto_takes_the_reference_engine_where_nothing_may_be_compiled():
    done = without_compiler("run", "two-disks", "--events", "5", "--digest")
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.slow
@pytest.mark.parametrize(
    "words", ["validate oblique", "run gas --set n=60 --until .05 --engine frames", "check jar", "certify oblique --events 3"]
)
def test_every_verb_goes_on_as_plain_python(words):
    done = without_compiler(*words.split())
    assert (done.returncode, "Traceback" in done.stderr) == (0, False)

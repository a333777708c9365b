"""No process outlives the test that has started it."""

import subprocess
import sys

LEFT = []


def test_a_process_is_started_and_not_ended():
    LEFT.append(subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"]))
    assert LEFT[0].poll() is None


def test_it_was_ended_with_its_test():
    assert all(process.poll() is not None for process in LEFT)

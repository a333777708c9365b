"""The self-test: well on this machine, told when something is wrong, and the same for every kind of processor."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from eventsim.cli import main
from eventsim.validation import selftest
from tests.validate.write_digests import table

ROOT = Path(__file__).parents[2]


def test_the_table_is_what_the_engines_say_today() -> None:
    """Written by tests.validate.write_digests."""
    assert json.loads(Path(selftest.__file__).with_name(selftest.TABLE).read_text()) == json.loads(table())


def test_a_machine_that_computes_otherwise_is_told_so(monkeypatch: pytest.MonkeyPatch) -> None:
    known = json.loads(table())
    known["break"][2] = "0" * 64
    known["gas"][0] = "0" * 64
    monkeypatch.setattr(selftest, "_table", lambda: json.dumps(known))
    monkeypatch.setattr(selftest, "has_compiler", lambda: False)
    monkeypatch.setattr(selftest, "_multiply_and_add_plainly", lambda x, y, z: 2.0**-60)
    done = CliRunner().invoke(main, ["selftest"])
    assert done.exit_code == 1
    assert "wrong  break: its log: its rows are not those of the table" in done.output
    assert "open   gas: its log: NumPy draws other numbers here" in done.output
    assert "wrong  Python: products are rounded before sums: multiplications and additions are fused" in done.output
    assert "do not trust results of this machine" in done.output
    assert "numpy: " in done.output


@pytest.mark.slow
@pytest.mark.parametrize("processor", ["generic", "x86-64-v2", "x86-64-v3"])
def test_all_processors_compute_the_same_bits(processor: str, tmp_path: Path) -> None:
    """Kernels for the fewest instructions, and for those that could multiply and add at once."""
    own = {"NUMBA_CPU_NAME": processor, "NUMBA_CPU_FEATURES": "", "NUMBA_CACHE_DIR": str(tmp_path), "PYTHONPATH": str(ROOT)}
    if processor == "x86-64-v3":
        del own["NUMBA_CPU_FEATURES"]
    code = (
        "from eventsim.validation import selftest\n"
        "found = [one for one in selftest.selftest(-1.0) if one.answer != 'well' and 'reference = fast' not in one.question]\n"
        "log = selftest.told(selftest.GAS, selftest.gas())[1]\n"
        "one = selftest._engines_agree(selftest.GAS, log, float('inf'))\n"
        "assert not [each for each in [*found, one] if each.answer == 'wrong'], (found, one)\n"
        "assert one.answer == 'well', one\n"
    )
    subprocess.run([sys.executable, "-c", code], env=os.environ | own, check=True, cwd=tmp_path)

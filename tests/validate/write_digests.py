"""Writes the table that `eventsim selftest` compares with: after a change that is meant to change logs.

    python -m tests.validate.write_digests
"""

from __future__ import annotations

import json
from pathlib import Path

from eventsim.validation import selftest


def table() -> str:
    """The table, from what this machine computes."""
    entries = {name: list(selftest.told(name, scene)[0]) for name, scene in selftest.scenes()}
    return json.dumps(entries, indent=1) + "\n"


if __name__ == "__main__":
    Path(selftest.__file__).with_name(selftest.TABLE).write_text(table(), encoding="utf-8")

"""Are the rows of the gallery those of another checkout, up to where places are counted from?  A command, no test.

    python -m tests.record.same_rows CHECKOUT [NAME ...]

Each scene is run by the reference engine here and there, from the stored starts.  A scene of a closed domain must give the same
bytes.  One of the open plane must give the same contacts; its places and times may differ by the rounding of another corner, and
the largest differences are told.  `--write` enters the digests of here into tests/gallery/golden.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import eventsim as es
from eventsim.record.compare import agreement
from eventsim.scene.stage import stage_of
from tests.gallery.test_gallery_digests import DIGESTS, outcome, stored

THERE = """
import sys, numpy as np, eventsim as es
from tests.gallery.test_gallery_digests import stored
from eventsim.scene.stage import stage_of
for name in sys.argv[2:]:
    scene = stored(name)
    log = es.simulate(scene, engine="reference", log=True).log
    np.savez(f"{sys.argv[1]}/{name}.npz", rows=log.rows, corner=np.array(stage_of(scene).corner))
"""


def verdict(name: str, rows: np.ndarray, corner: np.ndarray) -> str:
    """Compare the rows of a scene here with those of there; one line."""
    scene = stored(name)
    log = es.simulate(scene, engine="reference", log=True).log
    if log.rows.tobytes() == rows.tobytes():
        return f"{name}: {len(rows)} rows, the same bytes"
    moved = np.array(stage_of(scene).corner) - corner
    shifted = log.rows.copy()
    for column, along in (("xa", 0), ("xb", 0), ("ya", 1), ("yb", 1)):
        shifted[column] += moved[along]
    found = agreement(shifted, rows)
    mine, theirs = shifted[found.pairs[:, 0]], rows[found.pairs[:, 1]]
    apart = {
        column: float(np.nanmax(np.abs(mine[column] - theirs[column]), initial=0.0))
        for column in ("time", "xa", "ya", "vxa", "vya")
    }
    same = found.difference is None and found.missing == found.surplus == 0
    words = ", ".join(f"{column} {value:.1e}" for column, value in apart.items())
    order = "the same contacts" if same else f"DIFFERENT from row {found.difference}"
    return f"{name}: {len(rows)} rows, {order}, shifted by {moved.tolist()}; apart by at most {words}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("checkout", type=Path, help="of the commit before")
    parser.add_argument("names", nargs="*", help="gallery scenes; all without")
    parser.add_argument("--write", action="store_true", help="write the golden digests")
    given = parser.parse_args()
    known = json.loads(DIGESTS.read_text())
    names = given.names or sorted(known)
    with tempfile.TemporaryDirectory() as place:
        subprocess.run([sys.executable, "-c", THERE, place, *names], cwd=given.checkout, check=True)
        for name in names:
            with np.load(Path(place) / f"{name}.npz") as arrays:
                print(verdict(name, arrays["rows"], arrays["corner"]), flush=True)
            if given.write:
                known[name] = outcome(stored(name))
    if given.write:
        DIGESTS.write_text(json.dumps(known, indent=2) + "\n")


if __name__ == "__main__":
    main()

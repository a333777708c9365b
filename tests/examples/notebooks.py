"""Makes the notebooks of the lessons from their scripts, outputs and figures included.

    python -m tests.examples.notebooks
    python -m tests.examples.notebooks --without-answers FOLDER    scripts and notebooks for students, not run yet

A script has cells as editors know them: a line `# %%` begins code, `# %% [markdown]` text.
"""

from __future__ import annotations

import base64
import io
import json
import re
import sys
import warnings
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any

LESSONS = Path(__file__).parents[2] / "examples" / "lessons"
DPI = 80
WITHOUT = "--without-answers"
ANSWER = "\n#\n# **Answer.**"
"""What stands between an exercise and its answer, with which a script ends."""

ROOM = "\n\n# %%\n# your answer\n"


def cells_of(script: str) -> list[tuple[str, str]]:
    """The cells of a script: ("markdown" | "code", text)."""
    cells = []
    for block in re.split(r"^# %%", script, flags=re.MULTILINE)[1:]:
        kind, _, text = block.partition("\n")
        if "[markdown]" in kind:
            cells.append(("markdown", re.sub(r"^# ?", "", text.strip(), flags=re.MULTILINE)))
        else:
            cells.append(("code", text.strip()))
    return cells


def executed(cells: list[tuple[str, str]]) -> list[list[dict[str, Any]]]:
    """The outputs of each cell, run one after the other in one place: what it printed, and its figures."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    place: dict[str, Any] = {}
    found = []
    for kind, text in cells:
        outputs: list[dict[str, Any]] = []
        if kind == "code":
            with redirect_stdout(io.StringIO()) as said, warnings.catch_warnings():
                warnings.simplefilter("ignore", UserWarning)  # plt.show() has no window here
                exec(compile(text, "a cell", "exec"), place)
            if said.getvalue():
                outputs.append({"output_type": "stream", "name": "stdout", "text": said.getvalue().splitlines(keepends=True)})
            for number in plt.get_fignums():
                picture = io.BytesIO()
                plt.figure(number).savefig(picture, format="png", dpi=DPI, metadata={"Software": None})
                data = {"image/png": base64.b64encode(picture.getvalue()).decode("ascii")}
                outputs.append({"output_type": "display_data", "metadata": {}, "data": data})
            plt.close("all")
        found.append(outputs)
    return found


def notebook_of(script: str, outputs: list[list[dict[str, Any]]]) -> dict[str, Any]:
    """The notebook of a script."""
    cells: list[dict[str, Any]] = []
    for number, ((kind, text), told) in enumerate(zip(cells_of(script), outputs, strict=True)):
        cell: dict[str, Any] = {
            "cell_type": kind,
            "id": f"cell-{number}",
            "metadata": {},
            "source": text.splitlines(keepends=True),
        }
        if kind == "code":
            cell |= {"execution_count": None, "outputs": told}
        cells.append(cell)
    kernel = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}
    return {"cells": cells, "metadata": kernel, "nbformat": 4, "nbformat_minor": 5}


def without_answer(script: str) -> str:
    """The script with room where its answer was."""
    question, found, _ = script.partition(ANSWER)
    assert found, "a lesson has an answer"
    return question + ROOM


def write_notebook(path: Path, script: str, outputs: list[list[dict[str, Any]]]) -> None:
    """Write the notebook of a script."""
    notebook = notebook_of(script, outputs)
    text = json.dumps(notebook, indent=1, ensure_ascii=False) + "\n"
    path.write_text(text, encoding="utf-8")
    print(f"{path.stem}: {len(notebook['cells'])} cells, {len(text) // 1000} kB")


def main() -> int:
    """Write all notebooks, or those of the lessons that are named; or scripts and notebooks without answers to a folder."""
    sys.argv, names = sys.argv[:1], sys.argv[1:]
    folder = LESSONS
    if WITHOUT in names:
        at = names.index(WITHOUT)
        if at + 1 == len(names):
            print(f"{WITHOUT} FOLDER: say where the lessons for students are to be written", file=sys.stderr)
            return 2
        folder = Path(names[at + 1])
        folder.mkdir(parents=True, exist_ok=True)
        names = names[:at] + names[at + 2 :]
    for path in sorted(LESSONS.glob("*.py")):
        if not names or path.stem in names:
            script = path.read_text(encoding="utf-8")
            if folder.resolve() == LESSONS:
                outputs = executed(cells_of(script))
            else:
                script = without_answer(script)
                outputs = [[] for _ in cells_of(script)]
                (folder / path.name).write_text(script, encoding="utf-8")
            write_notebook(folder / f"{path.stem}.ipynb", script, outputs)
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""The notebook of the examples was executed, and says what its cells say today."""

import io
import json
from contextlib import redirect_stdout
from pathlib import Path

import pytest

NOTEBOOK = Path(__file__).parents[2] / "examples" / "notebook.ipynb"
CELLS = [cell for cell in json.loads(NOTEBOOK.read_text())["cells"] if cell["cell_type"] == "code"]


def text_of(cell):
    return "".join("".join(output.get("text", "")) for output in cell["outputs"])


def test_every_cell_was_executed_without_an_error():
    assert all(cell["execution_count"] for cell in CELLS)
    assert all(output["output_type"] != "error" for cell in CELLS for output in cell["outputs"])
    shown = [output["data"] for cell in CELLS for output in cell["outputs"] if "data" in output]
    assert any("openPlayer" in "".join(data.get("text/html", "")) for data in shown)


def test_the_cells_print_what_they_printed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for cell in CELLS:
        source = "".join(cell["source"])
        if "IPython" in source:
            pytest.importorskip("IPython", reason="IPython is not installed")
        printed = io.StringIO()
        with redirect_stdout(printed):
            exec(source, names)
        assert printed.getvalue() == text_of(cell)

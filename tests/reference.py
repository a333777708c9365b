"""Builds the reference: public names from their docstrings, commands from their --help, and the pages that teach.

    python -m tests.reference [--out FOLDER]

pdoc renders them; nothing of it is committed.
"""

from __future__ import annotations

import argparse
import sys
import warnings
from pathlib import Path
from types import ModuleType

import click

import eventsim
from eventsim.cli import main as command_line
from eventsim.cli.program import VERBS

EXAMPLES = Path(__file__).parents[1] / "examples"
PAGES = {"log_format": "log-format.md", "which_tool": "which-tool.md"}


def helps() -> str:
    """The help of every verb, as it is printed."""
    blocks = []
    with click.Context(command_line, info_name="eventsim") as context:
        for verb in VERBS:
            command = command_line.get_command(context, verb)
            assert command is not None
            with click.Context(command, info_name=verb, parent=context, terminal_width=110) as inner:
                blocks.append(f"## eventsim {verb}\n\n```text\n{command.get_help(inner)}\n```")
    return "\n\n".join(["The command line, verb by verb; each says the same with --help.", *blocks])


def page(name: str, text: str) -> ModuleType:
    """A page of its own: pdoc knows modules, and shows what they say of themselves."""
    module = ModuleType(name, text)
    module.__all__ = []  # type: ignore[attr-defined]
    return module


def build(folder: Path) -> list[Path]:
    """Write the reference into a folder; return its files."""
    import pdoc

    pages = [page("command_line", helps())]
    pages += [page(name, (EXAMPLES / file).read_text(encoding="utf-8")) for name, file in PAGES.items()]
    pdoc.render.configure(docformat="google", math=True, show_source=False, search=False)
    folder.mkdir(parents=True, exist_ok=True)
    modules = {module.__name__: pdoc.doc.Module(module) for module in (eventsim, *pages)}
    files = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # annotations that only type checkers see are shown as they are written
        for name, module in modules.items():
            files.append(folder / f"{name}.html")
            files[-1].write_text(pdoc.render.html_module(module, modules), encoding="utf-8")
        files.append(folder / "index.html")
        files[-1].write_text(pdoc.render.html_index(modules), encoding="utf-8")
    return files


def main() -> int:
    """Build it where it is asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=Path("build/reference"))
    for file in build(parser.parse_args().out):
        print(file)
    return 0


if __name__ == "__main__":
    sys.exit(main())

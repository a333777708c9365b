"""How large the house is, folder by folder: python -m tests.house [REVISION ...], the working tree last.

code: lines that hold a token, comments and docstrings apart.  imports: those of them that import.  statements: as the parser
counts them.
"""

from __future__ import annotations

import ast
import io
import subprocess
import sys
import tokenize
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parent.parent
EMPTY = {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENCODING}


DOCUMENTED = ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef


class Size(NamedTuple):
    """Of a file, or of several."""

    files: int = 0
    code: int = 0
    imports: int = 0
    statements: int = 0

    def plus(self, other: Size) -> Size:
        """Both together."""
        return Size(*(one + two for one, two in zip(self, other, strict=True)))


def size_of(text: str) -> Size:
    """The size of one module."""
    tree = ast.parse(text)
    told: set[int] = set()
    for node in ast.walk(tree):
        if isinstance(node, DOCUMENTED) and ast.get_docstring(node) is not None:
            docstring = node.body[0]
            told.update(range(docstring.lineno, (docstring.end_lineno or docstring.lineno) + 1))
    code = {
        line
        for token in tokenize.generate_tokens(io.StringIO(text).readline)
        if token.type not in EMPTY and token.type != tokenize.ENDMARKER
        for line in range(token.start[0], token.end[0] + 1)
    }
    statements = [node for node in ast.walk(tree) if isinstance(node, ast.stmt)]
    imports = {
        line
        for node in statements
        if isinstance(node, ast.Import | ast.ImportFrom)
        for line in range(node.lineno, (node.end_lineno or node.lineno) + 1)
    }
    return Size(1, len(code - told), len(imports), len(statements))


def modules(revision: str | None) -> Iterator[tuple[str, str]]:
    """(path, text) of the modules of a revision of the repository; None: of the working tree."""
    if revision is None:
        for path in sorted((ROOT / "eventsim").rglob("*.py")):
            yield str(path.relative_to(ROOT)), path.read_text()
        return
    listed = subprocess.run(
        ["git", "ls-tree", "-r", "--name-only", revision, "eventsim"], cwd=ROOT, capture_output=True, text=True, check=True
    )
    for name in listed.stdout.split():
        if name.endswith(".py"):
            shown = subprocess.run(["git", "show", f"{revision}:{name}"], cwd=ROOT, capture_output=True, text=True, check=True)
            yield name, shown.stdout


def sizes(revision: str | None) -> dict[str, Size]:
    """Folder of eventsim -> its size, all below it included; `eventsim`: everything."""
    found: dict[str, Size] = defaultdict(Size)
    for name, text in modules(revision):
        size = size_of(text)
        parts = Path(name).parts
        folder = parts[1] if len(parts) > 2 else "(top)"
        for key in {"eventsim", folder}:
            found[key] = found[key].plus(size)
        if folder == "engines" and len(parts) > 3:
            key = f"  engines/{parts[2]}"
            found[key] = found[key].plus(size)
    return found


def table(revisions: list[str | None]) -> str:
    """The sizes side by side."""
    columns = [sizes(revision) for revision in revisions]
    names = sorted({name for column in columns for name in column}, key=lambda name: (name == "eventsim", name.strip()))
    titles = [f"{revision or 'now':>31}" for revision in revisions]
    head = f"{'files':>5}{'code':>8}{'imports':>8}{'stmts':>10}"
    lines = [f"{'':<22}{'  '.join(titles)}", f"{'':<22}{'  '.join([head] * len(columns))}"]
    for name in names:
        cells = [column.get(name, Size()) for column in columns]
        told = [f"{size.files:>5}{size.code:>8}{size.imports:>8}{size.statements:>10}" for size in cells]
        lines.append(f"{name:<22}" + "  ".join(told))
    return "\n".join(lines)


if __name__ == "__main__":
    print(table([*sys.argv[1:], None]))

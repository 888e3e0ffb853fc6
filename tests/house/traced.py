"""Trace the guide's hazards and threats to code and tests.

python -m tests.house.traced [--run]: prints each row with what is missing; with --run, whether it passes.
"""

import argparse
import ast
import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TEST = re.compile(r"`(tests/[\w/]+\.py)::(\w+)`")
PART = re.compile(r"`((?:server|tracker|web/src)/[\w/]+(?:\.py)?)`")


@dataclass(frozen=True, slots=True, kw_only=True)
class TracedRow:
    """One row of a table in the guide.

    Attributes:
        page: name of the page.
        cells: its cells, as written.
    """

    page: str
    cells: tuple[str, ...]

    @property
    def tests(self) -> tuple[str, ...]:
        """Node ids of the tests that it names."""
        return tuple(f"{path}::{name}" for cell in self.cells for path, name in TEST.findall(cell))

    @property
    def missing(self) -> tuple[str, ...]:
        """Files and tests that it names and that do not exist; or that it names none."""
        absent = [part for cell in self.cells for part in PART.findall(cell) if not (ROOT / part).exists()]
        for test in self.tests:
            path, _, name = test.partition("::")
            if name not in _functions(ROOT / path):
                absent.append(test)
        return tuple(absent) if self.tests else ("a test",)


def traced_rows(page: str) -> list[TracedRow]:
    """Return the rows of all tables with a column `test` of a page of the guide."""
    text = (ROOT / f"docs/guide/{page}.md").read_text(encoding="utf-8")
    return [TracedRow(page=page, cells=cells) for cells in _table_rows(text)]


def _table_rows(text: str) -> Iterator[tuple[str, ...]]:
    is_traced = False
    for line in text.splitlines():
        if not line.startswith("|"):
            is_traced = False
            continue
        cells = tuple(cell.strip() for cell in line.strip("|").split("|"))
        if "test" in cells:
            is_traced = True
        elif is_traced and not set("".join(cells)) <= {"-", ":"}:
            yield cells


@cache
def _functions(path: Path) -> frozenset[str]:
    if not path.is_file():
        return frozenset()
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return frozenset(node.name for node in tree.body if isinstance(node, ast.FunctionDef))


def _passes(test: str) -> bool:
    # In a process of its own: a row is judged by its test alone.
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", test]
    return subprocess.run(command, cwd=ROOT, capture_output=True, check=False).returncode == 0


def main(arguments: list[str] | None = None) -> int:
    """Print the rows; return 1 if one lacks a file or test, or its test does not pass."""
    parser = argparse.ArgumentParser(prog="python -m tests.house.traced", description=__doc__)
    parser.add_argument("--run", action="store_true", help="run each test")
    given = parser.parse_args(arguments)
    untraced = 0
    rows = [row for page in ("hazards", "threats") for row in traced_rows(page)]
    for row in rows:
        state = f"missing: {', '.join(row.missing)}" if row.missing else "traced"
        if given.run and not row.missing:
            state = "passed" if all(map(_passes, row.tests)) else "FAILED"
        untraced += state not in {"traced", "passed"}
        sys.stdout.write(f"{state:8} {row.page}: {' | '.join(filter(None, row.cells))}\n")
        sys.stdout.flush()
    sys.stdout.write(f"{len(rows)} rows, {untraced} without evidence\n")
    return 1 if untraced else 0


if __name__ == "__main__":
    sys.exit(main())

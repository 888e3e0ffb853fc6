"""Trace the guide's hazards, threats and security requirements to code and tests.

python -m tests.house.traced [--run]: prints each row with what is missing; with --run, whether it passes.
"""

import argparse
import ast
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest

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
    return [TracedRow(page=page, cells=cells) for cells in guide_rows(page, column="test")]


def guide_rows(page: str, *, column: str) -> Iterator[tuple[str, ...]]:
    """Yield the cells of each row of the tables with this column of a page of the guide."""
    text = (ROOT / f"docs/guide/{page}.md").read_text(encoding="utf-8")
    is_wanted = False
    for line in text.splitlines():
        if not line.startswith("|"):
            is_wanted = False
            continue
        cells = tuple(cell.strip() for cell in line.strip("|").split("|"))
        if column in cells:
            is_wanted = True
        elif is_wanted and not set("".join(cells)) <= {"-", ":"}:
            yield cells


@cache
def _functions(path: Path) -> frozenset[str]:
    if not path.is_file():
        return frozenset()
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return frozenset(node.name for node in tree.body if isinstance(node, ast.FunctionDef))


class _Outcomes:
    """A plug-in of pytest that collects which tests passed; one that was skipped has not."""

    def __init__(self) -> None:
        self._passed: set[str] = set()
        self._failed: set[str] = set()

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Take the outcome of a part of a test, for all of its parameters."""
        test = report.nodeid.partition("[")[0]
        if report.failed:
            self._failed.add(test)
        elif report.when == "call" and report.passed:
            self._passed.add(test)

    @property
    def passed(self) -> set[str]:
        """Node ids of the tests of which nothing failed."""
        return self._passed - self._failed


def passed_tests(tests: Sequence[str]) -> set[str]:
    """Run tests in this process, and return those that passed."""
    outcomes = _Outcomes()
    pytest.main(["-q", "--tb=no", "-p", "no:cacheprovider", *tests], plugins=[outcomes])
    return outcomes.passed


def main(arguments: list[str] | None = None) -> int:
    """Print the rows; return 1 if one lacks a file or test, or its test does not pass."""
    parser = argparse.ArgumentParser(prog="python -m tests.house.traced", description=__doc__)
    parser.add_argument("--run", action="store_true", help="run each test")
    given = parser.parse_args(arguments)
    untraced = 0
    rows = [row for page in ("hazards", "threats", "asvs") for row in traced_rows(page)]
    passed = (
        passed_tests([test for row in rows if not row.missing for test in row.tests]) if given.run else set()
    )
    for row in rows:
        state = f"missing: {', '.join(row.missing)}" if row.missing else "traced"
        if given.run and not row.missing:
            state = "passed" if passed.issuperset(row.tests) else "FAILED"
        untraced += state not in {"traced", "passed"}
        sys.stdout.write(f"{state:8} {row.page}: {' | '.join(filter(None, row.cells))}\n")
    sys.stdout.write(f"{len(rows)} rows, {untraced} without evidence\n")
    return 1 if untraced else 0


if __name__ == "__main__":
    sys.exit(main())

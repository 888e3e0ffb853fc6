"""The guide's table of threats names tests that exist."""

import ast
import re
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
KINDS = set("STRIDE")


@cache
def names_in(path: Path) -> frozenset[str]:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return frozenset(node.name for node in tree.body if isinstance(node, ast.FunctionDef))


def rows_of_threats() -> list[list[str]]:
    text = (ROOT / "docs/guide/threats.md").read_text(encoding="utf-8")
    rows = [
        [cell.strip() for cell in line[1:-1].split("|")]
        for line in re.findall(r"^\|.+\|$", text, re.MULTILINE)
    ]
    return rows[2:]


def test_each_threat_has_a_kind_a_measure_and_a_test_that_exists() -> None:
    rows = rows_of_threats()
    assert len(rows) > 30
    for row in rows:
        _, kind, threat, measure, test = row
        assert kind in KINDS, row
        assert threat, row
        assert measure, row
        path, _, name = test.strip("`").partition("::")
        assert name in names_in(ROOT / path), row


def test_each_kind_of_threat_was_considered() -> None:
    assert {row[1] for row in rows_of_threats()} == KINDS

"""Each hazard, threat and security requirement of the guide names code and a test that exist."""

from pathlib import Path

import pytest

from tests.house import traced
from tests.house.traced import main, passed_tests, traced_rows

STRIDE = set("STRIDE")


def test_nothing_is_without_evidence(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 0
    assert capsys.readouterr().out.endswith(" rows, 0 without evidence\n")


def test_hazards_are_numbered_have_a_severity_and_say_what_remains() -> None:
    rows = [row.cells for row in traced_rows("hazards")]
    assert [cells[0] for cells in rows] == [f"H{number}" for number in range(1, len(rows) + 1)]
    for cells in rows:
        assert len(cells) == 8, cells
        assert all(cells), cells
        assert cells[3][0] in "123", cells


def test_each_kind_of_threat_was_considered() -> None:
    assert {row.cells[1] for row in traced_rows("threats")} == STRIDE


@pytest.mark.parametrize(
    ("row", "missing"),
    [
        ("H1 | `tests/house/test_traced.py::test_that_is_not_there`", "test_that_is_not_there"),
        ("H1 | `tests/house/no_such_file.py::test_it`", "no_such_file"),
        (
            "H1 | `server/no_such_part.py` | `tests/house/test_traced.py::test_nothing_is_without_evidence`",
            "no_such",
        ),
        ("H1 | no test", "a test"),
    ],
)
def test_a_row_without_its_evidence_is_reported(
    row: str,
    missing: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    guide = tmp_path / "docs/guide"
    guide.mkdir(parents=True)
    (guide / "hazards.md").write_text(f"| id | test |\n|---|---|\n| {row} |\n", encoding="utf-8")
    for other in ("threats", "asvs"):
        (guide / f"{other}.md").write_text("", encoding="utf-8")
    monkeypatch.setattr(traced, "ROOT", tmp_path)
    assert main([]) == 1
    reported = capsys.readouterr().out
    assert missing in reported
    assert reported.endswith("1 rows, 1 without evidence\n")


def test_a_test_that_was_skipped_or_fails_for_one_parameter_has_not_passed(tmp_path: Path) -> None:
    (tmp_path / "test_made.py").write_text(
        "import pytest\n"
        "def test_good(): pass\n"
        "def test_bad(): assert False\n"
        "@pytest.mark.skip\n"
        "def test_skipped(): pass\n"
        "@pytest.mark.parametrize('n', [1, 2])\n"
        "def test_of_each(n): assert n < 2\n",
        encoding="utf-8",
    )
    passed = passed_tests([f"{tmp_path}/test_made.py", f"--rootdir={tmp_path}"])
    assert passed == {"test_made.py::test_good"}

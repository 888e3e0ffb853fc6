"""The import contracts of pyproject.toml."""

import pytest
from importlinter.cli import lint_imports


def test_every_import_contract_is_kept(capsys: pytest.CaptureFixture[str]) -> None:
    stored = lint_imports(no_cache=True) == 0
    assert stored, capsys.readouterr().out

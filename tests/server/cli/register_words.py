"""`coaxial register ...` as it is typed, and the files that it is given."""

from pathlib import Path

import numpy as np
from typer.testing import CliRunner

from server.cli import app
from tracker.errors import NavigationError


def typed(*words: str | Path) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["register", *(str(word) for word in words)])
    if isinstance(result.exception, NavigationError):
        # `server.cli.main` tells it, with status 2.
        return 2, f"{result.exception.code}: {result.exception.message}"
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result.exit_code, result.stdout


def written(path: Path, points: np.ndarray, header: str = "", names: str = "") -> Path:
    rows = [",".join(f"{number:.9f}" for number in row) for row in points]
    if names:
        rows = [f"{name},{row}" for name, row in zip(names, rows, strict=True)]
    path.write_text("\n".join(([header] if header else []) + rows) + "\n", encoding="utf-8")
    return path

"""`coaxial board` as a person types it."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from server.cli import app
from tracker.errors import NavigationError


def typed(*words: str | Path) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["board", *map(str, words)])
    if isinstance(result.exception, NavigationError):
        # `server.cli.main` tells it, with status 2.
        return 2, result.exception.code
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result.exit_code, result.stdout


@pytest.mark.parametrize(
    ("words", "said"),
    [
        pytest.param(("dots",), "dots 16x14, pitch 10 mm, on A4 210 x 297 mm", id="dots"),
        pytest.param(
            ("dots", "--size", "4 x 11", "--layout", "asymmetric", "--pitch-mm", "15"),
            "dots 4x11 asymmetric, pitch 15 mm",
            id="asymmetric",
        ),
        pytest.param(
            ("dots", "--pitch-mm", "4", "--fiducials", "69, 74,149,154", "--paper", "letter"),
            "larger dots 69,74,149,154, on letter",
            id="larger-dots",
        ),
        pytest.param(
            ("checkerboard",), "checkerboard 9x6 inner corners, square 25 mm, on A4 297 x 210", id="checkers"
        ),
        pytest.param(
            ("charuco", "--layout", "older", "--paper", "A3"),
            "DICT_6X6_250, older layout, on A3",
            id="charuco",
        ),
        pytest.param(("aprilgrid",), "aprilgrid 6x6 tags, tag 20 mm, gap 6 mm", id="april-grid"),
    ],
)
@pytest.mark.parametrize("kind", ["pdf", "svg"])
def test_each_board_is_written(words: tuple[str, ...], said: str, kind: str, tmp_path: Path) -> None:
    status, text = typed(*words, "--output", tmp_path / "new" / f"board.{kind}")
    assert status == 0
    assert said in text
    content = (tmp_path / "new" / f"board.{kind}").read_bytes()
    assert content.startswith(b"%PDF-1.4" if kind == "pdf" else b"<?xml")


@pytest.mark.parametrize(
    ("words", "code"),
    [
        pytest.param(("dots", "--size", "many"), "BOARD_OPTION_INVALID", id="no-size"),
        pytest.param(("dots", "--size", "1x9"), "BOARD_INVALID", id="one-column"),
        pytest.param(("dots", "--fiducials", "a"), "BOARD_OPTION_INVALID", id="no-index"),
        pytest.param(("dots", "--fiducials", "224"), "BOARD_INVALID", id="index-beyond"),
        pytest.param(("dots", "--dot-mm", "9.5"), "BOARD_DOTS_UNPRINTABLE", id="dots-touch"),
        pytest.param(("checkerboard", "--square-mm", "nan"), "BOARD_INVALID", id="no-length"),
        pytest.param(("checkerboard", "--square-mm", "60"), "BOARD_TOO_LARGE", id="too-large"),
        pytest.param(("charuco", "--marker-mm", "30"), "BOARD_INVALID", id="no-margin"),
        pytest.param(("aprilgrid", "--gap-mm", "21"), "BOARD_INVALID", id="gap-wider-than-a-tag"),
        pytest.param(("charuco", "--dictionary", "DICT_9X9"), "BOARD_INVALID", id="no-dictionary"),
    ],
)
def test_what_cannot_be_printed_is_rejected(words: tuple[str, ...], code: str, tmp_path: Path) -> None:
    assert typed(*words, "--output", tmp_path / "board.pdf") == (2, code)
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_is_neither_pdf_nor_svg_is_rejected(tmp_path: Path) -> None:
    assert typed("dots", "--output", tmp_path / "board.png") == (2, "BOARD_FILE_UNKNOWN")

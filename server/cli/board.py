"""`coaxial board`: a calibration board as a file to print."""

import re
from pathlib import Path

import typer

from server.cli.output import write_whole
from server.printing import board_sheet, pdf_from_sheet, svg_from_sheet
from server.printing.board_sheet import description_of
from tracker.camera.boards import Board
from tracker.errors import InvalidInput

SIZE = re.compile(r"\s*(\d{1,4})\s*[xX×,]\s*(\d{1,4})\s*")


def size_of(text: str) -> tuple[int, int]:
    """Columns and rows as a person types them: "14x16".

    Raises:
        InvalidInput: BOARD_SIZE_INVALID.
    """
    match = SIZE.fullmatch(text)
    if match is None:
        raise InvalidInput(
            "BOARD_SIZE_INVALID",
            f"'{text}' is no size of a board",
            "Give columns x rows with --size, as in --size 14x16.",
            {"size": text},
        )
    return int(match[1]), int(match[2])


def indexes_of(text: str) -> tuple[int, ...]:
    """Indexes with commas between.

    Raises:
        InvalidInput: BOARD_INDEXES_INVALID.
    """
    words = [word for word in re.split(r"[\s,]+", text) if word]
    if not all(word.isascii() and word.isdigit() for word in words):
        raise InvalidInput(
            "BOARD_INDEXES_INVALID",
            f"'{text}' are no indexes of dots",
            "Give whole numbers from 0 with --fiducials, row by row, as in --fiducials 69,74,149,154.",
            {"fiducials": text},
        )
    return tuple(int(word) for word in words)


def write_board(board: Board, output: Path, *, paper: str, dot_mm: float | None = None) -> None:
    """Write the page, and tell what to do with it.

    Raises:
        InvalidInput: BOARD_FILE_UNKNOWN, OUTPUT_NOT_WRITABLE, or as `board_sheet`.
    """
    kind = output.suffix.lower()
    if kind not in (".pdf", ".svg"):
        raise InvalidInput(
            "BOARD_FILE_UNKNOWN",
            f"{output} ends in neither .pdf nor .svg",
            "Name the file with --output board.pdf or --output board.svg.",
            {"file": str(output)},
        )
    sheet = board_sheet(board, paper=paper, dot_mm=dot_mm)
    write_whole(output, pdf_from_sheet(sheet) if kind == ".pdf" else svg_from_sheet(sheet).encode())
    width, height = sheet.size_mm
    typer.echo(
        f"Wrote {output}: {description_of(board)}, on {paper} {width:g} x {height:g} mm.\n"
        "Print it at 100 %, glue it onto something flat, and measure both rulers and the board itself."
    )

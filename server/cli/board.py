"""`coaxial board`: a calibration board as a file to print."""

from pathlib import Path

import typer

from server.cli.output import write_atomically
from server.printing import board_sheet, pdf_from_sheet, svg_from_sheet
from server.printing.board_sheet import description_of
from tracker.camera.boards import Board
from tracker.errors import InvalidInput


def write_board(board: Board, output: Path, *, paper: str, dot_mm: float | None = None) -> None:
    """Write the sheet and print instructions.

    Raises:
        InvalidInput: BOARD_FILE_UNKNOWN, OUTPUT_NOT_WRITABLE, or as `board_sheet`.
    """
    kind = output.suffix.lower()
    if kind not in (".pdf", ".svg"):
        raise InvalidInput(
            "BOARD_FILE_UNKNOWN",
            f"the file type of {output} is neither .pdf nor .svg",
            "Name the file with --output board.pdf or --output board.svg.",
            {"file": str(output)},
        )
    sheet = board_sheet(board, paper=paper, dot_mm=dot_mm)
    write_atomically(output, pdf_from_sheet(sheet) if kind == ".pdf" else svg_from_sheet(sheet).encode())
    width, height = sheet.size_mm
    typer.echo(
        f"Wrote {output}: {description_of(board)}, on {paper} {width:g} x {height:g} mm.\n"
        "Print it at 100 %, fix it to a flat surface, and measure both rulers and the board."
    )

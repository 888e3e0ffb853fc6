"""The commands `coaxial board dots`, `checkerboard`, `charuco` and `aprilgrid`."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

board_app = typer.Typer(
    help="Make a calibration board to print at true size, as PDF or SVG.",
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)


class Paper(StrEnum):
    """Paper sizes."""

    A4 = "A4"
    A3 = "A3"
    LETTER = "letter"


class DotLayoutName(StrEnum):
    """Arrangement of the dots."""

    SYMMETRIC = "symmetric"
    ASYMMETRIC = "asymmetric"


class CharucoLayoutName(StrEnum):
    """Which corner is black."""

    NEWER = "newer"
    OLDER = "older"


OutputOption = Annotated[
    Path, typer.Option("--output", "-o", help="File to write; .pdf or .svg.", metavar="FILE")
]
PaperOption = Annotated[Paper, typer.Option(help="Paper size; the orientation follows the board.")]


@board_app.command()
def dots(
    output: OutputOption,
    size: Annotated[str, typer.Option(help="Columns x rows of dots.", metavar="CxR")] = "16x14",
    pitch_mm: Annotated[
        float,
        typer.Option(
            "--pitch-mm",
            help="Distance between neighbouring dots; asymmetric: between rows.",
            metavar="MM",
        ),
    ] = 10.0,
    layout: Annotated[
        DotLayoutName, typer.Option(help="Asymmetric: every second row is shifted by half a pitch.")
    ] = DotLayoutName.SYMMETRIC,
    fiducials: Annotated[
        str,
        typer.Option(
            help="Larger dots that define the orientation: comma-separated indexes, row by row from 0.",
            metavar="INDEXES",
        ),
    ] = "",
    dot_mm: Annotated[
        float | None,
        typer.Option("--dot-mm", help="Diameter of a dot; default: half the pitch.", metavar="MM"),
    ] = None,
    paper: PaperOption = Paper.A4,
) -> None:
    """Make a grid of dots."""
    from server.cli.board import write_board  # noqa: PLC0415  loaded when needed
    from server.cli.board_options import indexes_of, size_of  # noqa: PLC0415
    from tracker.camera.boards import DotBoard, DotLayout  # noqa: PLC0415

    columns, rows = size_of("--size", size)
    board = DotBoard(
        columns=columns,
        rows=rows,
        pitch_mm=pitch_mm,
        layout=DotLayout(layout.value),
        fiducials=indexes_of(fiducials),
    )
    write_board(board, output, paper=paper.value, dot_mm=dot_mm)


@board_app.command()
def checkerboard(
    output: OutputOption,
    size: Annotated[str, typer.Option(help="Columns x rows of inner corners.", metavar="CxR")] = "9x6",
    square_mm: Annotated[float, typer.Option("--square-mm", help="Side of a square.", metavar="MM")] = 25.0,
    paper: PaperOption = Paper.A4,
) -> None:
    """Make a checkerboard; its size is given in inner corners."""
    from server.cli.board import write_board  # noqa: PLC0415  loaded when needed
    from server.cli.board_options import size_of  # noqa: PLC0415
    from tracker.camera.boards import CheckerBoard  # noqa: PLC0415

    columns, rows = size_of("--size", size)
    write_board(CheckerBoard(columns=columns, rows=rows, square_mm=square_mm), output, paper=paper.value)


@board_app.command()
def charuco(
    output: OutputOption,
    size: Annotated[str, typer.Option(help="Columns x rows of squares.", metavar="CxR")] = "8x5",
    square_mm: Annotated[float, typer.Option("--square-mm", help="Side of a square.", metavar="MM")] = 30.0,
    marker_mm: Annotated[
        float, typer.Option("--marker-mm", help="Side of a marker, including its black border.", metavar="MM")
    ] = 22.0,
    dictionary: Annotated[
        str, typer.Option(help="ArUco dictionary (OpenCV name).", metavar="NAME")
    ] = "DICT_6X6_250",
    layout: Annotated[
        CharucoLayoutName, typer.Option(help="Older: as drawn by OpenCV before 4.6 for even numbers of rows.")
    ] = CharucoLayoutName.NEWER,
    paper: PaperOption = Paper.A4,
) -> None:
    """Make a ChArUco board: a checkerboard with an ArUco marker in each white square."""
    from server.cli.board import write_board  # noqa: PLC0415  loaded when needed
    from server.cli.board_options import size_of  # noqa: PLC0415
    from tracker.camera.boards import CharucoBoard, CharucoLayout  # noqa: PLC0415

    columns, rows = size_of("--size", size)
    board = CharucoBoard(
        columns=columns,
        rows=rows,
        square_mm=square_mm,
        marker_mm=marker_mm,
        dictionary=dictionary,
        layout=CharucoLayout(layout.value),
    )
    write_board(board, output, paper=paper.value)


@board_app.command()
def aprilgrid(
    output: OutputOption,
    size: Annotated[str, typer.Option(help="Columns x rows of tags.", metavar="CxR")] = "6x6",
    tag_mm: Annotated[
        float, typer.Option("--tag-mm", help="Side of a tag, including its black border.", metavar="MM")
    ] = 20.0,
    gap_mm: Annotated[
        float, typer.Option("--gap-mm", help="Gap between two tags (Kalibr: spacing x size).", metavar="MM")
    ] = 6.0,
    paper: PaperOption = Paper.A4,
) -> None:
    """Make an AprilGrid as Kalibr uses it: AprilTags 36h11 with black squares between their corners."""
    from server.cli.board import write_board  # noqa: PLC0415  loaded when needed
    from server.cli.board_options import size_of  # noqa: PLC0415
    from tracker.camera.boards import AprilGridBoard  # noqa: PLC0415

    columns, rows = size_of("--size", size)
    write_board(
        AprilGridBoard(columns=columns, rows=rows, tag_mm=tag_mm, gap_mm=gap_mm), output, paper=paper.value
    )

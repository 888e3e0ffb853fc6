"""The options that describe a calibration board; light, as every command loads them."""

from enum import StrEnum
from typing import Annotated

import typer


class Pattern(StrEnum):
    """What is on the board."""

    DOTS = "dots"
    ASYMMETRIC_DOTS = "asymmetric-dots"
    CHECKERBOARD = "checkerboard"
    CHARUCO = "charuco"


SizeOption = Annotated[
    str | None,
    typer.Option(
        help="Columns x rows: of dots, inner corners, or squares of a ChArUco board.", metavar="CxR"
    ),
]
PatternOption = Annotated[Pattern | None, typer.Option(help="What is on the board.", show_default=False)]
PitchOption = Annotated[
    float | None, typer.Option("--pitch-mm", help="From a dot to the next one.", metavar="MM")
]
SquareOption = Annotated[float | None, typer.Option("--square-mm", help="Side of a square.", metavar="MM")]
MarkerOption = Annotated[
    float | None, typer.Option("--marker-mm", help="Side of a ChArUco marker.", metavar="MM")
]
DictionaryOption = Annotated[str, typer.Option(help="OpenCV's name of a ChArUco board's markers.")]
LargerOption = Annotated[
    str,
    typer.Option(help="Indexes of larger dots, row by row from 0, with commas between.", metavar="INDEXES"),
]

"""Command-line options that describe a board, shared by all commands that detect one."""

from typing import Annotated

import typer

from server.cli.board_names import SIZE_COUNTS, Layout, Pattern

_PATTERN = typer.Option(help="Pattern of the board.", show_default=False)
_SIZE = typer.Option(
    help=f"Columns x rows: {SIZE_COUNTS}.",
    metavar="14x16",
    show_default=False,
)

# For commands that always detect a board.
PatternArgument = Annotated[Pattern, _PATTERN]
SizeArgument = Annotated[str, _SIZE]
# For commands with an alternative to a board.
PatternOption = Annotated[Pattern | None, _PATTERN]
SizeOption = Annotated[str | None, _SIZE]
PitchOption = Annotated[
    float | None,
    typer.Option(
        "--pitch-mm",
        help="Distance between neighbouring dots; asymmetric: between rows.",
        metavar="MM",
    ),
]
SquareOption = Annotated[float | None, typer.Option("--square-mm", help="Side of a square.", metavar="MM")]
MarkerOption = Annotated[
    float | None, typer.Option("--marker-mm", help="Side of a ChArUco marker.", metavar="MM")
]
TagOption = Annotated[
    float | None,
    typer.Option("--tag-mm", help="Side of a tag of an AprilGrid, border included.", metavar="MM"),
]
GapOption = Annotated[
    float | None,
    typer.Option("--gap-mm", help="Gap between the tags of an AprilGrid.", metavar="MM"),
]
DictionaryOption = Annotated[
    str | None, typer.Option(help="ArUco dictionary, as DICT_6X6_250.", metavar="NAME")
]
FiducialsOption = Annotated[
    str | None,
    typer.Option(help="Indexes of the larger dots, as 69,74,149,154; default: detected.", metavar="LIST"),
]
LayoutOption = Annotated[
    Layout | None,
    typer.Option(help="Dots: symmetric or asymmetric. ChArUco: newer or older; default: detected."),
]

"""`coaxial accuracy` and `coaxial ruler` as they are typed."""

from pathlib import Path
from typing import Annotated

import typer

from server.cli.board_names import BoardOptions
from server.cli.board_typed import (
    DictionaryOption,
    FiducialsOption,
    LayoutOption,
    MarkerOption,
    PatternOption,
    PitchOption,
    SizeOption,
    SquareOption,
)

LimitOption = Annotated[
    float, typer.Option("--limit-mm", help="The largest error that passes.", metavar="MM", min=0.0)
]
JsonOption = Annotated[bool, typer.Option("--json", help="Write the figures as JSON.", show_default=False)]


def accuracy(
    camera: Annotated[
        Path, typer.Option("--camera", help="Camera file (matrix, distortion, size_wh_px).", metavar="FILE")
    ],
    rows: Annotated[
        Path | None,
        typer.Argument(
            help="CSV of displacements: x1_mm,y1_mm,x2_mm,y2_mm on a plane, and where they were seen: "
            "u1_px,v1_px,u2_px,v2_px.",
            metavar="ROWS",
        ),
    ] = None,
    plane: Annotated[
        Path | None,
        typer.Option(
            help="CSV of other points of the plane, to which its place is fitted: x_mm,y_mm,u_px,v_px. "
            "Without it each displacement is left out of a fit to all the others.",
            metavar="CSV",
        ),
    ] = None,
    image: Annotated[
        Path | None,
        typer.Option(
            help="In place of ROWS: an image of a calibration board; every other point fits the plane.",
            metavar="IMAGE",
        ),
    ] = None,
    pattern: PatternOption = None,
    size: SizeOption = None,
    pitch_mm: PitchOption = None,
    square_mm: SquareOption = None,
    marker_mm: MarkerOption = None,
    dictionary: DictionaryOption = None,
    fiducials: FiducialsOption = None,
    layout: LayoutOption = None,
    limit_mm: LimitOption = 0.5,
    json: JsonOption = False,
) -> None:
    """Check a calibrated camera: known displacements on a grid against measured ones.

    Points must come from an image that the camera was not calibrated with. Exit status 1 above the limit.
    """
    from server.cli.accuracy import check_on_board, check_rows  # noqa: PLC0415  loaded when needed

    if image is None or pattern is None or size is None:
        status = check_rows(rows, camera=camera, plane=plane, limit_mm=limit_mm, as_json=json)
        raise typer.Exit(status)
    board = BoardOptions(
        pattern=pattern,
        size=size,
        pitch_mm=pitch_mm,
        square_mm=square_mm,
        marker_mm=marker_mm,
        dictionary=dictionary,
        fiducials=fiducials,
        layout=layout,
    )
    raise typer.Exit(check_on_board(image, board, camera=camera, limit_mm=limit_mm, as_json=json))


def ruler(
    vertical_mm: Annotated[
        float, typer.Option("--vertical-mm", help="V: how far the camera is above the object.", metavar="MM")
    ],
    horizontal_mm: Annotated[
        float, typer.Option("--horizontal-mm", help="H: how far the camera is beside it.", metavar="MM")
    ],
    rows: Annotated[
        Path | None,
        typer.Argument(help="CSV of displacements, as for 'coaxial accuracy'.", metavar="ROWS"),
    ] = None,
    focal_length_px: Annotated[
        float | None,
        typer.Option(
            "--focal-length-px", help="f; left out, it follows from the first row alone.", metavar="PX"
        ),
    ] = None,
    limit_mm: LimitOption = 0.5,
    json: JsonOption = False,
) -> None:
    """Measure by hand: D, theta, Pd/Rd, f and displacements from V and H alone, as the paper's 2.2 does.

    Exit status 1 above the limit.
    """
    from server.cli.accuracy import measure_with_ruler  # noqa: PLC0415  loaded when needed

    status = measure_with_ruler(
        rows,
        vertical_mm=vertical_mm,
        horizontal_mm=horizontal_mm,
        focal_length_px=focal_length_px,
        limit_mm=limit_mm,
        as_json=json,
    )
    raise typer.Exit(status)

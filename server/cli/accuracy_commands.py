"""The commands `coaxial accuracy` and `coaxial ruler`."""

from pathlib import Path
from typing import Annotated

import typer

from server.cli.board_arguments import (
    DictionaryOption,
    FiducialsOption,
    GapOption,
    LayoutOption,
    MarkerOption,
    PatternOption,
    PitchOption,
    SizeOption,
    SquareOption,
    TagOption,
)
from server.cli.board_names import BoardOptions

LimitOption = Annotated[
    float, typer.Option("--limit-mm", help="Largest permitted error.", metavar="MM", min=0.0)
]
JsonOption = Annotated[bool, typer.Option("--json", help="Write the figures as JSON.", show_default=False)]


def accuracy(
    camera: Annotated[
        Path, typer.Option("--camera", help="Camera file (matrix, distortion, size_wh_px).", metavar="FILE")
    ],
    rows: Annotated[
        Path | None,
        typer.Argument(
            help="CSV of displacements on a plane, x1_mm,y1_mm,x2_mm,y2_mm, and of their image points, "
            "u1_px,v1_px,u2_px,v2_px.",
            metavar="ROWS",
        ),
    ] = None,
    plane: Annotated[
        Path | None,
        typer.Option(
            help="CSV of other points that define the pose of the plane: x_mm,y_mm,u_px,v_px. "
            "Without it each displacement is measured with a fit to all others (leave-one-out).",
            metavar="CSV",
        ),
    ] = None,
    image: Annotated[
        Path | None,
        typer.Option(
            help="Image of a calibration board instead of ROWS; every second point defines the plane.",
            metavar="IMAGE",
        ),
    ] = None,
    pattern: PatternOption = None,
    size: SizeOption = None,
    pitch_mm: PitchOption = None,
    square_mm: SquareOption = None,
    marker_mm: MarkerOption = None,
    tag_mm: TagOption = None,
    gap_mm: GapOption = None,
    dictionary: DictionaryOption = None,
    fiducials: FiducialsOption = None,
    layout: LayoutOption = None,
    limit_mm: LimitOption = 0.5,
    json: JsonOption = False,
) -> None:
    """Check a camera calibration: compare known displacements on a grid with measured ones.

    Use points of an image that was not used for the calibration. Exit status 1 above the limit.
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
        tag_mm=tag_mm,
        gap_mm=gap_mm,
        dictionary=dictionary,
        fiducials=fiducials,
        layout=layout,
    )
    raise typer.Exit(check_on_board(image, board, camera=camera, limit_mm=limit_mm, as_json=json))


def ruler(
    vertical_mm: Annotated[
        float,
        typer.Option(
            "--vertical-mm", help="V: vertical distance from the object to the camera.", metavar="MM"
        ),
    ],
    horizontal_mm: Annotated[
        float,
        typer.Option(
            "--horizontal-mm", help="H: horizontal distance from the object to the camera.", metavar="MM"
        ),
    ],
    rows: Annotated[
        Path | None,
        typer.Argument(help="CSV of displacements, as for 'coaxial accuracy'.", metavar="ROWS"),
    ] = None,
    focal_length_px: Annotated[
        float | None,
        typer.Option(
            "--focal-length-px", help="Focal length f; default: computed from the first row.", metavar="PX"
        ),
    ] = None,
    limit_mm: LimitOption = 0.5,
    json: JsonOption = False,
) -> None:
    """Compute D, theta, Pd/Rd, f and displacements from V and H (section 2.2 of the paper).

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

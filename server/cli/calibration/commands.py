"""The commands `coaxial calibrate` and `coaxial calibrate-rig`."""

from pathlib import Path
from typing import Annotated

import typer

from server.cli.board_arguments import (
    DictionaryOption,
    FiducialsOption,
    GapOption,
    LayoutOption,
    MarkerOption,
    PatternArgument,
    PitchOption,
    SizeArgument,
    SquareOption,
    TagOption,
)
from server.cli.board_names import BoardOptions
from server.cli.config_option import ConfigOption

InsetOption = Annotated[
    str | None,
    typer.Option(help="Inner corners of a checkerboard inside the board, columns x rows.", metavar="13x8"),
]
InsetSquareOption = Annotated[
    float | None, typer.Option("--inset-square-mm", help="Side of its squares.", metavar="MM")
]
OutputOption = Annotated[
    Path | None, typer.Option(help="Camera file to write, such as camera.yaml.", metavar="FILE")
]
JsonOption = Annotated[bool, typer.Option("--json", help="Write the report as JSON.", show_default=False)]
PlotsOption = Annotated[
    Path | None, typer.Option(help="Write residuals.svg and coverage.svg into this folder.", metavar="FOLDER")
]
CameraNameOption = Annotated[
    str | None,
    typer.Option(
        help="Name of the camera in the settings; the file is rejected for other names.", metavar="NAME"
    ),
]
CameraSourceOption = Annotated[
    str | None,
    typer.Option(
        help="Source of the camera in the settings; the file is rejected for other sources.",
        metavar="SOURCE",
    ),
]
CoefficientsOption = Annotated[
    int | None,
    typer.Option(
        help="Number of distortion coefficients: 4, 5 or 8; default: selected by cross-validation.",
        metavar="N",
    ),
]
RmsOption = Annotated[
    float | None,
    typer.Option(
        "--max-rms-px",
        help="Largest permitted RMS; default: calibration.max_rms_px of the settings.",
        metavar="PX",
    ),
]


def add_calibration(app: typer.Typer) -> None:
    """Add the commands."""
    app.command()(calibrate)
    app.command()(calibrate_rig)


def calibrate(
    images: Annotated[list[str], typer.Argument(help="Images, folders or patterns.", metavar="IMAGES...")],
    pattern: PatternArgument,
    size: SizeArgument,
    pitch_mm: PitchOption = None,
    square_mm: SquareOption = None,
    marker_mm: MarkerOption = None,
    tag_mm: TagOption = None,
    gap_mm: GapOption = None,
    dictionary: DictionaryOption = None,
    fiducials: FiducialsOption = None,
    layout: LayoutOption = None,
    inset: InsetOption = None,
    inset_square_mm: InsetSquareOption = None,
    output: OutputOption = None,
    camera_name: CameraNameOption = None,
    camera_source: CameraSourceOption = None,
    coefficients: CoefficientsOption = None,
    max_rms_px: RmsOption = None,
    plots: PlotsOption = None,
    json: JsonOption = False,
    config: ConfigOption = None,
) -> None:
    """Calibrate a camera from images of a board, and report its uncertainty.

    Exit status 1 if the RMS reprojection error exceeds its limit; no camera file is written then.
    """
    from server.cli.calibration.run import CalibrationOrder, calibrate_camera  # noqa: PLC0415  loaded when needed

    order = CalibrationOrder(
        images=tuple(images),
        board=BoardOptions(
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
            inset=inset,
            inset_square_mm=inset_square_mm,
        ),
        output=output,
        plots=plots,
        camera_name=camera_name,
        camera_source=camera_source,
        coefficients=coefficients,
        max_rms_px=max_rms_px,
        config=config,
    )
    raise typer.Exit(calibrate_camera(order, as_json=json))


def calibrate_rig(
    camera: Annotated[
        list[str],
        typer.Option(
            help="Name of a camera and its images (folder or pattern); the order of the images is the same "
            "for all cameras. Repeatable.",
            metavar="NAME=IMAGES",
        ),
    ],
    pattern: PatternArgument,
    size: SizeArgument,
    pitch_mm: PitchOption = None,
    square_mm: SquareOption = None,
    marker_mm: MarkerOption = None,
    tag_mm: TagOption = None,
    gap_mm: GapOption = None,
    dictionary: DictionaryOption = None,
    fiducials: FiducialsOption = None,
    layout: LayoutOption = None,
    output: Annotated[
        Path | None, typer.Option(help="Rig file to write, such as rig.yaml.", metavar="FILE")
    ] = None,
    max_rms_px: RmsOption = None,
    json: JsonOption = False,
    config: ConfigOption = None,
) -> None:
    """Calibrate several cameras that do not move relative to each other; the first one is the origin."""
    from server.cli.calibration.rig import RigOrder, calibrate_cameras  # noqa: PLC0415  loaded when needed

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
    order = RigOrder(cameras=tuple(camera), board=board, output=output, max_rms_px=max_rms_px, config=config)
    raise typer.Exit(calibrate_cameras(order, as_json=json))

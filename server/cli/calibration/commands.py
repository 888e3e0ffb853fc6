"""What can be typed after `coaxial calibrate`."""

from pathlib import Path
from typing import Annotated

import typer

from server.cli.board_arguments import (
    DictionaryOption,
    FiducialsOption,
    LayoutOption,
    MarkerOption,
    PatternArgument,
    PitchOption,
    SizeArgument,
    SquareOption,
)
from server.cli.board_names import BoardOptions

InsetOption = Annotated[
    str | None,
    typer.Option(help="Inner corners of a checkerboard that is set into the board.", metavar="13x8"),
]
InsetSquareOption = Annotated[
    float | None, typer.Option("--inset-square-mm", help="Side of its squares.", metavar="MM")
]
OutputOption = Annotated[
    Path | None, typer.Option(help="Camera file that is written, as camera.yaml.", metavar="FILE")
]
JsonOption = Annotated[bool, typer.Option("--json", help="Write the report as JSON.", show_default=False)]
PlotsOption = Annotated[
    Path | None, typer.Option(help="Folder for residuals.svg and coverage.svg.", metavar="FOLDER")
]
CameraNameOption = Annotated[
    str | None,
    typer.Option(help="The camera's name in the settings; another one is rejected later.", metavar="NAME"),
]
CameraSourceOption = Annotated[
    str | None,
    typer.Option(
        help="The camera's source in the settings; another one is rejected later.", metavar="SOURCE"
    ),
]
CoefficientsOption = Annotated[
    int | None,
    typer.Option(help="Of the lens: 4, 5 or 8; the best on views held out if left out.", metavar="N"),
]
RmsOption = Annotated[
    float | None,
    typer.Option("--max-rms-px", help="Allowed RMS; calibration.max_rms_px if left out.", metavar="PX"),
]
ConfigOption = Annotated[
    Path | None,
    typer.Option("--config", help="Settings file; ./config.yaml is taken if it is there.", metavar="FILE"),
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
    """Calibrate a camera from images of a board, and tell how far it can be trusted.

    Exit status 1 says that the points lie off by more than is allowed; then no camera file is written.
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
            help="A camera's name and its images (folder or pattern), in the same order; repeat it.",
            metavar="NAME=IMAGES",
        ),
    ],
    pattern: PatternArgument,
    size: SizeArgument,
    pitch_mm: PitchOption = None,
    square_mm: SquareOption = None,
    marker_mm: MarkerOption = None,
    dictionary: DictionaryOption = None,
    fiducials: FiducialsOption = None,
    layout: LayoutOption = None,
    output: Annotated[
        Path | None, typer.Option(help="Rig file that is written, as rig.yaml.", metavar="FILE")
    ] = None,
    max_rms_px: RmsOption = None,
    json: JsonOption = False,
    config: ConfigOption = None,
) -> None:
    """Calibrate several cameras that stand still to each other; the first one is the origin."""
    from server.cli.calibration.rig import RigOrder, calibrate_cameras  # noqa: PLC0415  loaded when needed

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
    order = RigOrder(cameras=tuple(camera), board=board, output=output, max_rms_px=max_rms_px, config=config)
    raise typer.Exit(calibrate_cameras(order, as_json=json))

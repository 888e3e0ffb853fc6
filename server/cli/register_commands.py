"""The commands `coaxial register points` and `coaxial register surface`."""

from pathlib import Path
from typing import Annotated

import typer

from server.cli.config_option import ConfigOption

register_app = typer.Typer(
    help="Register the plan to the patient by landmarks or by a swept surface.",
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)

FixedOption = Annotated[
    Path,
    typer.Option(
        "--fixed",
        help="Landmarks on the CT, one per line: x,y,z in mm; or markups of 3D Slicer (.mrk.json).",
        metavar="FILE",
    ),
]
MovingOption = Annotated[
    Path,
    typer.Option(
        "--moving",
        help="Tip positions on the same landmarks, in the same order or with the same names.",
        metavar="FILE",
    ),
]
TargetOption = Annotated[
    list[str] | None,
    typer.Option(
        "--target-mm",
        help="Target at which the error (TRE) is estimated, such as the entry point: x,y,z in the frame of "
        "--fixed; repeatable.",
        metavar="X,Y,Z",
    ),
]
ExcludedOption = Annotated[
    list[str] | None,
    typer.Option(
        "--exclude", help="Exclude a point from the fit, by name or number; repeatable.", metavar="POINT"
    ),
]
MinFleOption = Annotated[
    float,
    typer.Option(
        "--min-fle-mm",
        help="Lower bound of the fiducial localisation error (FLE, 3-D RMS) used for the stated error.",
        metavar="MM",
        min=0.01,
        max=20.0,
    ),
]
ChannelOption = Annotated[
    str | None,
    typer.Option(
        "--channel-mm",
        help="Planned channel, entry and target in the frame of --fixed: report whether the registration is "
        "accurate enough for the screw, and what would be. Needs --tolerance.",
        metavar="X,Y,Z,X,Y,Z",
    ),
]
ToleranceOption = Annotated[
    str | None,
    typer.Option(
        "--tolerance",
        help="Tolerance of the screw in that channel, from the output of 'coaxial plan measure'.",
        metavar="MM,DEG",
    ),
]


def _text_transform(path: Path | None) -> Path | None:
    if path is not None and path.suffix.lower() in {".h5", ".hdf5"}:
        raise typer.BadParameter(f"{path} would be HDF5, which is not written; name a .tfm file.")
    return path


TransformOption = Annotated[
    Path | None,
    typer.Option(
        "--transform",
        callback=_text_transform,
        help="Also write the registration as a transform of ITK (.tfm) for 3D Slicer, if its limits are met.",
        metavar="TFM",
    ),
]
JsonOption = Annotated[bool, typer.Option("--json", help="Write the figures as JSON.", show_default=False)]


@register_app.callback()
def register() -> None:
    """Register the plan to the patient by landmarks or by a swept surface."""


@register_app.command()
def points(
    fixed: FixedOption,
    moving: MovingOption,
    target_mm: TargetOption = None,
    exclude: ExcludedOption = None,
    min_fle_mm: MinFleOption = 0.5,
    max_fre_mm: Annotated[
        float | None,
        typer.Option(
            "--max-fre-mm",
            help="Exit status 1 if the FRE (RMS) exceeds this; default: registration.max_fre_mm of the "
            "settings.",
            metavar="MM",
        ),
    ] = None,
    max_left_out_mm: Annotated[
        float | None,
        typer.Option(
            "--max-left-out-mm",
            help="Exit status 1 if the leave-one-out error of a landmark exceeds this; default: "
            "registration.max_left_out_mm of the settings.",
            metavar="MM",
            min=0.0,
        ),
    ] = None,
    max_tre_mm: Annotated[
        float | None,
        typer.Option(
            "--max-tre-mm",
            help="Exit status 1 if the stated TRE (3-D RMS) of a target exceeds this.",
            metavar="MM",
        ),
    ] = None,
    config: ConfigOption = None,
    transform: TransformOption = None,
    channel_mm: ChannelOption = None,
    tolerance: ToleranceOption = None,
    json: JsonOption = False,
) -> None:
    """Register by landmarks: print the transform, the residual of each point, and the error at targets.

    Points are paired by name if both files have names, otherwise by order. Exit status 1 if a limit is
    exceeded, with the possible outliers marked in the table; 2 if the points are too few, collinear or
    mirrored, or if another order fits better.
    """
    from server.cli.register import PointsOptions, register_from_files  # noqa: PLC0415  loaded when needed

    options = PointsOptions(
        fixed=fixed,
        moving=moving,
        targets=tuple(target_mm or ()),
        excluded=tuple(exclude or ()),
        min_fle_mm=min_fle_mm,
        max_fre_mm=max_fre_mm,
        max_left_out_mm=max_left_out_mm,
        max_tre_mm=max_tre_mm,
        config=config,
        transform=transform,
        channel=channel_mm,
        tolerance=tolerance,
    )
    raise typer.Exit(register_from_files(options, as_json=json))


@register_app.command()
def surface(
    surface: Annotated[
        Path,
        typer.Option(
            "--surface", help="Mesh of the bone in the frame of the CT: STL, OBJ or PLY.", metavar="MESH"
        ),
    ],
    points: Annotated[
        Path,
        typer.Option(
            "--points",
            help="Positions of the swept tip, one per line: x,y,z in mm; or a point list or curve of 3D "
            "Slicer (.mrk.json).",
            metavar="FILE",
        ),
    ],
    fixed: Annotated[
        Path | None,
        typer.Option("--fixed", help="Landmarks on the CT, for the initial transform.", metavar="CSV"),
    ] = None,
    moving: Annotated[
        Path | None, typer.Option("--moving", help="Tip positions on the same landmarks.", metavar="CSV")
    ] = None,
    start: Annotated[
        Path | None,
        typer.Option(
            "--start",
            help="Initial transform instead of landmarks: JSON with a 4x4 fixed_from_moving, or a "
            "transform of ITK (.tfm).",
            metavar="FILE",
        ),
    ] = None,
    unit: Annotated[
        str | None, typer.Option("--unit", help="Unit of the mesh: mm, cm, m or inch.", metavar="UNIT")
    ] = None,
    target_mm: TargetOption = None,
    tip_radius_mm: Annotated[
        float,
        typer.Option(
            "--tip-radius-mm", help="Radius of a ball tip whose centre is tracked.", min=0.0, max=20.0
        ),
    ] = 0.0,
    config: ConfigOption = None,
    transform: TransformOption = None,
    json: JsonOption = False,
) -> None:
    """Register points swept over the bone to its mesh, starting from a registration by landmarks.

    Exit status 1 if a limit is exceeded; 2 if the sweep leaves a direction undetermined, fits in two places,
    or does not fit the mesh, or if the landmarks exceed their limits in the settings.
    """
    from server.cli.register_surface import SurfaceOptions, register_sweep  # noqa: PLC0415  loaded when needed

    options = SurfaceOptions(
        surface=surface,
        unit=unit,
        points=points,
        start=start,
        fixed=fixed,
        moving=moving,
        targets=tuple(target_mm or ()),
        tip_radius_mm=tip_radius_mm,
        config=config,
        transform=transform,
    )
    raise typer.Exit(register_sweep(options, as_json=json))

"""What can be typed after `coaxial register`."""

from pathlib import Path
from typing import Annotated

import typer

register_app = typer.Typer(
    help="Register plan and patient: by points, or by a swept surface.",
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)

FixedOption = Annotated[
    Path, typer.Option("--fixed", help="Landmarks on the CT, a point a line: x,y,z in mm.", metavar="CSV")
]
MovingOption = Annotated[
    Path,
    typer.Option("--moving", help="The tip on the same landmarks, in the same order.", metavar="CSV"),
]
TargetOption = Annotated[
    list[str] | None,
    typer.Option(
        "--target-mm",
        help="Where the error is to be expected, as the entry point: x,y,z on the CT (frame of --fixed); "
        "may repeat.",
        metavar="X,Y,Z",
    ),
]
ExcludedOption = Annotated[
    list[str] | None,
    typer.Option(
        "--exclude", help="A point that has no say, by name or number; may repeat.", metavar="POINT"
    ),
]
LeastFleOption = Annotated[
    float,
    typer.Option(
        "--min-fle-mm",
        help="How well a landmark can be found at best (3-D RMS); what is stated is never narrower.",
        metavar="MM",
        min=0.01,
        max=20.0,
    ),
]
JsonOption = Annotated[bool, typer.Option("--json", help="Write the figures as JSON.", show_default=False)]


@register_app.callback()
def register() -> None:
    """Register plan and patient: by points, or by a swept surface."""


@register_app.command()
def points(
    fixed: FixedOption,
    moving: MovingOption,
    target_mm: TargetOption = None,
    exclude: ExcludedOption = None,
    min_fle_mm: LeastFleOption = 0.5,
    max_fre_mm: Annotated[
        float | None,
        typer.Option("--max-fre-mm", help="Exit status 1 if landmarks fit worse (RMS).", metavar="MM"),
    ] = None,
    max_tre_mm: Annotated[
        float | None,
        typer.Option(
            "--max-tre-mm", help="Exit status 1 if a target is stated less sure (3-D RMS).", metavar="MM"
        ),
    ] = None,
    json: JsonOption = False,
) -> None:
    """Fit touched landmarks to those marked on the CT: the motion, how each fits, the error at targets.

    Lines belong together by their order, or by their names where both files have some. Exit status 2 where
    points are too few, a line, mirrored, or fit better in another order.
    """
    from server.cli.register import PointsOrder, register_from_files  # noqa: PLC0415  loaded when needed

    order = PointsOrder(
        fixed=fixed,
        moving=moving,
        targets=tuple(target_mm or ()),
        excluded=tuple(exclude or ()),
        min_fle_mm=min_fle_mm,
        max_fre_mm=max_fre_mm,
        max_tre_mm=max_tre_mm,
    )
    raise typer.Exit(register_from_files(order, as_json=json))


@register_app.command()
def surface(
    surface: Annotated[
        Path, typer.Option("--surface", help="The bone's mesh: STL, OBJ or PLY, as the CT.", metavar="MESH")
    ],
    points: Annotated[
        Path, typer.Option("--points", help="The swept tip, a point a line: x,y,z in mm.", metavar="CSV")
    ],
    fixed: Annotated[
        Path | None, typer.Option("--fixed", help="Landmarks on the CT: the start.", metavar="CSV")
    ] = None,
    moving: Annotated[
        Path | None, typer.Option("--moving", help="The tip on the same landmarks.", metavar="CSV")
    ] = None,
    start: Annotated[
        Path | None,
        typer.Option(
            "--start", help="In place of landmarks: JSON with a 4x4 fixed_from_moving.", metavar="JSON"
        ),
    ] = None,
    unit: Annotated[
        str | None, typer.Option("--unit", help="Of the mesh: mm, cm, m, inch.", metavar="UNIT")
    ] = None,
    target_mm: TargetOption = None,
    tip_radius_mm: Annotated[
        float,
        typer.Option("--tip-radius-mm", help="Of a ball whose middle is tracked.", min=0.0, max=20.0),
    ] = 0.0,
    json: JsonOption = False,
) -> None:
    """Lay points swept over the bone on its mesh, from a fit by landmarks.

    Exit status 2 where the sweep slides (a direction that it does not hold), fits in two places, or lies off.
    """
    from server.cli.register_surface import SurfaceOrder, register_sweep  # noqa: PLC0415  loaded when needed

    order = SurfaceOrder(
        surface=surface,
        unit=unit,
        points=points,
        start=start,
        fixed=fixed,
        moving=moving,
        targets=tuple(target_mm or ()),
        tip_radius_mm=tip_radius_mm,
    )
    register_sweep(order, as_json=json)

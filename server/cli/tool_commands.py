"""What can be typed to calibrate a tool: its tip by pivoting, its axis by spinning, and to check it."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer


class LengthUnit(StrEnum):
    """In which unit translations are written."""

    MM = "mm"
    CM = "cm"
    M = "m"


PosesArgument = Annotated[
    Path,
    typer.Argument(
        help="Folder of files with a 4x4 matrix each, or one file: text, CSV, JSON, .npy, or the lines that "
        "'coaxial track --json' writes. Each takes the marker's points to the camera.",
        metavar="POSES",
    ),
]
JsonOption = Annotated[bool, typer.Option("--json", help="Write the result as JSON.", show_default=False)]
UnitOption = Annotated[LengthUnit, typer.Option(help="Unit of the translations.")]
MarkerOption = Annotated[
    str | None, typer.Option(help="Name of the marker on the tool.", metavar="NAME", show_default=False)
]
ConfigOption = Annotated[
    Path | None,
    typer.Option("--config", help="Settings file; ./config.yaml is taken if it is there.", metavar="FILE"),
]
ToolOption = Annotated[
    Path | None, typer.Option("--tool", help="Tool file that 'coaxial pivot' wrote.", metavar="FILE")
]
TipOption = Annotated[
    str | None, typer.Option("--tip-mm", help="The tip in the marker's frame, as x,y,z.", metavar="X,Y,Z")
]


def pivot(
    poses: PosesArgument,
    json: JsonOption = False,
    unit: UnitOption = LengthUnit.MM,
    marker: MarkerOption = None,
    side_mm: Annotated[
        float | None,
        typer.Option("--side-mm", help="Side of that marker; else from the settings.", metavar="MM"),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(help="Write a tool file for the settings, if the gate is passed.", metavar="FILE"),
    ] = None,
    config: ConfigOption = None,
) -> None:
    """Find a tool's tip from poses of its marker, taken while it was tilted with its tip in one divot.

    Exit status 1 if the tip stays farther from the pivot, or is less sure, than the settings allow.
    """
    from server.cli.tool import PivotOrder, calibrate_tip  # noqa: PLC0415  loaded when needed

    order = PivotOrder(
        poses=poses, unit=unit.value, marker=marker, side_mm=side_mm, output=output, config=config
    )
    raise typer.Exit(calibrate_tip(order, as_json=json))


def spin(
    poses: PosesArgument,
    json: JsonOption = False,
    unit: UnitOption = LengthUnit.MM,
    marker: MarkerOption = None,
    tool: ToolOption = None,
    tip_mm: TipOption = None,
    output: Annotated[
        Path | None,
        typer.Option(help="Write the tool file with the axis in it; may be the one that was read."),
    ] = None,
    config: ConfigOption = None,
) -> None:
    """Find a tool's axis from poses of its marker, taken while it was spun about that axis.

    The tip (--tool or --tip-mm) decides which way along the axis is drilling.
    Exit status 1 if the axis is less sure than the settings allow.
    """
    from server.cli.tool import TipOrder, calibrate_axis  # noqa: PLC0415  loaded when needed

    order = TipOrder(
        poses=poses, unit=unit.value, marker=marker, tool=tool, tip_mm=tip_mm, output=output, config=config
    )
    raise typer.Exit(calibrate_axis(order, as_json=json))


def tip_check(
    poses: PosesArgument,
    json: JsonOption = False,
    unit: UnitOption = LengthUnit.MM,
    marker: MarkerOption = None,
    tool: ToolOption = None,
    tip_mm: TipOption = None,
    config: ConfigOption = None,
) -> None:
    """Say how far a known tip seems to wander while it is held in one divot and the tool is tilted.

    Exit status 1 if that is more than the settings allow.
    """
    from server.cli.tool import TipOrder, check_tool_tip  # noqa: PLC0415  loaded when needed

    order = TipOrder(
        poses=poses, unit=unit.value, marker=marker, tool=tool, tip_mm=tip_mm, output=None, config=config
    )
    raise typer.Exit(check_tool_tip(order, as_json=json))

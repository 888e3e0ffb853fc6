"""The commands `coaxial pivot`, `coaxial spin` and `coaxial tip-check`."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from server.cli.config_option import ConfigOption


class LengthUnit(StrEnum):
    """Unit of translations."""

    MM = "mm"
    CM = "cm"
    M = "m"


PosesArgument = Annotated[
    Path,
    typer.Argument(
        help="Poses camera_from_marker: a folder with one 4x4 matrix per file, one text, CSV, JSON or .npy "
        "file, or the output of 'coaxial track --json'.",
        metavar="POSES",
    ),
]
JsonOption = Annotated[bool, typer.Option("--json", help="Write the result as JSON.", show_default=False)]
UnitOption = Annotated[LengthUnit, typer.Option(help="Unit of the translations.")]
MarkerOption = Annotated[
    str | None, typer.Option(help="Name of the marker on the tool.", metavar="NAME", show_default=False)
]
ToolOption = Annotated[
    Path | None, typer.Option("--tool", help="Tool file written by 'coaxial pivot'.", metavar="FILE")
]
TipOption = Annotated[
    str | None, typer.Option("--tip-mm", help="Tip in the marker frame, x,y,z in mm.", metavar="X,Y,Z")
]


def pivot(
    poses: PosesArgument,
    json: JsonOption = False,
    unit: UnitOption = LengthUnit.MM,
    marker: MarkerOption = None,
    side_mm: Annotated[
        float | None,
        typer.Option("--side-mm", help="Side of the marker; default: from the settings.", metavar="MM"),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(help="Write a tool file if the calibration passes its limits.", metavar="FILE"),
    ] = None,
    config: ConfigOption = None,
) -> None:
    """Pivot calibration: estimate the tip from poses recorded while the tool tilts about a fixed divot.

    Exit status 1 if the RMS error or the standard deviation of the tip exceeds its limit in the settings.
    """
    from server.cli.tool import PivotOptions, calibrate_tip  # noqa: PLC0415  loaded when needed

    options = PivotOptions(
        poses=poses, unit=unit.value, marker=marker, side_mm=side_mm, output=output, config=config
    )
    raise typer.Exit(calibrate_tip(options, as_json=json))


def spin(
    poses: PosesArgument,
    json: JsonOption = False,
    unit: UnitOption = LengthUnit.MM,
    marker: MarkerOption = None,
    tool: ToolOption = None,
    tip_mm: TipOption = None,
    output: Annotated[
        Path | None,
        typer.Option(help="Write the tool file with the axis; may be the file given with --tool."),
    ] = None,
    config: ConfigOption = None,
) -> None:
    """Spin calibration: estimate the axis from poses recorded while the tool rotates about it.

    The tip (--tool or --tip-mm) defines the sign of the axis: it points from the marker to the tip.
    Exit status 1 if the standard deviation of the axis exceeds its limit in the settings.
    """
    from server.cli.tool import TipOptions, calibrate_axis  # noqa: PLC0415  loaded when needed

    options = TipOptions(
        poses=poses, unit=unit.value, marker=marker, tool=tool, tip_mm=tip_mm, output=output, config=config
    )
    raise typer.Exit(calibrate_axis(options, as_json=json))


def tip_check(
    poses: PosesArgument,
    json: JsonOption = False,
    unit: UnitOption = LengthUnit.MM,
    marker: MarkerOption = None,
    tool: ToolOption = None,
    tip_mm: TipOption = None,
    config: ConfigOption = None,
) -> None:
    """Measure how far a known tip moves while it rests in one divot and the tool tilts.

    Exit status 1 if the RMS motion exceeds its limit in the settings.
    """
    from server.cli.tool import TipOptions, check_tool_tip  # noqa: PLC0415  loaded when needed

    options = TipOptions(
        poses=poses, unit=unit.value, marker=marker, tool=tool, tip_mm=tip_mm, output=None, config=config
    )
    raise typer.Exit(check_tool_tip(options, as_json=json))

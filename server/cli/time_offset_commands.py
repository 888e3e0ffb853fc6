"""The command `coaxial time-offset`."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from server.cli.tool_commands import LengthUnit

TRACK_HELP = (
    "Poses with times: the output of 'coaxial track --json', or a CSV with the header "
    "(time_s, x, y, z, qx, qy, qz, qw)."
)


class ComparedMotion(StrEnum):
    """The motion whose rates are compared."""

    ROTATION = "rotation"
    TRANSLATION = "translation"


def time_offset(
    first: Annotated[Path, typer.Argument(help=TRACK_HELP, metavar="FIRST")],
    second: Annotated[
        Path, typer.Argument(help="The same motion, recorded by the other source.", metavar="SECOND")
    ],
    json: Annotated[
        bool, typer.Option("--json", help="Write the result as JSON.", show_default=False)
    ] = False,
    motion: Annotated[
        ComparedMotion,
        typer.Option(help="Rotation allows two markers on one rigid tool; translation needs the same point."),
    ] = ComparedMotion.ROTATION,
    max_offset_s: Annotated[
        float,
        typer.Option(
            "--max-offset-s", help="Largest offset to search, in s.", min=0.1, max=60.0, metavar="S"
        ),
    ] = 1.0,
    first_marker: Annotated[
        str | None, typer.Option(help="Name of the marker in FIRST.", metavar="NAME", show_default=False)
    ] = None,
    second_marker: Annotated[
        str | None, typer.Option(help="Name of the marker in SECOND.", metavar="NAME", show_default=False)
    ] = None,
    first_unit: Annotated[LengthUnit, typer.Option(help="Unit of FIRST's translations.")] = LengthUnit.MM,
    second_unit: Annotated[LengthUnit, typer.Option(help="Unit of SECOND's translations.")] = LengthUnit.MM,
) -> None:
    """Estimate the constant time offset between two cameras or trackers from one motion that both recorded.

    Rotate and move the tool by hand, fast and irregularly, for more than 10 s in view of both. The offset is
    the time of FIRST minus the time of SECOND at the same moment. Add it to the times of SECOND.
    Exit status 1 if the motion does not determine it.
    """
    from server.cli.time_offset import TimeOffsetOptions, calibrate  # noqa: PLC0415  loaded when needed

    options = TimeOffsetOptions(
        files=(first, second),
        markers=(first_marker, second_marker),
        units=(first_unit.value, second_unit.value),
        motion=motion.value,
        max_offset_s=max_offset_s,
    )
    raise typer.Exit(calibrate(options, as_json=json))

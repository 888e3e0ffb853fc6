"""What can be typed to calibrate the time offset of two sources."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from server.cli.tool_commands import LengthUnit

TRACK_HELP = (
    "Poses with their times: the lines that 'coaxial track --json' writes, or a CSV with a header "
    "(time_s, x, y, z, qx, qy, qz, qw)."
)


class ComparedMotion(StrEnum):
    """Which rates are compared."""

    ROTATION = "rotation"
    TRANSLATION = "translation"


def time_offset(
    first: Annotated[Path, typer.Argument(help=TRACK_HELP, metavar="FIRST")],
    second: Annotated[Path, typer.Argument(help="The same motion by the other source.", metavar="SECOND")],
    json: Annotated[
        bool, typer.Option("--json", help="Write the result as JSON.", show_default=False)
    ] = False,
    motion: Annotated[
        ComparedMotion,
        typer.Option(
            help="Rotation compares any two markers on one rigid tool; translation needs one same point."
        ),
    ] = ComparedMotion.ROTATION,
    max_offset_s: Annotated[
        float, typer.Option("--max-offset-s", help="How far to search, in s.", min=0.1, max=60.0, metavar="S")
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
    """Find the constant time offset between two cameras or trackers from one motion that both recorded.

    Turn and move the tool by hand, fast and irregularly, for over 10 s in view of both. The offset is FIRST's
    time minus SECOND's time of one moment: positive where FIRST stamps later. Add it to SECOND's times.
    Exit status 1 if the motion does not determine it.
    """
    from server.cli.time_offset import TimeOffsetOrder, calibrate  # noqa: PLC0415  loaded when needed

    order = TimeOffsetOrder(
        files=(first, second),
        markers=(first_marker, second_marker),
        units=(first_unit.value, second_unit.value),
        motion=motion.value,
        max_offset_s=max_offset_s,
    )
    raise typer.Exit(calibrate(order, as_json=json))

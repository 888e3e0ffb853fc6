"""What can be typed after `coaxial plan`."""

from pathlib import Path
from typing import Annotated

import typer

plan_app = typer.Typer(
    help="Plan on a CT: list its series, measure a pedicle.",
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)


@plan_app.callback()
def plan() -> None:
    """Plan on a CT: list its series, measure a pedicle."""


@plan_app.command()
def measure(
    ct: Annotated[Path, typer.Argument(help="Folder or zip of DICOM slices, or a NIfTI file.", metavar="CT")],
    side: Annotated[str, typer.Option(help="The patient's side: left or right.", metavar="SIDE")],
    seed_lps_mm: Annotated[
        str,
        typer.Option(
            help="A point in the pedicle, x,y,z in mm: x to the patient's left, y backwards, z up.",
            metavar="X,Y,Z",
        ),
    ],
    series: Annotated[
        str | None, typer.Option(help="Which series, where the folder holds several.", metavar="ID")
    ] = None,
    config: Annotated[
        Path | None,
        typer.Option(help="Settings file; ./config.yaml is taken if it is there.", metavar="FILE"),
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Write the figures as JSON.", show_default=False)
    ] = False,
) -> None:
    """Measure a pedicle from one point in it: width, height, angles, length, and the screw that fits.

    Angles stand against the patient's axes: transverse_deg on an axial slice, positive to the middle;
    sagittal_deg on a sagittal slice, positive to the head; both going forwards.
    """
    from server.cli.plan import MeasureOrder, measure_in_file  # noqa: PLC0415  loaded when needed

    order = MeasureOrder(ct=ct, side=side, seed_lps_mm=seed_lps_mm, series=series, config=config)
    measure_in_file(order, as_json=json)


@plan_app.command()
def series(
    ct: Annotated[Path, typer.Argument(help="Folder or zip of DICOM slices, or a NIfTI file.", metavar="CT")],
    json: Annotated[
        bool, typer.Option("--json", help="Write the series as JSON.", show_default=False)
    ] = False,
) -> None:
    """List the series of a CT: slices, size and spacing; the first word of a line is what --series takes."""
    from server.cli.plan_series import tell_series  # noqa: PLC0415  loaded when needed

    tell_series(ct, as_json=json)

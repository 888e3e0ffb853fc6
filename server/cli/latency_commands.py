"""`coaxial latency`: print the measured latency from exposure to display."""

import json as json_text
from dataclasses import asdict
from typing import Annotated

import typer

NOT_MEASURED = 1
HOW_TO_MEASURE = """\
The latency is measured in the browser: the page shows codes and the camera records them.

1. Start the server with your camera:  coaxial run --source 0
2. Open the printed address on the screen to be measured, sign in as operator, and go to /operator/camera.
3. Select "Measure" on the card "Latency", and point the camera at the screen for about 20 s."""

latency_app = typer.Typer(
    name="latency",
    help="Latency from the exposure of an image to its display on the page.",
    no_args_is_help=True,
)


@latency_app.callback()
def latency() -> None:
    """Latency from the exposure of an image to its display on the page."""


@latency_app.command()
def show(
    json: Annotated[
        bool, typer.Option("--json", help="Write the results as JSON.", show_default=False)
    ] = False,
) -> None:
    """Print the last measurement of each camera. Exit status 1 if there is none."""
    from server.home_folder import home_folder  # noqa: PLC0415  loaded when needed
    from server.store.latency_file import LatencyFile  # noqa: PLC0415

    results = LatencyFile(home_folder()).results()
    if json:
        typer.echo(json_text.dumps([asdict(one) for one in results], indent=2))
    for one in () if json else results:
        report = one.report
        typer.echo(
            f"{one.camera}, {one.width_px}x{one.height_px} px, {one.rate_hz:g} images/s, "
            f"measured {one.at} by {one.made_by}\n"
            f"  exposure to display {report.median_ms:g} ms median, {report.p99_ms:g} ms p99, "
            f"{report.samples} codes"
        )
        for stage, stage_ms in report.stage_ms.items():
            typer.echo(f"  {stage:<18}{stage_ms:8.1f} ms median")
        typer.echo(
            f"  Resolution: one image every {report.image_period_ms:g} ms. A code is read "
            f"{report.late_on_average_ms:g} ms late on average; the numbers include this and the delay of "
            f"the screen ({one.screen.width_px}x{one.screen.height_px} px, one frame every "
            f"{one.screen.period_ms:.1f} ms).\n"
            f"  The clocks of page and server agree within {report.clock_error_ms:g} ms; "
            f"{report.skipped_images} of {report.images + report.skipped_images} images were skipped."
        )
    if not results:
        typer.echo(f"No latency has been measured yet.\n\n{HOW_TO_MEASURE}", err=json)
        raise typer.Exit(NOT_MEASURED)


@latency_app.command()
def measure() -> None:
    """Print how to measure the latency in the browser."""
    typer.echo(HOW_TO_MEASURE)

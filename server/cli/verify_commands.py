"""The command `coaxial verify`."""

from pathlib import Path
from typing import Annotated

import typer


def verify(
    theatres: Annotated[int, typer.Option(help="Number of simulated theatres.", min=1, max=100_000)] = 20,
    seed: Annotated[int, typer.Option(help="Seed of all random numbers.", min=0)] = 1,
    jobs: Annotated[
        int | None,
        typer.Option(help="Number of processes; default: number of CPU cores.", min=1, max=256),
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Write the figures as JSON.", show_default=False)
    ] = False,
    rows: Annotated[
        bool, typer.Option("--rows", help="With --json: also write one row per image.", show_default=False)
    ] = False,
    plots: Annotated[
        Path | None, typer.Option(help="Write SVG plots into this folder.", metavar="FOLDER")
    ] = None,
) -> None:
    """Verify registration and navigation against the ground truth of simulated theatres.

    Each theatre is rendered, tracked, registered and navigated, with and without a patient reference, and
    with a camera move halfway. Exit status 1 if the stated 95 % bounds contain the true value in fewer than
    92 % or more than 98 % of cases, or if wrong numbers are shown after the camera move.
    """
    from server.cli.verify import verify_theatres  # noqa: PLC0415  loaded when needed

    raise typer.Exit(
        verify_theatres(theatres, seed=seed, jobs=jobs, as_json=json, with_rows=rows, plots=plots)
    )

"""`coaxial verify` as it is typed."""

from pathlib import Path
from typing import Annotated

import typer


def verify(
    theatres: Annotated[int, typer.Option(help="How many theatres.", min=1, max=100_000)] = 20,
    seed: Annotated[int, typer.Option(help="All that is random follows from it.", min=0)] = 1,
    jobs: Annotated[
        int | None,
        typer.Option(help="Processes at once; as many as there are cores, if left out.", min=1, max=256),
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Write the figures as JSON.", show_default=False)
    ] = False,
    rows: Annotated[
        bool, typer.Option("--rows", help="With --json: every image, too.", show_default=False)
    ] = False,
    plots: Annotated[
        Path | None, typer.Option(help="Write plots as SVG into this folder.", metavar="FOLDER")
    ] = None,
) -> None:
    """Rehearse registration and navigation in theatres whose truth is known, and hold both against it.

    Each theatre is rendered, tracked, registered and navigated with and without the patient reference, and
    with the camera moved in the middle. Exit status 1 where what is stated as 95 % surely holds the truth in
    less than 92 % or more than 98 % of cases, or where wrong numbers are shown after the camera was moved.
    """
    from server.cli.verify import verify_theatres  # noqa: PLC0415  loaded when needed

    raise typer.Exit(
        verify_theatres(theatres, seed=seed, jobs=jobs, as_json=json, with_rows=rows, plots=plots)
    )

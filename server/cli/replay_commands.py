"""The command `coaxial replay`."""

from pathlib import Path
from typing import Annotated

import typer


def replay(
    recording: Annotated[Path, typer.Argument(help="A recording of Coaxial (.mcap).", metavar="FILE")],
    check: Annotated[
        bool,
        typer.Option(
            "--check",
            help="Track the images again, and compare every pose and alarm with the recorded one.",
            show_default=False,
        ),
    ] = False,
    config: Annotated[
        Path | None,
        typer.Option(
            "--config",
            help="Use the alarm limits of this settings file instead of the recorded ones.",
            metavar="FILE",
        ),
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Write the result as JSON.", show_default=False)
    ] = False,
) -> None:
    """Print the contents of a recording, or check that replaying it gives the same poses and alarms.

    Exit status 1 if anything differs, if the file is damaged, or if nothing could be compared. To watch a
    recording, use it as a source: coaxial run --source FILE.
    """
    from server.cli.replay import check_file, describe_file  # noqa: PLC0415  loaded when needed

    raise typer.Exit(
        check_file(recording, config=config, as_json=json)
        if check
        else describe_file(recording, as_json=json)
    )

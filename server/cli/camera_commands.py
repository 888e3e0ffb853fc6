"""What can be typed for the cameras at this machine: `coaxial cameras`."""

from pathlib import Path
from typing import Annotated

import typer


def cameras(
    config: Annotated[
        Path | None,
        typer.Option(
            "--config", help="Settings file; ./config.yaml is taken if it is there.", metavar="FILE"
        ),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Write the list as JSON.", show_default=False)] = False,
) -> None:
    """List the cameras at this machine, what each offers, and which mode Coaxial takes of it.

    The mode depends on camera.width, height, rate_hz and calibration of the settings.
    Exit status 1 if there is no camera.
    """
    from server.cli.cameras import list_cameras  # noqa: PLC0415  loaded when needed

    raise typer.Exit(list_cameras(config, as_json=json))

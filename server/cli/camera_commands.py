"""The command `coaxial cameras`."""

from typing import Annotated

import typer

from server.cli.config_option import ConfigOption


def cameras(
    config: ConfigOption = None,
    json: Annotated[bool, typer.Option("--json", help="Write the list as JSON.", show_default=False)] = False,
) -> None:
    """List the cameras of this computer, their modes, and the mode that Coaxial selects.

    The mode depends on camera.width, height, rate_hz and calibration in the settings.
    Exit status 1 if no camera is found.
    """
    from server.cli.cameras import list_cameras  # noqa: PLC0415  loaded when needed

    raise typer.Exit(list_cameras(config, as_json=json))

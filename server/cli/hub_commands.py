"""The command `coaxial theatres`."""

from pathlib import Path
from typing import Annotated

import typer


def theatres(
    config: Annotated[
        Path | None,
        typer.Option("--config", help="Settings file; default: ./config.yaml if it exists.", metavar="FILE"),
    ] = None,
    once: Annotated[
        bool, typer.Option("--once", help="Print the list once, after 4 s.", show_default=False)
    ] = False,
    json: Annotated[
        bool, typer.Option("--json", help="Write the list once as JSON.", show_default=False)
    ] = False,
) -> None:
    """List the theatres that publish to the NATS server of hub.url, with the age of what each stated last.

    The ages are measured by this computer's clock alone, and are upper bounds. Exit status 1 if there are
    no theatres.
    """
    from server.cli.theatres import list_theatres  # noqa: PLC0415  loaded when needed

    raise typer.Exit(list_theatres(config, once=once, as_json=json))

"""The command `coaxial theatres`."""

from typing import Annotated

import typer

from server.cli.config_option import ConfigOption


def theatres(
    config: ConfigOption = None,
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

"""The commands `coaxial theatres` and `coaxial hub`."""

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


def hub(
    config: ConfigOption = None,
    new_operator_link: Annotated[
        bool,
        typer.Option(
            "--new-operator-link", help="Print a new sign-in link for an operator.", show_default=False
        ),
    ] = False,
    log_json: Annotated[
        bool, typer.Option("--log-json", help="Log as JSON lines even on a terminal.", show_default=False)
    ] = False,
) -> None:
    """Serve the page on which supervisors follow the theatres that publish to the NATS server of hub.url.

    Its accounts are its own; hub.sees states which theatres each of them sees.
    """
    from server.cli.hub import run_hub  # noqa: PLC0415  loaded when needed

    run_hub(config, log_json=log_json, new_operator_link=new_operator_link)

"""`coaxial hub`: the page of all theatres, until a stop signal."""

import logging
import sys
from pathlib import Path

import typer

from server.cli.access_control import AccessControl
from server.cli.options import SettingOptions, config_from_options
from server.cli.run import listening_socket
from server.cli.stop_signal import StopSignal
from server.cli.web import serve_until
from server.home_folder import home_folder
from server.hub.connection import HubAddress
from server.hub_app import create_hub_app
from server.installation import product_version
from server.logs import LogSettings, configure_logging
from server.security.addresses import link_name
from server.security.tls import reject_unsafe
from server.store import Home

# Beside the cases of a theatre on the same computer, which has its own accounts.
HUB_FOLDER = "hub"


def run_hub(config: Path | None, *, log_json: bool, new_operator_link: bool) -> None:
    """Serve the hub until Ctrl+C or SIGTERM.

    Raises:
        NavigationError: A setting is invalid, the port is in use, or accounts cannot be stored.
    """
    with StopSignal().caught() as stopping:
        settings = config_from_options(SettingOptions(config=config))
        configure_logging(LogSettings.for_terminal(as_json=True if log_json else None))
        # What it logs reaches the page as our problem, in a sentence.
        logging.getLogger("nats").setLevel(logging.CRITICAL)
        reject_unsafe(settings)
        address = HubAddress.of(settings.hub)
        listener = listening_socket(settings.server.host, settings.server.port)
        with listener, Home(home_folder() / HUB_FOLDER) as home:
            access = AccessControl.of(settings, home.folder, new_operator_link=new_operator_link)
            app = create_hub_app(settings, address, access.people)

            def ready() -> None:
                typer.echo(f"Coaxial {product_version()} · hub · research software, not a medical device")
                host, port = listener.getsockname()[:2]
                for line in access.startup_lines(f"{link_name(host)}:{port}"):
                    typer.echo(line)
                typer.echo("Press Ctrl+C to stop")
                sys.stdout.flush()

            serve_until(app, listener, stopping, on_ready=ready, tls=access.tls)

"""`coaxial run`: the server from start to stop."""

import errno
import socket
import sys
from collections.abc import Callable
from contextlib import ExitStack
from typing import TYPE_CHECKING

import structlog
import typer

from server.cli.commands import coaxial_version
from server.cli.options import Given, config_from_options
from server.cli.stopping import Stopping
from server.config import Config
from server.errors import ConfigError
from server.logs import LogSettings, configure_logging
from server.security.reach import shown_name
from server.security.tls import reject_unsafe

if TYPE_CHECKING:
    from server.loop.rehearsed import Rehearsed
    from server.loop.tracked import Tracked
    from server.setup import CaseSetup, Preparation
    from server.stream.phone.receiver import Receiver

BACKLOG = 128
PORT_REMEDY = "Stop the program that uses this port, or choose another one with --port or COAXIAL_PORT."
HOST_REMEDY = "Give an address of this machine as server.host in the settings; 127.0.0.1 is always one."
log = structlog.get_logger(__name__)


def run_dashboard(given: Given, *, log_json: bool, debug: bool, new_operator_link: bool = False) -> None:
    """Start everything, serve until Ctrl+C or SIGTERM, and stop everything.

    Raises:
        NavigationError: a setting cannot be used, the port is taken, or cases cannot be kept.
    """
    with Stopping().caught() as stopping:
        config = config_from_options(given)
        settings = LogSettings.for_terminal(as_json=True if log_json else None, debug=debug)
        configure_logging(settings)
        reject_unsafe(config)
        _serve(config, settings, _listener(config), stopping, new_operator_link=new_operator_link)


def _serve(
    config: Config,
    settings: LogSettings,
    listener: socket.socket,
    stopping: Stopping,
    *,
    new_operator_link: bool,
) -> None:
    # The tracking process loads while the web server does: its supervisor is started between the imports.
    from server.cli.door import Door  # noqa: PLC0415
    from server.cli.kept import Kept  # noqa: PLC0415
    from server.loop.tracked import Tracked  # noqa: PLC0415
    from server.setup import build_setup  # noqa: PLC0415

    with ExitStack() as ending:
        tracked = Tracked(config, log=settings)
        tracked.start()
        ending.callback(tracked.stop)
        kept = Kept.opened(ending, settings)
        door = Door.of(config, kept.store, new_operator_link=new_operator_link)
        preparation = build_setup(config)
        _warn_of_markers(preparation)
        from server.alarms import AlarmDesk, StoredAlarmLog  # noqa: PLC0415
        from server.app import AppParts, create_app, picture_of  # noqa: PLC0415
        from server.cli.web import serve_until  # noqa: PLC0415
        from server.procedure import Steps  # noqa: PLC0415

        phone = _phone(config, preparation, tracked)
        alarm_log = StoredAlarmLog(kept.store)
        ending.callback(alarm_log.stop)
        alarms = AlarmDesk(config, log=alarm_log)
        alarms.tell = tracked.wake
        steps = Steps.of(
            hub=tracked.hub,
            store=kept.store,
            jobs=kept.jobs,
            config=config,
            markers=preparation.models,
            adopt=_adopting(tracked, preparation, phone),
            know=alarms.know,
            tracked_from_s=lambda: tracked.tracks_from_s,
        )
        app = create_app(
            AppParts(
                hub=tracked.hub,
                config=config,
                store=kept.store,
                jobs=kept.jobs,
                steps=steps,
                setup=preparation.setup,
                surface=preparation.surface,
                alarms=alarms,
                people=door.people,
                phone=phone,
                rehearsed=_rehearsed(config, preparation, tracked),
            )
        )
        tracked.publish(picture_of(app), look=alarms.look)
        serve_until(app, listener, stopping, on_ready=lambda: _greet(listener, door.words), tls=door.tls)


def _warn_of_markers(preparation: "Preparation") -> None:
    from server.marker_remarks import warn_of_markers  # noqa: PLC0415

    warn_of_markers(preparation.models)
    if not preparation.models:
        log.warning(
            "no marker is named, so nothing is tracked",
            code="NO_MARKER",
            remedy="Give its picture with --marker and its side with --side-mm, or in the settings.",
        )


def _phone(config: Config, preparation: "Preparation", tracked: "Tracked") -> "Receiver | None":
    from server.stream.phone.receiver import Receiver  # noqa: PLC0415

    if tracked.inbox is None:
        return None
    receiver = Receiver(tracked.inbox, config.camera)
    receiver.calibrated = preparation.calibrated_camera
    return receiver


def _adopting(
    tracked: "Tracked", preparation: "Preparation", phone: "Receiver | None"
) -> "Callable[[CaseSetup], None]":
    """Work with what a case knows; a phone that begins to send is asked for its calibration's size."""

    def adopt(case: "CaseSetup") -> None:
        if phone is not None:
            phone.calibrated = preparation.with_case(case).calibrated_camera
        tracked.adopt(case)

    return adopt


def _rehearsed(config: Config, preparation: "Preparation", tracked: "Tracked") -> "Rehearsed | None":
    from server.loop.rehearsed import Rehearsed  # noqa: PLC0415

    if preparation.theatre is None:
        return None
    return Rehearsed(config.rehearsal, play=tracked.play, begun=lambda: tracked.begun)


def _greet(listener: socket.socket, words: Callable[[str], list[str]]) -> None:
    """Say where the server is, and how to get in."""
    typer.echo(f"Coaxial {coaxial_version()} · research software, not a medical device")
    host, port = listener.getsockname()[:2]
    for line in words(f"{shown_name(host)}:{port}"):
        typer.echo(line)
    typer.echo("Ctrl+C stops it")
    sys.stdout.flush()


def _listener(config: Config) -> socket.socket:
    """The socket that is served, taken before anything is started, so that a taken port costs nothing."""
    host, port = config.server.host, config.server.port
    try:
        family, kind, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        listener = socket.socket(family, kind)
        try:
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            listener.bind(address)
            listener.listen(BACKLOG)
        except OSError:
            listener.close()
            raise
    except OSError as error:
        of_the_host = isinstance(error, socket.gaierror) or error.errno == errno.EADDRNOTAVAIL
        raise ConfigError(
            "HOST_NOT_AVAILABLE" if of_the_host else "PORT_NOT_AVAILABLE",
            f"the server cannot listen on {host}:{port}: {(error.strerror or str(error)).lower()}",
            HOST_REMEDY if of_the_host else PORT_REMEDY,
            {"host": host, "port": port},
        ) from error
    return listener

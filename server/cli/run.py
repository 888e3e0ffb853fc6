"""`coaxial run`: start the server, serve until a stop signal, and shut down."""

import errno
import gc
import socket
import sys
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import structlog
import typer

from server.cli.options import SettingOptions, config_from_options
from server.cli.stop_signal import StopSignal
from server.config import Config
from server.errors import ConfigError
from server.installation import product_version
from server.logs import LogSettings, configure_logging
from server.security.addresses import link_name
from server.security.tls import reject_unsafe, select_dicom_tls

if TYPE_CHECKING:
    from server.dicom_receiver import DicomReceiver
    from server.loop.rehearsal_control import RehearsalControl
    from server.loop.tracking_system import TrackingSystem
    from server.setup import CaseSetup, Preparation
    from server.stream.phone.receiver import Receiver

BACKLOG = 128
PORT_REMEDY = "Stop the program that uses this port, or choose another port with --port or COAXIAL_PORT."
HOST_REMEDY = "Set server.host to an address of this computer, for example 127.0.0.1."
LINK_PORT_REMEDY = "Stop the program that uses this port, or set openigtlink.port to another port."
DICOM_PORT_REMEDY = "Stop the program that uses this port, or set dicom.receive.port to another port."
DICOM_HOST_REMEDY = "Set dicom.receive.host to an address of this computer, for example 127.0.0.1."
LINK_HOST_REMEDY = "Set openigtlink.host to an address of this computer, for example 127.0.0.1."
log = structlog.get_logger(__name__)


def run_dashboard(
    given: SettingOptions, *, log_json: bool, debug: bool, new_operator_link: bool = False
) -> None:
    """Start everything, serve until Ctrl+C or SIGTERM, and stop everything.

    Raises:
        NavigationError: A setting is invalid, the port is in use, or cases cannot be stored.
    """
    with StopSignal().caught() as stopping:
        config = config_from_options(given)
        settings = LogSettings.for_terminal(as_json=True if log_json else None, debug=debug)
        configure_logging(settings)
        reject_unsafe(config)
        listener = listening_socket(config.server.host, config.server.port)
        doors = _Doors(web=listener, link=_link_listener(config), dicom=_dicom_listener(config))
        _serve(config, settings, doors, stopping, new_operator_link=new_operator_link)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Doors:
    """Listening sockets; None for what is off."""

    web: socket.socket
    link: socket.socket | None
    dicom: socket.socket | None


def _serve(
    config: Config,
    settings: LogSettings,
    doors: _Doors,
    stopping: StopSignal,
    *,
    new_operator_link: bool,
) -> None:
    # The tracking process is started between the imports, so that it loads in parallel with the web server.
    from server.camera_remarks import warn_of_configured_camera  # noqa: PLC0415
    from server.cli.access_control import AccessControl  # noqa: PLC0415
    from server.cli.storage import Storage  # noqa: PLC0415
    from server.loop.tracking_system import TrackingSystem  # noqa: PLC0415
    from server.setup import build_setup  # noqa: PLC0415

    with ExitStack() as ending:
        tracked = TrackingSystem(config, log=settings)
        tracked.start()
        ending.callback(tracked.stop)
        storage = Storage.opened(ending, settings)
        access = AccessControl.of(config, storage.store.home.folder, new_operator_link=new_operator_link)
        access.follow(storage.store)
        preparation = build_setup(config)
        _check_markers(preparation)
        warn_of_configured_camera(config)
        from server.alarms import AlarmService, StoredAlarmLog  # noqa: PLC0415
        from server.app import AppParts, create_app, picture_problem_of  # noqa: PLC0415
        from server.cli.web import serve_until  # noqa: PLC0415
        from server.hub.theatre import HubPublication  # noqa: PLC0415
        from server.procedure import Steps, TrackingLink  # noqa: PLC0415
        from server.recording.service import RecordingService  # noqa: PLC0415
        from server.sinks import Sinks  # noqa: PLC0415

        phone = _phone(config, preparation, tracked)
        alarm_log = StoredAlarmLog(storage.store)
        ending.callback(alarm_log.stop)
        alarms = AlarmService(config, log=alarm_log)
        alarms.on_change = tracked.wake
        steps = Steps.of(
            hub=tracked.hub,
            store=storage.store,
            jobs=storage.jobs,
            config=config,
            markers=preparation.models,
            tools=preparation.tools,
            tracking=TrackingLink(
                publish_setup=_case_callback(tracked, preparation, phone),
                publish_facts=alarms.set_facts,
                tracked_from_s=lambda: tracked.tracks_from_s,
            ),
        )
        recordings = RecordingService(
            tracked=tracked,
            alarms=alarms,
            store=storage.store,
            config=config,
            log_settings=settings,
            product_version=product_version(),
        )
        ending.callback(recordings.close)
        sinks = Sinks(config.plugins.sinks, tracked.hub, settings)
        ending.callback(sinks.stop)
        publication = HubPublication.of(
            config,
            tracked.hub,
            home=storage.store.home.folder,
            alarms=alarm_log,
            audit=access.people.audit,
            log_settings=settings,
        )
        if publication is not None:
            ending.callback(publication.stop)
        receiver = _dicom_receiver(config, doors.dicom, storage.store.home.folder, settings)
        if receiver is not None:
            ending.callback(receiver.stop)
            receiver.start()
        app = create_app(
            AppParts(
                hub=tracked.hub,
                config=config,
                store=storage.store,
                jobs=storage.jobs,
                steps=steps,
                setup=preparation.setup,
                surface=preparation.surface,
                alarms=alarms,
                people=access.people,
                recordings=recordings,
                phone=phone,
                rehearsed=_rehearsed(config, preparation, tracked),
                openigtlink=doors.link,
                sinks=sinks,
                publication=publication,
                dicom=receiver,
            )
        )
        recordings.follow()
        sinks.start()
        if publication is not None:
            publication.start()
        tracked.publish(
            check_alarms=alarms.observe,
            picture_problem=picture_problem_of(app),
            propose_channel=steps.channel_proposer.observe,
        )
        serve_until(
            app,
            doors.web,
            stopping,
            on_ready=lambda: _ready(doors, access.startup_lines),
            tls=access.tls,
        )


def _check_markers(preparation: "Preparation") -> None:
    from server.marker_remarks import reject_ambiguous_markers  # noqa: PLC0415

    reject_ambiguous_markers(preparation.models)
    if not preparation.models and preparation.external is None:
        log.warning(
            "no marker is configured, so nothing is tracked",
            code="NO_MARKER",
            remedy="Give its image with --marker and its side with --side-mm, or add it to the settings.",
        )


def _phone(config: Config, preparation: "Preparation", tracked: "TrackingSystem") -> "Receiver | None":
    from server.stream.phone.receiver import Receiver  # noqa: PLC0415

    if tracked.inbox is None:
        return None
    receiver = Receiver(tracked.inbox, config.camera)
    receiver.calibrated = preparation.calibrated_camera
    return receiver


def _case_callback(
    tracked: "TrackingSystem", preparation: "Preparation", phone: "Receiver | None"
) -> "Callable[[CaseSetup], None]":
    """Return the callback that applies the setup of a case to the tracker and to a connected phone."""

    def adopt(case: "CaseSetup") -> None:
        if phone is not None:
            phone.calibrated = preparation.with_case(case).calibrated_camera
        tracked.adopt(case)

    return adopt


def _rehearsed(
    config: Config, preparation: "Preparation", tracked: "TrackingSystem"
) -> "RehearsalControl | None":
    from server.loop.rehearsal_control import RehearsalControl  # noqa: PLC0415

    if preparation.theatre is None:
        return None
    return RehearsalControl(config.rehearsal, play=tracked.play, played_scene=lambda: tracked.played_scene)


def _dicom_receiver(
    config: Config, listener: socket.socket | None, home: Path, settings: LogSettings
) -> "DicomReceiver | None":
    """Return the receiver of CTs; None if it is off."""
    from server.cli.access_control import SECURITY_FOLDER  # noqa: PLC0415
    from server.dicom_receiver import DicomReceiver, delete_received  # noqa: PLC0415

    if listener is None:
        delete_received(home)
        return None
    tls = select_dicom_tls(config, home / SECURITY_FOLDER)
    certificate = None if tls is None else (tls.certificate, tls.key)
    return DicomReceiver.of(config.dicom, listener, home=home, certificate=certificate, log_settings=settings)


def _ready(doors: _Doors, lines_for: Callable[[str], list[str]]) -> None:
    """Print the addresses of the server and how to sign in, and enable garbage collection."""
    # A full collection of all modules takes a tenth of a second, in which no figures are sent.
    gc.freeze()
    gc.enable()
    typer.echo(f"Coaxial {product_version()} · research software, not a medical device")
    host, port = doors.web.getsockname()[:2]
    for line in lines_for(f"{link_name(host)}:{port}"):
        typer.echo(line)
    if doors.link is not None:
        host, port = doors.link.getsockname()[:2]
        typer.echo(f"OpenIGTLink: {link_name(host)}:{port}, without sign-in or encryption")
    if doors.dicom is not None:
        host, port = doors.dicom.getsockname()[:2]
        typer.echo(f"DICOM: {link_name(host)}:{port} receives CTs")
    typer.echo("Press Ctrl+C to stop")
    sys.stdout.flush()


def _link_listener(config: Config) -> socket.socket | None:
    """Return the listening socket of OpenIGTLink; None if it is off."""
    link = config.openigtlink
    if link.port is None:
        return None
    return listening_socket(link.host, link.port, port_remedy=LINK_PORT_REMEDY, host_remedy=LINK_HOST_REMEDY)


def _dicom_listener(config: Config) -> socket.socket | None:
    """Return the listening socket for DICOM; None if it is off."""
    receive = config.dicom.receive
    if receive.port is None:
        return None
    return listening_socket(
        receive.host, receive.port, port_remedy=DICOM_PORT_REMEDY, host_remedy=DICOM_HOST_REMEDY
    )


def listening_socket(
    host: str, port: int, *, port_remedy: str = PORT_REMEDY, host_remedy: str = HOST_REMEDY
) -> socket.socket:
    """Return the listening socket. It is bound first, so that a port in use is reported at once."""
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
            host_remedy if of_the_host else port_remedy,
            {"host": host, "port": port},
        ) from error
    return listener

"""The command line: commands, their options, and the report of an error."""

import gc
import sys
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from server.cli.accuracy_commands import accuracy, ruler
from server.cli.audit_commands import audit_app
from server.cli.board_commands import board_app
from server.cli.calibration.commands import add_calibration
from server.cli.camera_commands import cameras
from server.cli.certify_commands import certify_app
from server.cli.config_option import ConfigOption
from server.cli.hub_commands import hub, theatres
from server.cli.latency_commands import latency_app
from server.cli.marker_commands import marker_app
from server.cli.plan_commands import plan_app
from server.cli.recording_commands import recording_app
from server.cli.register_commands import register_app
from server.cli.replay_commands import replay
from server.cli.time_offset_commands import time_offset
from server.cli.tool_commands import pivot, spin, tip_check
from server.cli.track_help import TRACK_HELP
from server.cli.verify_commands import verify
from server.installation import default_settings, prepare_process, product_version, service_unit

BAD_INPUT = 2

app = typer.Typer(
    name="coaxial",
    help="Coaxial: navigation for pedicle-screw surgery by video. Research software, not a medical device.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.add_typer(marker_app, name="marker")
app.add_typer(board_app, name="board")
app.command()(cameras)
add_calibration(app)
app.command()(accuracy)
app.command()(ruler)
app.command()(pivot)
app.command()(spin)
app.command(name="tip-check")(tip_check)
app.command(name="time-offset")(time_offset)
app.add_typer(certify_app, name="certify")
app.add_typer(plan_app, name="plan")
app.add_typer(audit_app, name="audit")
app.add_typer(latency_app, name="latency")
app.add_typer(register_app, name="register")
app.command()(verify)
app.command()(replay)
app.add_typer(recording_app, name="recording")
app.command()(theatres)
app.command()(hub)


class Rate(StrEnum):
    """Playback rate of a file."""

    OWN = "own"
    FAST = "fast"


MarkerOption = Annotated[
    list[Path] | None,
    typer.Option(
        "--marker",
        help="Image of a marker whose black square fills it edge to edge; repeatable.",
        metavar="PNG",
    ),
]
SideOption = Annotated[
    list[float] | None,
    typer.Option(
        "--side-mm",
        help="Side of the marker in mm: one value for all markers, or one per marker.",
        metavar="MM",
    ),
]
NameOption = Annotated[
    list[str] | None,
    typer.Option("--name", help="Name of the marker; default: the file name.", metavar="NAME"),
]
CameraOption = Annotated[
    Path | None,
    typer.Option(
        "--camera",
        help="Camera file (matrix, distortion, size_wh_px); without it no result is in mm.",
        metavar="FILE",
    ),
]
LogJsonOption = Annotated[
    bool, typer.Option("--log-json", help="Log as JSON lines even on a terminal.", show_default=False)
]
DebugOption = Annotated[bool, typer.Option("--debug", help="Log debug messages.", show_default=False)]


@app.callback(invoke_without_command=True)
def coaxial(
    show_version: Annotated[
        bool, typer.Option("--version", help="Show the version.", is_eager=True, show_default=False)
    ] = False,
) -> None:
    """Coaxial: navigation for pedicle-screw surgery by video. Research software, not a medical device."""
    if show_version:
        typer.echo(f"Coaxial {product_version()}")
        raise typer.Exit


@app.command()
def run(
    config: ConfigOption = None,
    source: Annotated[
        str | None,
        typer.Option(
            help="rehearsal, a camera number or path, a video file, a recording, a stream URL, or a folder "
            "of images.",
            metavar="SOURCE",
        ),
    ] = None,
    marker: MarkerOption = None,
    side_mm: SideOption = None,
    name: NameOption = None,
    camera: CameraOption = None,
    port: Annotated[int | None, typer.Option(help="Port to listen on; 0 selects a free port.")] = None,
    loop: Annotated[
        bool | None,
        typer.Option(
            "--loop/--no-loop",
            " /--once",
            help="Restart a file at its end, or stop there.",
            show_default=False,
        ),
    ] = None,
    rate: Annotated[
        Rate | None,
        typer.Option(help="Play a file at its own rate, or as fast as possible.", show_default=False),
    ] = None,
    speed: Annotated[
        float | None,
        typer.Option(help="Play a file more slowly: 0.25 is a quarter of its own rate.", show_default=False),
    ] = None,
    new_operator_link: Annotated[
        bool,
        typer.Option(
            "--new-operator-link", help="Print a new sign-in link for the operator.", show_default=False
        ),
    ] = False,
    log_json: LogJsonOption = False,
    debug: DebugOption = False,
) -> None:
    """Start the dashboard: track the images of a source and show the result in a browser.

    Without options it starts the rehearsal, a simulated operating theatre.
    """
    from server.loop.forks import forking_context  # noqa: PLC0415  loaded when needed, see above

    # The tracker loads in its own process meanwhile.
    forking_context()
    # Imported modules are never freed, and garbage collection takes a sixth of the start. `run_dashboard`
    # enables it again.
    gc.disable()
    try:
        from server.cli.options import SettingOptions  # noqa: PLC0415
        from server.cli.run import run_dashboard  # noqa: PLC0415

        given = SettingOptions(
            config=config,
            source=source,
            markers=tuple(marker or ()),
            sides_mm=tuple(side_mm or ()),
            names=tuple(name or ()),
            camera=camera,
            port=port,
            loop=loop,
            rate=None if rate is None else rate.value,
            speed=speed,
        )
        run_dashboard(given, log_json=log_json, debug=debug, new_operator_link=new_operator_link)
    finally:
        gc.enable()


@app.command(help=TRACK_HELP)
def track(
    video: Annotated[
        str, typer.Argument(help="A video file, a folder of images, or 'rehearsal'.", metavar="VIDEO")
    ],
    marker: MarkerOption = None,
    side_mm: SideOption = None,
    name: NameOption = None,
    camera: CameraOption = None,
    json: Annotated[
        str | None,
        typer.Option(
            help="Write one JSON line per image and marker (format above); '-' is standard output.",
            metavar="FILE",
        ),
    ] = None,
    replace: Annotated[
        bool,
        typer.Option("--replace", help="Overwrite an existing JSON file.", show_default=False),
    ] = False,
    images: Annotated[int | None, typer.Option(help="Stop after this number of images.", min=1)] = None,
    config: ConfigOption = None,
    log_json: LogJsonOption = False,
    debug: DebugOption = False,
) -> None:
    """Track every image of a video as fast as possible, without skipping any."""
    from server.cli.options import SettingOptions  # noqa: PLC0415  loaded when needed, see above
    from server.cli.track import track_video  # noqa: PLC0415

    given = SettingOptions(
        config=config,
        source=video,
        markers=tuple(marker or ()),
        sides_mm=tuple(side_mm or ()),
        names=tuple(name or ()),
        camera=camera,
        loop=False,
        rate="fast",
    )
    status = track_video(
        given, json_file=json, replace=replace, images=images, log_json=log_json, debug=debug
    )
    raise typer.Exit(status)


@app.command(name="config")
def default_config() -> None:
    """Print the settings file: every key with its meaning and its default."""
    typer.echo(default_settings(), nl=False)


@app.command()
def service_file() -> None:
    """Print a hardened systemd unit that starts this installation."""
    executable = Path(sys.executable).parent / "coaxial"
    for needed in (executable, Path(sys.base_prefix)):
        if any(needed.is_relative_to(home) for home in (Path.home(), Path("/home"), Path("/root"))):
            typer.echo(f"Warning: {needed} is in a home folder, which the service cannot read.", err=True)
    typer.echo(service_unit(executable), nl=False)


def main() -> None:
    """Run `coaxial`. Print a `NavigationError` as one sentence with its remedy and exit with status 2."""
    prepare_process()
    try:
        app(prog_name="coaxial")
    except Exception as error:
        from tracker.errors import NavigationError  # noqa: PLC0415  loaded when needed, see above

        if not isinstance(error, NavigationError):
            raise
        end = "" if error.message.endswith((".", "?", "!")) else "."
        typer.echo(f"Error: {error.message}{end}\n{error.remedy}", err=True)
        sys.exit(BAD_INPUT)

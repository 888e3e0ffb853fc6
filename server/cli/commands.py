"""What can be typed: each command's options, and how a mistake is told."""

import sys
from enum import StrEnum
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Annotated

import typer

from server.cli.accuracy_commands import accuracy, ruler
from server.cli.audit_commands import audit_app
from server.cli.board_commands import board_app
from server.cli.calibration.commands import add_calibration
from server.cli.camera_commands import cameras
from server.cli.latency_commands import latency_app
from server.cli.marker_commands import marker_app
from server.cli.plan_commands import plan_app
from server.cli.register_commands import register_app
from server.cli.time_offset_commands import time_offset
from server.cli.tool_commands import pivot, spin, tip_check
from server.cli.track_words import TRACK_HELP
from server.cli.verify_commands import verify

BAD_INPUT = 2
UNKNOWN_VERSION = "0.1.0"

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
app.add_typer(plan_app, name="plan")
app.add_typer(audit_app, name="audit")
app.add_typer(latency_app, name="latency")
app.add_typer(register_app, name="register")
app.command()(verify)


class Rate(StrEnum):
    """How fast a file's images come."""

    OWN = "own"
    FAST = "fast"


ConfigOption = Annotated[
    Path | None,
    typer.Option("--config", help="Settings file; ./config.yaml is taken if it is there.", metavar="FILE"),
]
MarkerOption = Annotated[
    list[Path] | None,
    typer.Option(
        "--marker",
        help="Picture of a marker, filled edge to edge by its black square; may repeat.",
        metavar="PNG",
    ),
]
SideOption = Annotated[
    list[float] | None,
    typer.Option("--side-mm", help="Side of the marker in mm; one for all, or one each.", metavar="MM"),
]
NameOption = Annotated[
    list[str] | None,
    typer.Option("--name", help="Name of the marker; its file's name if left out.", metavar="NAME"),
]
CameraOption = Annotated[
    Path | None,
    typer.Option(
        "--camera",
        help="Camera file (matrix, distortion, size_wh_px); without one no mm are given.",
        metavar="FILE",
    ),
]
LogJsonOption = Annotated[
    bool, typer.Option("--log-json", help="Log JSON lines, also on a terminal.", show_default=False)
]
DebugOption = Annotated[bool, typer.Option("--debug", help="Log more.", show_default=False)]


@app.callback(invoke_without_command=True)
def coaxial(
    show_version: Annotated[
        bool, typer.Option("--version", help="Show the version.", is_eager=True, show_default=False)
    ] = False,
) -> None:
    """Coaxial: navigation for pedicle-screw surgery by video. Research software, not a medical device."""
    if show_version:
        typer.echo(f"Coaxial {coaxial_version()}")
        raise typer.Exit


@app.command()
def run(
    config: ConfigOption = None,
    source: Annotated[
        str | None,
        typer.Option(
            help="rehearsal, a camera's number or path, a video, a stream's address, a folder of images.",
            metavar="SOURCE",
        ),
    ] = None,
    marker: MarkerOption = None,
    side_mm: SideOption = None,
    name: NameOption = None,
    camera: CameraOption = None,
    port: Annotated[int | None, typer.Option(help="Port to listen on; 0 takes a free one.")] = None,
    loop: Annotated[
        bool | None,
        typer.Option(
            "--loop/--no-loop", " /--once", help="A file starts again at its end, or not.", show_default=False
        ),
    ] = None,
    rate: Annotated[
        Rate | None, typer.Option(help="A file at its own rate, or as fast as possible.", show_default=False)
    ] = None,
    new_operator_link: Annotated[
        bool,
        typer.Option(
            "--new-operator-link", help="Print a new link to sign in as operator.", show_default=False
        ),
    ] = False,
    log_json: LogJsonOption = False,
    debug: DebugOption = False,
) -> None:
    """Start the dashboard: track the images of a source, and show them in a browser.

    Without options: the rehearsal, a theatre that exists only in software.
    """
    from server.cli.options import Given  # noqa: PLC0415  loaded when needed, see above
    from server.cli.run import run_dashboard  # noqa: PLC0415

    given = Given(
        config=config,
        source=source,
        markers=tuple(marker or ()),
        sides_mm=tuple(side_mm or ()),
        names=tuple(name or ()),
        camera=camera,
        port=port,
        loop=loop,
        rate=None if rate is None else rate.value,
    )
    run_dashboard(given, log_json=log_json, debug=debug, new_operator_link=new_operator_link)


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
            help="Write a JSON line for each image and marker, see above; '-' is standard output.",
            metavar="FILE",
        ),
    ] = None,
    replace: Annotated[
        bool,
        typer.Option("--replace", help="Write over a JSON file of the same name.", show_default=False),
    ] = False,
    images: Annotated[int | None, typer.Option(help="Stop after so many images.", min=1)] = None,
    config: ConfigOption = None,
    log_json: LogJsonOption = False,
    debug: DebugOption = False,
) -> None:
    """Track every image of a video, as fast as possible and none skipped."""
    from server.cli.options import Given  # noqa: PLC0415  loaded when needed, see above
    from server.cli.track import track_video  # noqa: PLC0415

    given = Given(
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


def coaxial_version() -> str:
    """The installed version."""
    try:
        return version("coaxial")
    except PackageNotFoundError:
        return UNKNOWN_VERSION


def main() -> None:
    """The command `coaxial`: tells a mistake in one sentence with its remedy, and exits with status 2."""
    try:
        app(prog_name="coaxial")
    except Exception as error:
        from tracker.errors import NavigationError  # noqa: PLC0415  loaded when needed, see above

        if not isinstance(error, NavigationError):
            raise
        end = "" if error.message.endswith((".", "?", "!")) else "."
        typer.echo(f"Error: {error.message}{end}\n{error.remedy}", err=True)
        sys.exit(BAD_INPUT)

"""`coaxial recording`: export a recording as CSV or video, and cut out a part of it."""

from pathlib import Path
from typing import Annotated, Literal

import typer

recording_app = typer.Typer(
    name="recording",
    help="Export and cut recordings.",
    no_args_is_help=True,
)


@recording_app.callback()
def recording() -> None:
    """Export and cut recordings."""


@recording_app.command()
def export(
    file: Annotated[Path, typer.Argument(help="A recording of Coaxial (.mcap).", metavar="FILE")],
    to: Annotated[
        Path | None,
        typer.Option(
            "--to", help="Folder for the CSV files; created if missing.", metavar="DIR", file_okay=False
        ),
    ] = None,
    video: Annotated[
        Path | None,
        typer.Option(
            "--video", help="Video (MP4) with the overlay; needs PyAV.", metavar="FILE", dir_okay=False
        ),
    ] = None,
    language: Annotated[
        Literal["en", "de"], typer.Option("--language", help="Language of the texts in the video.")
    ] = "en",
) -> None:
    """Write poses.csv, deviations.csv and alarms.csv of a recording, or a video of it.

    Column names include the units. The video shows each image at its capture time with the overlay of its
    results, and is marked as a recording.
    """
    if to is None and video is None:
        raise typer.BadParameter("Give a folder for CSV (--to), a video file (--video), or both.")
    if video is not None:
        _reject_same(file, video)
    if to is not None:
        _write_tables(file, to)
    if video is not None:
        _write_video(file, video, language)


@recording_app.command()
def cut(
    file: Annotated[Path, typer.Argument(help="A recording of Coaxial (.mcap).", metavar="FILE")],
    target: Annotated[Path, typer.Argument(help="The new recording (.mcap).", metavar="OUT", dir_okay=False)],
    from_s: Annotated[
        float, typer.Option("--from", min=0.0, help="Start, in s after the first image.", metavar="S")
    ],
    to_s: Annotated[
        float, typer.Option("--to", min=0.0, help="End, in s after the first image.", metavar="S")
    ],
) -> None:
    """Write a part of a recording to a new recording.

    It starts at the stored tracking state before --from, up to a minute earlier, so that it replays exactly
    (coaxial replay OUT --check).
    """
    from server.cli.progress import shown_ratio  # noqa: PLC0415  loaded when needed
    from server.recording.cut import cut_recording  # noqa: PLC0415

    _reject_same(file, target)
    with shown_ratio("cutting") as report:
        summary = cut_recording(file, target, from_s=from_s, to_s=to_s, report=lambda ratio, _: report(ratio))
    typer.echo(str(target))
    typer.echo(f"{summary.images} images, from {summary.from_s:.2f} to {summary.to_s:.2f} s")
    if summary.missing_images:
        typer.echo(f"{summary.missing_images} tracked images in this time were not recorded")
    if not summary.is_exact:
        typer.echo("these images cannot be replayed, because no tracking state is stored before them")
    elif summary.from_s < from_s:
        typer.echo(f"it starts at {summary.from_s:.2f} s, where a tracking state is stored")


def _reject_same(file: Path, target: Path) -> None:
    if file.exists() and target.exists() and target.samefile(file):
        raise typer.BadParameter("The output is the recording itself.")


def _write_tables(file: Path, folder: Path) -> None:
    from server.disk import named_when_complete  # noqa: PLC0415  loaded when needed
    from server.errors import RecordingError  # noqa: PLC0415
    from server.recording.export import Table, csv_lines  # noqa: PLC0415

    tables = {table: csv_lines(file, table) for table in Table}
    for table, lines in tables.items():
        target = folder / f"{table}.csv"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            with (
                named_when_complete(target) as unfinished,
                unfinished.open("w", encoding="utf-8", newline="") as written,
            ):
                written.writelines(lines)
        except OSError as error:
            raise RecordingError(
                "TABLE_NOT_WRITTEN",
                f"{target} cannot be written: {(error.strerror or str(error)).lower()}",
                "Check that the folder is writable and its disk has free space, then export again.",
            ) from error
        typer.echo(str(target))


def _write_video(file: Path, target: Path, language: Literal["en", "de"]) -> None:
    from server.cli.progress import shown_ratio  # noqa: PLC0415
    from server.recording.video import write_video  # noqa: PLC0415  loaded when needed

    with shown_ratio("writing the video") as report:
        summary = write_video(file, target, language=language, report=lambda ratio, _: report(ratio))
    typer.echo(str(target))
    typer.echo(f"{summary.images} images")
    if summary.gaps:
        typer.echo(f"{summary.gaps} gaps without images, marked in the video")
    if summary.images_without_overlay:
        typer.echo(f"{summary.images_without_overlay} images without recorded results, marked in the video")
    if not summary.is_whole:
        typer.echo(f"the recording is incomplete: {summary.incomplete_reason}; it was read up to that point")

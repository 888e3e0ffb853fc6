"""`coaxial recording`: export a recording as tables, video or sequence, and cut out a part of it."""

from math import inf
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
            "--to", help="Folder for the tables; created if missing.", metavar="DIR", file_okay=False
        ),
    ] = None,
    format_: Annotated[
        Literal["csv", "parquet"],
        typer.Option("--format", help="Format of the tables; parquet needs pyarrow."),
    ] = "csv",
    video: Annotated[
        Path | None,
        typer.Option(
            "--video", help="Video (MP4) with the overlay; needs PyAV.", metavar="FILE", dir_okay=False
        ),
    ] = None,
    language: Annotated[
        Literal["en", "de"], typer.Option("--language", help="Language of the texts in the video.")
    ] = "en",
    sequence: Annotated[
        Path | None,
        typer.Option(
            "--sequence",
            help="Images with their poses (.igs.mha) for 3D Slicer and Plus.",
            metavar="FILE",
            dir_okay=False,
        ),
    ] = None,
    from_s: Annotated[
        float, typer.Option("--from", min=0.0, help="Start of the sequence, in s after the first image.")
    ] = 0.0,
    until_s: Annotated[
        float | None,
        typer.Option("--until", min=0.0, help="End of the sequence, in s after the first image."),
    ] = None,
) -> None:
    """Write the tables poses, deviations and alarms of a recording, a video of it, or its images with poses.

    Column names include the units. The video shows each image at its capture time with the overlay of its
    results, and is marked as a recording. The sequence is not compressed; an image that cannot be decoded and
    an absent pose have the status INVALID.
    """
    if to is None and video is None and sequence is None:
        raise typer.BadParameter(
            "Give a folder for tables (--to), a video (--video) or a sequence (--sequence)."
        )
    for target in (video, sequence):
        if target is not None:
            _reject_same(file, target)
    if to is not None:
        _write_tables(file, to, format_)
    if video is not None:
        _write_video(file, video, language)
    if sequence is not None:
        _write_sequence(file, sequence, from_s, until_s)


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


def _write_tables(file: Path, folder: Path, format_: Literal["csv", "parquet"]) -> None:
    from server.recording.export import Table, table_not_written, write_csv  # noqa: PLC0415  loaded when needed
    from server.recording.parquet import write_parquet  # noqa: PLC0415
    from server.recording_file import RecordingReader  # noqa: PLC0415

    # No folder is created for a file that is not a recording.
    RecordingReader(file).close()
    write = write_csv if format_ == "csv" else write_parquet
    for table in Table:
        target = folder / f"{table}.{format_}"
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise table_not_written(target, error) from error
        write(file, table, target)
        typer.echo(str(target))


def _write_sequence(file: Path, target: Path, from_s: float, until_s: float | None) -> None:
    from server.cli.progress import shown_ratio  # noqa: PLC0415  loaded when needed
    from server.recording.sequence_metafile import write_sequence  # noqa: PLC0415

    with shown_ratio("writing the sequence") as report:
        summary = write_sequence(
            file,
            target,
            from_s=from_s,
            to_s=inf if until_s is None else until_s,
            report=lambda ratio, _: report(ratio),
        )
    typer.echo(str(target))
    typer.echo(f"{summary.images} images, from {summary.from_s:.2f} to {summary.to_s:.2f} s")
    if summary.invalid_images:
        typer.echo(f"{summary.invalid_images} images cannot be decoded; they are black and INVALID")
    for name, frame in summary.frames.items():
        typer.echo(f"{frame}ToTracker: {name.strip()}")


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

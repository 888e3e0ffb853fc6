"""The command `coaxial replay`."""

from pathlib import Path
from typing import Annotated

import typer


def replay(
    recording: Annotated[
        Path,
        typer.Argument(
            help="A recording of Coaxial (.mcap); with --check also a folder with recordings.",
            metavar="FILE|DIR",
        ),
    ],
    check: Annotated[
        bool,
        typer.Option(
            "--check",
            help="Track the images again, and compare every pose and alarm with the recorded one.",
            show_default=False,
        ),
    ] = False,
    config: Annotated[
        Path | None,
        typer.Option(
            "--config",
            help="Use the alarm limits of this settings file instead of the recorded ones.",
            metavar="FILE",
        ),
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Write the result as JSON.", show_default=False)
    ] = False,
    workers: Annotated[
        int, typer.Option("--workers", min=1, max=256, help="Recordings of a folder checked at once.")
    ] = 1,
    scheduler: Annotated[
        str | None,
        typer.Option(
            "--scheduler",
            help="Check them on this Dask cluster, as tcp://host:8786; needs distributed.",
            metavar="ADDRESS",
        ),
    ] = None,
    table: Annotated[
        Path | None,
        typer.Option(
            "--table",
            help="Write the result of each recording to this file as it comes (JSON lines).",
            metavar="FILE",
            dir_okay=False,
        ),
    ] = None,
    resume: Annotated[
        bool,
        typer.Option(
            "--resume",
            help="Skip recordings whose result by the same version is in the table file, and append to it.",
            show_default=False,
        ),
    ] = False,
) -> None:
    """Print the contents of a recording, or check that replaying it gives the same poses and alarms.

    Exit status 1 if anything differs, if a file is damaged, or if nothing could be compared. A folder gives a
    table with a row for each recording in it and its subfolders. To watch a recording, use it as a source:
    coaxial run --source FILE.
    """
    _validate(
        recording, check=check, table=table, resume=resume, is_remote=scheduler is not None, workers=workers
    )
    if recording.is_dir():
        from server.cli.replay_folder import FolderCheck, check_folder  # noqa: PLC0415  loaded when needed

        options = FolderCheck(
            config=config, workers=workers, scheduler=scheduler, table=table, resume=resume, as_json=json
        )
        raise typer.Exit(check_folder(recording, options))
    from server.cli.replay import check_file, describe_file  # noqa: PLC0415  loaded when needed

    raise typer.Exit(
        check_file(recording, config=config, as_json=json)
        if check
        else describe_file(recording, as_json=json)
    )


def _validate(
    recording: Path, *, check: bool, table: Path | None, resume: bool, is_remote: bool, workers: int
) -> None:
    if recording.is_dir():
        if not check:
            raise typer.BadParameter("A folder of recordings can only be checked (--check).")
        if is_remote and workers > 1:
            raise typer.BadParameter("The cluster decides how many workers it has: give no --workers.")
        if resume and table is None:
            raise typer.BadParameter("--resume needs the table file of the earlier run (--table).")
    elif table is not None or resume or is_remote or workers > 1:
        raise typer.BadParameter(
            "--workers, --scheduler, --table and --resume are for a folder of recordings."
        )

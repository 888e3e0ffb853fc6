"""`coaxial recording export`: a recording as CSV."""

from pathlib import Path
from typing import Annotated

import typer

recording_app = typer.Typer(
    name="recording",
    help="Export recordings.",
    no_args_is_help=True,
)


@recording_app.callback()
def recording() -> None:
    """Export recordings."""


@recording_app.command()
def export(
    file: Annotated[Path, typer.Argument(help="A recording of Coaxial (.mcap).", metavar="FILE")],
    to: Annotated[Path, typer.Option("--to", help="Folder of the CSV files; made if needed.", metavar="DIR")],
) -> None:
    """Write poses.csv, deviations.csv and alarms.csv of a recording; columns are named with their units."""
    from server.recording.export import Table, csv_lines  # noqa: PLC0415  loaded when needed

    tables = {table: csv_lines(file, table) for table in Table}
    to.mkdir(parents=True, exist_ok=True)
    for table, lines in tables.items():
        target = to / f"{table}.csv"
        with target.open("w", encoding="utf-8", newline="") as written:
            written.writelines(lines)
        typer.echo(str(target))

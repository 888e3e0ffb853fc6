"""`coaxial audit`: whether the audit log is whole."""

from pathlib import Path
from typing import Annotated

import typer

BROKEN = 1
NOT_READ = 2

audit_app = typer.Typer(
    name="audit",
    help="The audit log: who did what, when, from which version to which.",
    no_args_is_help=True,
)


@audit_app.callback()
def audit() -> None:
    """The audit log: who did what, when, from which version to which."""


@audit_app.command()
def verify(
    file: Annotated[
        Path | None,
        typer.Argument(help="An exported log; left out: the one of COAXIAL_HOME.", metavar="FILE"),
    ] = None,
    sum_of_last: Annotated[
        str | None,
        typer.Option(
            "--sum", help="What the last line's SHA-256 was when it was exported.", metavar="SHA256"
        ),
    ] = None,
) -> None:
    """Tell the first line that was changed, is missing or stands elsewhere; exit status 1 where there is one.

    Of an exported file alone nobody can tell whether lines are missing at its end: give --sum for that.
    Who may write the server's folder can write a whole new log with its end beside it, and this command
    calls it whole: write down the SHA-256 elsewhere, and give it with --sum for an export of that time.
    """
    from server.security.audit.whole import verify_files  # noqa: PLC0415  loaded when needed
    from server.store import home_folder  # noqa: PLC0415

    room = home_folder() / "security"
    log = room / "audit.jsonl" if file is None else file
    try:
        verdict = verify_files(log, room / "audit-head.json" if file is None else None)
    except OSError as error:
        typer.echo(
            f"Error: the audit log {log} cannot be read: {(error.strerror or str(error)).lower()}.", err=True
        )
        typer.echo("Name an exported log, or the folder of the server with COAXIAL_HOME.", err=True)
        raise typer.Exit(NOT_READ) from None
    if verdict.fault is not None:
        typer.echo(f"Line {verdict.fault.line}: {verdict.fault.said}.")
        raise typer.Exit(BROKEN)
    if sum_of_last is not None and sum_of_last.strip().lower() != verdict.head.sum:
        typer.echo(f"Line {verdict.head.count + 1}: the last line is not the one with this SHA-256.")
        raise typer.Exit(BROKEN)
    typer.echo(f"{verdict.head.count} lines, whole. SHA-256 of the last one: {verdict.head.sum}")

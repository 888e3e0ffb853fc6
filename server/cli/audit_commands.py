"""`coaxial audit verify`: check the hash chain of the audit log."""

from pathlib import Path
from typing import Annotated

import typer

BROKEN = 1
NOT_READ = 2

audit_app = typer.Typer(
    name="audit",
    help="Check the audit log of all changes (who, what, when).",
    no_args_is_help=True,
)


@audit_app.callback()
def audit() -> None:
    """Check the audit log of all changes (who, what, when)."""


@audit_app.command()
def verify(
    file: Annotated[
        Path | None,
        typer.Argument(help="Exported log; default: the log in COAXIAL_HOME.", metavar="FILE"),
    ] = None,
    sum_of_last: Annotated[
        str | None,
        typer.Option("--sum", help="SHA-256 of the last line at the time of the export.", metavar="SHA256"),
    ] = None,
) -> None:
    """Report the first line that was changed, removed or moved. Exit status 1 if there is one.

    Lines missing at the end of an exported file can only be detected with --sum. Anyone with write access to
    the server's folder can replace the whole log with a consistent one. To detect this, record the SHA-256
    elsewhere and pass it with --sum for an export of that time.
    """
    from server.home_folder import home_folder  # noqa: PLC0415
    from server.security.audit.files import verify_files  # noqa: PLC0415  loaded when needed

    room = home_folder() / "security"
    log = room / "audit.jsonl" if file is None else file
    try:
        verdict = verify_files(log, room / "audit-head.json" if file is None else None)
    except OSError as error:
        typer.echo(
            f"Error: the audit log {log} cannot be read: {(error.strerror or str(error)).lower()}.", err=True
        )
        typer.echo("Give an exported log, or set COAXIAL_HOME to the folder of the server.", err=True)
        raise typer.Exit(NOT_READ) from None
    if verdict.fault is not None:
        typer.echo(f"Line {verdict.fault.line}: {verdict.fault.reason}.")
        raise typer.Exit(BROKEN)
    if sum_of_last is not None and sum_of_last.strip().lower() != verdict.head.sum:
        typer.echo(f"Line {verdict.head.count + 1}: the SHA-256 of the last line differs from --sum.")
        raise typer.Exit(BROKEN)
    typer.echo(f"{verdict.head.count} lines, unchanged. SHA-256 of the last line: {verdict.head.sum}")

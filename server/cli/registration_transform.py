"""Writing of a registration as a transform for 3D Slicer and ITK."""

from pathlib import Path

import typer

from server.cli.output import write_atomically
from server.slicer_file import itk_text
from tracker.geometry import Anchor, Rigid, Vertebra


def write_transform(path: Path | None, fixed_from_moving: Rigid[Vertebra, Anchor], *, passed: bool) -> None:
    """Write a registration as a transform of ITK, if a file is given and the registration met its limits.

    Raises:
        InvalidInput: OUTPUT_NOT_WRITABLE.
    """
    if path is None:
        return
    if not passed:
        typer.echo(f"{path} was not written, because the registration exceeds its limits.", err=True)
        return
    write_atomically(path, itk_text(fixed_from_moving).encode())

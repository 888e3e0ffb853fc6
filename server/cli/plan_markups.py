"""`coaxial plan markups`: a plan as a file for 3D Slicer."""

from pathlib import Path

import typer

from server.cli.markups_output import write_markups
from server.cli.plan_file import invalid_plan_file, read_plan_file
from server.slicer_file import plan_markups


def write_plan_markups(plan: Path, output: Path) -> None:
    """Write the landmarks, channels and screws of an exported plan as markups.

    Raises:
        InvalidInput: PLAN_FILE_INVALID, the file is not an exported plan or has neither landmarks nor
            channels; MARKUPS_NAME_INVALID, OUTPUT_NOT_WRITABLE.
        PlanError: The plan is invalid.
    """
    document = read_plan_file(plan).plan
    markups = plan_markups(document)
    if not markups:
        raise invalid_plan_file(
            plan, f"has {len(document.vertebrae)} vertebrae, but no landmark and no channel"
        )
    write_markups(output, markups)
    typer.echo(f"Wrote {', '.join(markup.name for markup in markups)} to {output}")

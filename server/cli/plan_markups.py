"""`coaxial plan markups`: a plan as a file for 3D Slicer."""

import json
from pathlib import Path

import typer

from server.cli.markups_output import write_markups
from server.slicer_file import plan_markups
from tracker.errors import InvalidInput
from tracker.plan import plan_from_mapping
from tracker.plan.document import validate_plan

REMEDY = "Give a plan that was exported on the page Plan or by GET /api/plan/export."


def write_plan_markups(plan: Path, output: Path) -> None:
    """Write the landmarks, channels and screws of an exported plan as markups.

    Raises:
        InvalidInput: PLAN_FILE_INVALID, the file is not an exported plan or has neither landmarks nor
            channels; MARKUPS_NAME_INVALID, OUTPUT_NOT_WRITABLE.
        PlanError: The plan is invalid.
    """
    try:
        mapped = json.loads(plan.read_text(encoding="utf-8"))
    except OSError as error:
        raise _invalid(plan, f"cannot be read: {(error.strerror or str(error)).lower()}") from error
    except (ValueError, RecursionError) as error:
        raise _invalid(plan, "is not valid JSON") from error
    if not isinstance(mapped, dict) or "plan" not in mapped:
        raise _invalid(plan, "has no field 'plan'")
    document = plan_from_mapping(mapped["plan"])
    validate_plan(document)
    markups = plan_markups(document)
    if not markups:
        raise _invalid(plan, f"has {len(document.vertebrae)} vertebrae, but no landmark and no channel")
    write_markups(output, markups)
    typer.echo(f"Wrote {', '.join(markup.name for markup in markups)} to {output}")


def _invalid(plan: Path, why: str) -> InvalidInput:
    return InvalidInput("PLAN_FILE_INVALID", f"{plan} {why}", REMEDY, {"file": str(plan)})

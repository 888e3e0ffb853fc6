"""Reading of a plan file that the page exported."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from tracker.errors import InvalidInput
from tracker.plan import PlanDocument, plan_from_mapping
from tracker.plan.document import validate_plan

REMEDY = "Give a plan that was exported on the page Plan or by GET /api/plan/export."


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanFile:
    """An exported plan.

    Attributes:
        plan: the plan, validated.
        ct_marks: checksum and placement of the voxels of its CT; empty if the file states none.
    """

    plan: PlanDocument
    ct_marks: Mapping[str, object]


def read_plan_file(path: Path) -> PlanFile:
    """Read an exported plan.

    Raises:
        InvalidInput: PLAN_FILE_INVALID, the file is not an exported plan.
        PlanError: The plan is invalid.
    """
    try:
        mapped = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise invalid_plan_file(path, f"cannot be read: {(error.strerror or str(error)).lower()}") from error
    except (ValueError, RecursionError) as error:
        raise invalid_plan_file(path, "is not valid JSON") from error
    if not isinstance(mapped, dict) or "plan" not in mapped:
        raise invalid_plan_file(path, "has no field 'plan'")
    document = plan_from_mapping(mapped["plan"])
    validate_plan(document)
    marks = mapped.get("ct")
    return PlanFile(plan=document, ct_marks=marks if isinstance(marks, dict) else {})


def invalid_plan_file(path: Path, why: str) -> InvalidInput:
    """Return the error for a file that is not an exported plan, or has nothing to write."""
    return InvalidInput("PLAN_FILE_INVALID", f"{path} {why}", REMEDY, {"file": str(path)})

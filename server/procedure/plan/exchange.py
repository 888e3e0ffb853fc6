"""Export and import of plans as files, with author, date and the checksum of their CT.

The import reads only the values that a person chose. Grades, clearances, bone densities, tolerances and lines
are recomputed on the CT of the case, whose voxels must have the checksum stated in the file. A plan cannot be
viewed without its CT.
"""

import json
from collections.abc import Mapping
from typing import NoReturn

import numpy as np

from server.procedure.ct import MappedCt
from server.procedure.plan.repository import StoredPlan
from tracker.errors import InvalidInput
from tracker.plan import PlanDocument, plan_from_mapping, plan_to_mapping

FORMAT, FORMAT_VERSION = "coaxial plan", 1
AGAIN = "Export the plan again from the program in which it was made."


def export_plan(stored: StoredPlan, ct: MappedCt | None) -> dict[str, object]:
    """Return the content of a plan file, without anything that identifies the patient.

    Args:
        stored: the plan.
        ct: the CT that it depends on; None if the case has another CT now.
    """
    document = stored.document
    return {
        "format": FORMAT,
        "format_version": FORMAT_VERSION,
        "made_at": document.made_at,
        "made_by": document.maker,
        "version": document.version,
        "ct": None if ct is None else _marks_of(ct),
        "plan": plan_to_mapping(stored.plan),
    }


def import_plan(content: bytes, ct: MappedCt, *, is_for_other_ct: bool = False) -> PlanDocument:
    """Parse a plan file that was made on this CT.

    Args:
        content: bytes of the file.
        ct: the CT of the open case.
        is_for_other_ct: also accept a plan that was made on another CT; it must be reviewed again.

    Raises:
        InvalidInput: PLAN_FILE_INVALID, PLAN_FILE_VERSION, PLAN_OF_ANOTHER_CT.
        PlanError: PLAN_INVALID, PLAN_VERSION_UNKNOWN, or the error of a record.
    """
    mapped = _parsed(content)
    if mapped.get("format") != FORMAT:
        raise _invalid(f"its format is not '{FORMAT}'")
    if mapped.get("format_version") != FORMAT_VERSION:
        raise InvalidInput(
            "PLAN_FILE_VERSION",
            f"the file has format version {repr(mapped.get('format_version'))[:20]}, but this program reads "
            f"version {FORMAT_VERSION}",
            "Export the plan with a program of the same version.",
            {"found": repr(mapped.get("format_version"))[:20], "known": FORMAT_VERSION},
        )
    if not is_for_other_ct and not _is_same(mapped.get("ct"), ct):
        raise InvalidInput(
            "PLAN_OF_ANOTHER_CT",
            "the plan was made on another CT than that of the open case, or does not state its CT",
            "Open the case of its CT, or set for_other_ct to import it for this CT and check every channel.",
        )
    return plan_from_mapping(mapped.get("plan"))


def _marks_of(ct: MappedCt) -> dict[str, object]:
    """Return the fingerprint of a CT: checksum and placement of its voxels."""
    return {
        "voxels_sha256": ct.file.sha256,
        "lps_from_ijk": ct.document.content["lps_from_ijk"],
    }


def _is_same(marks: object, ct: MappedCt) -> bool:
    if not isinstance(marks, Mapping) or marks.get("voxels_sha256") != ct.file.sha256:
        return False
    try:
        reported = np.array(marks.get("lps_from_ijk"), dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        return False
    own = np.array(ct.document.content["lps_from_ijk"], dtype=np.float64)
    return reported.shape == own.shape and bool(np.allclose(reported, own, rtol=0.0, atol=1e-6))


def _parsed(content: bytes) -> Mapping[str, object]:
    try:
        mapped = json.loads(content.decode("utf-8"), parse_constant=_no_number)
    except (UnicodeDecodeError, ValueError, RecursionError) as error:
        why = "it is nested too deeply" if isinstance(error, RecursionError) else "it is not valid JSON"
        raise _invalid(why) from None
    if not isinstance(mapped, Mapping):
        raise _invalid("it is not a JSON object")
    return mapped


def _no_number(word: str) -> NoReturn:
    raise ValueError(word)


def _invalid(why: str) -> InvalidInput:
    return InvalidInput(
        "PLAN_FILE_INVALID",
        f"the file is not a plan: {why}",
        AGAIN,
        {"plan_problem": why, "format": FORMAT},
    )

"""A plan as a file: written with who made it, when and on which CT, and read with distrust.

What a person chose is read from the file; grades, clearances, bone, tolerances and lines are computed again
on the CT of the case, which must be the one that the file names by the checksum of its voxels. A plan
cannot be viewed without its CT.
"""

import json
from collections.abc import Mapping
from typing import NoReturn

import numpy as np

from server.procedure.ct import CtInUse
from server.procedure.plan.kept import KeptPlan
from tracker.errors import InvalidInput
from tracker.plan import PlanDocument, plan_from_mapping, plan_to_mapping

FORMAT, FORMAT_VERSION = "coaxial plan", 1
AGAIN = "Export the plan again from the program in which it was made."


def plan_out(kept: KeptPlan, ct: CtInUse | None) -> dict[str, object]:
    """The plan for a file, without anything of the case that names the patient.

    Args:
        kept: the plan.
        ct: that it stands on; None where that is not the case's CT any more.
    """
    document = kept.document
    return {
        "format": FORMAT,
        "format_version": FORMAT_VERSION,
        "made_at": document.made_at,
        "made_by": document.maker,
        "version": document.version,
        "ct": None if ct is None else _marks_of(ct),
        "plan": plan_to_mapping(kept.plan),
    }


def plan_in(content: bytes, ct: CtInUse, *, is_for_other_ct: bool = False) -> PlanDocument:
    """The plan of a file, if it was made on this CT.

    Args:
        content: of the file.
        ct: that it shall stand on.
        is_for_other_ct: take a plan that was made on another CT; its author must look at it anew.

    Raises:
        InvalidInput: PLAN_FILE_INVALID, PLAN_FILE_VERSION, PLAN_OF_ANOTHER_CT.
        PlanError: PLAN_INVALID, PLAN_VERSION_UNKNOWN, or what a record refuses.
    """
    mapped = _parsed(content)
    if mapped.get("format") != FORMAT:
        raise _invalid(f"its format is not '{FORMAT}'")
    if mapped.get("format_version") != FORMAT_VERSION:
        raise InvalidInput(
            "PLAN_FILE_VERSION",
            f"the file has format version {repr(mapped.get('format_version'))[:20]}, this program reads "
            f"{FORMAT_VERSION}",
            "Export the plan with a program of the same version.",
        )
    if not is_for_other_ct and not _is_same(mapped.get("ct"), ct):
        raise InvalidInput(
            "PLAN_OF_ANOTHER_CT",
            "the plan was made on another CT than that of the open case, or does not tell on which",
            "Open the case of its CT, or say that it is meant for this one and check every channel.",
        )
    return plan_from_mapping(mapped.get("plan"))


def _marks_of(ct: CtInUse) -> dict[str, object]:
    """What a CT is known by: the sum of its voxels, and their place."""
    return {
        "voxels_sha256": ct.file.sha256,
        "lps_from_ijk": ct.document.content["lps_from_ijk"],
    }


def _is_same(marks: object, ct: CtInUse) -> bool:
    if not isinstance(marks, Mapping) or marks.get("voxels_sha256") != ct.file.sha256:
        return False
    try:
        told = np.array(marks.get("lps_from_ijk"), dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        return False
    own = np.array(ct.document.content["lps_from_ijk"], dtype=np.float64)
    return told.shape == own.shape and bool(np.allclose(told, own, rtol=0.0, atol=1e-6))


def _parsed(content: bytes) -> Mapping[str, object]:
    try:
        mapped = json.loads(content.decode("utf-8"), parse_constant=_no_number)
    except (UnicodeDecodeError, ValueError, RecursionError) as error:
        why = "it is nested too deeply" if isinstance(error, RecursionError) else "it is no JSON"
        raise _invalid(why) from None
    if not isinstance(mapped, Mapping):
        raise _invalid("it is no mapping")
    return mapped


def _no_number(word: str) -> NoReturn:
    raise ValueError(word)


def _invalid(why: str) -> InvalidInput:
    return InvalidInput("PLAN_FILE_INVALID", f"the file is no plan: {why}", AGAIN)

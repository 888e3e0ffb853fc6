"""The CT of a case, mapped from its file."""

import numpy as np

from tracker.errors import InvalidInput, PlanError
from tracker.plan import Volume


def volume_of(path: str, lps_from_ijk: object, *, title: str = "the CT") -> Volume:
    """The voxels of a CT's file with the place that its document tells, its axes in the patient's order.

    Raises:
        InvalidInput: CT_DOCUMENT_INVALID.
    """
    try:
        hu = np.load(path, mmap_mode="r")
        affine = np.array(lps_from_ijk, dtype=np.float64)
        return Volume(hu=hu, lps_from_ijk=affine).in_patient_order()
    except (PlanError, OSError, ValueError, TypeError, OverflowError) as error:
        raise InvalidInput(
            "CT_DOCUMENT_INVALID", f"{title} cannot be used: {error}", "Send the CT again."
        ) from error

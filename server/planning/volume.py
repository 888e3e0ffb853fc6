"""Loading of the CT of a case from its file."""

import numpy as np

from tracker.errors import InvalidInput, PlanError
from tracker.plan import Volume


def load_volume(path: str, lps_from_ijk: object, *, title: str = "the CT") -> Volume:
    """Return the memory-mapped voxels with the affine of the document; axes in the patient's order.

    Raises:
        InvalidInput: CT_DOCUMENT_INVALID.
    """
    try:
        hu = np.load(path, mmap_mode="r")
        affine = np.array(lps_from_ijk, dtype=np.float64)
        return Volume(hu=hu, lps_from_ijk=affine).in_patient_order()
    except (PlanError, OSError, ValueError, TypeError, OverflowError) as error:
        raise InvalidInput(
            "CT_DOCUMENT_INVALID", f"{title} cannot be used: {error}", "Upload the CT again."
        ) from error

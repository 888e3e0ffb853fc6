"""Loading of the CT of a case, and the job functions that compute in a volume."""

import numpy as np

from server.jobs import Report
from server.texts import Text
from tracker.errors import InvalidInput, PlanError
from tracker.plan import Volume, measure_pedicle
from tracker.plan.crop import cropped_around
from tracker.plan.document import plain

THE_CT: Text = {"en": "the CT", "de": "das CT"}


def load_volume(path: str, lps_from_ijk: object, *, title: Text = THE_CT) -> Volume:
    """Return the memory-mapped voxels with the affine of the document; axes in the patient's order.

    Raises:
        InvalidInput: CT_DOCUMENT_INVALID.
    """
    try:
        hu = np.load(path, mmap_mode="r")
        affine = np.array(lps_from_ijk, dtype=np.float64)
        return Volume(hu=hu, lps_from_ijk=affine).in_patient_order()
    except (PlanError, OSError, ValueError, TypeError, OverflowError) as error:
        why = error.message if isinstance(error, PlanError) else f"its file is damaged ({error})"
        raise InvalidInput(
            "CT_DOCUMENT_INVALID",
            f"{title['en']} cannot be used: {why}",
            "Upload the CT again.",
            {"title": title, "document_problem": why},
        ) from error


def measure_in_ct(
    report: Report, *, path: str, lps_from_ijk: list[list[float]], seed_lps_mm: list[float], side: str
) -> object:
    """Job: return the measured pedicle as JSON-serialisable values."""
    report(0.1, "looking for the pedicle")
    return plain(measure_pedicle(load_volume(path, lps_from_ijk), seed_lps_mm, side))


def scan_rehearsal(report: Report) -> Volume:
    """Job: simulate the CT of the rehearsal's vertebra; return the part around both pedicles."""
    # Imported here: the server itself needs no simulation.
    from tracker.rehearsal.anatomy import pedicle_channels  # noqa: PLC0415
    from tracker.rehearsal.ct import rehearsal_ct  # noqa: PLC0415

    report(0.1, "simulating the scan")
    ends = [
        point
        for channel in pedicle_channels()
        for point in (channel.entry_in_vertebra_mm, channel.target_in_vertebra_mm)
    ]
    return cropped_around(rehearsal_ct(), ends)

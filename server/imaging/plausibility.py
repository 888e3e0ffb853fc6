"""Plausibility of voxel values as Hounsfield units of a body."""

import numpy as np
import numpy.typing as npt

from server.imaging.voxels import MAX_HU, MIN_HU
from tracker.errors import InvalidInput, Remark

# Metal in an extended scale is inside the range; values outside were scaled wrongly.
MAX_BEYOND_RATIO = 0.05
AIR_HU = -300
BONE_HU = 200
EVERY = 4
OF_THIS_PATIENT = "Make sure that this is the patient's CT."


def reject_beyond(beyond: int, voxels: int) -> None:
    """Reject a CT with too many values outside of the range of Hounsfield units.

    Raises:
        InvalidInput: CT_VALUES_BEYOND.
    """
    if beyond <= MAX_BEYOND_RATIO * voxels:
        return
    raise InvalidInput(
        "CT_VALUES_BEYOND",
        f"{beyond} of {voxels} voxels ({beyond / voxels:.0%}) are outside {MIN_HU} to {MAX_HU} HU, the "
        f"maximum is {MAX_BEYOND_RATIO:.0%}: slope or intercept is wrong",
        "Export the original CT series again, in Hounsfield units.",
        {
            "beyond": beyond,
            "voxels": voxels,
            "max_ratio": MAX_BEYOND_RATIO,
            "beyond_ratio": float(beyond / voxels),
            "min_hu": MIN_HU,
            "max_hu": MAX_HU,
        },
    )


def value_warnings(hu: npt.NDArray[np.int16]) -> list[Remark]:
    """Return warnings about implausible voxels (slices, rows, columns); every fourth voxel is tested."""
    some = hu[:, ::EVERY, ::EVERY]
    low, high = int(some.min()), int(some.max())
    if low == high:
        return [
            Remark(
                code="CT_EMPTY", message=f"all voxels are {low} HU: this CT is empty", context={"low": low}
            )
        ]
    warnings = []
    if low > AIR_HU:
        warnings.append(
            Remark(
                code="CT_WITHOUT_AIR",
                message=f"there is no air: the lowest value is {low} HU; the values may not be Hounsfield "
                "units",
                context={"low": low},
            )
        )
    if high < BONE_HU:
        warnings.append(
            Remark(
                code="CT_WITHOUT_BONE",
                message=f"there is no bone: the highest value is {high} HU",
                context={"high": high},
            )
        )
    return warnings


def clipped_warning(beyond: int) -> Remark:
    """Return the warning about voxels outside of the range of Hounsfield units."""
    return Remark(
        code="CT_VALUES_CLIPPED",
        message=f"{beyond} voxels were outside {MIN_HU} to {MAX_HU} HU and were clipped to this range",
        context={"beyond": beyond, "min_hu": MIN_HU, "max_hu": MAX_HU},
    )

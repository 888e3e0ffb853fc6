"""Plausibility of voxel values as Hounsfield units of a body."""

import numpy as np
import numpy.typing as npt

from server.imaging.voxels import MAX_HU, MIN_HU
from tracker.errors import InvalidInput

# Metal in an extended scale is inside the range; values outside were scaled wrongly.
MAX_BEYOND_RATIO = 0.05
AIR_HU = -300
BONE_HU = 200
EVERY = 4


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


def value_warnings(hu: npt.NDArray[np.int16]) -> list[str]:
    """Return warnings about implausible voxels (slices, rows, columns); every fourth voxel is tested."""
    some = hu[:, ::EVERY, ::EVERY]
    low, high = int(some.min()), int(some.max())
    warnings = []
    if low == high:
        warnings.append(f"All voxels are {low} HU: this CT is empty.")
        return warnings
    if low > AIR_HU:
        warnings.append(
            f"There is no air: the lowest value is {low} HU; the values may not be Hounsfield units."
        )
    if high < BONE_HU:
        warnings.append(f"There is no bone: the highest value is {high} HU.")
    return warnings

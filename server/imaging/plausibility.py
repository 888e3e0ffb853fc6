"""Plausibility of voxel values as Hounsfield units of a body."""

import numpy as np
import numpy.typing as npt

from server.imaging.voxels import MAX_HU, MIN_HU
from tracker.errors import InvalidInput

# Metal in an extended scale stays inside; beyond lie numbers that were scaled wrongly.
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
        f"{beyond} of {voxels} voxels ({beyond / voxels:.0%}) lie beyond {MIN_HU} to {MAX_HU} HU, allowed "
        f"{MAX_BEYOND_RATIO:.0%}: their slope and intercept cannot be right",
        "Export the original CT series again, in Hounsfield units.",
        {"beyond": beyond, "voxels": voxels, "max_ratio": MAX_BEYOND_RATIO},
    )


def value_warnings(hu: npt.NDArray[np.int16]) -> list[str]:
    """What is odd about these voxels (slices, rows, columns), a sentence each; every fourth is looked at."""
    some = hu[:, ::EVERY, ::EVERY]
    low, high = int(some.min()), int(some.max())
    warnings = []
    if low == high:
        warnings.append(f"All voxels are {low} HU: there is nothing in this CT.")
        return warnings
    if low > AIR_HU:
        warnings.append(f"There is no air: the lowest value is {low} HU; these may be no Hounsfield units.")
    if high < BONE_HU:
        warnings.append(f"There is no bone: the highest value is {high} HU.")
    return warnings

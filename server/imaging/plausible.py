"""Whether numbers look like the Hounsfield units of a part of a body."""

import numpy as np
import numpy.typing as npt

AIR_HU = -300
BONE_HU = 200
EVERY = 4


def said_of_values(hu: npt.NDArray[np.int16]) -> list[str]:
    """What is odd about these voxels (slices, rows, columns), a sentence each; every fourth is looked at."""
    some = hu[:, ::EVERY, ::EVERY]
    low, high = int(some.min()), int(some.max())
    said = []
    if low == high:
        said.append(f"All voxels are {low} HU: there is nothing in this CT.")
        return said
    if low > AIR_HU:
        said.append(f"There is no air: the lowest value is {low} HU; these may be no Hounsfield units.")
    if high < BONE_HU:
        said.append(f"There is no bone: the highest value is {high} HU.")
    return said

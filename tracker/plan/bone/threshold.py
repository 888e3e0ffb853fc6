"""From how many HU on a voxel is bone, proposed from the CT itself."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy import ndimage
from skimage.filters import threshold_isodata

LOWEST_HU, HIGHEST_HU = -1024, 1500
# Muscle, blood and discs; contrast and scanners move it.
SOFT_TISSUE_HU = (-20, 120)
# As wide as noise makes a peak jagged.
SMOOTHED_OVER_HU = 8.0
SOFT_TISSUE_NEEDED_RATIO = 0.05
MIN_ABOVE_SURROUNDINGS_HU, HIGHEST_PROPOSED_HU = 60.0, 400.0
MAX_VOXELS = 4_000_000


@dataclass(frozen=True, slots=True, kw_only=True)
class ThresholdProposal:
    """A threshold, and what it was made from.

    Attributes:
        threshold_hu: what is at least this bright is taken for bone.
        surroundings_hu: the commonest value around the bone: soft tissue, or air for a dry specimen.
        bone_ratio: share of the voxels that it takes for bone.
    """

    threshold_hu: float
    surroundings_hu: float
    bone_ratio: float


def proposed_threshold(hu: npt.NDArray[np.int16]) -> ThresholdProposal:
    """The value that best parts bone from what surrounds it, from the histogram of a CT or a part of it.

    Half-way between the means of what is darker and what is brighter (Ridler and Calvard 1978), of all voxels
    from the peak of soft tissue on: fat and air are left out, as they would make a group by themselves, and
    metal counts as dense bone. A dry bone scanned in air has no soft tissue; there it is air that it is
    parted from. Large arrays are read in steps.

    Args:
        hu: (slices, rows, columns) int16.
    """
    step = max(1, int(np.ceil((hu.size / MAX_VOXELS) ** (1.0 / 3.0))))
    values = np.clip(hu[::step, ::step, ::step], LOWEST_HU, HIGHEST_HU).astype(np.int64).ravel()
    counts = np.bincount(values - LOWEST_HU, minlength=HIGHEST_HU - LOWEST_HU + 1).astype(np.float64)
    levels = np.arange(LOWEST_HU, HIGHEST_HU + 1, dtype=np.float64)
    smooth = ndimage.gaussian_filter1d(counts, SMOOTHED_OVER_HU)
    soft = (levels >= SOFT_TISSUE_HU[0]) & (levels <= SOFT_TISSUE_HU[1])
    if counts[soft].sum() >= SOFT_TISSUE_NEEDED_RATIO * values.size:
        surroundings = float(levels[soft][smooth[soft].argmax()])
    else:
        surroundings = float(levels[smooth.argmax()])
    least = surroundings + MIN_ABOVE_SURROUNDINGS_HU
    brighter = levels >= surroundings
    threshold = least
    if np.count_nonzero(counts[brighter]) > 1:
        histogram = (counts[brighter], levels[brighter])
        found = float(threshold_isodata(hist=histogram))  # type: ignore[no-untyped-call]  # it has no types
        threshold = float(np.clip(found, least, max(least, HIGHEST_PROPOSED_HU)))
    return ThresholdProposal(
        threshold_hu=threshold,
        surroundings_hu=surroundings,
        bone_ratio=float(counts[levels >= threshold].sum() / values.size),
    )

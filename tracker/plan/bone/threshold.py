"""Proposal of the bone threshold in HU from the histogram of the CT."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy
import skimage

MIN_HU, MAX_HU = -1024, 1500
# Muscle, blood and discs; contrast and scanner shift the peak.
SOFT_TISSUE_HU = (-20, 120)
# Width of the smoothing, larger than the noise of the histogram.
SMOOTHED_OVER_HU = 8.0
SOFT_TISSUE_NEEDED_RATIO = 0.05
MIN_ABOVE_SURROUNDINGS_HU, MAX_PROPOSED_HU = 60.0, 400.0
MAX_VOXELS = 4_000_000


@dataclass(frozen=True, slots=True, kw_only=True)
class ThresholdProposal:
    """A proposed threshold and the statistics behind it.

    Attributes:
        threshold_hu: minimum HU of bone.
        surroundings_hu: the mode around the bone: soft tissue, or air for a dry specimen.
        bone_ratio: share of the voxels above the threshold.
    """

    threshold_hu: float
    surroundings_hu: float
    bone_ratio: float


def proposed_threshold(hu: npt.NDArray[np.int16]) -> ThresholdProposal:
    """Return the threshold that best separates bone from its surroundings in the histogram.

    The threshold is half-way between the means of the classes below and above it (Ridler and Calvard 1978),
    over all voxels from the soft-tissue peak on. Fat and air are excluded, because they would form a class
    of their own; metal counts as dense bone. A dry bone scanned in air has no soft tissue and is separated
    from air. Large arrays are subsampled.

    Args:
        hu: (slices, rows, columns) int16.
    """
    step = max(1, int(np.ceil((hu.size / MAX_VOXELS) ** (1.0 / 3.0))))
    values = np.clip(hu[::step, ::step, ::step], MIN_HU, MAX_HU).astype(np.int64).ravel()
    counts = np.bincount(values - MIN_HU, minlength=MAX_HU - MIN_HU + 1).astype(np.float64)
    levels = np.arange(MIN_HU, MAX_HU + 1, dtype=np.float64)
    smooth = scipy.ndimage.gaussian_filter1d(counts, SMOOTHED_OVER_HU)
    soft = (levels >= SOFT_TISSUE_HU[0]) & (levels <= SOFT_TISSUE_HU[1])
    if counts[soft].sum() >= SOFT_TISSUE_NEEDED_RATIO * values.size:
        surroundings = float(levels[soft][smooth[soft].argmax()])
    else:
        surroundings = float(levels[smooth.argmax()])
    minimum = surroundings + MIN_ABOVE_SURROUNDINGS_HU
    brighter = levels >= surroundings
    threshold = minimum
    if np.count_nonzero(counts[brighter]) > 1:
        histogram = (counts[brighter], levels[brighter])
        found = float(skimage.filters.threshold_isodata(hist=histogram))
        threshold = float(np.clip(found, minimum, max(minimum, MAX_PROPOSED_HU)))
    return ThresholdProposal(
        threshold_hu=threshold,
        surroundings_hu=surroundings,
        bone_ratio=float(counts[levels >= threshold].sum() / values.size),
    )

"""Conversion of stored pixel values to Hounsfield units."""

import numpy as np
import numpy.typing as npt

from server.imaging.dicom.decoding import StoredPixels
from server.imaging.dicom.frame import FileAttributes, Frame
from server.imaging.dicom.pixels import is_encoded
from server.imaging.voxels import MAX_HU, MIN_HU, PADDING_HU


def hounsfield(stored: StoredPixels, frame: Frame) -> tuple[npt.NDArray[np.int16], int]:
    """Return HU (rows, columns) int16 of the stored values, and the number of values outside the range."""
    shared = frame.shared
    padded = None
    if shared.padding is not None:
        low, high = shared.padding
        padded = (stored >= low) & (stored <= high)
    values = _without_unused_bits(stored, shared)
    slope, intercept = frame.slope[0], frame.intercept[0]
    if slope == 1.0 and intercept == int(intercept) and abs(intercept) < 2**30 and shared.bits[1] <= 16:
        hu: npt.NDArray[np.int32 | np.float64] = values.astype(np.int32) + np.int32(intercept)
    else:
        hu = np.rint(values.astype(np.float64) * slope + intercept)
    if padded is not None:
        hu = np.where(padded, np.asarray(PADDING_HU, dtype=hu.dtype), hu)
    beyond = int(np.count_nonzero((hu < MIN_HU) | (hu > MAX_HU)))
    return np.clip(hu, MIN_HU, MAX_HU).astype(np.int16), beyond


def _without_unused_bits(stored: StoredPixels, shared: FileAttributes) -> StoredPixels:
    """Return the values without the bits above those stored, which may contain overlays."""
    unused = stored.dtype.itemsize * 8 - shared.bits[1]
    if unused <= 0 or is_encoded(shared):
        return stored
    return np.asarray(np.right_shift(np.left_shift(stored, unused), unused))

"""Picture of a reference slice with its three lines and the trajectory of each channel, as in the paper."""

import cv2
import numpy as np
import numpy.typing as npt

from tracker.errors import PlanError
from tracker.geometry import Array
from tracker.plan import SliceLine, VertebraPlan, Volume
from tracker.plan.slices import Slice, Window, shown

# BGR; the colours of lines and trajectories in the paper, distinct on grey.
LINE, PATH = (80, 220, 255), (90, 255, 90)
SMALLEST_SIDE_PX = 512
# Fractional bits of OpenCV's sub-pixel coordinates.
BITS = 4


def reference_slice(vertebra: VertebraPlan, volume: Volume) -> Slice:
    """Return the slice in radiological orientation: the patient's left on the right, posterior down.

    Raises:
        PlanError: REFERENCE_MISSING.
    """
    if not vertebra.references:
        raise PlanError(
            "REFERENCE_MISSING",
            f"{vertebra.name} has no reference slice",
            "Select its reference slice.",
            {"vertebra": vertebra.name},
        )
    k = vertebra.references[0].slice_index
    if not 0 <= k < volume.shape_ijk[2]:
        raise PlanError(
            "SLICE_OUTSIDE_CT",
            f"the reference slice is number {k}, the CT has {volume.shape_ijk[2]}",
            "Select the slice again on this CT.",
            {"slice_index": k, "slices": volume.shape_ijk[2]},
        )
    hu, start = volume.hu[k], np.array([0.0, 0.0, float(k)])
    steps = volume.lps_from_ijk[:3, :2].copy()
    for axis in (0, 1):
        if steps[axis, axis] < 0.0:
            hu = np.flip(hu, axis=1 - axis)
            start[axis] = volume.shape_ijk[axis] - 1.0
            steps[:, axis] *= -1.0
    return Slice(
        hu=np.ascontiguousarray(hu), lps_from_px=np.column_stack([steps, volume.lps_from_index(start)])
    )


def reference_picture(vertebra: VertebraPlan, volume: Volume, window: Window) -> npt.NDArray[np.uint8]:
    """Return the slice (height, width, 3), BGR, enlarged to square pixels, with lines and trajectories.

    Raises:
        PlanError: REFERENCE_MISSING, SLICE_OUTSIDE_CT.
    """
    one = reference_slice(vertebra, volume)
    reference = vertebra.references[0]
    side_mm = one.pixel_mm * np.array(one.size_wh_px)
    scale = max(1.0, SMALLEST_SIDE_PX / min(one.size_wh_px)) / one.pixel_mm.min()
    width, height = (round(float(mm * scale)) for mm in side_mm)
    grey = cv2.resize(shown(one.hu, window), (width, height), interpolation=cv2.INTER_LINEAR)
    image = np.asarray(cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR), dtype=np.uint8)
    zoom = np.array([width, height]) / np.array(one.size_wh_px)
    thickness = max(1, round(min(width, height) / 400))
    for line in reference.lines:
        _draw(image, _ends_px(one, line, zoom), LINE, thickness)
    for path in reference.paths:
        ends = _ends_px(one, path, zoom)
        _draw(image, ends, PATH, thickness)
        target = np.rint(ends[1] * 2**BITS).astype(int)
        cv2.circle(
            image, (int(target[0]), int(target[1])), 4 * thickness << BITS, PATH, thickness, cv2.LINE_AA, BITS
        )
    return image


def _ends_px(one: Slice, line: SliceLine, zoom: Array) -> Array:
    # The resize scales about the corner of a pixel, but coordinates refer to its centre.
    return np.asarray((one.pixel_from_lps(line.ends_lps_mm) + 0.5) * zoom - 0.5)


def _draw(image: npt.NDArray[np.uint8], ends_px: Array, colour: tuple[int, int, int], thickness: int) -> None:
    # Clipped, because OpenCV's fixed-point coordinates would overflow.
    ends = np.rint(np.clip(ends_px, -20_000.0, 20_000.0) * 2**BITS).astype(int)
    start, end = ((int(x), int(y)) for x, y in ends)
    cv2.line(image, start, end, colour, thickness, cv2.LINE_AA, BITS)

"""Overlay of the translucent reference slice and the planned needle lines on the live image."""

import cv2
import numpy as np
import numpy.typing as npt

from server.procedure.plan import reference_slice
from server.procedure.registration.needle_records import PlacedSlice
from tracker.geometry import Array
from tracker.plan import Volume
from tracker.plan.slices import Window, shown
from tracker.registration.needles import image_from_slice

# BGR, as the lines in the picture of the plan.
LINE = (80, 220, 255)
# Fractional bits of OpenCV's sub-pixel coordinates.
BITS = 4


def overlay_picture(placed: PlacedSlice, volume: Volume | None, window: Window) -> npt.NDArray[np.uint8]:
    """Render the overlay, (h, w, 3) BGR.

    Args:
        placed: the slice with its pose and image.
        volume: the CT of the slice; None draws the lines only.
        window: the grey-value window.
    """
    image = placed.scene.image.copy()
    reference = placed.scene.reference
    if volume is not None and reference is not None:
        homography = image_from_slice(placed.camera_from_vertebra, reference, placed.scene.camera)
        grey = np.asarray(shown(volume.hu[reference.slice_index], window), dtype=np.uint8)
        size = image.shape[1], image.shape[0]
        slice_there = cv2.warpPerspective(cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR), homography, size)
        share = cv2.warpPerspective(
            np.full(grey.shape, placed.overlay.fade_ratio, np.float32), homography, size
        )
        mixed = image + share[..., None] * (slice_there.astype(np.float32) - image)
        image = np.clip(np.rint(mixed), 0, 255).astype(np.uint8)
    for line in placed.lines_px:
        # Clipped, because OpenCV's fixed-point coordinates would overflow.
        points = np.rint(np.clip(line, -20_000.0, 20_000.0) * 2**BITS).astype(np.int32)
        cv2.polylines(image, [points], False, LINE, 2, cv2.LINE_AA, BITS)
    return np.asarray(image, dtype=np.uint8)


def slice_in_image(placed: PlacedSlice, volume: Volume) -> tuple[tuple[int, int], Array] | None:
    """Return the size of the slice picture in CT pixels, and its placement in the image.

    Returns:
        (width, height), and the homography (3, 3) from its pixels to image pixels, with integer pixel
        centres; None if the needles are at landmarks instead of lines of a slice.
    """
    reference = placed.scene.reference
    if reference is None:
        return None
    one = reference_slice(placed.scene.context.vertebra, volume)
    homography = image_from_slice(placed.camera_from_vertebra, reference, placed.scene.camera)
    # The picture of the plan shows the patient's left on the right, whatever the order of the scanner.
    corners_px = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    corners_lps = np.column_stack([corners_px, np.ones(3)]) @ one.lps_from_px.T
    own = volume.index_from_lps(corners_lps)[:, :2]
    own_from_shown = np.eye(3)
    own_from_shown[:2] = np.column_stack([own[1] - own[0], own[2] - own[0], own[0]])
    return one.size_wh_px, homography @ own_from_shown

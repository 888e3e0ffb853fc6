"""Checkerboard corners: saddle point detection and sub-pixel refinement."""

import cv2
import numpy as np
import numpy.typing as npt

from tracker.camera.detection.blobs import GreyImage
from tracker.geometry import Array

REFINE_CRITERIA = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 100, 1e-4)
# Half size of the refinement window, as a ratio of the shortest side of the squares around a corner, small
# enough to exclude the next corner and most of the lens distortion.
WINDOW_RATIO = 0.3
MIN_WINDOW_SIDE_PX, MAX_WINDOW_PX = 2, 12
SADDLE_SMOOTHING_PX = (1.5, 3.0)
MAX_SADDLES = 3000
# Brightness on a ring around a corner has two periods; radius in smoothing widths, points, and minimum ratio.
RING_SMOOTHINGS, RING_POINTS, MIN_CROSSED_RATIO = 2.5, 24, 0.7


def refined(
    grey: GreyImage, corners_px: Array, sides_px: Array, *, window_ratio: float = WINDOW_RATIO
) -> Array:
    """Return sub-pixel corners (n, 2) (`cv2.cornerSubPix`); `sides_px` (n,): the shortest side at each."""
    windows = np.clip(np.rint(window_ratio * sides_px), MIN_WINDOW_SIDE_PX, MAX_WINDOW_PX).astype(int)
    moved_corners = corners_px.copy()
    for window in np.unique(windows):
        some = windows == window
        start = corners_px[some].astype(np.float32).reshape(-1, 1, 2)
        found = cv2.cornerSubPix(grey, start, (int(window), int(window)), (-1, -1), REFINE_CRITERIA)
        moved = np.asarray(found, dtype=np.float64).reshape(-1, 2)
        # A corner that moves too far is reset.
        near = np.linalg.norm(moved - corners_px[some], axis=1) < max(1.5, 0.5 * window)
        moved_corners[some] = np.where(near[:, None], moved, corners_px[some])
    return moved_corners


def saddles(grey: GreyImage, *, smoothing_px: float) -> Array:
    """Return saddle points (n, 2) of the image, strongest first."""
    smooth = np.asarray(cv2.GaussianBlur(grey.astype(np.float32), (0, 0), smoothing_px), dtype=np.float32)
    xx = cv2.Sobel(smooth, cv2.CV_32F, 2, 0)
    yy = cv2.Sobel(smooth, cv2.CV_32F, 0, 2)
    xy = cv2.Sobel(smooth, cv2.CV_32F, 1, 1)
    strength = np.maximum(xy * xy - xx * yy, 0.0)
    reach = 2 * round(smoothing_px * 1.5) + 1
    peak = cv2.dilate(strength, np.ones((reach, reach), np.uint8))
    floor = 0.1 * float(np.percentile(peak, 99.0))
    y, x = np.nonzero((strength >= peak) & (strength > max(floor, 1.0)))
    strongest = np.argsort(-strength[y, x])[:MAX_SADDLES]
    points = np.stack([x[strongest], y[strongest]], axis=1).astype(np.float64)
    return points[_crossed(smooth, points, radius_px=RING_SMOOTHINGS * smoothing_px)]


def _crossed(smooth: npt.NDArray[np.float32], points: Array, *, radius_px: float) -> npt.NDArray[np.bool_]:
    """Return at which points (n,) the brightness on a ring has two periods, as at crossing edges."""
    if not len(points):
        return np.zeros(0, dtype=bool)
    angle = 2.0 * np.pi * np.arange(RING_POINTS) / RING_POINTS
    ring = points[:, None, :] + radius_px * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    x, y = (ring[..., axis].astype(np.float32) for axis in (0, 1))
    # Outside the image the border is replicated.
    values = cv2.remap(smooth, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE).reshape(x.shape)
    waves = np.abs(np.fft.rfft(values, axis=1))[:, 1:] ** 2
    return np.asarray(waves[:, 1] >= MIN_CROSSED_RATIO * waves.sum(axis=1), dtype=bool)


def quarter_signs(grey: GreyImage, corners_px: Array, a_px: Array, b_px: Array) -> Array:
    """Return the brightness difference (n,) of the quadrants along a + b and -a - b to the other two."""
    smooth = cv2.GaussianBlur(grey, (0, 0), 0.8).astype(np.float32)
    total = np.zeros(len(corners_px))
    for sign_a, sign_b in ((1, 1), (-1, -1), (1, -1), (-1, 1)):
        at = (corners_px + 0.3 * (sign_a * a_px + sign_b * b_px)).astype(np.float32)
        values = cv2.remap(smooth, at[:, 0], at[:, 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        total += sign_a * sign_b * values.ravel()
    return total

"""Blob detection: round spots with sub-pixel centres."""

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array

GreyImage = npt.NDArray[np.uint8]

MIN_AREA_PX, MAX_AREA_RATIO = 12.0, 0.02
MIN_AXES_RATIO = 0.25
# Minimum overlap of a spot with the ellipse of the same moments.
MIN_OVERLAP_RATIO = 0.8
MIN_CONTRAST = 10.0
# A window's size as a part of the image's height, from small dots to large ones.
WINDOW_RATIOS = (0.03, 0.07, 0.16)


@dataclass(frozen=True, slots=True, kw_only=True)
class Blobs:
    """Round spots.

    Attributes:
        centres_px: (n, 2).
        areas_px2: (n,).
        fourth_moments: (n,) normalised fourth moment of the distance from the centre: 4/3 for an ellipse,
            1.4 for a square or a parallelogram.
    """

    centres_px: Array
    areas_px2: Array
    fourth_moments: Array


def dark_blobs(grey: GreyImage, *, window_ratio: float) -> Blobs:
    """Return dark round spots on a lighter background; `window_ratio`: threshold window by image height."""
    window = max(7, int(grey.shape[0] * window_ratio) // 2 * 2 + 1)
    smooth = cv2.GaussianBlur(grey, (0, 0), 0.8)
    binary = cv2.adaptiveThreshold(smooth, 255, cv2.ADAPTIVE_THRESH_MEAN_C, cv2.THRESH_BINARY_INV, window, 5)
    count, labels, stats, _ = cv2.connectedComponentsWithStats(binary, connectivity=4)
    centres, areas, fourths = [], [], []
    max_area_px = MAX_AREA_RATIO * grey.size
    for label in range(1, count):
        left, top, width, height, area = (int(v) for v in stats[label])
        touches = left <= 0 or top <= 0 or left + width >= grey.shape[1] or top + height >= grey.shape[0]
        if touches or not MIN_AREA_PX <= area <= max_area_px or not 0.2 < width / height < 5.0:
            continue
        patch = labels[top : top + height, left : left + width] == label
        ellipse = _ellipse_of(patch)
        if ellipse is None:
            continue
        spot = _measured(grey, ellipse[0] + np.array([left, top]), ellipse[1])
        if spot is not None:
            centres.append(spot[0])
            areas.append(spot[1])
            fourths.append(ellipse[2])
    return Blobs(
        centres_px=np.array(centres, dtype=np.float64).reshape(-1, 2),
        areas_px2=np.array(areas, dtype=np.float64),
        fourth_moments=np.array(fourths, dtype=np.float64),
    )


def _ellipse_of(patch: npt.NDArray[np.bool_]) -> tuple[Array, Array, float] | None:
    """Return centre, second moments (2, 2) and fourth moment of a spot; None unless nearly an ellipse."""
    y, x = np.nonzero(patch)
    centre = np.array([x.mean(), y.mean()])
    offset = np.stack([x, y]) - centre[:, None]
    # The variance of a square pixel is added.
    moments = offset @ offset.T / x.size + np.eye(2) / 12.0
    small, large = np.sqrt(np.linalg.eigvalsh(moments))
    if small < MIN_AXES_RATIO * large:
        return None
    squares = np.einsum("in,ij,jn->n", offset, np.linalg.inv(moments), offset)
    inside = squares <= 4.0
    area = 4.0 * np.pi * small * large
    if inside.mean() < MIN_OVERLAP_RATIO or not MIN_OVERLAP_RATIO < x.size / area < 1.0 / MIN_OVERLAP_RATIO:
        return None
    return centre, moments, float((squares**2).mean() / squares.mean() ** 2)


def _measured(grey: GreyImage, centre: Array, moments: Array) -> tuple[Array, float] | None:
    """Return the intensity-weighted centre and area, relative to a planar background."""
    reach = 2.0 * np.sqrt(np.diag(moments)) * 1.6 + 3.0
    left, top = np.maximum(np.floor(centre - reach).astype(int), 0)
    right, bottom = np.ceil(centre + reach).astype(int) + 1
    patch = grey[top:bottom, left:right].astype(np.float64)
    y, x = np.mgrid[top : top + patch.shape[0], left : left + patch.shape[1]].astype(np.float64)
    dx, dy = x - centre[0], y - centre[1]
    inverse = np.linalg.inv(moments)
    # In units of the spot's radius, and in pixels beyond it.
    ratio = np.sqrt(inverse[0, 0] * dx * dx + 2 * inverse[0, 1] * dx * dy + inverse[1, 1] * dy * dy) / 2.0
    beyond = (ratio - 1.0) * 2.0 * float(np.sqrt(np.linalg.det(moments)) ** 0.5)
    ring = (beyond > 1.5) & (beyond < 1.5 + max(2.0, 0.5 * float(np.sqrt(np.linalg.det(moments)) ** 0.5)))
    core = ratio < 0.5
    if ring.sum() < 12 or not core.any():
        return None
    ground, *_ = np.linalg.lstsq(
        np.stack([np.ones(ring.sum()), dx[ring], dy[ring]], axis=1), patch[ring], rcond=None
    )
    light = ground[0] + ground[1] * dx + ground[2] * dy
    depth = float(np.median((light - patch)[core]))
    if depth < max(MIN_CONTRAST, 2.0 * float((patch - light)[ring].std())):
        return None
    weight = np.where(beyond < 1.5, (light - patch) / depth, 0.0)
    area = float(weight.sum())
    if area < MIN_AREA_PX / 2.0:
        return None
    moved = np.array([(weight * dx).sum(), (weight * dy).sum()]) / area
    if np.abs(moved).max() > 2.0:
        return None
    return centre + moved, area

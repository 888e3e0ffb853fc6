"""Blob detection: round spots with sub-pixel centres."""

from typing import Any, NamedTuple

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array

GreyImage = npt.NDArray[np.uint8]
Indices = npt.NDArray[np.signedinteger[Any]]

MIN_AREA_PX, MAX_AREA_RATIO = 12.0, 0.02
MIN_AXES_RATIO = 0.25
# Minimum overlap of a spot with the ellipse of the same moments.
MIN_OVERLAP_RATIO = 0.8
MIN_CONTRAST = 10.0
MIN_RING_PIXELS = 12
# A centre by intensity that lies further from the centre of the component is that of something else.
MAX_MOVE_PX = 2.0
MAX_PIXELS_AT_ONCE = 1_000_000
# A window's size as a part of the image's height, from small dots to large ones.
WINDOW_RATIOS = (0.03, 0.07, 0.16)


class Blobs(NamedTuple):
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
    _, labels, stats, _ = cv2.connectedComponentsWithStats(binary, connectivity=4)
    left, top, width, height, area = stats.T
    is_inside = (left > 0) & (top > 0) & (left + width < grey.shape[1]) & (top + height < grey.shape[0])
    is_plausible = (area >= MIN_AREA_PX) & (area <= MAX_AREA_RATIO * grey.size)
    is_compact = (width > 0.2 * height) & (width < 5.0 * height)
    candidates = is_inside & is_plausible & is_compact
    # Label 0 is the background.
    candidates[0] = False
    ellipses = _ellipses(labels, np.flatnonzero(candidates))
    parts = [_measured(grey, part) for part in _parts(ellipses)]
    return Blobs(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))


class _Ellipses(NamedTuple):
    """Nearly elliptic components: centres (n, 2), second moments (n, 2, 2), fourth moments (n,)."""

    centres_px: Array
    moments_px2: Array
    fourth_moments: Array


def _ellipses(labels: npt.NDArray[Any], candidates: Indices) -> _Ellipses:
    """Return the components of these labels that are nearly ellipses."""
    index_of = np.full(int(labels.max()) + 1, -1, dtype=np.int32)
    index_of[candidates] = np.arange(len(candidates), dtype=np.int32)
    index = index_of[labels]
    y, x = np.nonzero(index >= 0)
    index = index[y, x]
    count = len(candidates)
    counts = np.bincount(index, minlength=count)
    centres = np.stack([_sums(index, x, count), _sums(index, y, count)], axis=1) / counts[:, None]
    dx, dy = x - centres[index, 0], y - centres[index, 1]
    xx, xy, yy = (_sums(index, product, count) / counts for product in (dx * dx, dx * dy, dy * dy))
    # The variance of a square pixel is added.
    moments = np.stack([xx, xy, xy, yy], axis=1).reshape(-1, 2, 2) + np.eye(2) / 12.0
    small, large = np.sqrt(np.linalg.eigvalsh(moments)).T
    squares = _squares(moments, index, dx, dy)
    inside_ratios = _sums(index, squares <= 4.0, count) / counts
    area_ratios = counts / (4.0 * np.pi * small * large)
    is_ellipse = (
        (small >= MIN_AXES_RATIO * large)
        & (inside_ratios >= MIN_OVERLAP_RATIO)
        & (area_ratios > MIN_OVERLAP_RATIO)
        & (area_ratios < 1.0 / MIN_OVERLAP_RATIO)
    )
    fourths = _sums(index, squares**2, count) * counts / _sums(index, squares, count) ** 2
    return _Ellipses(centres[is_ellipse], moments[is_ellipse], fourths[is_ellipse])


def _parts(ellipses: _Ellipses) -> list[_Ellipses]:
    """Return the ellipses in parts whose pixels fit into little memory."""
    pixels = np.cumsum(np.prod(2.0 * _reach_px(ellipses.moments_px2) + 2.0, axis=1))
    cuts = np.flatnonzero(np.diff(pixels // MAX_PIXELS_AT_ONCE)) + 1
    return [_Ellipses(*part) for part in zip(*(np.split(column, cuts) for column in ellipses), strict=True)]


def _reach_px(moments_px2: Array) -> Array:
    """Return (n, 2) the half width and height that hold a spot and the background around it."""
    return 3.2 * np.sqrt(np.diagonal(moments_px2, axis1=1, axis2=2)) + 3.0


def _measured(grey: GreyImage, ellipses: _Ellipses) -> tuple[Array, Array, Array]:
    """Return intensity-weighted centres and areas, relative to a planar background, and fourth moments."""
    centres, moments, fourths = ellipses
    count = len(centres)
    reach = _reach_px(moments)
    first = np.maximum(np.floor(centres - reach).astype(int), 0)
    last = np.minimum(np.ceil(centres + reach).astype(int), np.array(grey.shape[::-1]) - 1)
    # The pixels of all spots in one table, because a call of NumPy for each spot costs more than its pixels.
    wide, high = (last - first + 1).T
    spot = np.repeat(np.arange(count), wide * high)
    pixel = np.arange(len(spot)) - np.repeat(np.cumsum(wide * high) - wide * high, wide * high)
    x, y = first[spot, 0] + pixel % wide[spot], first[spot, 1] + pixel // wide[spot]
    value = grey[y, x].astype(np.float64)
    dx, dy = x - centres[spot, 0], y - centres[spot, 1]
    # In units of the spot's radius, and in pixels beyond it.
    ratio = np.sqrt(_squares(moments, spot, dx, dy)) / 2.0
    deviation_px = np.linalg.det(moments) ** 0.25
    beyond = (ratio - 1.0) * 2.0 * deviation_px[spot]
    is_ring = (beyond > 1.5) & (beyond < 1.5 + np.maximum(2.0, 0.5 * deviation_px)[spot])
    is_core = ratio < 0.5

    ring = spot[is_ring]
    ring_counts = np.bincount(ring, minlength=count)
    columns = (np.ones(len(ring)), dx[is_ring], dy[is_ring])
    normal = np.stack([[_sums(ring, a * b, count) for b in columns] for a in columns])
    right = np.stack([_sums(ring, a * value[is_ring], count) for a in columns])
    # A ring that the image's border cuts to a line does not determine the plane.
    ground = np.einsum("nij,jn->ni", np.linalg.pinv(normal.transpose(2, 0, 1), hermitian=True), right)
    depression = ground[spot, 0] + ground[spot, 1] * dx + ground[spot, 2] * dy - value
    residual = depression[is_ring]
    with np.errstate(invalid="ignore", divide="ignore"):
        residual = residual - (_sums(ring, residual, count) / ring_counts)[ring]
        noise = np.sqrt(_sums(ring, residual**2, count) / ring_counts)
        depth = _medians(spot[is_core], depression[is_core], count)
        weight = np.where(beyond < 1.5, depression / depth[spot], 0.0)
        area = _sums(spot, weight, count)
        moved = np.stack([_sums(spot, weight * d, count) for d in (dx, dy)], axis=1) / area[:, None]
        is_spot = (
            (ring_counts >= MIN_RING_PIXELS)
            & (depth >= np.maximum(MIN_CONTRAST, 2.0 * noise))
            & (area >= MIN_AREA_PX / 2.0)
            & (np.abs(moved).max(axis=1) <= MAX_MOVE_PX)
        )
    return (centres + moved)[is_spot], area[is_spot], fourths[is_spot]


def _squares(moments: Array, index: Indices, dx: Array, dy: Array) -> Array:
    """Return the squared Mahalanobis distance of each offset under the moments of its index."""
    inverse = np.linalg.inv(moments)
    xx, xy, yy = inverse[:, 0, 0][index], 2.0 * inverse[:, 0, 1][index], inverse[:, 1, 1][index]
    return np.asarray(dx * (xx * dx + xy * dy) + yy * dy * dy, dtype=np.float64)


def _sums(index: Indices, values: npt.NDArray[np.generic], count: int) -> Array:
    """Return the sum of the values of each of `count` indices."""
    return np.asarray(np.bincount(index, values, count), dtype=np.float64)


def _medians(index: Indices, values: Array, count: int) -> Array:
    """Return the median of the values of each index, NaN for an index without values."""
    ordered = np.append(values[np.lexsort((values, index))], np.nan)
    counts = np.bincount(index, minlength=count)
    begins = np.cumsum(counts) - counts
    low, high = begins + (counts - 1) // 2, begins + counts // 2
    return np.where(counts > 0, (ordered[low] + ordered[high]) / 2.0, np.nan)

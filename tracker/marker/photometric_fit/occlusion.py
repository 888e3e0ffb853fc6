"""Occlusion mask of a square: components over its border occlude it, components inside contradict it."""

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.marker.photometric_fit.grid_kernels import RING, SQUARE_CELLS
from tracker.marker.photometric_fit.occlusion_kernels import dilated, half_plane_weights, residual_components

Mask = npt.NDArray[np.bool_]
OCCLUDED_CONTRAST, CLEAR_CONTRAST = 0.35, 0.2
MIN_COMPONENT_CELLS = 3
# A smaller component is a speck (dirt, a highlight) and not another shape.
MIN_AREA_RATIO = MIN_COMPONENT_CELLS / SQUARE_CELLS**2 - 1e-9
# Largest rim of an occluder that differs in illumination, in cells.
MAX_RIM = 10
WIDE_BLUR_CELLS = 0.6
MAX_CLEAR_RATIO = 0.1
SAME_OCCLUDER_CONTRAST, MAX_SLOPE = 0.35, 0.12
# Minimum visible part of the occluder on the paper, by the area of the component inside.
MIN_END_RATIO = 0.3
# Minimum contrast by its maximum: a darker cell is ink, not absence of light.
MIN_GAIN_RATIO = 0.08
# Directions and offsets of the half planes, offsets in half sides.
HALF_PLANE_ANGLES, HALF_PLANE_OFFSETS = 12, np.array([0.0, 0.35, 0.7])
OUTLIER_RESIDUAL_CONTRAST = 0.25


@dataclass(frozen=True, slots=True, kw_only=True)
class Residuals:
    """Cells (n, n) of a square and its paper after a fit.

    Attributes:
        observed: grey levels of the image.
        picture: the model, dark 0 to bright 1.
        residual: observed minus predicted value, in grey levels.
        gain: the contrast, in grey levels.
    """

    observed: Array
    picture: npt.NDArray[np.float32]
    residual: Array
    gain: Array


def unoccluded_weights(observed: Array, picture: npt.NDArray[np.float32]) -> Array | None:
    """Return weights by planar illumination of the unoccluded part; None where none are needed."""
    weight = np.empty(observed.shape)
    found = half_plane_weights(
        observed, picture, HALF_PLANE_ANGLES, HALF_PLANE_OFFSETS, OUTLIER_RESIDUAL_CONTRAST, weight
    )
    return weight if found else None


def find_occlusion(left: Residuals, *, blur_sd_cells: float) -> tuple[Mask, int]:
    """Return the occlusion mask and the area of the largest other contradicting component, in cells.

    `blur_sd_cells` is the sd of the image blur, by which the edge of an occluder spreads.
    """
    night = MIN_GAIN_RATIO * float(left.gain.max())
    contrast = np.maximum(left.gain, night)
    labels = np.empty(left.observed.shape, np.int64)
    areas = residual_components(left.residual, contrast, RING, OCCLUDED_CONTRAST, MIN_COMPONENT_CELLS, labels)
    occluded = (left.gain <= night) | (labels == -1)
    inside = 0
    occluders = occluded.copy() if len(areas) else occluded
    beside = dilated(dilated(occluders)) if len(areas) else occluders
    for number, area in enumerate(areas, start=1):
        piece = labels == number
        is_rim = int(area) <= MAX_RIM and bool((piece & beside).any())
        if is_rim or _continues_occluder(piece, occluders, left, contrast):
            occluded |= piece
        else:
            inside = max(inside, int(area))
    out = dilated(occluded)
    return (dilated(out) if blur_sd_cells > WIDE_BLUR_CELLS else out), inside


def _continues_occluder(piece: Mask, occluders: Mask, left: Residuals, contrast: Array) -> bool:
    """Return whether a component inside connects to an occluder, unseen because it is as dark as the ink.

    It does if the convex hull of both contains no part that clearly fits the model, in particular no outline:
    under a shadow the outline is faint but present.
    """
    observed = left.observed
    count, labels = cv2.connectedComponents(occluders.astype(np.uint8), connectivity=8)
    grey = float(np.median(observed[piece]))
    clear = (np.abs(left.residual) < CLEAR_CONTRAST * contrast) & (np.abs(observed - grey) > 0.4 * contrast)
    for label in range(1, count):
        end = labels == label
        ncc = abs(float(np.median(observed[end])) - grey) < SAME_OCCLUDER_CONTRAST * float(
            np.median(contrast[end])
        )
        if not ncc or end.sum() < MIN_END_RATIO * piece.sum():
            continue
        v, u = np.nonzero(piece | end)
        area = np.zeros(piece.shape, np.uint8)
        cv2.fillConvexPoly(area, cv2.convexHull(np.stack([u, v], axis=1).astype(np.int32)), 1)
        over = area > 0
        if (
            float(clear[over].mean()) < MAX_CLEAR_RATIO
            and _slope(observed, left.picture, over, contrast) < MAX_SLOPE
        ):
            return True
    return False


def _slope(observed: Array, picture: npt.NDArray[np.float32], area: Mask, contrast: Array) -> float:
    """Return the fraction of the model's contrast that is observed in an area, 0..1."""
    model = picture[area] - picture[area].mean()
    spread = float(model @ model)
    return (
        float(model @ observed[area]) / (spread * float(np.median(contrast[area]))) if spread > 0.0 else 0.0
    )

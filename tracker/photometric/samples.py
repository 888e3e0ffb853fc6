"""Pixel samples of the photometric fit."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tracker.edges import GreyImage
from tracker.geometry import Array, Camera, Marker, Rigid
from tracker.photometric.render_kernels import rays_to_plane
from tracker.photometric.selection_kernels import select_pixels
from tracker.photometric.texture import Textures

# Half width of the sampled area, in sides: the outer half of the blurred outline lies on white paper, and
# background beyond the paper is excluded.
REACH_RATIO = 0.6
# Pixels below this ratio to the steepest slope constrain the pose little: one in `FLAT_STRIDE` is taken.
# Where pixels are averaged, fewer lie on edges, and the ratio is lower.
MIN_SLOPE_RATIO, MIN_SLOPE_RATIO_AVERAGED, FLAT_STRIDE = 0.25, 0.12, 10
MAX_PIXELS = 30_000

# Maps points (n, 2) of a marker's plane, in sides from its centre to the right and upwards, to whether they
# are occluded (n,).
OccludedAt = Callable[[Array], npt.NDArray[np.bool_]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Samples:
    """Pixel values (n,) with their rays (n, 2), and the texture they are compared with.

    Each value is the mean of `step` x `step` pixels.
    """

    rays: Array
    values: Array
    lens: Array
    textures: Textures
    side_mm: float
    step: int


def sample_pixels(
    image: GreyImage,
    lens: Array,
    textures: Textures,
    start: Rigid[Camera, Marker],
    *,
    side_mm: float,
    step: int,
    blur_px2: Array,
    occluded_at: OccludedAt | None = None,
) -> Samples:
    """Select the pixels that constrain the pose near a start at this blur (3,), without occluded ones."""
    rays, values = np.empty((MAX_PIXELS, 2)), np.empty(MAX_PIXELS)
    # Copies, because Numba compiles a kernel again for arrays that are read-only.
    rotation, translation_mm = start.rotation.copy(), start.translation_mm.copy()
    count = select_pixels(
        image,
        step,
        lens,
        rotation,
        translation_mm,
        side_mm,
        REACH_RATIO,
        textures.arrays,
        blur_px2,
        MIN_SLOPE_RATIO if step == 1 else MIN_SLOPE_RATIO_AVERAGED,
        FLAT_STRIDE,
        rays,
        values,
    )
    rays, values = rays[:count], values[:count]
    if occluded_at is not None:
        at = np.empty_like(rays)
        rays_to_plane(rays, 0, count, rotation, translation_mm, side_mm, at)
        # `at` is in half sides.
        seen = ~occluded_at(0.5 * at)
        rays, values = np.ascontiguousarray(rays[seen]), values[seen]
    return Samples(rays=rays, values=values, lens=lens, textures=textures, side_mm=side_mm, step=step)


def subsample(seen: Samples, count: int) -> Samples:
    """Return about `count` of the samples, evenly spread."""
    every = max(len(seen.values) // count, 1)
    if every == 1:
        return seen
    return replace(
        seen,
        rays=np.ascontiguousarray(seen.rays[::every]),
        values=np.ascontiguousarray(seen.values[::every]),
    )

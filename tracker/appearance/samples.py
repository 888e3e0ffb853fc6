"""The pixels that tell of a marker's pose."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tracker.appearance.picture.kernels import onto_plane
from tracker.appearance.pixels.kernels import collect
from tracker.appearance.texture import Textures
from tracker.edges import GreyImage
from tracker.geometry import Array, Camera, Marker, Rigid

# Half of the part of the plane that is looked at, in sides: the outline's blurred outer half lies on the
# white paper, and what lies beyond the paper must not come in.
REACH_RATIO = 0.6
# Where the picture is this much flatter than at its steepest a pixel says little of the pose: few are enough.
# Where pixels are averaged, edges cover few of them, and all of those are asked.
MIN_SLOPE_RATIO, MIN_SLOPE_RATIO_AVERAGED, FLAT_STRIDE = 0.25, 0.12, 10
MAX_PIXELS = 30_000

# Which points (n, 2) of a marker's plane, in sides from its centre to the right and upwards, are covered.
CoveredAt = Callable[[Array], npt.NDArray[np.bool_]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Samples:
    """Pixels (n,) with their rays (n, 2), and what they are a picture of.

    `step` of them each way were averaged.
    """

    rays: Array
    values: Array
    lens: Array
    textures: Textures
    side_mm: float
    step: int


def samples_of(
    image: GreyImage,
    lens: Array,
    textures: Textures,
    start: Rigid[Camera, Marker],
    *,
    side_mm: float,
    step: int,
    blur_px2: Array,
    covered_at: CoveredAt | None = None,
) -> Samples:
    """The pixels that tell of the pose, as seen from a start at this blur (3,); not what is covered."""
    rays, values = np.empty((MAX_PIXELS, 2)), np.empty(MAX_PIXELS)
    count = collect(
        image,
        step,
        lens,
        start.rotation,
        start.translation_mm,
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
    if covered_at is not None:
        at = np.empty_like(rays)
        onto_plane(rays, 0, count, start.rotation, start.translation_mm, side_mm, at)
        # That is in half sides.
        seen = ~covered_at(0.5 * at)
        rays, values = np.ascontiguousarray(rays[seen]), values[seen]
    return Samples(rays=rays, values=values, lens=lens, textures=textures, side_mm=side_mm, step=step)


def some_of(seen: Samples, count: int) -> Samples:
    """About so many of the pixels, from everywhere."""
    every = max(len(seen.values) // count, 1)
    if every == 1:
        return seen
    return replace(
        seen,
        rays=np.ascontiguousarray(seen.rays[::every]),
        values=np.ascontiguousarray(seen.values[::every]),
    )

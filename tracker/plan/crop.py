"""The part of a CT around a few points, small enough to be sent to a viewer."""

import numpy as np
import numpy.typing as npt

from tracker.errors import PlanError
from tracker.geometry import Array
from tracker.plan.volume import Volume

# Around the channels of a vertebra: its body in front of them, the skin side of an approach behind them.
MARGIN_MM, MIN_MARGIN_MM = 30.0, 10.0
MAX_SIDE_MM = 100.0
MAX_BYTES = 16 * 2**20


def cropped_around(volume: Volume, points_lps_mm: npt.ArrayLike, *, max_bytes: int = MAX_BYTES) -> Volume:
    """Return the part of a CT around points, as a copy of its voxels.

    The margin is 30 mm along each patient axis, reduced to fit into 100 mm, but never less than 10 mm. Where
    the part needs more than `max_bytes`, pairs of neighbouring voxels are averaged along the axis with the
    smallest spacing until it does not; otherwise its voxels are those of the CT.

    Args:
        volume: the CT; may be mapped from a file, of which only this part is read.
        points_lps_mm: (n, 3) in LPS mm, such as the ends of the channels.
        max_bytes: limit on the size of the voxels.

    Raises:
        PlanError: CROP_OUTSIDE_CT, the part has fewer than two voxels along an axis of the CT.
    """
    low, high = _box_mm(np.asarray(points_lps_mm, dtype=np.float64))
    corners = np.stack(np.meshgrid(*zip(low, high, strict=True), indexing="ij"), axis=-1).reshape(-1, 3)
    index = volume.index_from_lps(corners)
    last = np.array(volume.shape_ijk) - 1
    first = np.clip(np.floor(index.min(axis=0)).astype(int), 0, last)
    end = np.clip(np.ceil(index.max(axis=0)).astype(int), 0, last)
    if (end - first < 1).any():
        raise PlanError(
            "CROP_OUTSIDE_CT",
            f"around the channels the CT has only {' x '.join(str(n) for n in end - first + 1)} voxels, "
            "needed 2 along each axis",
            "Plan the channels on this CT again.",
            {
                "low_lps_mm": low.tolist(),
                "high_lps_mm": high.tolist(),
                "voxels": " x ".join(str(n) for n in end - first + 1),
            },
        )
    rows, columns = slice(first[1], end[1] + 1), slice(first[0], end[0] + 1)
    # Slice by slice, because one large copy would block the interpreter and delay the navigation.
    hu = np.empty((end - first + 1)[::-1], dtype=np.int16)
    for k in range(hu.shape[0]):
        hu[k] = volume.hu[first[2] + k, rows, columns]
    affine = volume.lps_from_ijk.copy()
    affine[:3, 3] = volume.lps_from_index(first)
    part = Volume(hu=hu, lps_from_ijk=affine)
    while part.hu.nbytes > max_bytes:
        part = _halved(part, int(np.argmin(part.spacing_mm)))
    return part


def _box_mm(points_mm: Array) -> tuple[Array, Array]:
    low, high = points_mm.min(axis=0), points_mm.max(axis=0)
    margin_mm = np.clip((MAX_SIDE_MM - (high - low)) / 2.0, MIN_MARGIN_MM, MARGIN_MM)
    return low - margin_mm, high + margin_mm


def _halved(volume: Volume, axis: int) -> Volume:
    """Return the volume with pairs of voxels along an axis (i, j, k) averaged; a last odd one is dropped."""
    pairs = volume.shape_ijk[axis] // 2
    shape = list(volume.hu.shape)
    shape[2 - axis] = pairs
    hu = np.empty(shape, dtype=np.int16)
    for n in range(pairs):
        pair = np.take(volume.hu, (2 * n, 2 * n + 1), axis=2 - axis).mean(axis=2 - axis)
        hu[tuple(n if dimension == 2 - axis else slice(None) for dimension in range(3))] = np.rint(pair)
    affine = volume.lps_from_ijk.copy()
    affine[:3, 3] += affine[:3, axis] / 2.0
    affine[:3, axis] *= 2.0
    return Volume(hu=hu, lps_from_ijk=affine)

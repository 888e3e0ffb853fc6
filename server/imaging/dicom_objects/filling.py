"""Voxels whose centres lie inside of a closed surface."""

import numpy as np
import numpy.typing as npt

from server.imaging.dicom_objects.source import SourceSeries
from tracker.geometry import Array
from tracker.plan import Surface

# A row of voxels would meet the edge of two triangles twice; rows are shifted by parts of a nanometre.
SHIFT_VOXELS = (1.3e-7, 2.9e-7)


def is_closed(surface: Surface) -> bool:
    """Return whether each edge belongs to two triangles."""
    edges = np.sort(surface.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    return bool((np.unique(edges, axis=0, return_counts=True)[1] == 2).all())


def filled(source: SourceSeries, surface: Surface) -> npt.NDArray[np.bool_]:
    """Return which voxels (slices, rows, columns) of the CT lie inside, by the parity of crossings."""
    affine = source.stack.lps_from_ijk
    corners = (surface.vertices_mm - affine[:3, 3]) @ np.linalg.inv(affine[:3, :3]).T
    triangles = corners[surface.faces]
    columns, rows = source.size_wh_px
    crossings = np.zeros((len(source.frames), rows, columns + 1), dtype=np.uint8)
    low = np.ceil(triangles[:, :, 1:].min(axis=1) - SHIFT_VOXELS).astype(int)
    high = np.floor(triangles[:, :, 1:].max(axis=1) - SHIFT_VOXELS).astype(int)
    reach = high - low
    for j in range(int(reach[:, 0].max()) + 1):
        for k in range(int(reach[:, 1].max()) + 1):
            is_met = (reach >= (j, k)).all(axis=1)
            _count(crossings, triangles[is_met], low[is_met] + (j, k))
    return np.asarray(np.cumsum(crossings, axis=2, dtype=np.uint8)[:, :, :columns] % 2 == 1)


def _count(crossings: npt.NDArray[np.uint8], triangles: Array, rows: npt.NDArray[np.int64]) -> None:
    """Count where each triangle (n, 3, 3) is met by its row (n, 2), if it is, at the next voxel."""
    first, second, third = (triangles[:, n] for n in range(3))
    offset = rows + SHIFT_VOXELS - first[:, 1:]
    across, along = second[:, 1:] - first[:, 1:], third[:, 1:] - first[:, 1:]
    area = across[:, 0] * along[:, 1] - across[:, 1] * along[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        u = (offset[:, 0] * along[:, 1] - offset[:, 1] * along[:, 0]) / area
        v = (across[:, 0] * offset[:, 1] - across[:, 1] * offset[:, 0]) / area
        is_met = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0)
    u, v, (j, k) = u[is_met], v[is_met], rows[is_met].T
    at = first[is_met, 0] + u * (second - first)[is_met, 0] + v * (third - first)[is_met, 0]
    i = np.clip(np.ceil(at), 0, crossings.shape[2] - 1).astype(int)
    slices, height, _ = crossings.shape
    is_inside = (j >= 0) & (j < height) & (k >= 0) & (k < slices)
    np.add.at(crossings, (k[is_inside], j[is_inside], i[is_inside]), 1)

"""Labels of vertebrae in the grid of the CT, and what is measured of each."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from tracker.geometry import Array
from tracker.plan.labels.levels import CLASS_OF_LEVEL, LEVEL_OF_CLASS

Labels = npt.NDArray[np.uint8]
MM3_PER_ML = 1000.0


@dataclass(frozen=True, slots=True, kw_only=True)
class VertebraLabel:
    """Measured properties of the label of one vertebra.

    Attributes:
        level: `L3`.
        volume_ml: volume of its voxels.
        centroid_lps_mm: (3,).
        low_lps_mm: (3,), smallest coordinates of its voxel centres.
        high_lps_mm: (3,), largest coordinates.
        is_cut: whether it touches the border of the CT, so that a part of the vertebra may be missing.
    """

    level: str
    volume_ml: float
    centroid_lps_mm: Array
    low_lps_mm: Array
    high_lps_mm: Array
    is_cut: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class LabelVolume:
    """Class numbers of vertebrae (`CLASS_OF_LEVEL`) in voxels of the CT; 0 is no vertebra.

    Attributes:
        labels: (slices, rows, columns) uint8; labels[k, j, i] belongs to index (i, j, k).
        lps_from_ijk: (4, 4) affine in mm, as in `Volume`. The array may be a part of the CT.
        voxel_mm: largest distance of neighbouring voxels in the CT and in the file that the labels are from.
    """

    labels: Labels
    lps_from_ijk: Array
    voxel_mm: float

    @property
    def levels(self) -> tuple[str, ...]:
        """Return the levels that have a label, from the head down."""
        numbers = np.unique(self.labels)
        return tuple(level for level, number in CLASS_OF_LEVEL.items() if number in numbers)

    @property
    def spacing_mm(self) -> Array:
        """Return the distances (3,) between neighbouring voxels along i, j and k."""
        return np.asarray(np.linalg.norm(self.lps_from_ijk[:3, :3], axis=0))

    def lps_from_index(self, index_ijk: npt.ArrayLike) -> Array:
        """Return points (..., 3) in LPS mm of indexes (..., 3) as i, j, k."""
        return np.asarray(
            np.asarray(index_ijk, dtype=np.float64) @ self.lps_from_ijk[:3, :3].T + self.lps_from_ijk[:3, 3]
        )

    def level_at(self, points_lps_mm: npt.ArrayLike) -> list[str]:
        """Return the level at each of the points (n, 3), nearest voxel; empty where there is no label."""
        return [LEVEL_OF_CLASS.get(int(number), "") for number in self.numbers_at(points_lps_mm)]

    def numbers_at(self, points_lps_mm: npt.ArrayLike) -> Labels:
        """Return the class number at each of the points (n, 3), nearest voxel; 0 where there is no label."""
        offset = np.asarray(points_lps_mm, dtype=np.float64).reshape(-1, 3) - self.lps_from_ijk[:3, 3]
        index = np.rint(offset @ np.linalg.inv(self.lps_from_ijk[:3, :3]).T).astype(np.int64)
        size = np.array(self.labels.shape[::-1])
        is_inside = ((index >= 0) & (index < size)).all(axis=1)
        i, j, k = np.clip(index, 0, size - 1).T
        return np.where(is_inside, self.labels[k, j, i], 0).astype(np.uint8)

    def cropped_to(self, level: str, margin_mm: float = 0.0) -> "LabelVolume":
        """Return the part around one label, in which only that label remains.

        The part has at least one voxel without label on each side.

        Raises:
            KeyError: there is no such label.
        """
        is_level = self.labels == CLASS_OF_LEVEL[level]
        (box,) = scipy.ndimage.find_objects(is_level.astype(np.uint8), max_label=1)
        if box is None:
            raise KeyError(level)
        margin = 1 + np.ceil(margin_mm / self.spacing_mm[::-1]).astype(int)
        part = np.pad(is_level[box], [(width, width) for width in margin])
        start = np.array([one.start for one in box]) - margin
        affine = self.lps_from_ijk.copy()
        affine[:3, 3] = self.lps_from_index(start[::-1])
        return LabelVolume(
            labels=part * np.uint8(CLASS_OF_LEVEL[level]), lps_from_ijk=affine, voxel_mm=self.voxel_mm
        )

    def distance_mm(self, level: str, points_lps_mm: npt.ArrayLike) -> Array:
        """Return signed distances (n,) of points (n, 3) to the surface of a label, negative inside.

        The distance is that of the nearest voxel on the other side less half a voxel, so that it is exact to
        about half a voxel. Raises KeyError without such a label.
        """
        points = np.asarray(points_lps_mm, dtype=np.float64).reshape(-1, 3)
        part = self.cropped_to(level)
        inside = part.labels > 0
        spacing = part.spacing_mm[::-1]
        index = (points - part.lps_from_ijk[:3, 3]) @ np.linalg.inv(part.lps_from_ijk[:3, :3]).T
        clipped = np.clip(index, 0.0, np.array(inside.shape[::-1]) - 1.0)
        beyond_mm = np.linalg.norm((index - clipped) * spacing[::-1], axis=1)
        depth = scipy.ndimage.distance_transform_edt(inside, sampling=spacing)
        outside = scipy.ndimage.distance_transform_edt(~inside, sampling=spacing)
        signed = np.where(inside, 0.5 * spacing.mean() - depth, outside - 0.5 * spacing.mean())
        at_mm = scipy.ndimage.map_coordinates(signed, clipped[:, ::-1].T, order=1, mode="nearest")
        return np.asarray(at_mm + beyond_mm)


def measure_labels(volume: LabelVolume, *, shape_ijk: Sequence[int]) -> tuple[VertebraLabel, ...]:
    """Return the measured labels, from the head down.

    Args:
        volume: the labels in the complete grid of the CT.
        shape_ijk: number of columns, rows and slices of the CT.
    """
    boxes = scipy.ndimage.find_objects(volume.labels)
    voxel_ml = abs(float(np.linalg.det(volume.lps_from_ijk[:3, :3]))) / MM3_PER_ML
    measured = []
    for level, number in CLASS_OF_LEVEL.items():
        box = boxes[number - 1] if number <= len(boxes) else None
        if box is None:
            continue
        index = np.argwhere(volume.labels[box] == number)[:, ::-1] + [one.start for one in box[::-1]]
        points = volume.lps_from_index(index)
        measured.append(
            VertebraLabel(
                level=level,
                volume_ml=len(index) * voxel_ml,
                centroid_lps_mm=points.mean(axis=0),
                low_lps_mm=points.min(axis=0),
                high_lps_mm=points.max(axis=0),
                is_cut=bool((index == 0).any() or (index == np.array(shape_ijk) - 1).any()),
            )
        )
    return tuple(measured)
